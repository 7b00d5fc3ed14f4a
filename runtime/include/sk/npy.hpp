// SPDX-License-Identifier: MIT
//
// Arrays of numbers in .npy files, which NumPy reads and writes (NumPy Enhancement Proposal 1). They are host arrays: Stream::writeReals()
// and readReals() exchange the same doubles with a device.
#pragma once

#include <cstdint>
#include <filesystem>
#include <span>
#include <vector>

namespace sk {

/// Numbers in row-major order. No extents: a single number.
struct NumberArray {
  std::vector<std::int64_t> extents;
  std::vector<double> values;  ///< as many as the product of the extents
};

/// The type of the numbers in a file.
enum class NumberType : std::uint8_t { Float32, Float64 };

/// Reads a .npy file of booleans, integers, or floats of 16, 32 or 64 bits, of either byte order. Integers beyond 2^53 are rounded. Throws
/// sk::Error (File) if the file is missing, damaged, in Fortran's order, or holds something else than numbers, and sk::Error (Memory) if
/// its numbers do not fit in memory.
NumberArray readNpy(const std::filesystem::path& file);

/// Writes a .npy file, under another name at first, so that a file under its own name is always whole. Doubles are rounded to floats for
/// Float32. Throws sk::Error (Shape) unless `values` has as many numbers as the extents say, and sk::Error (File) if the file cannot
/// be written.
void writeNpy(const std::filesystem::path& file, std::span<const std::int64_t> extents,
              std::span<const double> values, NumberType type = NumberType::Float32);

}  // namespace sk
