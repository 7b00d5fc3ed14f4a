// SPDX-License-Identifier: MIT
//
// What a scene comes to: which parts of the model it needs (Features), the numbers of a step, rounded to the floats that
// devices and the loops that verify them both take (Constants), those that change with time (Moment), and the first state.
#pragma once

#include <cstdint>
#include <vector>

#include "scene.hpp"

namespace examples {

struct LinkKinds {
  bool structural = false;
  bool shear = false;
  bool bend = false;

  bool any() const { return structural || shear || bend; }
};

/// What is compiled, bound and run.
struct Features {
  LinkKinds springs;  ///< forces of links
  LinkKinds relaxed;  ///< constraints
  bool tearing = false;
  bool windy = false;
  bool carried = false;  ///< pins move
  bool spheres = false, planes = false, capsules = false, boxes = false;
  Law law = Law::Exact;
  Verlet verlet = Verlet::Displacements;

  bool touches() const { return spheres || planes || capsules || boxes; }
  /// What the scene requires.
  static Features of(const Scene& scene);
  /// The whole model; what the scene has not is there and does nothing (factors of 0, bodies out of reach).
  static Features full(const Scene& scene);
};

/// Lengths at rest and factors: what part of a link's excess is taken away, of springs k dt^2 / m.
struct LinkConstants {
  float right = 0, down = 0, diagonal = 0;
  float structural = 0, shear = 0, bend = 0;
};

struct WindConstants {
  sk::float3 velocity{};  ///< times dt
  float across = 0, along = 0;  ///< rho c A / (2 m), A a cell's area and m a point's mass
  float gust = 0, swirl = 0;
  sk::float3 wave{};  ///< radians a metre, along the velocity
};

struct Constants {
  sk::float3 gravity{};  ///< times dt^2
  float keep = 1;
  LinkConstants springs, relaxed;
  WindConstants wind;
  float thickness = 0;
  float longest = 1e30f;  ///< length over that at rest from which on a link tears
  int iterations = 1;
  double pointMass = 1;  ///< kg; devices count masses in this unit
};
Constants constantsOf(const Scene& scene);

/// The largest sum that the stiffnesses of one point's links have, those of the stiffest kind counted as 1; at least 1. No eigenvalue
/// of a round of relaxation with factor 1 is larger, by Gershgorin's theorem: each link adds at most its stiffness to the
/// sizes in the row of its point. Constraints are relaxed by scene.links.relaxation over this.
double stiffnessAround(const Scene& scene);

/// A body during a step, as devices get it: its place at the end of the step and its way in it.
struct Placed {
  sk::float3 at{};
  sk::float3 moved{};
};

struct Moment {
  float windPhase = 0;
  std::vector<sk::float3> carry;  ///< of each pin, its way in this step
  std::vector<Placed> bodies;  ///< of each body
};
/// For the step from `step` to step + 1. Without bodies and carries that move, all moments are alike but for the wind.
Moment momentAt(const Scene& scene, std::int64_t step);
bool bodiesMove(const Scene& scene);

/// Positions with inverse masses (0 where pinned, else 1), row by row; what Verlet keeps beside them, so that the cloth starts
/// from rest: x(0) - x(-1) = -g dt^2 / 2, or x(-1); the bits of each point's links; the number of its pin, or -1.
struct FirstState {
  std::vector<sk::float4> positions;
  std::vector<sk::float3> displacements;
  std::vector<std::int32_t> alive;
  std::vector<std::int32_t> pin;
};
FirstState firstState(const Scene& scene, const Constants& constants);

/// The direction in columns and rows of each of a point's twelve links, in the order of their bits: four structural, four shear, four bend.
struct LinkDirection {
  int x, y;
};
inline constexpr LinkDirection linkDirections[12] = {{1, 0},  {-1, 0}, {0, 1}, {0, -1}, {1, 1}, {-1, -1},
                                                     {-1, 1}, {1, -1}, {2, 0}, {-2, 0}, {0, 2}, {0, -2}};

}  // namespace examples
