// SPDX-License-Identifier: MIT
//
// Groups coherent rays into buckets by a tree over their five dimensions, origin and direction
// (J. Arvo and D. Kirk, "Fast ray tracing by ray classification", 1987). A bucket that overflows splits, unless all its rays are the same.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "model.hpp"

namespace rays {

class RayTree {
 public:
  /// The rays must outlive it. `take` gives `capacity` of them at most.
  RayTree(std::span<const Ray> rays, std::size_t capacity) : rays_(rays), capacity_(capacity) {
    nodes_.emplace_back();
  }

  void insert(std::uint32_t ray);
  /// Rays that are in the tree.
  std::size_t size() const { return size_; }
  /// Removes and returns one of the fullest buckets. It is never empty while the tree has rays.
  std::vector<std::uint32_t> take();

 private:
  static constexpr std::size_t dimensions = 5;
  using Place = std::array<float, dimensions>;
  struct Node {
    std::vector<std::uint32_t> rays;  ///< of a leaf
    std::uint32_t first = 0;  ///< of its two children; 0: it is a leaf
    std::uint32_t dimension = 0;
    float middle = 0.0f;  ///< where the second child begins
  };
  static Place placeOf(const Ray& ray);
  void split(std::uint32_t leaf);

  std::span<const Ray> rays_;
  std::size_t capacity_;
  std::size_t size_ = 0;
  std::vector<Node> nodes_;
  std::vector<std::uint32_t> full_;  ///< leaves that have been full; some have been taken since
};

}  // namespace rays
