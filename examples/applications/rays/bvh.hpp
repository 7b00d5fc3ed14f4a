// SPDX-License-Identifier: MIT
//
// A hierarchy of boxes over triangles and spheres, built on the host, and its two layouts for devices. It knows no device.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include <sk/types.hpp>

#include "model.hpp"

namespace rays {

/// How deep a tree may be, whatever the scene: kernels keep a stack of this many numbers.
inline constexpr int deepestBvh = 32;

struct Bounds {
  sk::float3 least = {HUGE_VALF, HUGE_VALF, HUGE_VALF};
  sk::float3 most = {-HUGE_VALF, -HUGE_VALF, -HUGE_VALF};

  void grow(const sk::float3& p);
  void grow(const Bounds& other);
  /// Half of the surface; 0 where nothing is in it.
  double halfArea() const;
};

Bounds boundsOf(const Triangle& triangle);
/// Larger by 2^-20 of the radius, since the sphere's test rounds more often than the test of boxes.
Bounds boundsOf(const Sphere& sphere);

using Corner = std::array<double, 3>;

inline Corner cornerOf(const sk::float3& v) { return {v.x, v.y, v.z}; }

/// Overlap tests in double precision, for structures that list the shapes in their cells. Returns true if a triangle meets a box: none of the separating axes separates them (T. Akenine-Möller, "Fast 3D triangle-box overlap
/// testing", 2001).
bool meets(const std::array<Corner, 3>& triangle, const Corner& centre, const Corner& half);

/// Returns true if a sphere's surface meets a box. The radius is widened by 2^-20 to both sides: see boundsOf().
bool meets(const Corner& middle, double radius, const Corner& centre, const Corner& half);

/// A leaf has `count` > 0 shapes from `first` on in Bvh::order; else its children are nodes `first` and `first` + 1.
struct BvhNode {
  Bounds bounds;
  std::uint32_t first = 0;
  std::uint32_t count = 0;
  std::uint32_t axis = 0;  ///< along which the first child lies before the second
};

struct BvhSettings {
  int bins = 16;  ///< places that are tried along an axis
  int leaf = 2;  ///< shapes in a leaf at most, but where all boxes are alike
  double visit = 1.0;  ///< cost of a node relative to that of a shape
};

struct Bvh {
  std::vector<BvhNode> nodes;  ///< the root first; none where there are no shapes
  std::vector<std::uint32_t> order;  ///< triangles by index, then spheres
  int depth = 0;
  double cost =
      0.0;  ///< expected nodes and shapes that a ray meets which meets the root's box (surface area heuristic)
};

/// Splits by the surface area heuristic in bins (I. Wald, "On fast construction of SAH-based bounding volume hierarchies", 2007). Boxes are a
/// little larger than what is in them, so that rounding never misses one (docs/rays.md). Calls `progress` with the number of shapes in leaves so far.
Bvh buildBvh(std::span<const Triangle> triangles, std::span<const Sphere> spheres,
             const BvhSettings& settings, const std::function<void(std::int64_t)>& progress = {});

/// Two elements a node, at 2 * i and 2 * i + 1: (least, first) and (most, count). Siblings lie beside each other.
std::vector<sk::float4> pairLayout(const Bvh& bvh);

/// For each of the eight signs of directions, the tree in the order in which such a ray meets it, one after the other. Two elements a
/// node: (least, skip) and (most, leaf). `skip` is the node after those below this one; `leaf` is 0, or 8 * first + count.
std::vector<sk::float4> skipLayout(const Bvh& bvh);

/// Three elements a shape, for numbers as in Bvh::order. Triangle: (a, id), (b, material), (c, index into Model::triangles).
/// Sphere: (centre, id), (radius, 0, 0, material), (0, 0, 0, -1). Numbers are packed as `packedInt` has them.
std::vector<sk::float4> shapeLayout(std::span<const std::uint32_t> order, const Model& model);

/// Two elements a plane: (normal, distance) and (0, 0, 0, material).
std::vector<sk::float4> planeLayout(const Model& model);

/// An int from -1 to 2^29 as a float that no device rounds or takes for a denormal.
float packedInt(std::int64_t i);

// The same hierarchy with nodes of eight children, whose boxes are bytes (H. Ylitie, T. Karras, S. Laine, "Efficient incoherent ray traversal on
// GPUs through compressed wide BVHs", 2017; wide_bvh.cpp).

/// Children of a wide node. Bit k of a child's slot says on which side of axis k it lies, so that a ray whose direction has the signs `octant`
/// meets slots in the order of slot ^ octant.
inline constexpr int wideChildren = 8;

/// How many wide nodes there may be: kernels keep a node's number and a bit for each child in an int.
inline constexpr std::size_t mostWideNodes = std::size_t{1} << 23;

struct WideBvh {
  /// Four elements a node. The first has the bits of the origin's coordinates, and a byte for each axis: the biased exponent of what a step
  /// is long. The others have a byte for each child, in steps from the origin: (low x, low y), (low z, high x), (high y, high z), each of
  /// them in two ints, slots 0 to 3 and 4 to 7.
  std::vector<sk::int4> nodes;
  /// Eight a node: the child's number; or -(8 first + count), the shapes of a leaf in Bvh::order; -8 for none.
  std::vector<std::int32_t> children;

  std::size_t size() const { return nodes.size() / 4; }
};

/// Opens the child with the largest surface until a node has eight. Boxes hold those of `bvh`, with so much room that kernels
/// may compute distances from bytes (docs/rays.md). Throws std::runtime_error beyond mostWideNodes.
WideBvh widen(const Bvh& bvh);

}  // namespace rays
