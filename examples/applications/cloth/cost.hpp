// SPDX-License-Identifier: MIT
//
// What a scene required and what the whole model would have cost, measured side by side from the same state.
#pragma once

#include <string>

#include <sk/sk.hpp>

#include "scene.hpp"
#include "simulation.hpp"

namespace examples {

/// What one step of a model costs.
struct Cost {
  int streams = 0;
  double passes = 0;
  double bytes = 0;  ///< read and written
  double milliseconds = 0;
};

struct Comparison {
  Cost required;
  Cost full;
  double deviation = 0;  ///< the largest difference of a coordinate after the steps, in metres
  std::int64_t steps = 0;
};

/// Goes on from `state` with both models for some steps, in turns, and takes the medians of the times.
Comparison compareWithFull(sk::Device& device, const Scene& scene, sk::Precision precision,
                           const State& state);

/// "structural, shear; 2 rounds" and the like: what of the model the scene has switched on.
std::string partsOf(const Scene& scene);

/// The table for people.
std::string tableOf(const Comparison& comparison, const Scene& scene);

}  // namespace examples
