// SPDX-License-Identifier: MIT
//
// A scene from its first step to its last: pictures, numbers, the watch for what is not finite, and the end where nothing
// changes any more; or in a window (live.cpp).
#pragma once

#include <string>

#include <sk/sk.hpp>

#include "lattice.hpp"
#include "reference.hpp"
#include "scene.hpp"
#include "support/host_memory.hpp"

namespace examples {

/// Writes what the scene begins with: computed on the host, the same on every device. Random numbers are of its seed alone.
void writeInitial(const Model& model, const Initial& initial, Lattice& lattice);

struct Outcome {
  std::int64_t steps = 0;
  double milliseconds = 0.0;  ///< of the steps, without pictures and numbers
  bool settled = false;
  double change = 0.0;  ///< the last that was measured
  std::int64_t checks = 0;  ///< how often it was
  int frames = 0;
  State beforeLast, last;  ///< the fields one step before the end, and at the end
};

/// What runScene() takes, and the account of costs if there is one.
BytesPerCell memoryFor(const Scene& scene, bool hasAccount);

/// Runs the scene. If the lattice is divided over ranks, the first one writes the files, and has the states. Throws std::runtime_error, naming step, field and cell, where a number is not finite; pictures that
/// were made before stay.
Outcome runScene(const Scene& scene, Lattice& lattice);

/// Throws where a field has a number that is not finite.
void requireFinite(Lattice& lattice, std::int64_t step);

/// Runs in a window until it is closed, drawn from the texture of a field's stream, which never visits host memory. Keys: space stops and goes on, s makes one step, f shows the next field, + and - take more or
/// fewer steps for a picture, r begins anew, q and Escape end. Throws std::runtime_error where there is no display, for
/// a device that has no OpenGL, and where a number is not finite.
void runLive(const Scene& scene, const std::string& deviceName);

}  // namespace examples
