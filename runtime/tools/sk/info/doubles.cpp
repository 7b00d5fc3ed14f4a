// SPDX-License-Identifier: MIT
//
// The number of correct bits in results of doubles: 53 for native doubles, 44 to 48 for pairs of floats.
#include <algorithm>
#include <cmath>
#include <vector>

#include "info/device_info.hpp"
#include "info/numbers.hpp"
#include "info/operations.sk.hpp"

namespace sk_tool {

namespace {

constexpr std::size_t count = 1 << 12;

/// Doubles that pairs of floats also represent, to 48 bits.
std::vector<double> operands(unsigned seed) {
  Numbers numbers(seed);
  std::vector<double> operands(count);
  for (double& x : operands)
    x = (1 + numbers.unit() + 0x1p-32 * numbers.unit()) * std::exp2(std::floor(40 * numbers.unit()) - 20);
  return operands;
}

/// -log2 of the largest relative error.
template <class Operation>
double bitsOf(const std::vector<double>& got, const std::vector<double>& a, const std::vector<double>& b,
              const Operation& operation) {
  long double worst = 0;
  for (std::size_t i = 0; i < count; ++i) {
    const long double reference = operation(static_cast<long double>(a[i]), static_cast<long double>(b[i]));
    worst = std::max(worst, std::fabs((static_cast<long double>(got[i]) - reference) / reference));
  }
  return rounded(-std::log2(static_cast<double>(std::max(worst, 0x1p-64L))));
}

}  // namespace

Json probeDoubles(sk::Device& device) {
  const std::vector<double> a = operands(5);
  const std::vector<double> b = operands(6);
  auto x = streamOf(device, a);
  auto y = streamOf(device, b);
  std::vector<sk::Stream<double>> r;
  for (int i = 0; i < 4; ++i) r.push_back(device.stream<double>(x.shape()));
  probes::doubleArithmetic(x, y, r[0], r[1], r[2], r[3]);
  using Real = long double;
  Json json;
  json["bits of +"] = bitsOf(r[0].read(), a, b, [](Real p, Real q) { return p + q; });
  json["bits of *"] = bitsOf(r[1].read(), a, b, [](Real p, Real q) { return p * q; });
  json["bits of /"] = bitsOf(r[2].read(), a, b, [](Real p, Real q) { return p / q; });
  json["bits of sqrt"] = bitsOf(r[3].read(), a, b, [](Real p, Real) { return std::sqrt(p); });
  json["form"] = json["bits of +"] >= 52.5 ? "native" : "pairs of floats";
  return json;
}

}  // namespace sk_tool
