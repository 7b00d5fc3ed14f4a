// SPDX-License-Identifier: MIT
//
// Compares pictures by different engines, machines and devices: they may differ by noise alone.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include <sk/sk.hpp>

#include "engine.hpp"
#include "scene.hpp"

namespace rays {

/// A way to make a picture: an engine with its settings.
struct Mode {
  std::string name;
  MakeEngine make;
};

/// Every engine, and of each every machine and every way through the scene. The first is the default.
std::vector<Mode> allModes();

/// The picture of a scene by one mode.
struct Result {
  std::vector<sk::float3> radiance;
  std::vector<sk::float3> variance;  ///< of the pixels' means
};
Result resultOf(sk::Device& device, const Scene& scene, const Mode& mode);

/// How far a picture is from another of the same random numbers. Programs round differently, so that here and there a path takes another turn;
/// a mistake moves the mean.
struct Likeness {
  double mean =
      0.0;  ///< difference of the means, in the standard errors of the mean difference of two pixels
  double pixel = 0.0;  ///< the largest difference of two pixels, in the standard errors of their difference
  double differing = 0.0;  ///< the part of pixels that differ by more than a thousandth
};
Likeness likenessOf(const Result& a, const Result& b);

/// The scenes of a folder, in alphabetical order.
std::vector<std::filesystem::path> sceneFiles(const std::filesystem::path& folder);

}  // namespace rays
