// SPDX-License-Identifier: MIT
//
// What of a scene file makes things to see: meshes, instances, spheres, flakes, planes.
#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "model.hpp"
#include "support/scene_file.hpp"

namespace rays {

/// What reading a scene carries along.
struct Reading {
  std::filesystem::path folder;  ///< that files are relative to
  bool strict = false;
  int mostLevel = 1000;  ///< detail of shapes that have levels
  std::map<std::string, std::int32_t, std::less<>> materials{};  ///< by name
  std::vector<std::string> warnings{};
};

inline constexpr examples::Range positiveLength{1e-30, 1e30};

sk::float3 colourOf(const examples::SceneTable& table, std::string_view key, sk::float3 otherwise);

/// Triangles, spheres and planes with lengths as in the file. `unit` scales them, after all is read.
void readShapes(const examples::SceneTable& root, Reading& reading, Model& model);

/// The number of the material that `key` names; the first one where it is left out.
std::int32_t materialNumber(const examples::SceneTable& table, std::string_view key, const Reading& reading);

/// Brings the model's extent near 1, by a power of two.
void chooseUnit(Model& model);

}  // namespace rays
