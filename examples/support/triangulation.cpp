// SPDX-License-Identifier: MIT
#include "support/triangulation.hpp"

#include <algorithm>
#include <cmath>
#include <deque>

namespace examples {

namespace {

struct Point {
  double x = 0.0, y = 0.0;
  friend bool operator==(const Point&, const Point&) = default;
};

/// Twice the area of a triangle, positive if it is counterclockwise: a difference of products within 2 ulp (W. Kahan's), so that its sign
/// is right.
double area(Point a, Point b, Point c) {
  const double x1 = b.x - a.x, y1 = b.y - a.y, x2 = c.x - a.x, y2 = c.y - a.y;
  const double product = y1 * x2;
  return std::fma(x1, y2, -product) + std::fma(-y1, x2, product);
}

double component(const Vector& v, int axis) { return axis == 0 ? v.x : axis == 1 ? v.y : v.z; }

/// The polygon in a plane, counterclockwise: without the coordinate in which its normal is largest. Empty if it has no normal.
std::vector<Point> flat(std::span<const Vector> corners) {
  double size = 0.0;
  for (const Vector& p : corners) size = std::max({size, std::abs(p.x), std::abs(p.y), std::abs(p.z)});
  if (!(size > 0.0) || !std::isfinite(size)) return {};
  const double scale =
      std::ldexp(1.0, std::clamp(-std::ilogb(size), -1000, 1000));  // nothing overflows, nor rounds
  Vector normal;
  for (std::size_t i = 0; i < corners.size(); ++i) {
    const Vector first = scale * corners[0];
    normal += cross(scale * corners[i] - first, scale * corners[(i + 1) % corners.size()] - first);
  }
  int axis = 0;
  for (const int other : {1, 2}) {
    if (std::abs(component(normal, other)) > std::abs(component(normal, axis))) axis = other;
  }
  const double largest = component(normal, axis);
  if (largest == 0.0 || std::isnan(largest)) return {};
  std::vector<Point> points;
  for (const Vector& p : corners) {
    const Point q{scale * component(p, (axis + 1) % 3), scale * component(p, (axis + 2) % 3)};
    points.push_back(largest > 0.0 ? q : Point{q.y, q.x});
  }
  return points;
}

bool isFan(const std::vector<Point>& p) {
  for (std::size_t i = 2; i < p.size(); ++i) {
    if (!(area(p[0], p[i - 1], p[i]) > 0.0)) return false;
  }
  return true;
}

/// Cuts ears, corners whose triangle holds no other corner. Only the neighbours of a cut ear can become ears, and only corners that are
/// not convex can be in another's triangle, so that n corners of which r are reflex take time in n * r.
class Ears {
 public:
  Ears(const std::vector<Point>& points, std::vector<std::array<std::uint32_t, 3>>& triangles)
      : points_(points),
        triangles_(triangles),
        before_(points.size()),
        after_(points.size()),
        isCut_(points.size()) {
    const auto count = static_cast<std::uint32_t>(points.size());
    for (std::uint32_t i = 0; i < count; ++i) {
      before_[i] = (i + count - 1) % count;
      after_[i] = (i + 1) % count;
      candidates_.push_back(i);
    }
    for (std::uint32_t i = 0; i < count; ++i) {
      if (!(turn(i) > 0.0)) reflex_.push_back(i);
    }
  }

  void cutAll() {
    std::uint32_t last = 0;
    for (std::size_t left = points_.size(); left > 3; --left) {
      const std::uint32_t ear = nextEar(last);
      last = after_[ear];
      cut(ear);
    }
    triangles_.push_back({before_[last], last, after_[last]});
  }

 private:
  double turn(std::uint32_t i) const { return area(points_[before_[i]], points_[i], points_[after_[i]]); }

  bool isEar(std::uint32_t i) const {
    if (!(turn(i) > 0.0)) return false;
    const Point a = points_[before_[i]], b = points_[i], c = points_[after_[i]];
    return std::ranges::none_of(reflex_, [&](std::uint32_t j) {
      const Point p = points_[j];
      return !isCut_[j] && p != a && p != b && p != c && area(a, b, p) >= 0.0 && area(b, c, p) >= 0.0 &&
             area(c, a, p) >= 0.0;
    });
  }

  /// A polygon that touches or crosses itself may have no ear: then a corner without area goes, or a convex one, or any.
  std::uint32_t nextEar(std::uint32_t start) {
    while (!candidates_.empty()) {
      const std::uint32_t i = candidates_.front();
      candidates_.pop_front();
      if (!isCut_[i] && isEar(i)) return i;
    }
    std::uint32_t best = start;
    for (std::uint32_t i = after_[start]; i != start; i = after_[i]) {
      const double t = turn(i);
      if (t == 0.0) return i;
      if (t > 0.0 && !(turn(best) > 0.0)) best = i;
    }
    return best;
  }

  void cut(std::uint32_t i) {
    const std::uint32_t a = before_[i], c = after_[i];
    triangles_.push_back({a, i, c});
    isCut_[i] = true;
    after_[a] = c;
    before_[c] = a;
    candidates_.insert(candidates_.end(), {a, c});
    std::erase_if(reflex_, [&](std::uint32_t j) { return j == i || ((j == a || j == c) && turn(j) > 0.0); });
  }

  const std::vector<Point>& points_;
  std::vector<std::array<std::uint32_t, 3>>& triangles_;
  std::vector<std::uint32_t> before_, after_;  ///< neighbours in what is left
  std::vector<bool> isCut_;
  std::vector<std::uint32_t> reflex_;
  std::deque<std::uint32_t> candidates_;
};

}  // namespace

void triangulate(std::span<const Vector> corners, std::vector<std::array<std::uint32_t, 3>>& triangles) {
  triangles.clear();
  if (corners.size() > 3) {
    const std::vector<Point> points = flat(corners);
    if (!points.empty() && !isFan(points)) return Ears(points, triangles).cutAll();
  }
  for (std::uint32_t i = 2; i < corners.size(); ++i) triangles.push_back({0, i - 1, i});
}

}  // namespace examples
