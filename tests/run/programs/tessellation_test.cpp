// SPDX-License-Identifier: MIT
//
// tessellation.sk against the same passes over a vector, in double. Results are exact: corners begin as integers below 32, and
// each halving adds a bit, so that no square or product needs more than the 24 bits of a float.
#include "programs/tessellation.sk.hpp"

#include <algorithm>
#include <utility>

#include "support/devices.hpp"
#include "support/values.hpp"

using namespace run_tests;
using tessellation::Detail;
using tessellation::Triangle;

namespace {

/// Refines until a pass halves no triangle.
sk::Stream<Triangle> tessellated(sk::Device& device, const Detail& detail,
                                 const std::vector<Triangle>& mesh) {
  auto coarse = device.stream<Triangle>({static_cast<std::int64_t>(mesh.size())});
  auto fine = device.stream<Triangle>({0});
  coarse.write(mesh);
  for (;;) {
    tessellation::refine(detail, coarse, fine);
    if (fine.size() == coarse.size()) return fine;
    std::swap(coarse, fine);
  }
}

struct Point {
  double x, y;
};
Point pointOf(const sk::float2& p) { return {p.x, p.y}; }
sk::float2 rounded(const Point& p) { return {static_cast<float>(p.x), static_cast<float>(p.y)}; }
double distance2(const Point& p, const Point& q) {
  return (p.x - q.x) * (p.x - q.x) + (p.y - q.y) * (p.y - q.y);
}

/// One pass over a vector.
std::vector<Triangle> refined(const Detail& detail, const std::vector<Triangle>& mesh) {
  std::vector<Triangle> fine;
  for (const Triangle& t : mesh) {
    const Point p[3] = {pointOf(t.a), pointOf(t.b), pointOf(t.c)};
    int first = 0;
    for (int i = 1; i < 3; ++i) {
      const bool isLonger = distance2(p[i], p[(i + 1) % 3]) > distance2(p[first], p[first + 1]);
      if (isLonger) first = i;
    }
    const Point a = p[first], b = p[(first + 1) % 3], c = p[(first + 2) % 3];
    const Point middle{(a.x + b.x) / 2, (a.y + b.y) / 2};
    if (distance2(a, b) <=
        std::max<double>(detail.least, detail.slope * distance2(middle, pointOf(detail.eye)))) {
      fine.push_back(t);
    } else {
      fine.push_back({rounded(c), rounded(a), rounded(middle)});
      fine.push_back({rounded(b), rounded(c), rounded(middle)});
    }
  }
  return fine;
}

/// Counterclockwise triangles with integer corners below 32.
std::vector<Triangle> triangles(std::size_t count) {
  std::vector<Triangle> mesh;
  for (std::uint32_t seed = 0; mesh.size() < count; ++seed) {
    const auto corner = [&](std::uint32_t k) {
      const std::uint32_t bits = hashed(3 * seed + k + 1);
      return sk::float2{static_cast<float>(bits & 31u), static_cast<float>(bits >> 8 & 31u)};
    };
    const Triangle t{corner(0), corner(1), corner(2)};
    const float area = (t.b.x - t.a.x) * (t.c.y - t.a.y) - (t.b.y - t.a.y) * (t.c.x - t.a.x);
    if (area > 0) mesh.push_back(t);
  }
  return mesh;
}

bool areSame(const Triangle& s, const Triangle& t) { return s.a == t.a && s.b == t.b && s.c == t.c; }

}  // namespace

TEST_CASE("tessellation: halved until small enough for its distance, in order") {
  onDrawnLayouts([](sk::Device& device) {
    for (const std::size_t count : {0, 1, 2, 13}) {
      for (const Detail& detail :
           {Detail{{16, 16}, 4, 0.0625f}, Detail{{3, 30}, 16, 0}, Detail{{0, 0}, 4096, 1}}) {
        INFO(count << " triangles, edges of " << detail.least << " and " << detail.slope
                   << " times the distance");
        const auto mesh = triangles(count);
        std::vector<Triangle> expected = mesh;
        for (std::size_t before = 0; before != expected.size();) {
          before = expected.size();
          expected = refined(detail, expected);
        }
        const auto result = tessellated(device, detail, mesh);
        const auto actual = result.read();
        REQUIRE(actual.size() == expected.size());
        CHECK(std::equal(actual.begin(), actual.end(), expected.begin(), areSame));

        auto start = device.stream<Triangle>({static_cast<std::int64_t>(count)});
        start.write(mesh);
        CHECK(tessellation::area(result) == tessellation::area(start));  // sums of few bits: exact
      }
    }
  });
}

TEST_CASE("tessellation: more triangles than a row of a texture has texels") {
  onGlAndNative([](sk::Device& device) {
    const Detail detail{{16, 16}, 0.0625f, 0};
    std::vector<Triangle> expected = triangles(11);
    for (std::size_t before = 0; before != expected.size();) {
      before = expected.size();
      expected = refined(detail, expected);
    }
    CHECK(expected.size() > 16384);
    const auto actual = tessellated(device, detail, triangles(11)).read();
    REQUIRE(actual.size() == expected.size());
    CHECK(std::equal(actual.begin(), actual.end(), expected.begin(), areSame));
  });
}
