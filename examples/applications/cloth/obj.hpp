// SPDX-License-Identifier: MIT
//
// A cloth as a Wavefront OBJ file: positions, normals, texture coordinates, and the triangles that are not torn. Numbers have as
// many digits as it takes to read the same floats again.
#pragma once

#include <filesystem>
#include <span>

#include <sk/types.hpp>

namespace examples {

/// Row by row, columns * rows of each; the w of a normal has the bits of the triangles right and below of its point that
/// are whole: 1 of (here, below, right), 2 of (right, below, diagonally below). Creates the file's folder. Throws std::runtime_error where it
/// cannot be written.
void saveObj(const std::filesystem::path& file, int columns, int rows, std::span<const sk::float4> positions,
             std::span<const sk::float4> normals);

}  // namespace examples
