// SPDX-License-Identifier: MIT
//
// One step of the cloth of examples/applications/cloth: gravity, two rounds of relaxation of twelve links to a point, a ball and a floor.
// floats: x, y, z and inverse mass of each point in turn, then x, y, z of what each moved by in the last step; as in the
// result.
#include <algorithm>
#include <array>
#include <cmath>

#include "cloth.sk.hpp"
#include "constants.hpp"
#include "our_task.hpp"
#include "programs/all.hpp"

namespace race {
namespace {

template <class Vector>
std::vector<Vector> vectorsOf(const std::vector<float>& parts) {
  const auto* first = reinterpret_cast<const Vector*>(parts.data());
  return {first, first + parts.size() * sizeof(float) / sizeof(Vector)};
}

class Cloth final : public OurTask {
 public:
  Cloth(sk::Device& device, const sk::CallOptions& options, const Problem& p)
      : OurTask(device),
        integrate_(cloth::integrate.with(options)),
        relax_(cloth::relax.with(options)),
        collide_(cloth::collide.with(options)),
        from_(filled<sk::float4>({p.rows, p.columns}, vectorsOf<sk::float4>(p.floats[0]))),
        moved_(filled<sk::float3>({p.rows, p.columns}, vectorsOf<sk::float3>(p.floats[1]))),
        at_(device.stream<sk::float4>({p.rows, p.columns})),
        by_(device.stream<sk::float3>({p.rows, p.columns})),
        spheres_(
            filled<cloth::Sphere>({1}, {{{clothBall[0], clothBall[1], clothBall[2]}, clothBall[3], {}, 0}})),
        planes_(filled<cloth::Plane>({1}, {{{}, 0, {0, 1, 0}, {}}})) {}

  std::vector<float> result() override {
    std::vector<float> all = flat(at_.read());
    const std::vector<float> by = flat(by_.read());
    all.insert(all.end(), by.begin(), by.end());
    return all;
  }

 private:
  void once() override {
    constexpr unsigned displacements = 0;  // cloth::Verlet
    const cloth::Forces gravity{
        .motion = cloth::Motion{{0, clothFall, 0}, clothKeep}, .windy = false, .air = cloth::Wind{}};
    integrate_(netOf(false, from_), gravity, {.carried = false}, displacements, moved_, sk::none, sk::none,
               at_, by_);
    for (int round = 0; round < clothRounds; ++round)
      relax_(netOf(true, at_), displacements, by_, sk::none, at_, by_);
    collide_({.spheres = true,
              .planes = true,
              .capsules = false,
              .boxes = false,
              .thickness = clothThickness,
              .sphere = spheres_,
              .plane = planes_},
             at_, by_, at_, by_);
  }

  /// All links, or none.
  static cloth::Net netOf(bool linked, const sk::Stream<sk::float4>& points) {
    return {
        .structural = linked,
        .shear = linked,
        .bend = linked,
        .tearing = false,
        .law = 0U,  // cloth::Law: exact
        .links = cloth::Links{clothCell, clothCell, clothDiagonal, clothStructural, clothShear, clothBend},
        .p = points};
  }

  cloth::IntegrateKernel integrate_;
  cloth::RelaxKernel relax_;
  cloth::CollideKernel collide_;
  sk::Stream<sk::float4> from_;
  sk::Stream<sk::float3> moved_;
  sk::Stream<sk::float4> at_;
  sk::Stream<sk::float3> by_;
  sk::Stream<cloth::Sphere> spheres_;
  sk::Stream<cloth::Plane> planes_;
};

using Vector = std::array<double, 3>;

Vector sum(const Vector& a, double factor, const Vector& b) {
  return {a[0] + factor * b[0], a[1] + factor * b[1], a[2] + factor * b[2]};
}
double dot(const Vector& a, const Vector& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }

/// The step at single points, in double precision.
class Reference {
 public:
  explicit Reference(const Problem& p) : p_(p) {}

  struct Point {
    Vector at, by;
  };

  /// After the first so many rounds of relaxation.
  Point relaxed(int rounds, std::int64_t y, std::int64_t x) const {
    if (rounds == 0) return integrated(y, x);
    Point point = relaxed(rounds - 1, y, x);
    Vector pull{};
    for (const ClothLink& link : clothLinks) {
      const std::int64_t row = y + link.y, column = x + link.x;
      if (row < 0 || row >= p_.rows || column < 0 || column >= p_.columns) continue;
      const Vector d = sum(relaxed(rounds - 1, row, column).at, -1, point.at);
      const double excess = 1 - link.rest / std::sqrt(dot(d, d));
      const double share = weight(y, x) / std::max(weight(y, x) + weight(row, column), 1e-37);
      pull = sum(pull, link.factor * share * excess, d);
    }
    point.at = sum(point.at, 1, pull);
    point.by = sum(point.by, 1, pull);
    return point;
  }

  Point stepped(std::int64_t y, std::int64_t x) const {
    Point point = relaxed(clothRounds, y, x);
    if (weight(y, x) == 0) return point;
    const Vector out = sum(point.at, -1, {clothBall[0], clothBall[1], clothBall[2]});
    const double l = std::sqrt(dot(out, out));
    touch(sum({}, 1 / l, out), double{clothBall[3]} + clothThickness - l, point);
    touch({0, 1, 0}, clothThickness - point.at[1], point);
    return point;
  }

  double weight(std::int64_t y, std::int64_t x) const { return part(0, 4, y, x, 3); }

 private:
  double part(std::size_t list, std::size_t parts, std::int64_t y, std::int64_t x, std::size_t k) const {
    return p_.floats[list][parts * static_cast<std::size_t>(y * p_.columns + x) + k];
  }

  Point integrated(std::int64_t y, std::int64_t x) const {
    Point point{};
    for (std::size_t k = 0; k < 3; ++k) {
      const double fall = k == 1 ? clothFall : 0;
      point.by[k] = weight(y, x) == 0 ? 0 : clothKeep * part(1, 3, y, x, k) + fall;
      point.at[k] = part(0, 4, y, x, k) + point.by[k];
    }
    return point;
  }

  static void touch(const Vector& normal, double depth, Point& point) {
    if (depth <= 0) return;
    point.at = sum(point.at, depth, normal);
    point.by = sum(point.by, -std::min(dot(point.by, normal), 0.0), normal);
  }

  const Problem& p_;
};

}  // namespace

Problem clothProblem(int log2) {
  Problem p = grid(log2);
  const auto n = static_cast<std::size_t>(p.size());
  const std::vector<float> shaken = numbers(3 * p.size(), 1, -0.1f * clothCell, 0.1f * clothCell);
  std::vector<float> at;
  at.reserve(4 * n);
  for (std::int64_t i = 0; i < p.size(); ++i) {
    const auto x = static_cast<float>(i % p.columns - p.columns / 2);
    const auto y = static_cast<float>(i / p.columns - p.rows / 2);
    const float* by = &shaken[3 * static_cast<std::size_t>(i)];
    at.insert(at.end(), {clothCell * x + by[0], clothHeight + by[1], clothCell * y + by[2],
                         i < p.columns ? 0.0f : 1.0f});
  }
  p.floats = {std::move(at), numbers(3 * p.size(), 2, -0.01f * clothCell, 0.01f * clothCell)};
  return p;
}

Check clothCheck(const Problem& p) {
  const Reference reference(p);
  Check check{{}, {}, 1e-6};
  for (const std::int64_t i : somePlaces(p.size(), 1024)) {
    const std::int64_t y = i / p.columns, x = i % p.columns;
    const Reference::Point point = reference.stepped(y, x);
    for (std::int64_t k = 0; k < 4; ++k) {
      check.places.push_back(4 * i + k);
      check.values.push_back(k < 3 ? point.at[static_cast<std::size_t>(k)] : reference.weight(y, x));
    }
    for (std::int64_t k = 0; k < 3; ++k) {
      check.places.push_back(4 * p.size() + 3 * i + k);
      check.values.push_back(point.by[static_cast<std::size_t>(k)]);
    }
  }
  return check;
}

std::unique_ptr<Task> clothOurs(sk::Device& device, const sk::CallOptions& options, const Problem& p) {
  return std::make_unique<Cloth>(device, options, p);
}

}  // namespace race
