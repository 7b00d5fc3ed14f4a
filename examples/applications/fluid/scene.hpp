// SPDX-License-Identifier: MIT
//
// Scenes of flows: TOML files, read to a model, a start and what to make of them.
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>

#include "model.hpp"
#include "support/field_view.hpp"
#include "support/record.hpp"

namespace fluid {

struct Initial {
  Triple velocity{};
  double noise = 0.0;  ///< largest random part of each component
  std::uint32_t random = 1;
  std::vector<double> smoke, heat;  ///< from files, x fastest, without the layer; empty: none
};

enum class Shown { Smoke, Temperature, Vorticity, Speed };

struct View : examples::FieldView {
  View() { colours = "lagoon"; }
  Shown shown = Shown::Speed;
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

/// What a command line says in place of the file. Of another size the spacing follows, so that the width stays.
struct Overrides : examples::SceneOverrides {
  std::optional<Scheme> scheme;
  std::optional<Projector> projector;
};

/// As scenes write them.
inline constexpr std::array<std::string_view, 4> schemeNames = {"semi-lagrangian", "maccormack", "bfecc",
                                                                "central"};
inline constexpr std::array<std::string_view, 2> projectorNames = {"chebyshev", "multigrid"};

/// Throws std::runtime_error, "FILE:LINE:COLUMN: what is wrong and the way out".
Scene readScene(const std::filesystem::path& file, const Overrides& overrides);

}  // namespace fluid
