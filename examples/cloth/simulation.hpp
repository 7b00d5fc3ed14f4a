// SPDX-License-Identifier: MIT
//
// A cloth on its device: the streams that the features need and no others, the passes of a step, and what the device reduces of
// it. Files and pictures are others' business.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include <sk/sk.hpp>

#include "model.hpp"

namespace examples {

/// What a look at all points has found.
struct Census {
  std::int64_t broken = 0;  ///< points that are NaN, or farther than 10^18 m
  std::int64_t first = 0;  ///< the first of them, row by row
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

/// All that a run goes on from.
struct State {
  std::int64_t step = 0;
  std::vector<double> positions;  ///< x, y, z and inverse mass of each point
  std::vector<double> displacements;  ///< x, y, z
  std::vector<std::int32_t> alive;  ///< bits of the links; empty where nothing tears
};

class Simulation {
 public:
  /// `precision` is what steps are computed in and streams hold.
  Simulation(sk::Device& device, const Scene& scene, const Features& features, sk::Precision precision);
  Simulation(Simulation&&) noexcept;
  ~Simulation();

  /// Queues steps. finish() waits for them and adds up the time that both have taken.
  void advance(std::int64_t steps);
  void finish();
  double milliseconds() const { return milliseconds_; }
  std::int64_t step() const { return step_; }

  Census census() const;
  Observation observe() const;
  /// That still hold, each once; 0 where nothing tears.
  std::int64_t links() const;

  State state() const;
  /// Where `state` tells of no links, those stay as they are.
  void restore(const State& state);
  std::vector<double> positions() const { return p_.readReals(); }

  /// Positions (x, y, z, inverse mass) and normals (w: the bits of the two triangles right and below of the point that are whole)
  /// as they are now, in single precision.
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

  sk::Device* device_;
  Scene scene_;
  Features features_;
  Constants constants_;
  sk::CallOptions options_;
  std::int64_t step_ = 0;
  double milliseconds_ = 0.0;

  sk::Stream<sk::float4> p_;
  sk::Stream<sk::float3> d_;
  std::optional<sk::Stream<int>> alive_;
  std::optional<sk::Stream<int>> pin_;
  std::optional<sk::Stream<sk::float3>> carry_;
  std::unique_ptr<Bodies> bodies_;
  std::optional<sk::Stream<sk::float4>> shown_, normals_;
};

}  // namespace examples
