// SPDX-License-Identifier: MIT
//
// Pictures in and out of files. Knows PNG and what else stb_image reads; knows nothing of devices, but
// its pixels are what streams of int3 and float3 take and give.
#pragma once

#include <cstdint>
#include <filesystem>
#include <span>
#include <vector>

#include <sk/types.hpp>

namespace examples {

/// What a file's pixels are: integer codes from 0 to `white`, gamma-encoded as sRGB, row by row from the
/// top (grey pictures have three equal components, what is transparent is seen on white).
struct Picture {
  int width = 0;
  int height = 0;
  int white = 255;               ///< 255 or 65535
  std::vector<sk::int3> pixels;  ///< width * height
};

/// Reads a picture. Throws std::runtime_error with the file's name where it is missing, no picture, or larger than 2^26 pixels.
Picture loadPicture(const std::filesystem::path& file);

/// Writes 8-bit sRGB from components in [0, 1] that are already sRGB-encoded (values outside are clamped,
/// NaN is black). Creates the file's folder. Throws std::runtime_error where the file cannot be written.
void savePng(const std::filesystem::path& file, int width, int height, std::span<const sk::float3> pixels);
void savePng(const std::filesystem::path& file, const Picture& picture);

/// The curve of sRGB (IEC 61966-2-1), between values in [0, 1].
double linearFromSrgb(double encoded);
double srgbFromLinear(double linear);

}  // namespace examples
