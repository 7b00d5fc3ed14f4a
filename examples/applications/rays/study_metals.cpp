// SPDX-License-Identifier: MIT
//
// Rough metals that absorb nothing in a white furnace: the light that their facets reflect once, and the light that pictures have.
#include "study.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include <fmt/format.h>

#include "known_pictures.hpp"
#include "microfacets.hpp"
#include "scene_shapes.hpp"
#include "support/table.hpp"

namespace rays {
namespace {

constexpr std::array degrees = {0, 45, 75, 85};

/// A floor of white metal under a white sky, seen under this angle.
KnownPicture furnaceOf(double roughness, double angle) {
  KnownPicture picture{.name = "metal in a furnace", .radiance = 1.0};
  Model& model = picture.model;
  model.materials = {{.name = "metal",
                      .scattering = Scattering::Metal,
                      .colour = {1, 1, 1},
                      .roughness = static_cast<float>(roughness)}};
  model.planes.push_back({{0, 1, 0}, 0.0f, 0});
  model.environment.colour = {1, 1, 1};
  model.camera = {.from = {std::sin(angle), std::cos(angle), 0},
                  .to = {0, 0, 0},
                  .up = {0.1, 0.1, 1},
                  .fieldOfView = 0.0005,
                  .focus = 1};
  chooseUnit(model);
  return picture;
}

}  // namespace

Findings studyMetals(sk::Device& device, bool isSmall) {
  const Effort effort = isSmall ? Effort{.side = 32, .samples = 32} : Effort{};
  std::vector<std::string> header = {"roughness"};
  for (const int angle : degrees) {
    header.push_back(fmt::format("{} degrees: once", angle));
    header.emplace_back("all");
  }
  examples::Table table(header);
  examples::Verification white("distance of a white metal from 1 in a furnace, beyond four standard errors",
                               0.0025, "the fit of the kernels is as good as this");
  std::int64_t place = 0;
  for (const double roughness : {0.001, 0.1, 0.2, 0.3, 0.5, 0.7, 0.85, 1.0}) {
    std::vector<std::string> cells = {fmt::format("{}", roughness)};
    for (const int degree : degrees) {
      const double angle = degree * std::numbers::pi / 180;
      const Estimate e =
          estimate(device, furnaceOf(roughness, angle), effort, Strategy::Both, Sampling::Random);
      white.note(place++, std::max(std::abs(e.mean - 1) - 4 * e.error, 0.0));
      cells.push_back(fmt::format("{:.3f}", reflectedOnce(std::cos(angle), roughness)));
      cells.push_back(fmt::format("{:.3f}", e.mean));
    }
    table.add(cells);
  }
  return {table.markdown(), {white}};
}

}  // namespace rays
