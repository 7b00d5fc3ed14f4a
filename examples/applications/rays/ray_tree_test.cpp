// SPDX-License-Identifier: MIT
#include "ray_tree.hpp"

#include <algorithm>
#include <catch2/catch.hpp>
#include <utility>

#include "octree.hpp"
#include "scenes_test.hpp"

namespace rays {
namespace {

TEST_CASE("a tree gives each ray back once, in buckets that are not too full") {
  const std::vector<Ray> rays = raysAtRandom(5000);
  RayTree tree(rays, 64);
  std::vector<int> seen(rays.size());
  std::size_t buckets = 0;
  const auto take = [&] {
    const std::vector<std::uint32_t> bucket = tree.take();
    CHECK(!bucket.empty());
    CHECK(bucket.size() <= 64);
    ++buckets;
    for (const std::uint32_t ray : bucket) ++seen[ray];
  };
  for (std::uint32_t i = 0; i < rays.size(); ++i) {
    tree.insert(i);
    while (tree.size() > 1000) take();
  }
  while (tree.size() > 0) take();
  CHECK(std::ranges::all_of(seen, [](int n) { return n == 1; }));
  // Half full on average, or better.
  CHECK(buckets <= 2 * rays.size() / 64);
}

TEST_CASE("rays of a bucket are alike") {
  const std::vector<Ray> rays = raysAtRandom(5000);
  RayTree tree(rays, 64);
  for (std::uint32_t i = 0; i < rays.size(); ++i) tree.insert(i);
  double extent = 0;
  int buckets = 0;
  for (; tree.size() > 0; ++buckets) {
    Bundle bundle;
    bool isFirst = true;
    for (const std::uint32_t ray : tree.take()) bundle.grow(rays[ray], std::exchange(isFirst, false));
    for (std::size_t i = 0; i < 3; ++i) extent += bundle.fromMost[i] - bundle.fromLeast[i];
  }
  // All rays together extend over 6 along each axis.
  CHECK(extent / (3 * buckets) < 3.5);
}

TEST_CASE("rays that are all the same make full buckets") {
  const std::vector<Ray> rays(1000, Ray{.origin = {1, 2, 3}, .direction = {0, 0, 1}});
  RayTree tree(rays, 64);
  for (std::uint32_t i = 0; i < rays.size(); ++i) tree.insert(i);
  for (int i = 0; i < 15; ++i) CHECK(tree.take().size() == 64);
  CHECK(tree.take().size() == 40);
  CHECK(tree.size() == 0);
}

TEST_CASE("a bundle keeps every shape that one of its rays hits") {
  const Model model = soup({});
  const std::vector<Ray> rays = raysAtRandom(400);
  Octree octree(model, 4);
  std::size_t kept = 0;
  for (std::size_t first = 0; first < rays.size(); first += 8) {
    Bundle bundle;
    for (std::size_t i = first; i < first + 8; ++i) bundle.grow(rays[i], i == first);
    const std::vector<int> shapes = octree.shapesOf(bundle);
    CHECK(std::ranges::is_sorted(shapes));
    for (std::size_t i = first; i < first + 8; ++i) {
      Bundle alone;
      alone.grow(rays[i], true);
      const std::vector<int> own = octree.shapesOf(alone);
      CHECK(std::ranges::includes(shapes, own));
      kept += own.size();
    }
  }
  // A ray alone meets the boxes of some shapes, not of all 320.
  CHECK(kept > 400);
  CHECK(kept < 400 * 60);
}

}  // namespace
}  // namespace rays
