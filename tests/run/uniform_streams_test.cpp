// SPDX-License-Identifier: MIT
//
// Promises: a stream or view of one element stands for a uniform wherever a value may, in every layout and storage; it is
// read as it was before the call; and other streams are refused.
#include <cstdint>
#include <vector>

#include <catch2/catch.hpp>

#include "error_of.hpp"
#include "scalars.sk.hpp"
#include "sk/sk.hpp"
#include "support/devices.hpp"

namespace run_tests {
namespace {

using Catch::Matchers::Contains;

template <class T>
sk::Stream<T> streamOf(sk::Device& device, const std::vector<T>& values) {
  auto stream = device.stream<T>({static_cast<std::int64_t>(values.size())});
  stream.write(values);
  return stream;
}

TEST_CASE("a stream of one element stands for a uniform, in every layout") {
  onSomeLayouts([](sk::Device& device) {
    const auto x = streamOf<float>(device, {1, 2, 3, 4, 5, 6, 7});
    auto y = device.stream<float>({7});
    const auto one = streamOf<float>(device, {2.5f});
    scalars::scale(one, x, y);
    CHECK(y.read() == std::vector<float>{2.5f, 5, 7.5f, 10, 12.5f, 15, 17.5f});
    auto many = device.stream<float>({9, 31});
    scalars::fill(100.0f, many);
    for (const auto& [row, column] : {std::pair{0, 0}, {0, 1}, {3, 30}, {8, 17}}) {
      INFO("element " << row << ", " << column);
      scalars::scale(many.domain({row, column}, {row + 1, column + 1}), x, y);
      CHECK(y.read()[2] == 3 * (100.0f + static_cast<float>(column)));
    }
    auto written = device.stream<float>({300});  // packed, and linearised or layered under small limits
    scalars::fill(streamOf<float>(device, {0.5f}), written);
    for (const int i : {0, 3, 130, 299}) {
      INFO("element " << i);
      scalars::scale(written.domain({i}, {i + 1}), x, y);
      CHECK(y.read()[1] == 2 * (0.5f + static_cast<float>(i)));
    }
    scalars::scale(written.domain({7}, {8}), written, written);
    CHECK(written.read()[7] == 7.5f * 7.5f);
    CHECK(written.read()[299] == 7.5f * 299.5f);
    scalars::loop(streamOf<int>(device, {5}), x, y);
    CHECK(y.read()[6] == 35);
  });
}

TEST_CASE("uniforms of every kind come from streams, some of them beside values") {
  onEveryTarget([](sk::Device& device) {
    const auto x = streamOf<float>(device, {1, 2, 3, 4, 5});
    auto doubles = device.stream<double>({5});
    auto lines = device.stream<scalars::Line>({1});
    lines.write(std::vector{scalars::Line{2, {10, 3}, 1e-3}});
    scalars::line(lines, x, doubles);
    CHECK(doubles.read()[4] == Approx(10 + 1e-3 + 7).epsilon(1e-12));
    auto turn = device.stream<sk::float2x2>({1});
    turn.write(std::vector{sk::float2x2{{{0, -1}, {1, 0}}}});
    const auto points = streamOf<sk::float2>(device, {{1, 2}, {3, 4}});
    auto turned = device.stream<sk::float2>({2});
    scalars::turn(turn, points, turned);
    CHECK(turned.read()[1].x == -4);
    CHECK(turned.read()[1].y == 3);
    auto first = device.stream<bool>({1});
    const auto a = streamOf<sk::float3>(device, {{1, 2, 3}}), b = streamOf<sk::float3>(device, {{4, 5, 6}});
    auto picked = device.stream<sk::float3>({3});
    for (const bool isFirst : {true, false}) {
      first.fill(isFirst);
      scalars::pick(first, a, sk::float3{7, 8, 9}, picked);
      CHECK(picked.read()[2].z == (isFirst ? 3 : 9));
      scalars::pick(isFirst, sk::float3{1, 1, 1}, b, picked);
      CHECK(picked.read()[0].y == (isFirst ? 1 : 5));
    }
  });
}

TEST_CASE("reductions, scans and append outputs take uniforms from streams") {
  onEveryTarget([](sk::Device& device) {
    const auto x = streamOf<float>(device, std::vector<float>(5000, 0.5f));
    const auto half = streamOf<float>(device, {0.25f});
    CHECK(scalars::weighted(half, x) == 625);
    auto sums = device.stream<float>({5});
    scalars::weighted(half, x, sums);
    CHECK(sums.read()[3] == 125);
    auto inPlace = streamOf<float>(device, {0.25f});
    scalars::weighted(inPlace, x, inPlace);
    CHECK(inPlace.read()[0] == 625);
    CHECK(scalars::weighted.with({.accumulate = sk::Accumulate::Exact})(half, x) == 625);
    std::vector<int> values(3000);
    for (int i = 0; i < 3000; ++i) values[static_cast<std::size_t>(i)] = i % 100;
    const auto numbers = streamOf(device, values);
    const auto seven = streamOf<int>(device, {7});
    const scalars::Count count = scalars::below(seven, numbers);
    CHECK(count.below == 210);
    CHECK(count.all == 3000);
    auto running = device.stream<int>({3000});
    scalars::running(seven, numbers, running);
    CHECK(running.read()[2999] == 7 * 30 * 4950);
    auto kept = device.stream<int>({0});
    scalars::above(streamOf<int>(device, {97}), numbers, kept);
    CHECK(kept.size() == 60);
    auto counts = device.stream<int>({15});
    counts.fill(0);
    if (!device.profile().starts_with("essl")) {
      scalars::bins(seven, numbers, counts);
      CHECK(counts.read()[2] == 210);
    }
  });
}

TEST_CASE("uniforms come from streams in every storage and precision, and in several passes") {
  onEveryTarget([](sk::Device& device) {
    const auto x = streamOf<float>(device, {1, 3});
    auto y = device.stream<float>({2});
    for (const sk::Storage storage : {sk::Storage::Half, sk::Storage::Extended, sk::Storage::Double}) {
      auto a = device.stream<float>({1}, storage);
      a.write(std::vector{0.75f});
      scalars::scale(a, x, y);
      CHECK(y.read()[1] == 2.25f);
      for (const sk::Precision precision :
           {sk::Precision::Half, sk::Precision::Extended, sk::Precision::Double}) {
        if (precision == sk::Precision::Double && device.profile().starts_with("essl"))
          continue;  // has no doubles
        scalars::scale.with({.precision = precision})(a, x, y);
        CHECK(y.read()[1] == 2.25f);
      }
    }
    std::vector<sk::Stream<sk::float4>> out;
    for (int i = 0; i < 9; ++i) out.push_back(device.stream<sk::float4>({1}));
    const auto a = streamOf<sk::float4>(device, {{1, 2, 3, 4}});
    scalars::five(a, sk::float4{5, 6, 7, 8}, out[0], out[1], out[2], out[3], out[4], out[5], out[6], out[7],
                  out[8]);
    CHECK(out[2].read()[0].w == 12);
    CHECK(out[4].read()[0].x == 5);
    CHECK(out[7].read()[0].y == 6);
  });
  sk::Device reference = sk::Device::reference();
  auto a = reference.stream<float>({1});
  a.writeReals(std::vector{0.1});
  const auto x = streamOf<float>(reference, {3});
  auto y = reference.stream<float>({1});
  scalars::scale(a, x, y);
  CHECK(y.readReals()[0] == 3 * 0.1);
}

TEST_CASE("a loop reads a uniform's stream in each iteration") {
  onEveryTarget([](sk::Device& device) {
    auto a = streamOf<float>(device, {1}), x = streamOf<float>(device, {2});
    sk::Loop loop = device.record([&] {
      scalars::scale(a, x, x);
      scalars::scale(2.0f, a, a);
    });
    loop.repeat(4);
    CHECK(x.read()[0] == 2 * 1 * 2 * 4 * 8);
  });
}

TEST_CASE("other streams are refused as uniforms") {
  onEveryTarget([](sk::Device& device) {
    const auto x = streamOf<float>(device, {1, 3});
    auto y = device.stream<float>({2});
    CHECK_THAT(errorOf([&] { scalars::scale(x, x, y); }),
               Contains("'a' is one value") && Contains("shape {2}"));
    CHECK_THAT(errorOf([&] { static_cast<void>(scalars::weighted(device.stream<float>({0}), x)); }),
               Contains("'w' is one value") && Contains("{0}"));
    CHECK_THAT(errorOf([&] { scalars::scale(sk::Stream<float>(), x, y); }), Contains("'a' holds no stream"));
    sk::Device other = sk::Device::native();
    CHECK_THAT(errorOf([&] { scalars::scale(streamOf<float>(other, {1}), x, y); }), Contains("two devices"));
  });
}

}  // namespace
}  // namespace run_tests
