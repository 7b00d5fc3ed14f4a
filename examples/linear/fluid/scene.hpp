// SPDX-License-Identifier: MIT
//
// Scenes of flows: TOML files, read to a model, a start and what to make of them.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "model.hpp"
#include "support/record.hpp"

namespace fluid {

struct Initial {
  Triple velocity{};
  double noise = 0.0;  ///< largest random part of each component
  std::uint32_t random = 1;
};

enum class Shown { Smoke, Temperature, Vorticity, Speed };

struct View {
  Shown shown = Shown::Speed;
  std::string colours = "lagoon";
  std::optional<double> low, high;
  int zoom = 0;  ///< pixels a cell; 0: chosen for about a thousand across
  double turn = 0.55, tilt = 0.3;  ///< of the camera in space, in radians
  double thickness = 1.0;  ///< in space, how opaque smoke of density 1 is in a tenth of the grid's height
  bool glows = false;  ///< what is hot, in space
};

struct Scene {
  std::string name, title;
  Model model;
  Initial initial;
  std::int64_t steps = 100;
  examples::Record record;
  View view;
};

/// What a command line says in place of the file.
struct Overrides {
  std::vector<std::int64_t> size;  ///< cells; the spacing follows, so that the width stays
  std::optional<std::int64_t> steps;
  std::optional<Scheme> scheme;
  std::optional<Projector> projector;
  std::optional<sk::Precision> precision;
};

/// As scenes write them.
std::span<const std::string_view> schemeNames();
std::span<const std::string_view> projectorNames();

/// Throws std::runtime_error, "FILE:LINE:COLUMN: what is wrong and the way out".
Scene readScene(const std::filesystem::path& file, const Overrides& overrides);

}  // namespace fluid
