// SPDX-License-Identifier: MIT
#include "ray_tree.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace rays {

/// Directions as points of the unit square's double, by folding out an octahedron.
RayTree::Place RayTree::placeOf(const Ray& ray) {
  const sk::float3& d = ray.direction;
  const float sum = std::abs(d.x) + std::abs(d.y) + std::abs(d.z);
  float u = d.x / sum, v = d.y / sum;
  if (d.z < 0) {
    const float folded = std::copysign(1 - std::abs(v), u);
    v = std::copysign(1 - std::abs(u), v);
    u = folded;
  }
  return {ray.origin.x, ray.origin.y, ray.origin.z, u, v};
}

void RayTree::insert(std::uint32_t ray) {
  const Place place = placeOf(rays_[ray]);
  std::uint32_t at = 0;
  while (nodes_[at].first != 0)
    at = nodes_[at].first + (place[nodes_[at].dimension] >= nodes_[at].middle ? 1 : 0);
  nodes_[at].rays.push_back(ray);
  ++size_;
  const std::size_t count = nodes_[at].rays.size();
  if (count % capacity_ == 0) full_.push_back(at);
  if (count > capacity_ && count % capacity_ == 1) split(at);
}

/// At the median of the dimension in which the rays differ most. Rays that do not differ at all stay together.
void RayTree::split(std::uint32_t leaf) {
  std::vector<Place> places;
  for (const std::uint32_t ray : nodes_[leaf].rays) places.push_back(placeOf(rays_[ray]));
  float widest = 0.0f, middle = 0.0f;
  std::size_t dimension = 0;
  for (std::size_t i = 0; i < dimensions; ++i) {
    std::vector<float> values;
    for (const Place& place : places) values.push_back(place[i]);
    const auto half = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
    const auto [least, most] = std::ranges::minmax(values);
    if (!(most - least > widest)) continue;
    std::nth_element(values.begin(), half, values.end());
    widest = most - least;
    dimension = i;
    // The first child must not stay empty.
    middle = *half > least ? *half : most;
  }
  if (!(widest > 0)) return;
  const std::vector<std::uint32_t> rays = std::exchange(nodes_[leaf].rays, {});
  const auto first = static_cast<std::uint32_t>(nodes_.size());
  nodes_.resize(nodes_.size() + 2);
  nodes_[leaf].first = first;
  nodes_[leaf].dimension = static_cast<std::uint32_t>(dimension);
  nodes_[leaf].middle = middle;
  for (std::size_t i = 0; i < rays.size(); ++i) {
    const bool isSecond = places[i][dimension] >= middle;
    nodes_[first + (isSecond ? 1 : 0)].rays.push_back(rays[i]);
  }
  for (const std::uint32_t child : {first, first + 1})
    if (nodes_[child].rays.size() >= capacity_) full_.push_back(child);
}

std::vector<std::uint32_t> RayTree::take() {
  while (!full_.empty() && nodes_[full_.back()].rays.size() < capacity_) full_.pop_back();
  std::uint32_t fullest = 0;
  if (!full_.empty()) {
    fullest = full_.back();
  } else {
    for (std::uint32_t i = 1; i < nodes_.size(); ++i)
      if (nodes_[i].rays.size() > nodes_[fullest].rays.size()) fullest = i;
  }
  std::vector<std::uint32_t>& rays = nodes_[fullest].rays;
  const auto last = rays.end() - static_cast<std::ptrdiff_t>(std::min(rays.size(), capacity_));
  std::vector<std::uint32_t> bucket(last, rays.end());
  rays.erase(last, rays.end());
  size_ -= bucket.size();
  return bucket;
}

}  // namespace rays
