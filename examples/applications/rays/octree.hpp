// SPDX-License-Identifier: MIT
//
// An octree over triangles and spheres, and bundles of rays through it, all on the host (N. Carr, J. Hall, J. Hart, "The ray engine", 2002).
#pragma once

#include <cstdint>
#include <vector>

#include "bvh.hpp"
#include "model.hpp"

namespace rays {

/// All rays that begin in a box and whose directions, as points, lie in another.
struct Bundle {
  Corner fromLeast{}, fromMost{};
  Corner alongLeast{}, alongMost{};
  double least = 0.0, most = 0.0;  ///< distances

  void grow(const Ray& ray, bool isFirst);
  /// False only where no ray of the bundle meets the box.
  bool mayMeet(const Corner& low, const Corner& high) const;
};

class Octree {
 public:
  /// A node with more shapes than `leaf` has children.
  Octree(const Model& model, int leaf);

  /// Numbers of shapes, triangles before spheres, that rays of the bundle may meet, ascending.
  std::vector<int> shapesOf(const Bundle& bundle);

  std::size_t nodes() const { return nodes_.size(); }

 private:
  struct Node {
    Corner low{}, high{};
    std::int32_t first = 0;  ///< of its children, or of its shapes in `lists_`
    std::int32_t count = -1;  ///< of shapes; -1: it has children
  };
  void split(std::size_t at, std::vector<int> shapes, int level);
  bool isIn(int shape, const Corner& low, const Corner& high) const;
  void visit(std::size_t at, const Bundle& bundle, std::vector<int>& shapes);

  const Model& model_;
  int leaf_;
  double margin_ = 0.0;
  std::vector<Node> nodes_;
  std::vector<int> lists_;
  std::vector<Bounds> boxes_;  ///< of shapes
  std::vector<std::uint32_t> stamps_;  ///< the bundle that has seen a shape
  std::uint32_t stamp_ = 0;
};

}  // namespace rays
