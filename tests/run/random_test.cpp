// SPDX-License-Identifier: MIT
//
// Random numbers: the known answers of the generator's authors, and moments of what is made of its bits.
#include <cmath>

#include "random.sk.hpp"
#include "support/devices.hpp"
#include "support/values.hpp"

using namespace run_tests;
using sk::float4, sk::uint2, sk::uint4;

TEST_CASE("philox gives the known answers", "[random]") {
  const std::vector<uint4> counters = {
      {0, 0, 0, 0}, {~0U, ~0U, ~0U, ~0U}, {0x243f6a88U, 0x85a308d3U, 0x13198a2eU, 0x03707344U}};
  const std::vector<uint2> keys = {{0, 0}, {~0U, ~0U}, {0xa4093822U, 0x299f31d0U}};
  const std::vector<uint4> answers = {{0x6627e8d5U, 0xe169c58dU, 0xbc57ac4cU, 0x9b00dbd8U},
                                      {0x408f276dU, 0x41c83b0eU, 0xa20bc7c6U, 0x6d5451fdU},
                                      {0xd16cfe09U, 0x94fdccebU, 0x5001e420U, 0x24126ea1U}};
  onEveryTarget([&](sk::Device& device) {
    auto r = device.stream<uint4>({3});
    random_numbers::answers(streamOf<uint4>(device, counters), streamOf<uint2>(device, keys), r);
    const auto read = r.read();
    for (std::size_t i = 0; i < answers.size(); ++i) {
      INFO(i);
      CHECK(read[i].x == answers[i].x);
      CHECK(read[i].y == answers[i].y);
      CHECK(read[i].z == answers[i].z);
      CHECK(read[i].w == answers[i].w);
    }
  });
}

namespace {

/// The mean of f over all components.
template <class F>
double mean(const std::vector<float4>& values, const F& f) {
  double sum = 0;
  for (const float4& v : values) sum += f(v.x) + f(v.y) + f(v.z) + f(v.w);
  return sum / (4.0 * static_cast<double>(values.size()));
}

}  // namespace

TEST_CASE("uniform and normal numbers have their moments", "[random]") {
  constexpr std::int64_t n = 1 << 14;
  onGlAndNative([](sk::Device& device) {
    auto r = device.stream<float4>({n / 128, 128});
    random_numbers::uniforms(7, 1234, r);
    const auto u = r.read();
    // Five standard deviations of the mean of 65,536 numbers.
    CHECK(std::fabs(mean(u, [](double x) { return x; }) - 0.5) < 5 * std::sqrt(1 / 12.0) / 256);
    CHECK(std::fabs(mean(u, [](double x) { return x * x; }) - 1 / 3.0) < 5 * 0.299 / 256);
    CHECK(mean(u, [](double x) { return x >= 0 && x < 1; }) == 1);
    random_numbers::normals(7, 1234, r);
    const auto z = r.read();
    CHECK(std::fabs(mean(z, [](double x) { return x; })) < 5.0 / 256);
    CHECK(std::fabs(mean(z, [](double x) { return x * x; }) - 1) < 5 * std::sqrt(2.0) / 256);
    CHECK(std::fabs(mean(z, [](double x) { return x * x * x * x; }) - 3) < 5 * std::sqrt(96.0) / 256);

    auto e = device.stream<float>({2});
    auto ends = device.stream<sk::float2>({2});
    random_numbers::ends(streamOf<unsigned>(device, {0U, ~0U}), e, ends);
    CHECK(e.read() == std::vector<float>{0, 1 - 0x1p-24F});
    for (const auto& v : ends.read()) CHECK((std::fabs(v.x) < 5.9F && std::fabs(v.y) < 5.9F));
  });
}
