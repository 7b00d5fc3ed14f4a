// SPDX-License-Identifier: MIT
//
// Native code that computes in binary128 calls functions for every operation. A library that includes this file defines these
// functions, and computes them by MPFR with 400 bits instead, so that the reference of a kernel can itself be checked (`sk accuracy`).
// Include it in one source of the library only, and link libmpfr in place of libquadmath.
//
// A number that binary128 cannot hold is passed on as its first 97 bits and a number in the last 16, by which its 400 bits are
// found again. Copies, signs and choices keep the bits, and comparisons are functions, too. For x86-64, whose functions of
// binary128 have names of their own.
#pragma once

#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <mutex>
#include <unordered_map>

#include <mpfr.h>

namespace sk::native::mpfr {

__extension__ typedef __float128 Quad;

inline constexpr mpfr_prec_t precision = 400;
inline constexpr std::size_t mostKept = std::size_t{1}
                                        << 20;  ///< later numbers have the bits of binary128 only

/// A binary128: `low` holds the last 64 bits.
struct Bits {
  std::uint64_t low = 0, high = 0;

  bool operator==(const Bits&) const = default;
  bool isNegative() const { return high >> 63 != 0; }
  int exponent() const { return static_cast<int>(high >> 48 & 0x7fff); }
  Bits magnitude() const { return {low, high & ~(std::uint64_t{1} << 63)}; }
};

struct HashOfBits {
  std::size_t operator()(const Bits& bits) const {
    return (bits.low ^ bits.high * 0x9e3779b97f4a7c15U) * 0xbf58476d1ce4e5b9U >> 7;
  }
};

inline Bits bitsOf(Quad x) { return std::bit_cast<Bits>(x); }

inline Quad quadOf(Bits bits, bool isNegative) {
  bits.high |= isNegative ? std::uint64_t{1} << 63 : 0;
  return std::bit_cast<Quad>(bits);
}

class Number {
 public:
  Number() { mpfr_init2(value, precision); }
  ~Number() { mpfr_clear(value); }
  Number(const Number&) = delete;
  Number& operator=(const Number&) = delete;

  mpfr_t value;
};

/// The numbers that binary128 cannot hold, by their bits without a sign.
class Store {
 public:
  void find(mpfr_t value, Quad x) {
    const Bits all = bitsOf(x), bits = all.magnitude();
    if (const auto kept = numbers_.find(bits); kept != numbers_.end()) {
      mpfr_set(value, kept->second->value, MPFR_RNDN);
    } else if (bits.exponent() == 0x7fff) {
      const bool isInfinite = bits.low == 0 && (bits.high & 0xffffffffffff) == 0;
      isInfinite ? mpfr_set_inf(value, 1) : mpfr_set_nan(value);
    } else {
      const bool isNormal = bits.exponent() != 0;
      const std::uint64_t first = (bits.high & 0xffffffffffff) | (isNormal ? std::uint64_t{1} << 48 : 0);
      const int unit = (isNormal ? bits.exponent() : 1) - 16383 - 112;
      mpfr_set_ui_2exp(value, first, unit + 64, MPFR_RNDN);
      mpfr_set_ui_2exp(low_.value, bits.low, unit, MPFR_RNDN);
      mpfr_add(value, value, low_.value, MPFR_RNDN);
    }
    if (all.isNegative()) mpfr_neg(value, value, MPFR_RNDN);
  }

  Quad keep(const mpfr_t value) {
    const bool isNegative = mpfr_signbit(value) != 0;
    if (mpfr_nan_p(value)) return quadOf({1, 0x7fff800000000000}, false);
    if (mpfr_zero_p(value)) return quadOf({}, isNegative);
    mpfr_set(short_, value, MPFR_RNDZ);
    const long field = mpfr_inf_p(value) ? 0x7fff : mpfr_get_exp(short_) - 1 + 16383;
    if (field >= 0x7fff) return quadOf({0, std::uint64_t{0x7fff} << 48}, isNegative);
    if (field <= 0) return quadOf({}, isNegative);
    const bool isExact = mpfr_equal_p(short_, value) != 0;
    // The 97 bits as two whole numbers, of 49 and 48 bits.
    mpfr_abs(short_, short_, MPFR_RNDN);
    mpfr_mul_2si(short_, short_, 49 - mpfr_get_exp(short_), MPFR_RNDN);
    const std::uint64_t first = mpfr_get_ui(short_, MPFR_RNDZ);
    mpfr_sub_ui(short_, short_, first, MPFR_RNDN);
    mpfr_mul_2si(short_, short_, 48, MPFR_RNDN);
    const std::uint64_t second = mpfr_get_ui(short_, MPFR_RNDZ);
    Bits bits{second << 16, (static_cast<std::uint64_t>(field) << 48) | (first & 0xffffffffffff)};
    if (isExact || kept_.size() >= mostKept) return quadOf(bits, isNegative);
    for (int tries = 0; tries < 64; ++tries) {
      number_ = number_ % 0xffff + 1;
      bits.low = (second << 16) | number_;
      if (numbers_.contains(bits)) continue;
      Number& number = kept_.emplace_back();
      mpfr_abs(number.value, value, MPFR_RNDN);
      numbers_.emplace(bits, &number);
      break;
    }
    return quadOf(bits, isNegative);
  }

  Store() { mpfr_init2(short_, 97); }
  ~Store() { mpfr_clear(short_); }
  Store(const Store&) = delete;
  Store& operator=(const Store&) = delete;

 private:
  std::unordered_map<Bits, Number*, HashOfBits> numbers_;
  std::deque<Number> kept_;
  Number low_;
  mpfr_t short_;
  std::uint64_t number_ = 0;
};

/// The store and a call's arguments and result; threads take turns.
class Call {
 public:
  template <class... Quads>
  explicit Call(Quads... x) : lock_(mutex()) {
    std::size_t i = 0;
    (store().find(operands()[i++].value, x), ...);
  }
  mpfr_t& operator[](std::size_t i) { return operands()[i].value; }
  mpfr_t& result() { return operands()[3].value; }
  Quad keep() { return store().keep(result()); }

 private:
  static std::mutex& mutex() {
    static std::mutex mutex;
    return mutex;
  }
  static Store& store() {
    static Store store;
    return store;
  }
  static std::array<Number, 4>& operands() {
    static std::array<Number, 4> operands;
    return operands;
  }

  std::scoped_lock<std::mutex> lock_;
};

}  // namespace sk::native::mpfr

extern "C" {

#define SK_QUAD1(name, function)                          \
  sk::native::mpfr::Quad name(sk::native::mpfr::Quad x) { \
    sk::native::mpfr::Call call(x);                       \
    function(call.result(), call[0]);                     \
    return call.keep();                                   \
  }
#define SK_QUAD2(name, function)                                                    \
  sk::native::mpfr::Quad name(sk::native::mpfr::Quad x, sk::native::mpfr::Quad y) { \
    sk::native::mpfr::Call call(x, y);                                              \
    function(call.result(), call[0], call[1], MPFR_RNDN);                           \
    return call.keep();                                                             \
  }
#define SK_QUAD_OF(name)                                     \
  sk::native::mpfr::Quad name##q(sk::native::mpfr::Quad x) { \
    sk::native::mpfr::Call call(x);                          \
    mpfr_##name(call.result(), call[0], MPFR_RNDN);          \
    return call.keep();                                      \
  }
SK_QUAD2(__addtf3, mpfr_add)
SK_QUAD2(__subtf3, mpfr_sub)
SK_QUAD2(__multf3, mpfr_mul)
SK_QUAD2(__divtf3, mpfr_div)
SK_QUAD2(powq, mpfr_pow)
SK_QUAD2(atan2q, mpfr_atan2)
SK_QUAD2(fmodq, mpfr_fmod)
SK_QUAD2(hypotq, mpfr_hypot)
SK_QUAD1(floorq, mpfr_floor)
SK_QUAD1(ceilq, mpfr_ceil)
SK_QUAD1(truncq, mpfr_trunc)
SK_QUAD1(nearbyintq, mpfr_roundeven)
SK_QUAD_OF(sqrt)
SK_QUAD_OF(sin)
SK_QUAD_OF(cos)
SK_QUAD_OF(tan)
SK_QUAD_OF(asin)
SK_QUAD_OF(acos)
SK_QUAD_OF(atan)
SK_QUAD_OF(sinh)
SK_QUAD_OF(cosh)
SK_QUAD_OF(tanh)
SK_QUAD_OF(asinh)
SK_QUAD_OF(acosh)
SK_QUAD_OF(atanh)
SK_QUAD_OF(exp)
SK_QUAD_OF(exp2)
SK_QUAD_OF(log)
SK_QUAD_OF(log2)
SK_QUAD_OF(log10)
SK_QUAD_OF(log1p)
SK_QUAD_OF(expm1)
SK_QUAD_OF(cbrt)
SK_QUAD_OF(erf)
SK_QUAD_OF(erfc)
#undef SK_QUAD_OF
#undef SK_QUAD1
#undef SK_QUAD2

sk::native::mpfr::Quad fmaq(sk::native::mpfr::Quad x, sk::native::mpfr::Quad y, sk::native::mpfr::Quad z) {
  sk::native::mpfr::Call call(x, y, z);
  mpfr_fma(call.result(), call[0], call[1], call[2], MPFR_RNDN);
  return call.keep();
}
sk::native::mpfr::Quad ldexpq(sk::native::mpfr::Quad x, int exponent) {
  sk::native::mpfr::Call call(x);
  mpfr_mul_2si(call.result(), call[0], exponent, MPFR_RNDN);
  return call.keep();
}
sk::native::mpfr::Quad frexpq(sk::native::mpfr::Quad x, int* exponent) {
  sk::native::mpfr::Call call(x);
  mpfr_exp_t own = 0;
  mpfr_frexp(&own, call.result(), call[0], MPFR_RNDN);
  *exponent = static_cast<int>(own);
  return call.keep();
}

// As GCC's functions: 1 is what makes a comparison false for NaN, except for the second three.
#define SK_COMPARISON(name, ofNan)                                                  \
  int name(sk::native::mpfr::Quad x, sk::native::mpfr::Quad y) {                    \
    sk::native::mpfr::Call call(x, y);                                              \
    return mpfr_unordered_p(call[0], call[1]) ? ofNan : mpfr_cmp(call[0], call[1]); \
  }
SK_COMPARISON(__eqtf2, 1)
SK_COMPARISON(__netf2, 1)
SK_COMPARISON(__lttf2, 1)
SK_COMPARISON(__letf2, 1)
SK_COMPARISON(__gttf2, -1)
SK_COMPARISON(__getf2, -1)
#undef SK_COMPARISON
int __unordtf2(sk::native::mpfr::Quad x, sk::native::mpfr::Quad y) {
  sk::native::mpfr::Call call(x, y);
  return mpfr_unordered_p(call[0], call[1]);
}

#define SK_TO_WHOLE(name, type, function)                   \
  type name(sk::native::mpfr::Quad x) {                     \
    sk::native::mpfr::Call call(x);                         \
    return static_cast<type>(function(call[0], MPFR_RNDZ)); \
  }
SK_TO_WHOLE(__fixtfsi, std::int32_t, mpfr_get_si)
SK_TO_WHOLE(__fixtfdi, std::int64_t, mpfr_get_si)
SK_TO_WHOLE(__fixunstfsi, std::uint32_t, mpfr_get_ui)
SK_TO_WHOLE(__fixunstfdi, std::uint64_t, mpfr_get_ui)
#undef SK_TO_WHOLE
float __trunctfsf2(sk::native::mpfr::Quad x) {
  sk::native::mpfr::Call call(x);
  return mpfr_get_flt(call[0], MPFR_RNDN);
}
double __trunctfdf2(sk::native::mpfr::Quad x) {
  sk::native::mpfr::Call call(x);
  return mpfr_get_d(call[0], MPFR_RNDN);
}

#define SK_TO_QUAD(name, type, function)   \
  sk::native::mpfr::Quad name(type x) {    \
    sk::native::mpfr::Call call;           \
    function(call.result(), x, MPFR_RNDN); \
    return call.keep();                    \
  }
SK_TO_QUAD(__floatsitf, std::int32_t, mpfr_set_si)
SK_TO_QUAD(__floatditf, std::int64_t, mpfr_set_si)
SK_TO_QUAD(__floatunsitf, std::uint32_t, mpfr_set_ui)
SK_TO_QUAD(__floatunditf, std::uint64_t, mpfr_set_ui)
SK_TO_QUAD(__extendsftf2, float, mpfr_set_flt)
SK_TO_QUAD(__extenddftf2, double, mpfr_set_d)
#undef SK_TO_QUAD

}  // extern "C"
