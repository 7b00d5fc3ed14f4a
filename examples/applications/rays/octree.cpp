// SPDX-License-Identifier: MIT
#include "octree.hpp"

#include <algorithm>
#include <numeric>
#include <utility>

#include "grid.hpp"

namespace rays {
namespace {

constexpr int deepestOctree = 10;

Corner widened(const Corner& c, double by) { return {c[0] + by, c[1] + by, c[2] + by}; }

}  // namespace

void Bundle::grow(const Ray& ray, bool isFirst) {
  const Corner from = cornerOf(ray.origin), along = cornerOf(ray.direction);
  if (isFirst) {
    fromLeast = fromMost = from;
    alongLeast = alongMost = along;
    least = ray.least;
    most = ray.most;
    return;
  }
  for (std::size_t i = 0; i < 3; ++i) {
    fromLeast[i] = std::min(fromLeast[i], from[i]);
    fromMost[i] = std::max(fromMost[i], from[i]);
    alongLeast[i] = std::min(alongLeast[i], along[i]);
    alongMost[i] = std::max(alongMost[i], along[i]);
  }
  least = std::min(least, double(ray.least));
  most = std::max(most, double(ray.most));
}

bool Bundle::mayMeet(const Corner& low, const Corner& high) const {
  double from = least, to = most;
  for (std::size_t i = 0; i < 3; ++i) {
    // At distance t the rays span t * alongLeast to t * alongMost, seen from where they begin: it must reach `near` and begin before `far`.
    const double near = low[i] - fromMost[i], far = high[i] - fromLeast[i];
    if (alongMost[i] > 0)
      from = std::max(from, near / alongMost[i]);
    else if (alongMost[i] < 0)
      to = std::min(to, near / alongMost[i]);
    else if (near > 0)
      return false;
    if (alongLeast[i] > 0)
      to = std::min(to, far / alongLeast[i]);
    else if (alongLeast[i] < 0)
      from = std::max(from, far / alongLeast[i]);
    else if (far < 0)
      return false;
  }
  return from <= to;
}

Octree::Octree(const Model& model, int leaf) : model_(model), leaf_(leaf) {
  Bounds bounds;
  for (const Triangle& t : model.triangles) boxes_.push_back(boundsOf(t));
  for (const Sphere& s : model.spheres) boxes_.push_back(boundsOf(s));
  for (const Bounds& box : boxes_) bounds.grow(box);
  stamps_.resize(boxes_.size());
  if (boxes_.empty()) return;
  margin_ = gridMargin(bounds);
  const Corner low = widened(cornerOf(bounds.least), -margin_),
               high = widened(cornerOf(bounds.most), margin_);
  nodes_.push_back({low, high});
  std::vector<int> all(boxes_.size());
  std::iota(all.begin(), all.end(), 0);
  split(0, std::move(all), 0);
}

bool Octree::isIn(int shape, const Corner& low, const Corner& high) const {
  Corner centre, half;
  for (std::size_t i = 0; i < 3; ++i) {
    centre[i] = 0.5 * (low[i] + high[i]);
    half[i] = 0.5 * (high[i] - low[i]) + margin_;
  }
  const auto number = static_cast<std::size_t>(shape);
  const std::size_t triangles = model_.triangles.size();
  if (number >= triangles) {
    const Sphere& s = model_.spheres[number - triangles];
    return meets(cornerOf(s.centre), s.radius, centre, half);
  }
  const Triangle& t = model_.triangles[number];
  return meets({cornerOf(t.a), cornerOf(t.b), cornerOf(t.c)}, centre, half);
}

void Octree::split(std::size_t at, std::vector<int> shapes, int level) {
  const Corner low = nodes_[at].low, high = nodes_[at].high;
  std::array<Node, 8> children;
  std::array<std::vector<int>, 8> lists;
  std::size_t entries = 0;
  const bool wants = static_cast<int>(shapes.size()) > leaf_ && level < deepestOctree;
  for (std::size_t child = 0; wants && child < 8; ++child) {
    for (std::size_t i = 0; i < 3; ++i) {
      const double middle = 0.5 * (low[i] + high[i]);
      children[child].low[i] = (child >> i & 1) != 0 ? middle : low[i];
      children[child].high[i] = (child >> i & 1) != 0 ? high[i] : middle;
    }
    for (const int shape : shapes)
      if (isIn(shape, children[child].low, children[child].high)) lists[child].push_back(shape);
    entries += lists[child].size();
  }
  // Shapes that all children hold are not worth the split.
  if (!wants || entries > 4 * shapes.size()) {
    nodes_[at].first = static_cast<std::int32_t>(lists_.size());
    nodes_[at].count = static_cast<std::int32_t>(shapes.size());
    lists_.insert(lists_.end(), shapes.begin(), shapes.end());
    return;
  }
  const std::size_t first = nodes_.size();
  nodes_[at].first = static_cast<std::int32_t>(first);
  nodes_.insert(nodes_.end(), children.begin(), children.end());
  shapes = {};
  for (std::size_t child = 0; child < 8; ++child) split(first + child, std::move(lists[child]), level + 1);
}

std::vector<int> Octree::shapesOf(const Bundle& bundle) {
  std::vector<int> shapes;
  if (nodes_.empty()) return shapes;
  ++stamp_;
  visit(0, bundle, shapes);
  std::sort(shapes.begin(), shapes.end());
  return shapes;
}

void Octree::visit(std::size_t at, const Bundle& bundle, std::vector<int>& shapes) {
  const Node& node = nodes_[at];
  if (node.count == 0 || !bundle.mayMeet(widened(node.low, -margin_), widened(node.high, margin_))) return;
  const auto first = static_cast<std::size_t>(node.first);
  if (node.count < 0) {
    for (std::size_t child = 0; child < 8; ++child) visit(first + child, bundle, shapes);
    return;
  }
  for (std::size_t i = first; i < first + static_cast<std::size_t>(node.count); ++i) {
    const auto shape = static_cast<std::size_t>(lists_[i]);
    if (std::exchange(stamps_[shape], stamp_) == stamp_) continue;
    const Bounds& box = boxes_[shape];
    if (bundle.mayMeet(widened(cornerOf(box.least), -margin_), widened(cornerOf(box.most), margin_)))
      shapes.push_back(lists_[i]);
  }
}

}  // namespace rays
