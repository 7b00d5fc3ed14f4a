// SPDX-License-Identifier: MIT
//
// A scene from its start to its last step, with pictures and numbers on the way, and its residual, energy and last step against double precision.
#pragma once

#include <cstdint>
#include <vector>

#include "scene.hpp"
#include "support/host_memory.hpp"
#include "support/verification.hpp"
#include "surface.hpp"

namespace waves {

struct Outcome {
  std::int64_t steps = 0;
  double time = 0.0, milliseconds = 0.0;
  std::int64_t iterations = 0, mostIterations = 0,
               missed = 0;  ///< most: of one step; missed: steps short of the tolerance
  double residual = 0.0;  ///< the largest ||b - A w|| / ||b|| of all steps
  double residualLast = 0.0;  ///< of the last step, in double precision
  double energy = 0.0, drift = 0.0,
         driftBound = 0.0;  ///< without what drops bring; drift and bound are parts of the energy at the end
  int pictures = 0;
  std::vector<examples::Verification> verifications;
};

/// What run() takes, its check of the last step against double precision included.
examples::BytesPerCell memoryFor(const Model& model);

/// In a space of the scene's shape, {height, width}. If it is divided over ranks, the first one verifies, and writes pictures and numbers. Throws std::runtime_error, "step N: ...", if the surface is not finite; pictures that were made before are kept.
Outcome run(const linear::Space& space, const Scene& scene);

}  // namespace waves
