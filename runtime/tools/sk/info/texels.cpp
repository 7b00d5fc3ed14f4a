// SPDX-License-Identifier: MIT
//
// How textures change numbers: stores to halves, linear filters, and the addresses of elements.
#include <algorithm>
#include <cmath>
#include <set>
#include <vector>

#include "info/device_info.hpp"
#include "info/numbers.hpp"
#include "info/raw_kernel.hpp"
#include "info/texels.sk.hpp"

namespace sk_tool {

namespace {

constexpr int bits = 16;  ///< of the positions at which filters are sampled

/// Whether every element of a shape reads its own number.
bool countsRight(sk::Device& device, const sk::Shape& shape) {
  auto r = device.stream<int>(shape);
  probes::number(r);
  const std::vector<int> got = r.read();
  for (std::size_t i = 0; i < got.size(); ++i) {
    if (got[i] != static_cast<int>(i)) return false;
  }
  return true;
}

/// The largest n such that 0 ... n are all exact as floats, tested around 2^24.
Json exactFloats(sk::Device& device) {
  constexpr int middle = 1 << 24;
  std::vector<int> n;
  for (int i = middle - 512; i < middle + 512; ++i) n.push_back(i);
  auto x = streamOf(device, n);
  auto r = device.stream<float>(x.shape());
  probes::toFloat(x, r);
  const std::vector<float> got = r.read();
  for (std::size_t i = 0; i < n.size(); ++i) {
    if (double{got[i]} != n[i]) return n[i] - 1;
  }
  return n.back();
}

}  // namespace

// 1 + 2^-11 is halfway between halves, and ties to even gives 1; for 1 + 3 * 2^-11, it gives the upper one
Json probeHalfStores(sk::Device& device) {
  static const RawKernel store =
      RawKernel::of<float, sk::half>("store a half", "void f(float x, out float r) { r = x; }\n");
  const std::vector<float> given{1 + 0x1p-11F, 1 + 0x3p-11F, 1 + 0x1.8p-11F, 65519, 65520, 1e6F, 0x1p-24F};
  const sk::Shape shape = squareOf(given.size());
  auto x = streamOf(device, given);
  auto r = device.stream<sk::half>(shape);
  store(x, r);
  std::vector<float> got;
  for (const sk::half h : r.read()) got.push_back(static_cast<float>(h));
  const bool up = got[2] > 1;
  const bool even = got[0] == 1 && got[1] == 1 + 0x4p-11F;
  return {{"rounding", !up    ? "toward zero"
                       : even ? "to nearest, ties to even"
                              : "to nearest, ties away"},
          {"65519 becomes", got[3]},
          {"65520 becomes", std::isinf(got[4]) ? Json("inf") : Json(got[4])},
          {"1e6 becomes", std::isinf(got[5]) ? Json("inf") : Json(got[5])},
          {"denormals", got[6] == 0x1p-24F ? "kept" : "taken as 0"}};
}

// Between elements 0 and 1, the result is the weight.
Json probeFilter(sk::Device& device) {
  auto a = device.stream<float>({2, 2});
  a.write(std::vector<float>{0, 1, 0, 1});
  std::vector<sk::float2> at;
  for (int i = 0; i < 1 << bits; ++i) at.push_back({static_cast<float>(i) / (1 << bits), 0});
  const sk::Shape shape = squareOf(at.size());
  auto x = device.stream<sk::float2>(shape);
  auto r = device.stream<float>(shape);
  x.write(at);
  probes::filtered(a, x, r);
  const std::vector<float> got = r.read();
  const std::set<float> weights(got.begin(), got.end());
  double worst = 0;
  for (std::size_t i = 0; i < got.size(); ++i) {
    worst = std::max(worst, std::fabs(double{got[i]} - at[i].x));
  }
  return {{"weights_of_65536", weights.size()},
          {"weight_bits", static_cast<int>(std::lround(std::log2(static_cast<double>(weights.size()))))},
          {"max_absolute", worst}};
}

Json probeIndices(sk::Device& device) {
  constexpr std::int64_t many = (1 << 22) + 1;
  const std::int64_t side = std::min(device.limits().textureSize, 1 << 15);
  return {{"row", side},
          {"row_exact", countsRight(device, {1, side})},
          {"column", side},
          {"column_exact", countsRight(device, {side, 1})},
          {"linearised", many},
          {"linearised_exact", countsRight(device, {many})},
          {"int_to_float_exact_to", exactFloats(device)}};
}

}  // namespace sk_tool
