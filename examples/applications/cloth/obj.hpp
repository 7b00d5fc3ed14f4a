// SPDX-License-Identifier: MIT
//
// A cloth as a file: positions, normals, texture coordinates in a Wavefront OBJ file, and the triangles that are not torn. Numbers of OBJ files have as
// many digits as it takes to read the same floats again. A name that ends in .vtp gets a file for VTK, without texture coordinates.
#pragma once

#include <filesystem>
#include <span>

#include <sk/types.hpp>

namespace examples {

/// Row by row, columns * rows of each; the w of a normal has the bits of the triangles right and below of its point that
/// are whole: 1 of (here, below, right), 2 of (right, below, diagonally below). Creates the file's folder. Throws std::runtime_error where it
/// cannot be written.
void saveMesh(const std::filesystem::path& file, int columns, int rows, std::span<const sk::float4> positions,
              std::span<const sk::float4> normals);

}  // namespace examples
