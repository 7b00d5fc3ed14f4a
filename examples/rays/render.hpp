// SPDX-License-Identifier: MIT
//
// From passes to a file: as many as there are samples or seconds, then tone mapping.
#pragma once

#include <cstdint>
#include <vector>

#include <sk/types.hpp>

#include "engine.hpp"
#include "scene.hpp"

namespace rays {

struct Rendering {
  std::vector<sk::float3> radiance;
  std::int64_t samples = 0;
  double milliseconds = 0.0;
};

/// Shows progress. Pictures without pixels need no pass.
Rendering render(Renderer& renderer, const Scene& scene);

/// A component of radiance as sRGB in [0, 1]. Filmic: the curve that K. Narkowicz fitted to ACES (2015).
float toneMapped(float radiance, const Output& output);

/// PNG or PFM, by the name's ending. Throws std::runtime_error where it is another one, where the picture has no pixels and where the
/// file cannot be written.
void saveRendering(const Rendering& rendering, const Scene& scene);

/// Throws what `saveRendering` would throw for the ending or the size, before anything is rendered.
void checkOutput(const Scene& scene);

}  // namespace rays
