// SPDX-License-Identifier: MIT
//
// Pixels as screens and films want them, and as files have them. It knows PNG and what else stb_image reads, and nothing of devices, but its
// pixels are what streams of int3 and float3 take and give.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <span>
#include <vector>

#include <sk/types.hpp>

namespace examples {

/// 8 bits each of red, green and blue, sRGB-encoded, row by row from the top.
struct Image {
  int width = 0;
  int height = 0;
  std::vector<std::uint8_t> rgb;  ///< width * height * 3

  std::uint8_t* pixel(int x, int y) {
    return rgb.data() + (std::size_t(y) * std::size_t(width) + std::size_t(x)) * 3;
  }
  const std::uint8_t* pixel(int x, int y) const {
    return rgb.data() + (std::size_t(y) * std::size_t(width) + std::size_t(x)) * 3;
  }
};

/// One colour everywhere; components are sRGB-encoded, in [0, 1].
Image plainImage(int width, int height, const sk::float3& colour);
/// An image of width * height sRGB-encoded pixels in [0, 1]; values outside are clamped, and NaN becomes black.
Image imageOf(int width, int height, std::span<const sk::float3> pixels);
/// Each pixel the mean of factor x factor ones, as light: the second half of supersampling. Sizes are multiples of the factor.
Image reduced(const Image& image, int factor);
/// Copies `part` into `image`, its upper left corner at (x, y); what is outside is dropped.
void paste(Image& image, const Image& part, int x, int y);
/// Mixes a colour into a pixel, `share` of it (in [0, 1]); a pixel outside is nothing.
void blend(Image& image, int x, int y, const sk::float3& colour, float share);

/// Throws std::runtime_error unless the name ends in .png.
void checkPngName(const std::filesystem::path& file);
/// Creates the file's folder. Throws std::runtime_error where the file cannot be written, or as checkPngName does.
void savePng(const std::filesystem::path& file, const Image& image);

/// What a file's pixels are: integer codes from 0 to `white`, gamma-encoded as sRGB, row by row from the
/// top (grey pictures have three equal components, what is transparent is seen on white).
struct Picture {
  int width = 0;
  int height = 0;
  int white = 255;  ///< 255 or 65535
  std::vector<sk::int3> pixels;  ///< width * height
};

/// Reads a picture. Throws std::runtime_error with the file's name where it is missing, no picture, or larger than 2^26 pixels.
Picture loadPicture(const std::filesystem::path& file);

/// Saves the picture that imageOf() makes of pixels, or a picture of codes.
void savePng(const std::filesystem::path& file, int width, int height, std::span<const sk::float3> pixels);
void savePng(const std::filesystem::path& file, const Picture& picture);

/// The curve of sRGB (IEC 61966-2-1), between values in [0, 1].
double linearFromSrgb(double encoded);
double srgbFromLinear(double linear);

}  // namespace examples
