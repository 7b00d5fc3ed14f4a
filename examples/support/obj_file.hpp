// SPDX-License-Identifier: MIT
//
// Wavefront OBJ files ("Advanced Visualizer Manual", appendix B): what they say of triangles. Lines, curves and free-form surfaces are
// passed over, and so are groups.
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include <sk/types.hpp>

#include "support/text_cursor.hpp"
#include "support/vec.hpp"

namespace examples {

/// Comments and lines that go on, in OBJ files and in the MTL files of their materials.
constexpr TextRules objRules{.comment = '#', .continues = true};

/// Indices into the lists of ObjFile; -1 where the corner has none.
struct ObjCorner {
  std::int32_t point = -1, texture = -1, normal = -1;
};

struct ObjTriangle {
  std::array<ObjCorner, 3> corners{};
  std::int32_t material = -1;  ///< index into ObjFile::materials; -1: none
};

struct ObjFile {
  std::vector<Vector> points;
  std::vector<sk::float2> textures;
  std::vector<sk::float3> normals;
  std::vector<ObjTriangle> triangles;  ///< polygons are cut, see triangulate()
  std::vector<std::string> materials;  ///< names, in the order of their first use
  std::vector<std::filesystem::path> materialFiles;  ///< which are there
};

struct ObjOptions {
  bool onlyFinite = false;  ///< refuse positions that are not finite
  std::filesystem::path materialsFolder{};  ///< where files of materials are; empty: they are not looked for
};

/// Throws std::runtime_error, "FILE:LINE:COLUMN: what is wrong"; `name` stands for the file.
ObjFile parseObj(const std::string& name, std::string_view text, const ObjOptions& options = {});

}  // namespace examples
