// SPDX-License-Identifier: MIT
#include "bvh.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <numeric>

namespace rays {
namespace {

constexpr int mostBins = 64;

float component(const sk::float3& v, std::size_t axis) { return axis == 0 ? v.x : axis == 1 ? v.y : v.z; }

/// Outwards by one float, and by 2^-40 of the scene's extent, which is about 1.
float below(float x) { return std::min(std::nextafter(x, -HUGE_VALF), x - 0x1p-40f); }
float above(float x) { return std::max(std::nextafter(x, HUGE_VALF), x + 0x1p-40f); }

Bounds widened(const Bounds& b) {
  return {{below(b.least.x), below(b.least.y), below(b.least.z)},
          {above(b.most.x), above(b.most.y), above(b.most.z)}};
}

struct Split {
  double cost = std::numeric_limits<double>::infinity();
  std::size_t axis = 0;
  int bin = 0;  ///< the first bin of the second side
};

class Builder {
 public:
  Builder(std::vector<Bounds> boxes, const BvhSettings& settings,
          const std::function<void(std::int64_t)>& progress)
      : boxes_(std::move(boxes)), settings_(settings), progress_(progress) {
    centres_.reserve(boxes_.size());
    for (const Bounds& b : boxes_) {
      centres_.push_back({0.5f * b.least.x + 0.5f * b.most.x, 0.5f * b.least.y + 0.5f * b.most.y,
                          0.5f * b.least.z + 0.5f * b.most.z});
    }
  }

  Bvh build() {
    bvh_.order.resize(boxes_.size());
    std::iota(bvh_.order.begin(), bvh_.order.end(), 0u);
    if (boxes_.empty()) return std::move(bvh_);
    bvh_.nodes.reserve(2 * boxes_.size());
    bvh_.nodes.emplace_back();
    subdivide(0, 0, static_cast<std::uint32_t>(boxes_.size()), 1);
    const double whole = std::max(bvh_.nodes[0].bounds.halfArea(), 1e-300);
    for (const BvhNode& node : bvh_.nodes)
      bvh_.cost += node.bounds.halfArea() / whole * (node.count > 0 ? node.count : 2 * settings_.visit);
    for (BvhNode& node : bvh_.nodes) node.bounds = widened(node.bounds);
    return std::move(bvh_);
  }

 private:
  /// Makes the node of the shapes [first, first + count) of the order; `level` counts from 1.
  void subdivide(std::uint32_t at, std::uint32_t first, std::uint32_t count, int level) {
    bvh_.depth = std::max(bvh_.depth, level);
    Bounds bounds, centres;
    for (std::uint32_t i = first; i < first + count; ++i) {
      bounds.grow(boxes_[bvh_.order[i]]);
      centres.grow(centres_[bvh_.order[i]]);
    }
    bvh_.nodes[at].bounds = bounds;
    const std::uint32_t middle = split(at, bounds, centres, first, count, level);
    if (middle == first) {
      bvh_.nodes[at].first = first;
      bvh_.nodes[at].count = count;
      done_ += count;
      if (progress_) progress_(done_);
      return;
    }
    const auto children = static_cast<std::uint32_t>(bvh_.nodes.size());
    bvh_.nodes[at].first = children;
    bvh_.nodes.resize(bvh_.nodes.size() + 2);
    subdivide(children, first, middle - first, level + 1);
    subdivide(children + 1, middle, first + count - middle, level + 1);
  }

  /// Orders the shapes into two sides, and gives where the second begins; `first` where they stay a leaf.
  std::uint32_t split(std::uint32_t at, const Bounds& bounds, const Bounds& centres, std::uint32_t first,
                      std::uint32_t count, int level) {
    const auto most = static_cast<std::uint32_t>(settings_.leaf);
    if (count == 1) return first;
    // What is still below this level holds if the sides are halves from here on.
    const bool mustHalve = std::ldexp(double(most), deepestBvh - level - 1) < count;
    const Split best = mustHalve ? Split{} : bestSplit(bounds, centres, first, count);
    if (!mustHalve && best.cost >= count && count <= most) return first;
    const auto begin = bvh_.order.begin() + first, end = begin + count;
    if (std::isfinite(best.cost)) {
      bvh_.nodes[at].axis = static_cast<std::uint32_t>(best.axis);
      const auto middle = std::partition(
          begin, end, [&](std::uint32_t i) { return binOf(centres, best.axis, centres_[i]) < best.bin; });
      return static_cast<std::uint32_t>(middle - bvh_.order.begin());
    }
    if (count <= most) return first;
    const std::size_t axis = longestAxis(centres);
    bvh_.nodes[at].axis = static_cast<std::uint32_t>(axis);
    std::nth_element(begin, begin + count / 2, end, [&](std::uint32_t a, std::uint32_t b) {
      const float x = component(centres_[a], axis), y = component(centres_[b], axis);
      return x < y || (x == y && a < b);
    });
    return first + count / 2;
  }

  static std::size_t longestAxis(const Bounds& b) {
    const float x = b.most.x - b.least.x, y = b.most.y - b.least.y, z = b.most.z - b.least.z;
    return x >= y && x >= z ? 0 : y >= z ? 1 : 2;
  }

  int binOf(const Bounds& centres, std::size_t axis, const sk::float3& centre) const {
    const float low = component(centres.least, axis), high = component(centres.most, axis);
    const auto bin =
        static_cast<int>((component(centre, axis) - low) / (high - low) * static_cast<float>(settings_.bins));
    return std::clamp(bin, 0, settings_.bins - 1);
  }

  /// Returns the cheapest split over all axes and bins; its cost is infinite if nothing can be split.
  Split bestSplit(const Bounds& bounds, const Bounds& centres, std::uint32_t first,
                  std::uint32_t count) const {
    Split best;
    const double whole = bounds.halfArea();
    for (std::size_t axis = 0; axis < 3; ++axis) {
      if (!(component(centres.most, axis) > component(centres.least, axis))) continue;
      std::array<Bounds, mostBins> boxes{};
      std::array<std::uint32_t, mostBins> counts{};
      for (std::uint32_t i = first; i < first + count; ++i) {
        const auto bin = static_cast<std::size_t>(binOf(centres, axis, centres_[bvh_.order[i]]));
        boxes[bin].grow(boxes_[bvh_.order[i]]);
        ++counts[bin];
      }
      const auto bins = static_cast<std::size_t>(settings_.bins);
      std::array<double, mostBins> after{};
      Bounds side;
      std::uint32_t n = 0;
      for (std::size_t bin = bins - 1; bin > 0; --bin) {
        side.grow(boxes[bin]);
        n += counts[bin];
        after[bin] = n > 0 ? side.halfArea() * n : HUGE_VAL;
      }
      side = {};
      n = 0;
      for (std::size_t bin = 1; bin < bins; ++bin) {
        side.grow(boxes[bin - 1]);
        n += counts[bin - 1];
        if (n == 0) continue;
        const double shapes = side.halfArea() * n + after[bin];
        const double cost = 2 * settings_.visit + (whole > 0 ? shapes / whole : double(count));
        if (std::isfinite(shapes) && cost < best.cost) best = {cost, axis, static_cast<int>(bin)};
      }
    }
    return best;
  }

  std::vector<Bounds> boxes_;
  std::vector<sk::float3> centres_;
  const BvhSettings& settings_;
  const std::function<void(std::int64_t)>& progress_;
  std::int64_t done_ = 0;
  Bvh bvh_;
};

sk::float4 joined(const sk::float3& v, float w) { return {v.x, v.y, v.z, w}; }

/// Appends a node and all below it, nearer children first, for directions whose signs are `octant` (bit i: axis i is negative).
void appendOrdered(const Bvh& bvh, std::uint32_t at, unsigned octant, std::vector<sk::float4>& layout) {
  const BvhNode& node = bvh.nodes[at];
  const std::size_t here = layout.size();
  const std::int64_t leaf = node.count > 0 ? std::int64_t{8} * node.first + node.count : 0;
  layout.push_back(joined(node.bounds.least, 0));
  layout.push_back(joined(node.bounds.most, packedInt(leaf)));
  if (node.count == 0) {
    const std::uint32_t second = octant >> node.axis & 1;
    appendOrdered(bvh, node.first + second, octant, layout);
    appendOrdered(bvh, node.first + 1 - second, octant, layout);
  }
  layout[here].w = packedInt(static_cast<std::int64_t>(layout.size() / 2));
}

}  // namespace

void Bounds::grow(const sk::float3& p) {
  least = {std::min(least.x, p.x), std::min(least.y, p.y), std::min(least.z, p.z)};
  most = {std::max(most.x, p.x), std::max(most.y, p.y), std::max(most.z, p.z)};
}

void Bounds::grow(const Bounds& other) {
  least = {std::min(least.x, other.least.x), std::min(least.y, other.least.y),
           std::min(least.z, other.least.z)};
  most = {std::max(most.x, other.most.x), std::max(most.y, other.most.y), std::max(most.z, other.most.z)};
}

double Bounds::halfArea() const {
  if (!(most.x >= least.x)) return 0.0;
  const double x = double(most.x) - least.x, y = double(most.y) - least.y, z = double(most.z) - least.z;
  return x * y + y * z + z * x;
}

Bounds boundsOf(const Triangle& t) {
  Bounds b;
  for (const sk::float3* p : {&t.a, &t.b, &t.c}) b.grow(*p);
  return b;
}

Bounds boundsOf(const Sphere& s) {
  const float r = s.radius * (1 + 0x1p-20f);
  return {{s.centre.x - r, s.centre.y - r, s.centre.z - r}, {s.centre.x + r, s.centre.y + r, s.centre.z + r}};
}

float packedInt(std::int64_t i) { return std::bit_cast<float>(static_cast<std::uint32_t>(0x40000001 + i)); }

Bvh buildBvh(std::span<const Triangle> triangles, std::span<const Sphere> spheres,
             const BvhSettings& settings, const std::function<void(std::int64_t)>& progress) {
  std::vector<Bounds> boxes;
  boxes.reserve(triangles.size() + spheres.size());
  for (const Triangle& t : triangles) boxes.push_back(boundsOf(t));
  for (const Sphere& s : spheres) boxes.push_back(boundsOf(s));
  return Builder(std::move(boxes), settings, progress).build();
}

std::vector<sk::float4> pairLayout(const Bvh& bvh) {
  std::vector<sk::float4> layout;
  layout.reserve(2 * bvh.nodes.size());
  for (const BvhNode& node : bvh.nodes) {
    layout.push_back(joined(node.bounds.least, packedInt(node.first)));
    layout.push_back(joined(node.bounds.most, packedInt(node.count)));
  }
  return layout;
}

std::vector<sk::float4> skipLayout(const Bvh& bvh) {
  std::vector<sk::float4> layout;
  if (bvh.nodes.empty()) return layout;
  layout.reserve(16 * bvh.nodes.size());
  for (unsigned octant = 0; octant < 8; ++octant) appendOrdered(bvh, 0, octant, layout);
  return layout;
}

std::vector<sk::float4> shapeLayout(std::span<const std::uint32_t> order, const Model& model) {
  std::vector<sk::float4> layout;
  layout.reserve(3 * order.size());
  for (const std::uint32_t i : order) {
    if (i < model.triangles.size()) {
      const Triangle& t = model.triangles[i];
      layout.push_back(joined(t.a, packedInt(t.id)));
      layout.push_back(joined(t.b, packedInt(t.material)));
      layout.push_back(joined(t.c, packedInt(i)));
    } else {
      const std::size_t s = i - model.triangles.size();
      const Sphere& sphere = model.spheres[s];
      layout.push_back(joined(sphere.centre, packedInt(model.sphereId(s))));
      layout.push_back({sphere.radius, 0, 0, packedInt(sphere.material)});
      layout.push_back({0, 0, 0, packedInt(-1)});
    }
  }
  return layout;
}

std::vector<sk::float4> planeLayout(const Model& model) {
  std::vector<sk::float4> layout;
  for (const Plane& p : model.planes) {
    layout.push_back({p.normal.x, p.normal.y, p.normal.z, p.distance});
    layout.push_back({0, 0, 0, packedInt(p.material)});
  }
  return layout;
}

bool meets(const std::array<Corner, 3>& triangle, const Corner& centre, const Corner& half) {
  std::array<Vector, 3> v;
  for (std::size_t i = 0; i < 3; ++i)
    v[i] = {triangle[i][0] - centre[0], triangle[i][1] - centre[1], triangle[i][2] - centre[2]};
  const auto separates = [&](const Vector& axis) {
    const double reach = half[0] * std::abs(axis.x) + half[1] * std::abs(axis.y) + half[2] * std::abs(axis.z);
    const double a = dot(axis, v[0]), b = dot(axis, v[1]), c = dot(axis, v[2]);
    return std::min({a, b, c}) > reach || std::max({a, b, c}) < -reach;
  };
  constexpr std::array<Vector, 3> axes = {{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}};
  const std::array<Vector, 3> edges = {v[1] - v[0], v[2] - v[1], v[0] - v[2]};
  if (separates(cross(edges[0], edges[1]))) return false;
  for (const Vector& axis : axes) {
    if (separates(axis)) return false;
    for (const Vector& edge : edges)
      if (separates(cross(axis, edge))) return false;
  }
  return true;
}

bool meets(const Corner& middle, double radius, const Corner& centre, const Corner& half) {
  double nearest = 0, farthest = 0;
  for (std::size_t i = 0; i < 3; ++i) {
    const double away = std::abs(middle[i] - centre[i]);
    nearest += std::pow(std::max(0.0, away - half[i]), 2);
    farthest += std::pow(away + half[i], 2);
  }
  return nearest <= std::pow(radius * (1 + 0x1p-20), 2) && farthest >= std::pow(radius * (1 - 0x1p-20), 2);
}

}  // namespace rays
