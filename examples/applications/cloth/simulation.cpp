// SPDX-License-Identifier: MIT
#include "simulation.hpp"

#include <algorithm>
#include <cmath>

#include "cloth.sk.hpp"
#include "support/stopwatch.hpp"

namespace examples {
namespace {

/// A configuration file may choose the storage of a cloth in single precision.
sk::Storage storageFor(sk::Precision precision) {
  switch (precision) {
    case sk::Precision::Extended: return sk::Storage::Extended;
    case sk::Precision::Double: return sk::Storage::Double;
    case sk::Precision::Default:
    case sk::Precision::Half:
    case sk::Precision::Single: break;
  }
  return sk::Storage::Default;
}

cloth::Links linksOf(const LinkConstants& k) {
  return {k.right, k.down, k.diagonal, k.structural, k.shear, k.bend};
}

cloth::Wind windOf(const WindConstants& w, float phase) {
  return {w.velocity, w.across, w.along, w.gust, w.swirl, phase, w.wave};
}

/// The stream, or sk::none where the scene has it not.
template <class Parameter, class Stream>
sk::Optional<Parameter> given(const std::optional<Stream>& stream) {
  if (!stream) return sk::none;
  return *stream;
}

/// The same for a member of a bundle, which refers to the stream.
template <class Stream>
sk::GatherMember<typename Stream::value_type> member(const std::optional<Stream>& stream) {
  if (!stream) return sk::none;
  return *stream;
}

cloth::Net netOf(const Features& features, const LinkKinds& kinds, const LinkConstants& k,
                 const GridStream<sk::float4>& p) {
  return {.structural = kinds.structural,
          .shear = kinds.shear,
          .bend = kinds.bend,
          .tearing = features.tearing,
          .law = static_cast<unsigned>(features.law),
          .links = linksOf(k),
          .p = p};
}

// Bodies that touch nothing, for the model that has everything.
constexpr float never = -1e30f;
constexpr cloth::Sphere noSphere{{0, 0, 0}, never, {0, 0, 0}, 0};
constexpr cloth::Plane noPlane{{0, never, 0}, 0, {0, 1, 0}, {0, 0, 0}};
constexpr cloth::Capsule noCapsule{{0, 0, 0}, never, {0, 0, 0}, 0, {0, 0, 0}};
constexpr cloth::Box noBox{{0, never, 0}, 0, {0, 0, 0}, {0, 0, 0, 1}, {0, 0, 0}};

/// Puts the bodies of a kind in its stream, the neutral one where the scene has none.
template <class T, class Make>
void placeKind(sk::Device& device, bool wanted, const Scene& scene, Kind kind, const Moment& moment,
               const T& none, std::optional<sk::Stream<T>>& stream, const Make& make) {
  if (!wanted) return;
  std::vector<T> bodies;
  for (std::size_t i = 0; i < scene.bodies.size(); ++i) {
    if (scene.bodies[i].kind == kind) bodies.push_back(make(scene.bodies[i], moment.bodies[i]));
  }
  if (bodies.empty()) bodies.push_back(none);
  if (!stream) stream = device.stream<T>({static_cast<std::int64_t>(bodies.size())});
  stream->writeAsync(bodies);
}

}  // namespace

/// The streams of each kind of bodies, where there are any.
struct Simulation::Bodies {
  std::optional<sk::Stream<cloth::Sphere>> spheres;
  std::optional<sk::Stream<cloth::Plane>> planes;
  std::optional<sk::Stream<cloth::Capsule>> capsules;
  std::optional<sk::Stream<cloth::Box>> boxes;
};

sk::Shape shapeOf(const Scene& scene) { return {scene.cloth.rows, scene.cloth.columns}; }

Simulation::Simulation(sk::Device& device, const Scene& scene, const Features& features,
                       sk::Precision precision)
    : Simulation(Space(device, shapeOf(scene)), scene, features, precision) {}

Simulation::Simulation(const Space& space, const Scene& scene, const Features& features,
                       sk::Precision precision)
    : space_(space),
      scene_(scene),
      features_(features),
      constants_(constantsOf(scene)),
      options_{.precision = precision},
      p_(namedStream<sk::float4>(space, storageFor(precision), "cloth::p")),
      d_(namedStream<sk::float3>(space, storageFor(precision), "cloth::d")),
      bodies_(std::make_unique<Bodies>()) {
  const FirstState first = firstState(scene, constants_);
  p_.write(first.positions);
  d_.write(first.displacements);
  if (features_.tearing) {
    alive_ = space.stream<int>();
    alive_->write(first.alive);
  }
  if (features_.carried) {
    pin_ = space.stream<int>();
    pin_->write(first.pin);
    carry_ = space.device().stream<sk::float3>(
        {std::max<std::int64_t>(1, static_cast<std::int64_t>(scene.pins.size()))});
    if (scene.pins.empty()) carry_->write(std::vector<sk::float3>(1));
  }
  place(momentAt(scene_, 0));
}

Simulation::Simulation(Simulation&&) noexcept = default;
Simulation::~Simulation() = default;

void Simulation::place(const Moment& moment) {
  const auto friction = [](const Body& b) { return static_cast<float>(b.friction); };
  placeKind(space_.device(), features_.spheres, scene_, Kind::Sphere, moment, noSphere, bodies_->spheres,
            [&](const Body& b, const Placed& now) {
              return cloth::Sphere{now.at, static_cast<float>(b.size.x), now.moved, friction(b)};
            });
  placeKind(space_.device(), features_.planes, scene_, Kind::Plane, moment, noPlane, bodies_->planes,
            [&](const Body& b, const Placed& now) {
              return cloth::Plane{now.at, friction(b), toFloat3(b.along), now.moved};
            });
  placeKind(space_.device(), features_.capsules, scene_, Kind::Capsule, moment, noCapsule, bodies_->capsules,
            [&](const Body& b, const Placed& now) {
              return cloth::Capsule{now.at, static_cast<float>(b.size.x), toFloat3(b.along), friction(b),
                                    now.moved};
            });
  placeKind(space_.device(), features_.boxes, scene_, Kind::Box, moment, noBox, bodies_->boxes,
            [&](const Body& b, const Placed& now) {
              const sk::float3 axis = toFloat3(b.axis);
              return cloth::Box{now.at,
                                friction(b),
                                toFloat3(b.size),
                                {axis.x, axis.y, axis.z, static_cast<float>(b.turn)},
                                now.moved};
            });
}

void Simulation::integrate(const Moment& moment) {
  if (carry_ && !moment.carry.empty()) carry_->writeAsync(moment.carry);
  const cloth::Forces forces{.motion = cloth::Motion{constants_.gravity, constants_.keep},
                             .windy = features_.windy,
                             .air = windOf(constants_.wind, moment.windPhase)};
  cloth::integrate.with(options_)(netOf(features_, features_.springs, constants_.springs, p_), forces,
                                  {.carried = features_.carried, .carry = member(carry_)},
                                  static_cast<unsigned>(features_.verlet), d_,
                                  given<sk::ElementIn<int>>(alive_), given<sk::ElementIn<int>>(pin_), p_, d_);
}

void Simulation::relax() {
  const auto verlet = static_cast<unsigned>(features_.verlet);
  const cloth::Net net = netOf(features_, features_.relaxed, constants_.relaxed, p_);
  const auto alive = given<sk::ElementIn<int>>(alive_);
  const auto call = cloth::relax.with(options_);
  if (features_.verlet == Verlet::Displacements)
    call(net, verlet, d_, alive, p_, d_);
  else
    call(net, verlet, sk::none, alive, p_, sk::none);
}

void Simulation::collide(const Moment& moment) {
  if (bodiesMove(scene_)) place(moment);
  const cloth::Bodies bodies{.spheres = features_.spheres,
                             .planes = features_.planes,
                             .capsules = features_.capsules,
                             .boxes = features_.boxes,
                             .thickness = constants_.thickness,
                             .sphere = member(bodies_->spheres),
                             .plane = member(bodies_->planes),
                             .capsule = member(bodies_->capsules),
                             .box = member(bodies_->boxes)};
  cloth::collide.with(options_)(bodies, p_, d_, p_, d_);
}

void Simulation::tear() {
  const LinkKinds both{.shear = features_.relaxed.shear || features_.springs.shear,
                       .bend = features_.relaxed.bend || features_.springs.bend};
  cloth::tear.with(options_)(netOf(features_, both, constants_.relaxed, p_), constants_.longest, *alive_,
                             *alive_);
}

void Simulation::advance(std::int64_t steps) {
  const Stopwatch stopwatch;
  for (; steps > 0; --steps, ++step_) {
    const Moment moment = momentAt(scene_, step_);
    integrate(moment);
    if (features_.relaxed.any()) {
      for (int round = 0; round < constants_.iterations; ++round) relax();
    }
    if (features_.touches()) collide(moment);
    if (features_.tearing) tear();
  }
  milliseconds_ += stopwatch.milliseconds();
}

void Simulation::finish() {
  const Stopwatch stopwatch;
  space_.device().finish();
  milliseconds_ += stopwatch.milliseconds();
}

Census Simulation::census() const {
  const auto [broken, fastest] =
      cloth::census.with(options_)(static_cast<unsigned>(features_.verlet), p_, d_);
  return {broken, fastest / scene_.run.dt};
}

Observation Simulation::observe() const {
  const bool springs = scene_.links.springs;
  const LinkConstants& k = springs ? constants_.springs : constants_.relaxed;
  const cloth::Net net{.shear = scene_.links.shear.has_value(),
                       .bend = scene_.links.bend.has_value(),
                       .tearing = alive_.has_value(),
                       .links = linksOf(k),
                       .p = p_.whole()};
  const cloth::Observed o =
      cloth::observe.with(options_)(net, springs, static_cast<unsigned>(features_.verlet), constants_.gravity,
                                    p_.whole(), d_.whole(), given<sk::ElementIn<int>>(alive_));
  const double joule = constants_.pointMass / (scene_.run.dt * scene_.run.dt);
  const double mass = std::max(1.0, static_cast<double>(o.energy.w));
  Observation result;
  result.kinetic = o.energy.x * joule;
  result.elastic = o.energy.y * joule;
  result.potential = -o.energy.z * joule;
  result.strain = o.strain / std::max(1, o.links);
  result.largest = o.links > 0 ? o.largest : 0.0;
  result.centre = (1.0 / mass) * vecOf<double>(o.centre);
  return result;
}

std::int64_t Simulation::links() const { return alive_ ? cloth::countLinks(*alive_) : 0; }

State Simulation::state() const {
  State s{step_, p_.readReals(), d_.readReals(), alive_.has_value(), {}};
  if (alive_) s.alive = alive_->read();
  return s;
}

void Simulation::restore(const State& state) {
  step_ = state.step;
  p_.writeReals(state.positions);
  d_.writeReals(state.displacements);
  if (alive_ && state.tears) alive_->write(state.alive);
}

std::int64_t State::firstBroken(Verlet verlet) const {
  const auto points = static_cast<std::int64_t>(positions.size() / 4);
  for (std::int64_t i = 0; i < points; ++i) {
    double size = 0.0;
    for (std::int64_t k = 0; k < 3; ++k) {
      const double x = positions[static_cast<std::size_t>(4 * i + k)],
                   d = displacements[static_cast<std::size_t>(3 * i + k)];
      size += std::abs(x) + std::abs(verlet == Verlet::Displacements ? d : x - d);
    }
    if (!(size < 1e18)) return i;
  }
  return std::max<std::int64_t>(points - 1, 0);
}

void Simulation::dress() {
  if (!normals_) {
    shown_ = space_.device().stream<sk::float4>(space_.shape());
    normals_ = space_.device().stream<sk::float4>(space_.shape());
  }
  cloth::dress.with(options_)(features_.tearing, p_.whole(), given<sk::In<int>>(alive_), *shown_, *normals_);
}

int Simulation::streams() const {
  return 2 + alive_.has_value() + pin_.has_value() + carry_.has_value() + bodies_->spheres.has_value() +
         bodies_->planes.has_value() + bodies_->capsules.has_value() + bodies_->boxes.has_value();
}

}  // namespace examples
