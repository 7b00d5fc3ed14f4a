// SPDX-License-Identifier: MIT
//
// Pictures all of whose pixels see one point, with the radiance that the point is known to have. Each pixel is then an independent estimate of one
// number.
#pragma once

#include <string>
#include <vector>

#include <sk/sk.hpp>

#include "engine.hpp"
#include "model.hpp"
#include "scene.hpp"

namespace rays {

struct KnownPicture {
  std::string name;
  /// Holds camera, materials, shapes and lights; its lengths are in the units of the scene file.
  Model model{};
  double radiance = 0.0;  ///< NaN: not known, so that ways to compute it can only agree
  int depth = 2;  ///< segments of paths
  /// The difference that the last segment makes, in place of the whole radiance.
  bool lastSegmentAlone = false;
};

/// Light of polygons, spheres, suns and skies on a floor, rough materials under them, an integrating sphere, and each segment in a furnace.
std::vector<KnownPicture> knownPictures();

struct Estimate {
  double mean = 0.0;
  double error = 0.0;  ///< standard error of the mean, of independent pixels
};

struct Effort {
  int side = 64;  ///< pixels a side
  int samples = 256;  ///< for each pixel
};

/// The green of all pixels by the default engine.
Estimate estimate(sk::Device& device, const KnownPicture& picture, const Effort& effort, Strategy strategy,
                  Sampling sampling);

/// Root mean squares of the pixels' errors after each number of samples; the numbers must rise.
std::vector<double> rootMeanSquares(sk::Device& device, const KnownPicture& picture, int side,
                                    const std::vector<int>& samples, Strategy strategy, Sampling sampling);

/// How many standard errors the difference is; a part of 2^-20 is what floats round.
double deviation(const Estimate& e, double known);

}  // namespace rays
