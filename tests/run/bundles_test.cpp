// SPDX-License-Identifier: MIT
//
// Bundles against the same kernels with parameters one by one, with streams, views, scalars and values as members, and
// members that are missing.
#include <array>

#include "bundles.sk.hpp"
#include "error_of.hpp"
#include "support/devices.hpp"
#include "support/values.hpp"

using namespace run_tests;
using sk::float3, sk::float4;

namespace {

constexpr std::int64_t height = 5, width = 6;

/// The members of a scene, and what is shaded.
struct Streams {
  explicit Streams(sk::Device& device)
      : corner(device.stream<float4>({9})),
        cell(device.stream<int>({2, height, width})),
        sky(device.stream<float4>({4, 7})),
        ground(device.stream<float>({height, width})),
        hit(device.stream<float>({height, width})),
        colour(device.stream<float3>({height, width})),
        expected(device.stream<float3>({height, width})),
        level(device.scalar<float>()) {
    fill(corner, [](int i) { return float4{float(i % 3), float(i % 4), float(i), 1}; });
    fill(cell, [](int i) { return i * 7 % 8; });
    fill(sky, [](int i) { return float4{float(i), float(2 * i), 3, 1}; });
    fill(ground, [](int i) { return float(i * i % 11); });
    fill(hit, [](int i) { return 0.5f * float(i); });
    level.assign(0.25f);
  }

  template <class T, class Make>
  static void fill(sk::Stream<T>& stream, const Make& make) {
    std::vector<T> values;
    for (int i = 0; i < stream.size(); ++i) values.push_back(make(i));
    stream.write(values);
  }

  bundles::Scene scene() {
    return {.corner = corner,
            .cell = cell,
            .sky = sky,
            .view = {float3{0, 0, 0}, 2.0f},
            .ground = {.height = ground, .level = level},
            .isLit = true,
            .mode = 1,
            .weights = {1.0f, 2.0f, 3.0f}};
  }

  void flat(bool isLit, int mode) {
    const std::array<float, 3> weights{1, 2, 3};
    bundles::flatShade(corner, cell, sky, bundles::View{{0, 0, 0}, 2}, ground, level, isLit, mode, weights, hit,
                       expected);
  }

  sk::Stream<float4> corner;
  sk::Stream<int> cell;
  sk::Stream<float4> sky;
  sk::Stream<float> ground, hit;
  sk::Stream<float3> colour, expected;
  sk::Scalar<float> level;
};

bool isSame(const sk::Stream<float3>& a, const sk::Stream<float3>& b, float factor = 1) {
  const auto left = a.read(), right = b.read();
  for (std::size_t i = 0; i < left.size(); ++i) {
    if (left[i].x != factor * right[i].x || left[i].y != factor * right[i].y || left[i].z != factor * right[i].z)
      return false;
  }
  return true;
}

}  // namespace

TEST_CASE("a bundle gives the results of its members one by one", "[bundles]") {
  onSomeLayouts([](sk::Device& device) {
    Streams streams(device);
    bundles::Scene scene = streams.scene();
    streams.flat(true, 1);
    bundles::shade(scene, streams.hit, streams.colour);
    CHECK(isSame(streams.colour, streams.expected));

    bundles::shadeTwice(scene, streams.hit, streams.colour);
    CHECK(isSame(streams.colour, streams.expected, 2));

    scene.isLit = false;
    scene.mode = 0;
    streams.flat(false, 0);
    bundles::shade(scene, streams.hit, streams.colour);
    CHECK(isSame(streams.colour, streams.expected));
  });
}

TEST_CASE("a bundle refers to streams, and copies views and values", "[bundles]") {
  onGlAndNative([](sk::Device& device) {
    auto a = device.stream<float>({4}), b = device.stream<float>({4}), r = device.stream<float>({4});
    a.write(std::vector<float>{1, 2, 3, 4});
    b.write(std::vector<float>{5, 6, 7, 8});
    View view{.u = a};
    mirrored(view, r);
    CHECK(r.read() == std::vector<float>{3, 2, 1, 1});
    std::swap(a, b);  // the member follows its stream
    mirrored(view, r);
    CHECK(r.read() == std::vector<float>{7, 6, 5, 5});
    mirrored({.u = a.domain({2}, {4})}, r);
    CHECK(r.read() == std::vector<float>{8, 8, 7, 7});
  });
}

TEST_CASE("reduces, scans, folded outputs and pushes take bundles", "[bundles]") {
  onGlAndNative([](sk::Device& device) {
    auto x = device.stream<float>({4}), factor = device.stream<float>({4}), y = device.stream<float>({4});
    auto total = device.stream<float>({1}), pushed = device.stream<float>({4});
    x.write(std::vector<float>{1, 2, 3, 4});
    factor.write(std::vector<float>{2, 1, 0, 3});
    const bundles::Terms terms{.factor = factor, .offset = 0.5f};
    CHECK(bundles::weightedSum(terms, x) == 18.0f);
    bundles::weightedSum(terms, x, total);
    CHECK(total.read()[0] == 18.0f);
    bundles::weightedPrefix(x, terms, y);
    CHECK(y.read() == std::vector<float>{2.5f, 7, 13.5f, 22});
    bundles::scaledAndSum({.factor = factor}, x, y, total);
    CHECK(y.read() == std::vector<float>{2, 2, 0, 12});
    CHECK(total.read()[0] == 16.0f);
    bundles::above({.factor = factor, .offset = 1.5f}, x, pushed);
    CHECK(pushed.read() == std::vector<float>{2, 0, 12});
  });
}

TEST_CASE("templates take bundles as arguments", "[bundles]") {
  onGlAndNative([](sk::Device& device) {
    auto a = device.stream<float>({1, 2}), b = device.stream<float>({1, 2}), r = device.stream<float>({1, 2});
    a.write(std::vector<float>{5, 6});
    b.write(std::vector<float>{1, 3});
    bundles::height({.height = a, .level = 0.5f}, r);
    CHECK(r.read() == std::vector<float>{5.5f, 6.5f});
    bundles::heightsOfTwo({.first = {.height = a, .level = 1}, .second = {.height = b, .level = 0}}, r);
    CHECK(r.read() == std::vector<float>{5, 4});
  });
}

TEST_CASE("a recorded loop keeps a bundle", "[bundles]") {
  onGlAndNative([](sk::Device& device) {
    auto a = device.stream<float>({8}), b = device.stream<float>({8});
    a.fill(0);
    a.domain({0}, {1}).fill(1);
    sk::Loop loop = device.record([&] {
      mirrored({.u = a}, b);
      std::swap(a, b);
    });
    loop.repeat(4);
    std::vector<float> expected(8, 0.0f), next(8);
    expected[0] = 1;
    for (int n = 0; n < 4; ++n) {
      for (int i = 0; i < 8; ++i) next[std::size_t(i)] = expected[std::size_t(i < 3 ? 2 - i : i - 3)];
      expected = next;
    }
    CHECK(a.read() == expected);
  });
}

TEST_CASE("a member that a kernel reads must be given", "[bundles]") {
  onGlAndNative([](sk::Device& device) {
    Streams streams(device);
    const auto messageOf = [&](const bundles::Scene& scene) {
      return errorOf([&] { bundles::shade(scene, streams.hit, streams.colour); });
    };
    bundles::Scene scene = streams.scene();
    scene.sky = sk::none;
    CHECK(messageOf(scene) ==
          "bundles::shade: the kernel reads 'scene.sky', which is not given; give this member of the bundle a stream");
    scene = streams.scene();
    scene.ground.height = {};
    CHECK(messageOf(scene).find("'scene.ground.height', which is not given") != std::string::npos);
    scene = streams.scene();
    scene.view = {};
    CHECK(messageOf(scene).find("'scene.view', which is not given; give this member of the bundle a value") !=
          std::string::npos);
    scene = streams.scene();
    scene.mode = {};
    CHECK(messageOf(scene).find("'scene.mode' has no value") != std::string::npos);
    scene = streams.scene();
    scene.corner = streams.sky;
    CHECK(messageOf(scene).find("'scene.corner'") != std::string::npos);
    sk::Device other = sk::Device::native();
    auto elsewhere = other.stream<float4>({9});
    scene = streams.scene();
    scene.corner = elsewhere;
    CHECK(messageOf(scene).find("'scene.corner'") != std::string::npos);

    // What is not read need not be there.
    auto h = device.stream<float>({height, width});
    bundles::heights({.ground = {.height = streams.ground, .level = 1}}, h);
    CHECK(h.read()[3] == 10.0f);
  });
}

TEST_CASE("members take what parameters take", "[bundles]") {
  onGlAndNative([](sk::Device& device) {
    auto x = device.stream<float>({2}), r = device.stream<float>({2});
    auto line = device.stream<sk::float2>({2}), plane = device.stream<sk::float2>({2, 2});
    auto triples = device.stream<float3>({2});
    line.fill({0, 0});
    plane.fill({0, 0});
    triples.fill({0, 0, 0});
    x.fill(4);
    const float weights[3] = {1, 2, 3};
    const std::array<float, 3> same{1, 2, 3};
    const float one[1] = {2}, two[2] = {1, 2};
    const bundles::Grid_1 first{.u = line, .data = one};
    const bundles::Grid_2_ second{.u = plane, .data = two};
    const bundles::Grid_2 rows{.v = triples, .w = triples};
    const float expected = 1 + 4 + 3 * 5 + 7 * 2 + 8 * 2 + 1 + 3;
    bundles::Values values{
        .direction = {0, 0, 1}, .span = {sk::int2{1, 2}, sk::int2{3, 4}}, .weights = weights, .count = 5};
    bundles::valued(values, first, second, rows, x, r);
    CHECK(r.read() == std::vector<float>{expected, expected});
    values.weights = same;
    values.direction = {2, 2, 2};
    bundles::valued(values, first, second, rows, x, r);
    CHECK(r.read()[0] == expected + 1);
    values.weights = std::span<const float, 3>(weights);
    values.weights = {1, 2, 4};
    const auto count = device.scalar<int>(2);
    values.count = count * 3;  // a temporary
    bundles::valued(values, first, second, rows, x, r);
    CHECK(r.read()[0] == expected + 1 + 4 * 6 - 3 * 5);
    bundles::unread({}, x, r);
    CHECK(r.read()[1] == 4);
  });
}
