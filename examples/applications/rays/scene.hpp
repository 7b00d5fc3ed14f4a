// SPDX-License-Identifier: MIT
//
// A scene file: the model that it makes, the picture, the engine that it asks for and every engine's settings.
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "engine.hpp"
#include "model.hpp"

namespace rays {

enum class ToneMap : std::uint8_t { Linear, Filmic };

struct Output {
  std::filesystem::path picture;  ///< .png, .pfm or .exr
  ToneMap tone = ToneMap::Linear;
  double exposure = 1.0;
  std::int64_t samples = 64;
  double seconds = 0.0;  ///< ends the samples early; 0: it does not
  double error = 0.0;  ///< stops pixels that are good enough (exposure.hpp); 0: all get all samples
  int least = 32;  ///< samples before a pixel may stop
};

struct Scene {
  std::filesystem::path file;
  std::string name;  ///< of the file, without its ending
  std::string title;
  Model model;
  Picture picture;
  Output output;
  std::string engine;
  std::map<std::string, MakeEngine, std::less<>> engines;  ///< with the scene's settings, by name
  std::vector<std::string> warnings;
};

/// What the command line says in place of the file.
struct Overrides {
  std::optional<int> width{}, height{};
  std::optional<std::int64_t> samples{};
  std::optional<double> seconds{};
  std::string engine{};
  bool strict = false;  ///< vertices that are not finite are an error
  std::optional<double> error{};
  int mostLevel = 1000;  ///< the detail of computed shapes is lowered to this level
};

/// Throws std::runtime_error, "FILE:LINE:COLUMN: what is wrong and the way out".
Scene readScene(const std::filesystem::path& file, const Overrides& overrides);

}  // namespace rays
