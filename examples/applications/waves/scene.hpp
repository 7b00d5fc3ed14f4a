// SPDX-License-Identifier: MIT
//
// Scenes of water: TOML files, read to a model, the drops that fall into it, and what to make of them.
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "support/record.hpp"
#include "surface.hpp"

namespace waves {

/// Presses a dent with a rim of the same volume into the surface: -depth (1 - s) exp(-s), s = (distance / radius)^2.
struct Drop {
  double x = 0.0, y = 0.0, radius = 0.0, depth = 0.0;
  double time = 0.0;  ///< it falls before the first step that begins then or later
};

struct View {
  int width = 960, height = 600;  ///< pixels
  double turn = 0.5, tilt = 0.6;  ///< of the camera, in radians
  double distance = 1.0;  ///< of the camera, where 1 shows the pool and its edge
  double depth = 0.25;  ///< of the pool, as a part of its width
  double tiles = 16.0;  ///< along the pool's width
  double exaggeration = 1.0;  ///< of heights
};

struct Scene {
  std::string name, title;
  Model model;
  std::vector<Drop> drops;  ///< by their times
  std::vector<double> heights;  ///< at the start, row-major, from a file; empty: flat
  std::int64_t steps = 200;
  examples::Record record;
  View view;
};

/// What a command line says in place of the file. Of another size, the width of the pool and the time step stay.
struct Overrides : examples::SceneOverrides {
  std::optional<Scheme> scheme;
};

/// As scenes write them.
inline constexpr std::array<std::string_view, 2> schemeNames = {"crank-nicolson", "backward-euler"};

/// Throws std::runtime_error, "FILE:LINE:COLUMN: what is wrong and the way out".
Scene readScene(const std::filesystem::path& file, const Overrides& overrides);

/// Adds a drop to heights, row-major.
void add(const Drop& drop, const Model& model, std::vector<double>& heights);

}  // namespace waves
