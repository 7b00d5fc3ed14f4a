// SPDX-License-Identifier: MIT
#include "numbers/data.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <limits>

#include "support/function_oracle.hpp"
#include "support/oracle.hpp"

namespace fuzz::numbers {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

/// A mantissa in [1, 2).
double mantissa(Random& random, const Range& range) {
  const int bits = range.digits - 1;
  const auto fraction = static_cast<double>(random.next() >> (64 - bits));
  return 1 + std::ldexp(fraction, -bits);
}

/// x * 2^exponent, with the bits that the range has there.
double scaled(double x, int exponent, const Range& range) {
  const double made = std::ldexp(x, exponent);
  if (range.digits == 53) return made;
  const auto rounded = static_cast<float>(made);
  return std::isinf(rounded) ? std::copysign(static_cast<double>(std::numeric_limits<float>::max()), x)
                             : static_cast<double>(rounded);
}

double negative(Random& random) { return random.chance(1, 2) ? -1 : 1; }
double anyNumber(Random& random, const Range& range) {
  return negative(random) * scaled(mantissa(random, range), random.between(range.least, range.most), range);
}

/// All bits of the mantissas are set, and all have one sign: sums carry as often as they can.
void fillCarries(Random& random, Values& x, const Range& range) {
  const double full = (2 - std::ldexp(1.0, 1 - range.digits)) * negative(random);
  const int exponent = random.between(range.least, range.most),
            spread = random.pick(std::array{0, 0, 0, 3, 26, 60});
  for (double& one : x)
    one = scaled(full, std::clamp(exponent + random.between(-spread, 0), range.least, range.most), range);
}

void fillEqual(Random& random, Values& x, const Range& range) {
  const double value =
      random.chance(1, 2)
          ? negative(random) * random.pick(std::array{1.0, 127.0, 255.0, 3.0, 65535.0, 16777215.0})
          : anyNumber(random, range);
  std::ranges::fill(x, value);
}

void fillHugeAndTiny(Random& random, Values& x, const Range& range) {
  const int high = random.between(range.most - 60, range.most),
            low = random.between(range.least, range.least + 100);
  const bool areCancelling = random.chance(1, 2);
  double last = 0;
  for (std::size_t i = 0; i < x.size(); ++i) {
    if (i % 2 == 1) {
      x[i] = negative(random) * scaled(mantissa(random, range), low, range);
    } else {
      last = areCancelling && i % 4 == 2 ? -last
                                         : negative(random) * scaled(mantissa(random, range), high, range);
      x[i] = last;
    }
  }
}

/// A number, and halves of its unit in the last place, with a little more or less to break ties.
void fillHalves(Random& random, Values& x, const Range& range) {
  const int exponent = random.between(range.least + 60, range.most - 10);
  for (double& one : x) {
    const int below =
        random.pick(std::array{0, range.digits, range.digits, range.digits + 1, 2 * range.digits});
    one = negative(random) * std::ldexp(1.0, std::max(exponent - below, range.least));
  }
  x.front() = std::ldexp(mantissa(random, range), exponent);
}

/// Sums that cancel but for 10^-k.
void fillCancelling(Random& random, Values& x, const Range& range) {
  if (x.size() < 4) return fillHalves(random, x, range);
  const std::vector<float> hard = numerics::illConditionedSum(x.size(), std::pow(10.0, random.between(2, 24)),
                                                              static_cast<unsigned>(random.next()));
  const int shift = random.pick(std::array{0, 0, 0, -100, -60, 30});
  for (std::size_t i = 0; i < x.size(); ++i) x[i] = scaled(static_cast<double>(hard[i]), shift, range);
}

void fillWithin(Random& random, Values& x, const Range& range, int low, int high, bool haveOneSign) {
  for (double& one : x) {
    one = scaled(mantissa(random, range),
                 random.between(std::max(low, range.least), std::min(high, range.most)), range);
    if (!haveOneSign) one *= negative(random);
  }
}

void sprinkleSpecials(Random& random, Values& x) {
  const std::array specials{-0.0,     0.0,       -0.0,           0.0,     infinity, -infinity, std::nan(""),
                            0x1p-149, -0x1p-149, 0x1.fffffep127, 0x1p-126};
  const int kinds = random.between(1, 3);
  for (int k = 0; k < kinds; ++k) {
    const double special = random.pick(specials);
    const std::size_t count = random.chance(1, 2) ? 1 : 1 + random.below(x.size());
    for (std::size_t i = 0; i < count; ++i)
      random.chance(1, 4) ? x[random.below(x.size())] = special : x[i] = special;
  }
}

}  // namespace

Values terms(Random& random, std::size_t count, const Range& range, std::size_t kind) {
  Values x(count);
  if (count == 0) return x;
  switch (kind) {
    case 0:
    case 1: fillCarries(random, x, range); break;
    case 2: fillEqual(random, x, range); break;
    case 3: fillHugeAndTiny(random, x, range); break;
    case 4: fillHalves(random, x, range); break;
    case 5: fillCancelling(random, x, range); break;
    case 6: fillWithin(random, x, range, range.least, range.most, false); break;
    case 7: fillWithin(random, x, range, range.least, range.least + 60, random.chance(1, 2)); break;
    case 8: {
      const int exponent = random.between(range.least, range.most);
      fillWithin(random, x, range, exponent, exponent + random.between(0, 2), random.chance(1, 2));
      break;
    }
    case 9: fillWithin(random, x, range, range.most - 20, range.most, false); break;
    case 10: {
      const int low = random.between(-80, 20);
      fillWithin(random, x, range, low, low + random.between(1, 60), random.chance(1, 2));
      break;
    }
    default: fillWithin(random, x, range, -1, 0, true); break;
  }
  if (random.chance(1, 12)) sprinkleSpecials(random, x);
  if (random.chance(1, 40)) std::ranges::fill(x, random.chance(1, 2) ? -0.0 : 0.0);
  return x;
}

Values arguments(Random& random, std::size_t count, Data data, bool areDoubles) {
  static const std::vector<float> specials = numerics::specialNumbers<float>(),
                                  angles = numerics::nearMultiplesOfHalfPi<float>(40, 200);
  static const std::vector<double> wideSpecials = numerics::specialNumbers<double>(),
                                   wideAngles = numerics::nearMultiplesOfHalfPi<double>(40, 200);
  const Range range = areDoubles ? Range{-1000, 1000, 53} : floatRange;
  const auto rounded = [&](double x) { return areDoubles ? x : static_cast<double>(static_cast<float>(x)); };
  const double unit = areDoubles ? 0x1p-52 : 0x1p-23;
  Values x(count);
  for (double& one : x) {
    const double t = static_cast<double>(random.next() >> 11U) * 0x1p-53;
    switch (random.below(9)) {
      case 0: one = areDoubles ? random.pick(wideSpecials) : random.pick(specials); break;
      case 1: one = anyNumber(random, range); break;
      case 2: one = negative(random) * (1 + random.between(-40, 40) * unit); break;  // near 1
      case 3:
        one = negative(random) * (random.between(0, 20) + 0.5 + random.between(-2, 2) * unit);
        break;  // halves
      case 4: one = negative(random) * scaled(mantissa(random, range), random.between(-30, 8), range); break;
      case 5:
        one = data == Data::Angles ? (areDoubles ? random.pick(wideAngles) : random.pick(angles))
                                   : 100 * (2 * t - 1);
        break;
      case 6: one = data == Data::Fractions ? 2 * t - 1 : (areDoubles ? 1500 : 180) * (2 * t - 1); break;
      case 7: one = negative(random) * random.between(0, 300); break;
      default:
        one = negative(random) *
              scaled(mantissa(random, range), random.between(range.least, range.least + 40), range);
        break;
    }
    one = rounded(one);
  }
  return x;
}

Values integers(Random& random, std::size_t count, bool areSigned) {
  const std::array corners{0.0,  1.0,     -1.0,    2.0,          -2.0,          31.0,          32.0,
                           33.0, 65535.0, 65536.0, 2147483647.0, -2147483648.0, -2147483647.0, 16777217.0};
  Values x(count);
  for (double& one : x) {
    one = random.chance(1, 2)
              ? random.pick(corners)
              : static_cast<double>(static_cast<std::int32_t>(static_cast<std::uint32_t>(random.next())));
    if (!areSigned) one = static_cast<double>(static_cast<std::uint32_t>(static_cast<std::int64_t>(one)));
  }
  return x;
}

}  // namespace fuzz::numbers
