// SPDX-License-Identifier: MIT
#include "host_cloth.hpp"

#include <algorithm>
#include <cmath>

namespace examples {
namespace {

/// Length at rest, factor, and direction of coincident ends of a link, by its bit.
struct LinkOf {
  float rest;
  float factor;
};
LinkOf linkOf(int link, const LinkConstants& k) {
  const bool across = linkDirections[link].y == 0;
  if (link < 4) return {across ? k.right : k.down, k.structural};
  if (link < 8) return {k.diagonal, k.shear};
  return {2 * (across ? k.right : k.down), k.bend};
}

bool wanted(int link, const LinkKinds& kinds) {
  return link < 4 ? kinds.structural : link < 8 ? kinds.shear : kinds.bend;
}

template <class Real>
Vec<Real> apart(int link) {
  const auto sign = [](int v) { return static_cast<Real>(v > 0 ? 1 : v < 0 ? -1 : 0); };
  const Real x = sign(linkDirections[link].x), y = sign(linkDirections[link].y);
  if (x == 0 || y == 0) return {x, -y, 0};
  return {static_cast<Real>(0.6f) * x, static_cast<Real>(-0.8f) * y, 0};
}

/// v turned by the unit quaternion of axis and w.
template <class Real>
Vec<Real> turned(Vec<Real> v, Vec<Real> axis, Real w) {
  return v + Real(2) * cross(axis, cross(axis, v) + w * v);
}

template <class Real>
struct Contact {
  Vec<Real> normal;
  Real depth;
};

template <class Real>
Contact<Real> outOf(Vec<Real> d, Real radius) {
  const Real l = length(d);
  return {l > 0 ? (1 / l) * d : Vec<Real>{0, 1, 0}, radius - l};
}

template <class Real>
Contact<Real> outOfBox(Vec<Real> d, Vec<Real> half, Real thickness) {
  const Vec<Real> side{Real(d.x < 0 ? -1 : 1), Real(d.y < 0 ? -1 : 1), Real(d.z < 0 ? -1 : 1)};
  const Vec<Real> beyond{std::abs(d.x) - half.x, std::abs(d.y) - half.y, std::abs(d.z) - half.z};
  const Vec<Real> out{std::max(beyond.x, Real(0)), std::max(beyond.y, Real(0)), std::max(beyond.z, Real(0))};
  const Real l = length(out);
  if (l > 0) return {{side.x * out.x / l, side.y * out.y / l, side.z * out.z / l}, thickness - l};
  const Real face = std::max({beyond.x, beyond.y, beyond.z});
  if (beyond.y == face) return {{0, side.y, 0}, thickness - face};
  if (beyond.x == face) return {{side.x, 0, 0}, thickness - face};
  return {{0, 0, side.z}, thickness - face};
}

}  // namespace

template <class Real>
HostCloth<Real>::HostCloth(const Scene& scene, const Constants& constants)
    : HostCloth(scene, constants, firstState(scene, constants)) {}

template <class Real>
HostCloth<Real>::HostCloth(const Scene& scene, const Constants& constants, const FirstState& first)
    : scene_(scene),
      features_(Features::of(scene)),
      constants_(constants),
      alive_(first.alive),
      pin_(first.pin) {
  for (const sk::float4& p : first.positions) {
    at_.push_back({p.x, p.y, p.z});
    weight_.push_back(p.w);
  }
  for (const sk::float3& d : first.displacements) last_.push_back(vecOf<Real>(d));
  next_ = at_;
  left_ = alive_;
}

template <class Real>
bool HostCloth<Real>::neighbour(std::size_t i, int link, std::size_t& other) const {
  const auto columns = static_cast<std::int64_t>(scene_.cloth.columns);
  const std::int64_t x = static_cast<std::int64_t>(i) % columns + linkDirections[link].x;
  const std::int64_t y = static_cast<std::int64_t>(i) / columns + linkDirections[link].y;
  other = static_cast<std::size_t>(y * columns + x);
  return x >= 0 && x < columns && y >= 0 && y < scene_.cloth.rows;
}

template <class Real>
Vec<Real> HostCloth<Real>::pull(std::size_t i, const LinkConstants& k, const LinkKinds& kinds,
                                bool springs) const {
  Vec<Real> sum{};
  for (int link = 0; link < 12; ++link) {
    std::size_t j;
    if (!wanted(link, kinds) || (features_.tearing && !((alive_[i] >> link) & 1)) || !neighbour(i, link, j))
      continue;
    const LinkOf constants = linkOf(link, k);
    const Real share =
        static_cast<Real>(constants.factor) * (springs ? weight_[i] : weight_[i] / (weight_[i] + weight_[j]));
    const Vec<Real> d = at_[j] - at_[i];
    const Real l = length(d), rest = constants.rest;
    if (!std::isfinite(l)) continue;
    if (l <= static_cast<Real>(1e-12) * rest) {
      sum -= (share * rest) * apart<Real>(link);
    } else if (features_.law == Law::Exact) {
      sum += (share * (1 - rest / l)) * d;
    } else {
      sum += (share * ((l * l - rest * rest) / (l * l + rest * rest))) * d;
    }
  }
  return sum;
}

template <class Real>
Vec<Real> HostCloth<Real>::wind(std::size_t i, const Vec<Real>& last, Real phase) const {
  const WindConstants& w = constants_.wind;
  const auto side = [&](int link) {
    std::size_t j;
    const bool linked = neighbour(i, link, j) && (!features_.tearing || ((alive_[i] >> link) & 1));
    return linked ? at_[j] : at_[i];
  };
  const Vec<Real> normal = normalized(cross(side(2) - side(3), side(0) - side(1)));
  const Vec<Real> velocity = vecOf<Real>(w.velocity);
  const Real angle = phase - dot(vecOf<Real>(w.wave), at_[i]);
  const Real swirl = w.swirl * std::sin(static_cast<Real>(1.7f) * angle + static_cast<Real>(2.3f) * at_[i].y);
  const Vec<Real> sideways = cross(velocity, Vec<Real>{0, 1, 0});
  const Vec<Real> flow = (1 + w.gust * std::sin(angle)) * velocity + swirl * sideways - last;
  const Vec<Real> through = dot(flow, normal) * normal;
  return length(flow) *
         (static_cast<Real>(w.across) * through + static_cast<Real>(w.along) * (flow - through));
}

template <class Real>
void HostCloth<Real>::integrate(const Moment& moment) {
  const bool displaced = features_.verlet == Verlet::Displacements;
  for (std::size_t i = 0; i < at_.size(); ++i) {
    Vec<Real> by{};
    if (weight_[i] == 0) {
      if (features_.carried && pin_[i] >= 0)
        by = vecOf<Real>(moment.carry[static_cast<std::size_t>(pin_[i])]);
    } else {
      const Vec<Real> last = displaced ? last_[i] : at_[i] - last_[i];
      Vec<Real> force{};
      if (features_.springs.any()) force += pull(i, constants_.springs, features_.springs, true);
      if (features_.windy) force += weight_[i] * wind(i, last, moment.windPhase);
      by = static_cast<Real>(constants_.keep) * last + (vecOf<Real>(constants_.gravity) + force);
    }
    next_[i] = at_[i] + by;
    last_[i] = displaced ? by : at_[i];
  }
  at_.swap(next_);
}

template <class Real>
void HostCloth<Real>::relax() {
  for (std::size_t i = 0; i < at_.size(); ++i) {
    Vec<Real> by{};
    if (weight_[i] > 0) by = pull(i, constants_.relaxed, features_.relaxed, false);
    next_[i] = at_[i] + by;
    if (features_.verlet == Verlet::Displacements) last_[i] += by;
  }
  at_.swap(next_);
}

template <class Real>
void HostCloth<Real>::touch(const Body& body, const Placed& placed, Vec<Real>& at, Vec<Real>& by) const {
  const Vec<Real> along = vecOf<Real>(toFloat3(body.along)), size = vecOf<Real>(toFloat3(body.size));
  const Real thickness = constants_.thickness, friction = static_cast<float>(body.friction);
  const Vec<Real> centre = vecOf<Real>(placed.at), moved = vecOf<Real>(placed.moved);
  Contact<Real> c{};
  switch (body.kind) {
    case Kind::Sphere: c = outOf(at - centre, size.x + thickness); break;
    case Kind::Plane: c = {along, thickness - dot(along, at - centre)}; break;
    case Kind::Capsule: {
      const Real square = dot(along, along);
      const Real t = square > 0 ? std::clamp(dot(at - centre, along) / square, Real(0), Real(1)) : Real(0);
      c = outOf(at - centre - t * along, size.x + thickness);
      break;
    }
    case Kind::Box: {
      const Vec<Real> axis = vecOf<Real>(toFloat3(body.axis));
      const Real w = static_cast<float>(body.turn);
      c = outOfBox(turned(at - centre, Real(-1) * axis, w), size, thickness);
      c.normal = turned(c.normal, axis, w);
      break;
    }
  }
  if (!(c.depth > 0)) return;
  const Vec<Real> relative = by - moved;
  const Real inward = dot(relative, c.normal);
  const Vec<Real> slip = relative - inward * c.normal;
  const Real way = length(slip);
  const Vec<Real> lost = way > friction * c.depth ? (friction * c.depth / way) * slip : slip;
  at += c.depth * c.normal - lost;
  by = moved + slip - lost + std::max(inward, Real(0)) * c.normal;
}

template <class Real>
void HostCloth<Real>::collide(const Moment& moment) {
  constexpr Kind order[] = {Kind::Sphere, Kind::Capsule, Kind::Box, Kind::Plane};
  for (std::size_t i = 0; i < at_.size(); ++i) {
    if (weight_[i] == 0) continue;
    for (const Kind kind : order) {
      for (std::size_t b = 0; b < scene_.bodies.size(); ++b) {
        if (scene_.bodies[b].kind == kind) touch(scene_.bodies[b], moment.bodies[b], at_[i], last_[i]);
      }
    }
  }
}

template <class Real>
void HostCloth<Real>::tear() {
  for (std::size_t i = 0; i < at_.size(); ++i) {
    left_[i] = alive_[i];
    for (int link = 0; link < 12; ++link) {
      std::size_t j;
      const LinkKinds kinds{true, features_.relaxed.shear || features_.springs.shear,
                            features_.relaxed.bend || features_.springs.bend};
      if (!wanted(link, kinds) || !neighbour(i, link, j)) continue;
      const Real most = static_cast<Real>(constants_.longest) * linkOf(link, constants_.relaxed).rest;
      if (length(at_[j] - at_[i]) > most) left_[i] &= ~(1 << link);
    }
  }
  alive_.swap(left_);
}

template <class Real>
void HostCloth<Real>::advance(std::int64_t steps) {
  for (; steps > 0; --steps, ++step_) {
    const Moment moment = momentAt(scene_, step_);
    integrate(moment);
    if (features_.relaxed.any()) {
      for (int round = 0; round < constants_.iterations; ++round) relax();
    }
    if (features_.touches()) collide(moment);
    if (features_.tearing) tear();
  }
}

template class HostCloth<float>;
template class HostCloth<double>;
template class HostCloth<long double>;

}  // namespace examples
