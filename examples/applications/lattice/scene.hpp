// SPDX-License-Identifier: MIT
//
// A scene file: the model that it makes, how it begins, how long it runs, what is recorded and what is looked at. It
// refuses what it does not know, and steps of time that would not be stable.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "model.hpp"
#include "support/field_view.hpp"
#include "support/record.hpp"

namespace examples {

/// How the temperature begins.
enum class Profile : std::uint8_t { Uniform, Conduction };

struct Initial {
  Profile profile = Profile::Uniform;
  double temperature = 0.0;  ///< of the uniform profile
  double noise = 0.0;  ///< evenly spread in +- this much, in each cell
  double rolls = 0.0;  ///< pairs of rolls across the width, as a wave of the amplitude `noise` in place of it
  int blobs = 0;  ///< warm discs or balls, of `blobRadius` cells and up to twice that
  double blobRadius = 6.0, blobTemperature = 0.0;
  int seeds = 1;  ///< squares of (u, v) for a reaction; 1 stands in the middle
  int seedSide = 20;
  double u = 0.5, v = 0.25;  ///< in the squares
  std::uint32_t random = 1;
  /// From files, in place of what the other numbers say; empty: none.
  std::vector<double> temperatureField, uField, vField;
};

/// The run ends early when no field changes by more than `tolerance` in a step, asked every `every` steps.
struct Settling {
  double tolerance = 1e-6;
  std::int64_t every = 32;
};

/// What a picture shows: a field, or what is made of some.
enum class Shown : std::uint8_t { Temperature, U, V, Speed, Vorticity, Pressure, Bubbles };

struct View : FieldView {
  View() { colours = "ember"; }
  Shown shown = Shown::Temperature;
  double relief = 0.0;
  bool mirror = false;  ///< the colours from the high end to the low one
};

struct Scene {
  std::string name;  ///< of the file, without its ending
  std::string title;
  Model model;
  Initial initial;
  std::int64_t steps = 1000;
  std::optional<Settling> settling;
  Record record;
  std::int64_t csvInterval = 0;  ///< steps between two rows of numbers; 0: a hundredth of the run
  View view;
};

/// What the command line says in place of the file.
struct Overrides : SceneOverrides {
  std::optional<double> settle;
};

/// Throws std::runtime_error, "FILE:LINE:COLUMN: what is wrong and the way out".
Scene readScene(const std::filesystem::path& file, const Overrides& overrides);

/// As scenes write it: "temperature", "u" ...
std::string_view nameOf(Shown shown);

/// Whether a model's operators make it.
bool has(const Model& model, Shown shown);

}  // namespace examples
