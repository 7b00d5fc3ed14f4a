// SPDX-License-Identifier: MIT
//
// Elements that are computed side by side, each in a lane of vectors: a value of each of them (Lanes<T>), and which of them take
// part (Lanes<bool>). Every lane holds the very bits that the scalar code would compute. lanes_intrinsics.hpp has the
// intrinsics, lanes_memory.hpp how values come from arrays and go there.
//
// The vectors are GCC's own, of 256 bits, and compiled to what a CPU has: all that takes or gives them is meant to become part of
// one function (SK_NATIVE_WIDE), so that none is ever passed.
#pragma once

#include <bit>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <type_traits>
#include <utility>

#include "sk/native/scalar.hpp"
#include "sk/native/vector.hpp"

/// Whether kernels may compute by lanes. Who would rather compile sooner than run faster has no use for them.
#if defined(SK_NATIVE_PLAIN) || !(defined(__clang__) || (defined(__GNUC__) && __GNUC__ >= 12))
#define SK_NATIVE_LANES false
#else
#define SK_NATIVE_LANES true
#endif

// None is passed, and so no warning is due that it would be passed otherwise on another CPU.
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wpsabi"

namespace sk::native {

inline constexpr int laneCount = 16;

/// Values that vectors of the compiler hold, a bool as 0 or -1.
template <class T>
struct WordOf {
  using Type = float;
};
template <>
struct WordOf<Int> {
  using Type = std::int32_t;
};
template <>
struct WordOf<Uint> {
  using Type = std::uint32_t;
};
template <>
struct WordOf<bool> {
  using Type = std::int32_t;
};

inline constexpr int lanesOfPart = 8;
inline constexpr int partCount = laneCount / lanesOfPart;

template <class Word>
using Part [[gnu::vector_size(lanesOfPart * sizeof(Word))]] = Word;
using Bits = Part<std::uint32_t>;
using Truth = Part<std::int32_t>;

/// A word in every lane. Made of its bits by arithmetic: what GCC 12 makes of a list in braces inserts one lane after the other.
template <class Word>
Part<Word> filled(Word word) {
  return (Part<Word>)(Bits{} - (0U - std::bit_cast<std::uint32_t>(word)));
}
/// yes where truth is -1, no where it is 0. Of the ways to say this, GCC makes one instruction of this one.
template <class Word>
Part<Word> chosen(const Truth& truth, const Part<Word>& yes, const Part<Word>& no) {
  return truth < 0 ? yes : no;
}

template <class T>
struct Lanes {
  using Scalar = T;
  using Word = typename WordOf<T>::Type;

  Part<Word> parts[partCount];

  Lanes() = default;
  Lanes(T all) {
    for (Part<Word>& part : parts) part = filled<Word>(wordOf(all));
  }
  template <class Literal>
    requires(std::is_same_v<T, float> && std::is_arithmetic_v<Literal> && !std::is_same_v<Literal, bool>)
  explicit Lanes(Literal all) : Lanes(static_cast<float>(all)) {}

  /// operation(parts...) for each part of the arguments.
  template <class Operation, class... Arguments>
  static Lanes byPart(Operation&& operation, const Arguments&... arguments) {
    Lanes result;
    for (int p = 0; p < partCount; ++p) result.parts[p] = (Part<Word>)operation(arguments.parts[p]...);
    return result;
  }

  T operator()(int lane) const { return fromWord(parts[lane / lanesOfPart][lane % lanesOfPart]); }

  static constexpr Word wordOf(T value) {
    if constexpr (isInteger<T>) {
      return value.word();
    } else if constexpr (std::is_same_v<T, bool>) {
      return value ? -1 : 0;
    } else {
      return value;
    }
  }
  static constexpr T fromWord(Word word) { return T(word); }
};

/// Which lanes take part.
using Mask = Lanes<bool>;

template <class T>
inline constexpr bool isLanes = false;
template <class T>
inline constexpr bool isLanes<Lanes<T>> = true;
template <class T>
concept OfLanes = isLanes<Component<T>>;

/// The type of the values of all lanes.
template <class T>
struct LanesOfType {
  using Type = Lanes<T>;
};
template <class T, std::size_t N>
struct LanesOfType<Vec<T, N>> {
  using Type = Vec<Lanes<T>, N>;
};
template <class T>
using LanesOf = typename LanesOfType<T>::Type;

// clang-format off: one operator a line

/// Of these types; one operand may be a scalar, which serves for all lanes.
#define SK_NATIVE_LANES_2(op, Result, expression) \
  template <class T> Result operator op(const Lanes<T>& a, const Lanes<T>& b) { return Result::byPart([](const auto& x, const auto& y) { return expression; }, a, b); } \
  template <class T> Result operator op(const Lanes<T>& a, const std::type_identity_t<T>& b) { return a op Lanes<T>(b); } \
  template <class T> Result operator op(const std::type_identity_t<T>& a, const Lanes<T>& b) { return Lanes<T>(a) op b; }

/// Integers wrap, so they are computed without a sign.
template <class V> auto plain(const V& x) { return x; }
inline Bits plain(const Truth& x) { return (Bits)x; }

SK_NATIVE_LANES_2(+, Lanes<T>, plain(x) + plain(y))
SK_NATIVE_LANES_2(-, Lanes<T>, plain(x) - plain(y))
SK_NATIVE_LANES_2(*, Lanes<T>, plain(x) * plain(y))
SK_NATIVE_LANES_2(&, Lanes<T>, x & y)
SK_NATIVE_LANES_2(|, Lanes<T>, x | y)
SK_NATIVE_LANES_2(^, Lanes<T>, x ^ y)
SK_NATIVE_LANES_2(<, Mask, x < y)
SK_NATIVE_LANES_2(<=, Mask, x <= y)
SK_NATIVE_LANES_2(>, Mask, x > y)
SK_NATIVE_LANES_2(>=, Mask, x >= y)
SK_NATIVE_LANES_2(==, Mask, x == y)
SK_NATIVE_LANES_2(!=, Mask, x != y)

template <class T> Lanes<T> operator-(const Lanes<T>& a) { return Lanes<T>::byPart([](const auto& x) { return -plain(x); }, a); }
template <class T> Lanes<T> operator~(const Lanes<T>& a) { return Lanes<T>::byPart([](const auto& x) { return ~x; }, a); }
inline Mask operator!(const Mask& a) { return Mask::byPart([](const auto& x) { return ~x; }, a); }

/// A count is taken modulo 32.
template <class T, class Count> Lanes<T> operator<<(const Lanes<T>& a, const Lanes<Count>& count) { return Lanes<T>::byPart([](const auto& x, const auto& n) { return plain(x) << ((Bits)n & 31U); }, a, count); }
template <class T, class Count> Lanes<T> operator>>(const Lanes<T>& a, const Lanes<Count>& count) { return Lanes<T>::byPart([](const auto& x, const auto& n) { return x >> (Part<typename Lanes<T>::Word>)((Bits)n & 31U); }, a, count); }
template <class T, class Word> Lanes<T> operator<<(const Lanes<T>& a, Integer<Word> count) { return a << Lanes<Integer<Word>>(count); }
template <class T, class Word> Lanes<T> operator>>(const Lanes<T>& a, Integer<Word> count) { return a >> Lanes<Integer<Word>>(count); }
template <class Word, class Count> auto operator<<(Integer<Word> a, const Lanes<Count>& count) { return Lanes<Integer<Word>>(a) << count; }
template <class Word, class Count> auto operator>>(Integer<Word> a, const Lanes<Count>& count) { return Lanes<Integer<Word>>(a) >> count; }
#undef SK_NATIVE_LANES_2
// clang-format on

// ---- masks --------------------------------------------------------------------------------------

/// Whether any lane takes part.
inline bool any(const Mask& mask) {
  Truth together = mask.parts[0];
  for (int p = 1; p < partCount; ++p) together |= mask.parts[p];
  using Half [[gnu::vector_size(16)]] = std::int32_t;
  const Half half = __builtin_shufflevector(together, together, 0, 1, 2, 3) |
                    __builtin_shufflevector(together, together, 4, 5, 6, 7);
#if defined(__SSE__)
  using Floats [[gnu::vector_size(16)]] = float;
  return __builtin_ia32_movmskps((Floats)half) != 0;
#else
  return (half[0] | half[1] | half[2] | half[3]) != 0;
#endif
}
inline bool all(const Mask& mask) { return !any(!mask); }
/// Those of `mask` that are not among `others`.
inline Mask without(const Mask& mask, const Mask& others) { return mask & !others; }

/// condition ? yes : no.
template <class T>
Lanes<T> select(const Mask& condition, const Lanes<T>& yes, const Lanes<T>& no) {
  return Lanes<T>::byPart([](const auto& c, const auto& y, const auto& n) { return c < 0 ? y : n; },
                          condition, yes, no);
}
template <class T, std::size_t N>
Vec<Lanes<T>, N> select(const Mask& condition, const Vec<Lanes<T>, N>& yes, const Vec<Lanes<T>, N>& no) {
  return byComponent([&](const Lanes<T>& y, const Lanes<T>& n) { return select(condition, y, n); }, yes, no);
}
template <class T, std::size_t N>
Vec<Lanes<T>, N> select(const Vec<Mask, N>& condition, const Vec<Lanes<T>, N>& yes,
                        const Vec<Lanes<T>, N>& no) {
  return byComponent([](const Mask& c, const Lanes<T>& y, const Lanes<T>& n) { return select(c, y, n); },
                     condition, yes, no);
}

/// `place = value` for the lanes that take part.
template <class T>
void put(const Mask& mask, T& place, const std::type_identity_t<T>& value) {
  place = select(mask, value, place);
}

/// `++place` for the lanes that take part.
template <class Word>
void count(const Mask& mask, Lanes<Integer<Word>>& place) {
  place = Lanes<Integer<Word>>::byPart([](const auto& x, const Truth& on) { return plain(x) - (Bits)on; },
                                       place, mask);
}

/// What `yes` gives to those lanes of `on` that fulfil a condition, and `no` to the others; neither is called for none.
template <class Yes, class No>
auto choose(const Mask& on, const Mask& condition, Yes&& yes, No&& no) {
  const Mask those = on & condition, others = without(on, condition);
  std::remove_cvref_t<decltype(yes(those))> result{};
  if (any(those)) result = yes(those);
  if (any(others)) result = select(condition, result, no(others));
  return result;
}

// ---- conversions --------------------------------------------------------------------------------

/// One value for all lanes.
template <class T>
LanesOf<T> spread(const T& value) {
  if constexpr (Vector<T>) {
    return byComponent([](auto x) { return Lanes<decltype(x)>(x); }, value);
  } else {
    return value;
  }
}
template <OfLanes T>
const T& spread(const T& value) {
  return value;
}

/// The language's conversion: native::convert of every lane.
template <class To, class From>
auto convertLanes(const From& from) {
  using Word = typename WordOf<To>::Type;
  if constexpr (Vector<From>) {
    return byComponent([](const auto& x) { return convertLanes<To>(x); }, from);
  } else if constexpr (std::is_same_v<From, Lanes<To>>) {
    return from;
  } else if constexpr (std::is_same_v<To, bool>) {
    return from != typename From::Scalar(0);
  } else if constexpr (std::is_same_v<From, Mask>) {
    return Lanes<To>::byPart([](const Truth& x) { return (Bits)x & (Bits)filled<Word>(Word{1}); }, from);
  } else if constexpr (isInteger<To> && isInteger<typename From::Scalar>) {
    return Lanes<To>::byPart([](const auto& x) { return x; }, from);
  } else if constexpr (isInteger<To>) {
    return Lanes<To>::byPart(
        [](const Part<float>& x) {
          using Limits = std::numeric_limits<Word>;
          constexpr auto least = static_cast<float>(Limits::min());
          constexpr auto beyond = static_cast<float>(Limits::max() / 2 + 1) * 2;
          const Truth isHigh = x >= filled(beyond);
          const Truth isInside = (x > filled(least)) & ~isHigh;
          const Part<float> safe = chosen<float>(isInside, x, Part<float>{});
          const Part<Word> whole = __builtin_convertvector(safe, Part<Word>);
          // where x is NaN, neither
          const Part<Word> low = chosen<Word>(x <= filled(least), filled(Limits::min()), whole);
          return chosen<Word>(isHigh, filled(Limits::max()), low);
        },
        from);
  } else {
    return Lanes<To>::byPart([](const auto& x) { return __builtin_convertvector(x, Part<float>); }, from);
  }
}

// ---- lane by lane -------------------------------------------------------------------------------

/// The value of one lane; of what has no lanes, itself.
template <class T>
auto laneOf(const T& value, int lane) {
  if constexpr (OfLanes<T>) {
    return byComponent([&](const auto& x) { return x(lane); }, value);
  } else {
    return value;
  }
}

/// Values in arrays, to be filled lane by lane.
template <class T>
class Collected {
 public:
  void set(int lane, const T& value) { values_[lane] = Lanes<T>::wordOf(value); }
  Lanes<T> take() const {
    Lanes<T> result;
    for (int p = 0; p < partCount; ++p) {
      const Word* const w = values_ + p * lanesOfPart;
      // halves, since GCC 12 stores a list of eight one after the other
      const Quarter low = {w[0], w[1], w[2], w[3]}, high = {w[4], w[5], w[6], w[7]};
      result.parts[p] = __builtin_shufflevector(low, high, 0, 1, 2, 3, 4, 5, 6, 7);
    }
    return result;
  }

 private:
  using Word = typename Lanes<T>::Word;
  using Quarter [[gnu::vector_size(4 * sizeof(Word))]] = Word;
  Word values_[laneCount];
};
template <class T, std::size_t N>
class Collected<Vec<T, N>> {
 public:
  void set(int lane, const Vec<T, N>& value) {
    for (std::size_t i = 0; i < N; ++i) components_[i].set(lane, value.components[i]);
  }
  Vec<Lanes<T>, N> take() const {
    return [&]<std::size_t... I>(std::index_sequence<I...>) {
      return Vec<Lanes<T>, N>(components_[I].take()...);
    }(std::make_index_sequence<N>());
  }

 private:
  Collected<T> components_[N];
};

/// What `operation` makes of every lane of the arguments; those that are no lanes serve for all. A loop, as operations may be long.
template <class Operation, class... Arguments>
auto laneByLane(Operation&& operation, const Arguments&... arguments) {
  Collected<std::remove_cvref_t<decltype(operation(laneOf(arguments, 0)...))>> results;
#pragma GCC unroll 1
  for (int lane = 0; lane < laneCount; ++lane) results.set(lane, operation(laneOf(arguments, lane)...));
  return results.take();
}
/// The same of a short operation, without a loop.
template <class Operation, class... Arguments>
auto eachLane(Operation&& operation, const Arguments&... arguments) {
  Collected<std::remove_cvref_t<decltype(operation(laneOf(arguments, 0)...))>> results;
#pragma GCC unroll 16
  for (int lane = 0; lane < laneCount; ++lane) results.set(lane, operation(laneOf(arguments, lane)...));
  return results.take();
}

// ---- division -----------------------------------------------------------------------------------

/// Of int, in double: a quotient of 32 bits is a whole number there, or further from one than any rounding.
inline Lanes<Int> quotient(const Lanes<Int>& a, const Lanes<Int>& b) {
  return Lanes<Int>::byPart(
      [](const Truth& x, const Truth& y) {
        using Quarter [[gnu::vector_size(16)]] = std::int32_t;
        using Doubles [[gnu::vector_size(32)]] = double;
        const auto divided = [](const Quarter& n, const Quarter& d) {
          return __builtin_convertvector(
              __builtin_convertvector(n, Doubles) / __builtin_convertvector(d, Doubles), Quarter);
        };
        const Truth isZero = y == 0, isMinusOne = y == -1;
        const Truth safe = chosen<std::int32_t>(isZero | isMinusOne, filled(1), y);
        const Quarter low = divided(__builtin_shufflevector(x, x, 0, 1, 2, 3),
                                    __builtin_shufflevector(safe, safe, 0, 1, 2, 3));
        const Quarter high = divided(__builtin_shufflevector(x, x, 4, 5, 6, 7),
                                     __builtin_shufflevector(safe, safe, 4, 5, 6, 7));
        const Truth whole = __builtin_shufflevector(low, high, 0, 1, 2, 3, 4, 5, 6, 7);
        // what is divided by 1 instead
        return chosen<std::int32_t>(isMinusOne, (Truth)(0U - (Bits)whole), whole);
      },
      a, b);
}
inline Lanes<Int> remainder(const Lanes<Int>& a, const Lanes<Int>& b) {
  return select(b == Int(0), Lanes<Int>(0), a - quotient(a, b) * b);
}

// clang-format off: one operator a line
inline Lanes<float> operator/(const Lanes<float>& a, const Lanes<float>& b) { return Lanes<float>::byPart([](const auto& x, const auto& y) { return x / y; }, a, b); }
inline Lanes<Int> operator/(const Lanes<Int>& a, const Lanes<Int>& b) { return quotient(a, b); }
inline Lanes<Int> operator%(const Lanes<Int>& a, const Lanes<Int>& b) { return remainder(a, b); }
inline Lanes<Uint> operator/(const Lanes<Uint>& a, const Lanes<Uint>& b) { return laneByLane([](Uint x, Uint y) { return x / y; }, a, b); }
inline Lanes<Uint> operator%(const Lanes<Uint>& a, const Lanes<Uint>& b) { return laneByLane([](Uint x, Uint y) { return x % y; }, a, b); }
template <class T> Lanes<T> operator/(const Lanes<T>& a, const std::type_identity_t<T>& b) { return a / Lanes<T>(b); }
template <class T> Lanes<T> operator/(const std::type_identity_t<T>& a, const Lanes<T>& b) { return Lanes<T>(a) / b; }
template <class T> Lanes<T> operator%(const Lanes<T>& a, const std::type_identity_t<T>& b) { return a % Lanes<T>(b); }
template <class T> Lanes<T> operator%(const std::type_identity_t<T>& a, const Lanes<T>& b) { return Lanes<T>(a) % b; }
// clang-format on

}  // namespace sk::native

#pragma GCC diagnostic pop
