// SPDX-License-Identifier: MIT
//
// Fields of grids and surfaces in files that other programs read: VTK's XML formats for ParaView and VisIt, NumPy's .npy, and plain numbers; and
// numbers for grids from .npy files and pictures.
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "support/scene_file.hpp"
#include "support/vec.hpp"

namespace examples {

/// One number, or three components of a vector, for each cell or point.
struct FileField {
  std::string name;
  int components = 1;  ///< 1 or 3
  std::vector<double> values;  ///< components of a cell or point side by side
};

/// Fields in the middle of the cells of a box. x is the fastest dimension; row 0 is the lowest. A depth of 1 is a plane.
struct GridFile {
  std::array<std::int64_t, 3> cells = {1, 1, 1};  ///< width, height, depth
  double spacing = 1.0;
  std::vector<FileField> fields;
};

/// Triangles with fields on their corners.
struct SurfaceFile {
  std::vector<Vector> points;
  std::vector<std::array<std::int32_t, 3>> triangles;
  std::vector<FileField> fields;
};

/// Throws std::runtime_error unless the ending is one that saveGrid() knows.
void checkGridName(const std::filesystem::path& file);

/// Writes numbers as floats, and the file's folder if there is none. FILE.vti has all fields. For FILE.npy and FILE.raw, each field has a file of its own: field u is
/// in FILE_u.npy. Arrays have the shape {depth, height, width, components}, without the depth of a plane and the components of a number; raw files have
/// little-endian floats in that order, and nothing else. Returns the files. Throws std::runtime_error.
std::vector<std::filesystem::path> saveGrid(const std::filesystem::path& file, const GridFile& grid);

/// Writes FILE.vtp, numbers as floats. Throws std::runtime_error.
void saveSurface(const std::filesystem::path& file, const SurfaceFile& surface);

/// Numbers for the cells of a grid, in its order, from a .npy file of the shape {height, width} or {depth, height, width}, or from a picture whose
/// lightness is read as 0 (black) to 1 (white), its last row for row 0. Throws std::runtime_error, naming the file, where it has
/// another size, and for numbers that are not finite.
std::vector<double> loadGrid(const std::filesystem::path& file, const std::array<std::int64_t, 3>& cells);

/// The same for a key of a scene that names a file, relative to the folder; no numbers if the table has no such key. With KEY_range = [low, high],
/// 0 in the file becomes `low` and 1 becomes `high`. Throws std::runtime_error, "FILE:LINE:COLUMN: what is wrong".
std::vector<double> readField(const SceneTable& table, const std::string& key,
                              const std::filesystem::path& folder, const std::array<std::int64_t, 3>& cells);

}  // namespace examples
