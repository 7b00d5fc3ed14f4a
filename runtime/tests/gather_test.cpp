// SPDX-License-Identifier: MIT
//
// Gathers against the same lookup on the host: ranks, boundary modes, neighbours, views, layouts.
#include <algorithm>
#include <memory>
#include <numeric>
#include <vector>

#include <catch2/catch.hpp>

#include "sk/sk.hpp"
#include "test_kernel.hpp"

using namespace sk;
using namespace sk::test;
using program::Boundary;

namespace {

std::int64_t inside(std::int64_t i, std::int64_t extent, Boundary boundary) {
  const auto modulo = [](std::int64_t a, std::int64_t b) { return (a % b + b) % b; };
  switch (boundary) {
    case Boundary::Clamp: return std::clamp<std::int64_t>(i, 0, extent - 1);
    case Boundary::Wrap: return modulo(i, extent);
    case Boundary::Mirror: {
      const std::int64_t p = modulo(i, 2 * extent);
      return p < extent ? p : 2 * extent - 1 - p;
    }
    case Boundary::Border: return i >= 0 && i < extent ? i : -1;
  }
  return -1;
}

program::Parameter gatherOf(Boundary boundary, int rank) {
  program::Parameter parameter = gather<float>("a", rank, boundary);
  parameter.border = "-7.0";
  return parameter;
}

/// Reads the neighbour (dx, dy) of each element: by sk_near_a if `near`, else by sk_at_a.
const TestKernel& neighbour(Boundary boundary, bool near) {
  static constexpr const char* nearBody =
      "void neighbour(int dx, int dy, out float r) { r = sk_near_a(ivec2(dx, dy)); }\n";
  static constexpr const char* atBody =
      "void neighbour(int dx, int dy, out float r) { r = sk_at_a(sk_index().xy + ivec2(dx, dy)); }\n";
  const auto make = [](Boundary mode, const char* body) {
    return new TestKernel(
        "neighbour", body,
        {gatherOf(mode, 2), uniform<std::int32_t>("dx"), uniform<std::int32_t>("dy"), output<float>("r")});
  };
  static const std::unique_ptr<TestKernel> kernels[4][2] = {
      {std::unique_ptr<TestKernel>(make(Boundary::Clamp, atBody)),
       std::unique_ptr<TestKernel>(make(Boundary::Clamp, nearBody))},
      {std::unique_ptr<TestKernel>(make(Boundary::Wrap, atBody)),
       std::unique_ptr<TestKernel>(make(Boundary::Wrap, nearBody))},
      {std::unique_ptr<TestKernel>(make(Boundary::Mirror, atBody)),
       std::unique_ptr<TestKernel>(make(Boundary::Mirror, nearBody))},
      {std::unique_ptr<TestKernel>(make(Boundary::Border, atBody)),
       std::unique_ptr<TestKernel>(make(Boundary::Border, nearBody))}};
  return *kernels[static_cast<std::size_t>(boundary)][near ? 1 : 0];
}

}  // namespace

TEST_CASE("every boundary mode, by index and by neighbour") {
  const auto profile = GENERATE(from_range(profileNames));
  const auto limit = GENERATE(0, 16);
  const auto boundary = GENERATE(Boundary::Clamp, Boundary::Wrap, Boundary::Mirror, Boundary::Border);
  const auto near = GENERATE(false, true);
  const auto asView = GENERATE(false, true);
  Device device({.profile = profile, .textureLimit = limit});
  constexpr std::int64_t height = 5;
  constexpr std::int64_t width = 7;
  auto whole = device.stream<float>({height + 3, width + 11});
  std::vector<float> host(static_cast<std::size_t>(whole.size()));
  std::iota(host.begin(), host.end(), 1.0f);
  whole.write(host);
  auto exact = device.stream<float>({height, width});  // not linearised, unlike the view's stream
  const auto view = whole.domain({2, 3}, {2 + height, 3 + width});
  exact.write(view.read());
  const auto values = view.read();
  auto r = device.stream<float>({height, width});
  for (const auto& [dx, dy] :
       {std::pair{0, 0}, {1, 0}, {-1, 0}, {0, 1}, {0, -1}, {3, -2}, {-6, 4}, {-20, 33}, {1000, -1000}}) {
    if (asView) {
      neighbour(boundary, near)(view, dx, dy, r);
    } else {
      neighbour(boundary, near)(exact, dx, dy, r);
    }
    const auto result = r.read();
    for (std::int64_t i = 0; i < height * width; ++i) {
      const std::int64_t x = inside(i % width + dx, width, boundary);
      const std::int64_t y = inside(i / width + dy, height, boundary);
      const float expected = x < 0 || y < 0 ? -7.0f : values[static_cast<std::size_t>(y * width + x)];
      REQUIRE(result[static_cast<std::size_t>(i)] == expected);
    }
  }
}

TEST_CASE("a stencil whose reach is known") {
  const auto profile = GENERATE(from_range(profileNames));
  const auto extents = GENERATE(Shape(1, 1), Shape(1, 9), Shape(2, 2), Shape(33, 17));
  Device device({.profile = profile});
  static const TestKernel laplace(
      "laplace",
      "void laplace(out float r) {\n  r = sk_near_a(ivec2(1, 0)) + sk_near_a(ivec2(-1, 0)) + "
      "sk_near_a(ivec2(0, 1)) + sk_near_a(ivec2(0, -1));\n}\n",
      {gather<float>("a", 2, Boundary::Wrap), output<float>("r")}, {}, 1);
  auto a = device.stream<float>(extents);
  auto r = device.stream<float>(extents);
  std::vector<float> host(static_cast<std::size_t>(extents.size()));
  std::iota(host.begin(), host.end(), 0.0f);
  a.write(host);
  laplace(a, r);
  const auto result = r.read();
  const std::int64_t height = extents[0];
  const std::int64_t width = extents[1];
  const auto at = [&](std::int64_t y, std::int64_t x) {
    return host[static_cast<std::size_t>((y + height) % height * width + (x + width) % width)];
  };
  for (std::int64_t i = 0; i < extents.size(); ++i) {
    const std::int64_t y = i / width;
    const std::int64_t x = i % width;
    REQUIRE(result[static_cast<std::size_t>(i)] == at(y, x + 1) + at(y, x - 1) + at(y + 1, x) + at(y - 1, x));
  }
}

TEST_CASE("gathers of rank 1 and 4, of another shape than the output") {
  const auto profile = GENERATE(from_range(profileNames));
  const auto limit = GENERATE(0, 16);
  Device device({.profile = profile, .textureLimit = limit});
  static const TestKernel line(
      "line", "void line(int i, out int r) { r = sk_at_a(i) + sk_extent_a().x; }\n",
      {gather<std::int32_t>("a", 1), input<std::int32_t>("i"), output<std::int32_t>("r")});
  auto a = device.stream<std::int32_t>(150);
  std::vector<std::int32_t> host(150);
  std::iota(host.begin(), host.end(), 1000);
  a.write(host);
  auto i = device.stream<std::int32_t>({2, 3});
  i.write(std::vector<std::int32_t>{0, 149, 75, -5, 200, 2147483647});
  auto r = device.stream<std::int32_t>({2, 3});
  line(a, i, r);
  CHECK(r.read() == std::vector<std::int32_t>{1150, 1299, 1225, 1150, 1299, 1299});

  static const TestKernel box("box", "void box(ivec4 i, out int r) { r = sk_at_b(i); }\n",
                              {gather<std::int32_t>("b", 4), input<int4>("i"), output<std::int32_t>("r")});
  auto b = device.stream<std::int32_t>({2, 3, 4, 5});
  std::vector<std::int32_t> boxHost(120);
  std::iota(boxHost.begin(), boxHost.end(), 0);
  b.write(boxHost);
  auto j = device.stream<int4>(3);
  j.write(std::vector<int4>{{0, 0, 0, 0}, {4, 3, 2, 1}, {2, 1, 0, 1}});
  auto s = device.stream<std::int32_t>(3);
  box(b, j, s);
  CHECK(s.read() == std::vector<std::int32_t>{0, 119, 67});
}
