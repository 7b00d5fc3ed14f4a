// SPDX-License-Identifier: MIT
//
// A cloth on its device, or divided over the devices of several ranks: the streams that the features need and no others, the passes
// of a step, and what the device reduces of it. Files and pictures are others' business.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include <sk/sk.hpp>

#include "model.hpp"
#include "support/grid_stream.hpp"

namespace examples {

/// What a look at all points has found.
struct Census {
  std::int64_t broken = 0;  ///< points that are NaN, or farther than 10^18 m
  double fastest = 0.0;  ///< m/s
};

/// What a cloth as a whole does, in metres, kilograms and joules.
struct Observation {
  double kinetic = 0, elastic = 0, potential = 0;
  double strain = 0;  ///< the mean | l / rest - 1 | of all links
  double largest = 0;  ///< the largest
  Vector centre;  ///< of the mass of what is not pinned

  double energy() const { return kinetic + elastic + potential; }
};

/// All that a run goes on from. If the cloth is divided, the first rank has it.
struct State {
  std::int64_t step = 0;
  std::vector<double> positions;  ///< x, y, z and inverse mass of each point
  std::vector<double> displacements;  ///< x, y, z
  bool tears = false;
  std::vector<std::int32_t> alive;  ///< bits of the links; empty where nothing tears

  /// The first point, row by row, that a census counts as broken; the last one if none is.
  std::int64_t firstBroken(Verlet verlet) const;
};

/// The extents of a cloth's streams.
sk::Shape shapeOf(const Scene& scene);

/// If its space is divided over ranks, all ranks make the same calls.
class Simulation {
 public:
  /// `precision` is what steps are computed in and streams hold. The space has the shape of the scene's cloth.
  Simulation(const Space& space, const Scene& scene, const Features& features, sk::Precision precision);
  Simulation(sk::Device& device, const Scene& scene, const Features& features, sk::Precision precision);
  Simulation(Simulation&&) noexcept;
  ~Simulation();

  /// Queues steps. finish() waits for them and adds up the time that both have taken.
  void advance(std::int64_t steps);
  void finish();
  double milliseconds() const { return milliseconds_; }
  std::int64_t step() const { return step_; }

  Census census() const;
  const Space& space() const { return space_; }
  /// Not of a cloth that is divided: let one on one device have its state.
  Observation observe() const;
  /// That still hold, each once; 0 where nothing tears.
  std::int64_t links() const;

  State state() const;
  /// Where `state` tells of no links, those stay as they are.
  void restore(const State& state);
  std::vector<double> positions() const { return p_.readReals(); }

  /// Positions (x, y, z, inverse mass) and normals (w: the bits of the two triangles right and below of the point that are whole)
  /// as they are now, in single precision. Not of a cloth that is divided.
  void dress();
  const sk::Stream<sk::float4>& dressedPositions() const { return *shown_; }
  const sk::Stream<sk::float4>& dressedNormals() const { return *normals_; }

  /// How many streams a step reads or writes.
  int streams() const;
  const Features& features() const { return features_; }

 private:
  struct Bodies;

  void integrate(const Moment& moment);
  void relax();
  void collide(const Moment& moment);
  void tear();
  void place(const Moment& moment);

  Space space_;
  Scene scene_;
  Features features_;
  Constants constants_;
  sk::CallOptions options_;
  std::int64_t step_ = 0;
  double milliseconds_ = 0.0;

  GridStream<sk::float4> p_;
  GridStream<sk::float3> d_;
  std::optional<GridStream<int>> alive_;
  std::optional<GridStream<int>> pin_;
  std::optional<sk::Stream<sk::float3>> carry_;
  std::unique_ptr<Bodies> bodies_;
  std::optional<sk::Stream<sk::float4>> shown_, normals_;
};

}  // namespace examples
