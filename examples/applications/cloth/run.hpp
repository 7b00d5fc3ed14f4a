// SPDX-License-Identifier: MIT
//
// A run from the first step to the last: it looks for broken numbers and for rest, and calls somebody at each frame. A
// frame is only shown of a cloth whose numbers are all sound. Or in a window (live.cpp).
#pragma once

#include <cstdint>
#include <functional>
#include <string>

#include <sk/options.hpp>

#include "scene.hpp"
#include "simulation.hpp"

namespace examples {

/// What a run has come to.
struct Outcome {
  std::int64_t steps = 0;
  bool settled = false;  ///< and so ended before its time
  double fastest = 0.0;  ///< m/s, at the last look
};

/// Runs scene.run.steps steps, or until the cloth has settled. `onFrame` is called with the number of each of the
/// scene's frames, from 0 (the first state, which is shown even to a scene that wants 1) on. Throws std::runtime_error, naming the step and the point, where a number breaks; the
/// frames before stand.
Outcome run(Simulation& simulation, const Scene& scene, const std::function<void(int frame)>& onFrame);

/// Runs in a window as long as somebody looks at it, at the pace of the clock where the device is fast enough. `device` is native or reference, or the window's own OpenGL
/// is taken. Throws std::runtime_error where there is no display, or where a number breaks.
void runLive(const Scene& scene, sk::Precision precision, const std::string& device, PictureSize size);

}  // namespace examples
