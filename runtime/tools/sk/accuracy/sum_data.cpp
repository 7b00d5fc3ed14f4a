// SPDX-License-Identifier: MIT
#include "accuracy/sum_data.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "info/numbers.hpp"

namespace sk_tool {

namespace {

constexpr double cancellation = 1e12;

float draw(SumData data, bool hasFactors, Numbers& numbers) {
  if (data == SumData::Tiny) {
    const double least = hasFactors ? 0x1p-63 : 0x1p-126, most = hasFactors ? 0x1p-45 : 0x1p-90;
    return numbers.anySign(numbers.logarithmic(least, most));
  }
  if (data == SumData::Uniform) return numbers.linear(0, 1);
  if (data == SumData::Signed) return numbers.linear(-1, 1);
  return numbers.anySign(numbers.logarithmic(std::exp(-10), std::exp(10)));
}

/// Like GenDot (Ogita, Rump and Oishi, SIAM J. Sci. Comput. 26, 2005, algorithm 6.1): the first half is
/// random, and each number of the second half brings the sum to a random number whose magnitude falls from
/// the first half's to a small part.
void cancel(Pairs& pairs, bool hasFactors, Numbers& numbers) {
  const std::size_t count = pairs.x.size();
  const std::size_t half = count / 2;
  ExactSum sum;
  double magnitude = 0;
  for (std::size_t i = 0; i < half; ++i) {
    const double product = double{pairs.x[i]} * pairs.y[i];
    sum.add(product);
    magnitude += std::fabs(product);
  }
  const double largest = magnitude / std::sqrt(static_cast<double>(half) + 1);
  for (std::size_t i = half; i < count; ++i) {
    const double done = static_cast<double>(i + 1 - half) / static_cast<double>(count - half);
    const double size = std::pow(largest, 1 - done) * std::pow(2 * magnitude / cancellation, done);
    const double wanted = (2 * numbers.unit() - 1) * size - sum.value();
    pairs.y[i] = hasFactors ? numbers.anySign(numbers.linear(0.5, 2)) : 1;
    pairs.x[i] = static_cast<float>(wanted / pairs.y[i]);
    sum.add(double{pairs.x[i]} * pairs.y[i]);
  }
  for (std::size_t i = count; i > 1; --i) {
    const auto j = static_cast<std::size_t>(numbers.unit() * static_cast<double>(i));
    std::swap(pairs.x[i - 1], pairs.x[j]);
    std::swap(pairs.y[i - 1], pairs.y[j]);
  }
}

}  // namespace

Pairs drawPairs(SumData data, std::size_t count, bool hasFactors, unsigned seed) {
  Numbers numbers(seed);
  Pairs pairs{std::vector<float>(count), std::vector<float>(count, 1.0F)};
  for (float& x : pairs.x) x = draw(data, hasFactors, numbers);
  if (hasFactors) {
    for (float& y : pairs.y) y = draw(data, hasFactors, numbers);
  }
  if (data == SumData::IllConditioned) cancel(pairs, hasFactors, numbers);
  return pairs;
}

}  // namespace sk_tool
