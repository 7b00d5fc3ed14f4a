// SPDX-License-Identifier: MIT
//
// A scene from its start to its last step, with pictures and numbers on the way, and the last step against double precision.
#pragma once

#include <cstdint>
#include <vector>

#include "flow.hpp"
#include "scene.hpp"
#include "support/host_memory.hpp"
#include "support/verification.hpp"

namespace fluid {

struct Outcome {
  std::int64_t steps = 0;
  double time = 0.0, milliseconds = 0.0;
  double shortest = 1e300, longest = 0.0;  ///< time steps
  double largestCfl = 0.0;
  std::int64_t iterations = 0, missed = 0;  ///< of projections; steps that did not reach the tolerance
  Step last;
  int streams = 0, pictures = 0;
  double passes = 0.0, bytes = 0.0;  ///< of the last step
  std::vector<examples::Verification> verifications;
};

/// The start of a scene: noise, if it has any, and no divergence.
Flow begin(const linear::Space& space, const Scene& scene);

/// What run() takes for each cell, those of the layer included, with its check of the last step against double precision.
examples::BytesPerCell memoryFor(const Model& model);

/// In a space of the model's shape. If it is divided over ranks, the first one verifies, and writes pictures and numbers. Throws std::runtime_error, "step N: ...", if a field is not finite; pictures that were made before are kept.
Outcome run(const linear::Space& space, const Scene& scene);

}  // namespace fluid
