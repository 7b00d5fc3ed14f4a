// SPDX-License-Identifier: MIT
//
// A mesh as files and generators give it, before it is placed in a scene.
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "model.hpp"

namespace rays {

struct Face {
  std::array<std::uint32_t, 3> points{};
  std::int32_t material = -1;  ///< index into Mesh::materials; -1: the one that the scene names
};

struct Mesh {
  std::vector<Vector> points;    ///< may hold NaN and infinities, which whoever places the mesh deals with
  std::vector<Face> faces;       ///< indices are below the number of points
  std::vector<Corners> corners;  ///< one for each face, or none at all
  std::vector<Material> materials;
  std::vector<std::filesystem::path> textures;  ///< that Material::texture counts
};

/// OBJ or PLY, by the name's ending. Throws std::runtime_error, "FILE:LINE:COLUMN: what is wrong" where the file is text, and
/// "FILE: what is wrong" where it is not, cannot be read or has another ending.
/// Without `wantsMaterials` the materials of an OBJ file are not looked at.
Mesh loadMesh(const std::filesystem::path& file, bool wantsMaterials);

Mesh parseObj(const std::string& name, const std::string& text, const std::filesystem::path& folder,
              bool wantsMaterials);
Mesh parsePly(const std::string& name, std::string_view bytes);

}  // namespace rays
