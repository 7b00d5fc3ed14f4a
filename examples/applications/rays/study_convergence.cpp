// SPDX-License-Identifier: MIT
//
// How fast errors fall with samples: independent numbers and Sobol's, for light that varies smoothly over them and for light that does not.
#include "study.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include <fmt/format.h>

#include "known_pictures.hpp"
#include "support/table.hpp"

namespace rays {
namespace {

struct Case {
  std::string_view picture;
  Strategy strategy;
  std::string_view does;  ///< to the numbers
  bool isSmooth;
};

constexpr std::array cases = {
    Case{"a sphere of light", Strategy::Lights, "a smooth function of two numbers", true},
    Case{"a square of light above", Strategy::Lights, "smooth on each of two triangles", true},
    Case{"a sphere of light", Strategy::Surfaces, "an edge: the light is met or not", false},
    Case{"all of these", Strategy::Both, "kinks and edges of eight numbers", false},
    Case{"a furnace, segment 2", Strategy::Both, "edges of boxes", false},
};

/// The slope of a line through logarithms, least squares.
double slopeOf(const std::vector<int>& samples, const std::vector<double>& errors) {
  const auto n = static_cast<double>(samples.size());
  double mx = 0, my = 0, xx = 0, xy = 0;
  for (std::size_t i = 0; i < samples.size(); ++i) {
    mx += std::log(samples[i]) / n;
    my += std::log(errors[i]) / n;
  }
  for (std::size_t i = 0; i < samples.size(); ++i) {
    const double x = std::log(samples[i]) - mx;
    xx += x * x;
    xy += x * (std::log(errors[i]) - my);
  }
  return xy / xx;
}

}  // namespace

Findings studyConvergence(sk::Device& device, bool isSmall) {
  const std::vector<int> samples =
      isSmall ? std::vector{4, 8, 16, 32, 64} : std::vector{4, 8, 16, 32, 64, 128, 256, 512, 1024};
  const int side = isSmall ? 32 : 64;
  examples::Table table(
      {"picture", "strategy", "samples are", "independent: slope", "error", "Sobol's: slope", "error"});
  // The logarithm of a root mean square of n pixels is off by 1 / sqrt(2 n), of samples that build on each other.
  examples::Verification independent("slopes of independent samples, less -0.5", isSmall ? 0.05 : 0.02,
                                     "four standard errors of slopes from as many pixels");
  examples::Verification sobol("slopes of Sobol's samples on smooth functions, plus 1", 0.25,
                               "half an order, which independent samples have, would be 0.5");
  const std::vector<KnownPicture> pictures = knownPictures();
  std::int64_t place = 0;
  for (const Case& c : cases) {
    KnownPicture picture = *std::ranges::find(pictures, c.picture, &KnownPicture::name);
    if (picture.lastSegmentAlone) picture.radiance += 1;  // both segments at once
    std::vector<std::string> cells = {picture.name,
                                      c.strategy == Strategy::Both     ? "both"
                                      : c.strategy == Strategy::Lights ? "lights"
                                                                       : "surfaces",
                                      std::string(c.does)};
    for (const Sampling sampling : {Sampling::Random, Sampling::Sobol}) {
      const std::vector<double> errors =
          rootMeanSquares(device, picture, side, samples, c.strategy, sampling);
      const double slope = slopeOf(samples, errors);
      if (sampling == Sampling::Random) independent.note(place, std::abs(slope + 0.5));
      if (sampling == Sampling::Sobol && c.isSmooth) sobol.note(place, slope + 1);
      cells.push_back(fmt::format("{:.2f}", slope));
      cells.push_back(fmt::format("{:.1e}", errors.back() / picture.radiance));
    }
    table.add(cells);
    ++place;
  }
  return {table.markdown(), {independent, sobol}};
}

}  // namespace rays
