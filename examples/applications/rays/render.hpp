// SPDX-License-Identifier: MIT
//
// Renders passes until the samples, the seconds or the error are reached, then maps tones and writes a file.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include <sk/types.hpp>

#include "engine.hpp"
#include "layers.hpp"
#include "scene.hpp"

namespace rays {

struct Rendering {
  std::vector<sk::float3> radiance;
  std::int64_t samples = 0;  ///< of a pixel that has not stopped
  std::int64_t resumed = 0;  ///< of those, how many were on file
  double perPixel = 0.0;  ///< samples, on average
  std::int64_t unfinished = 0;  ///< pixels that may be farther off than the error which was asked for
  double milliseconds = 0.0;  ///< of this run
};

/// Where a picture goes on from, and what is kept up to date while it is made.
struct Resuming {
  std::filesystem::path state{};
  std::string device{};  ///< its name
};

/// Shows progress. Pictures without pixels need no pass. With `scene.output.error`, pixels are asked at `isLook`. Throws what state_file.hpp throws.
Rendering render(Renderer& renderer, const Scene& scene, const Resuming& resuming = {});

/// Returns true if pixels may stop after `samples` samples: at `least`, 2^k and 3 * 2^k. Each look is one more chance to stop by accident, so
/// there are few.
bool isLook(std::int64_t samples, std::int64_t least);

/// A component of radiance as sRGB in [0, 1]. Filmic: the curve that K. Narkowicz fitted to ACES (2015).
float toneMapped(float radiance, const Output& output);

/// PNG, PFM or OpenEXR, by the name's ending, the last with `layers`. Throws std::runtime_error where it is another one, where the picture has no pixels and where the
/// file cannot be written.
void saveRendering(const Rendering& rendering, const Scene& scene, const std::vector<Layer>& layers = {});

/// Throws what `saveRendering` would throw for the ending or the size, before anything is rendered.
void checkOutput(const Scene& scene);

/// Shows the scene in a window, where it becomes better as long as nobody moves, until the window is closed (live.cpp). The mouse turns the camera about the point that it looks at, the wheel goes nearer and farther; space stops and goes
/// on, r begins anew, + and - change the exposure, q and Escape end. `device` is native or reference, or the window's own OpenGL is taken. Throws
/// std::runtime_error where there is no display.
void runLive(Scene& scene, const std::string& device);

}  // namespace rays
