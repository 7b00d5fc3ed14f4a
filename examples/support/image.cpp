// SPDX-License-Identifier: MIT
#include "support/image.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <stdexcept>

#include <fmt/format.h>
#include <stb/stb_image_write.h>

#include "support/picture.hpp"

namespace examples {
namespace {

std::uint8_t byteOf(float component) {
  const float inside = component > 0.0f ? std::min(component, 1.0f) : 0.0f;
  return static_cast<std::uint8_t>(std::lround(inside * 255.0f));
}

Image emptyImage(int width, int height) {
  return {width, height, std::vector<std::uint8_t>(std::size_t(width) * std::size_t(height) * 3)};
}

/// The light of every code.
const std::array<float, 256>& lightOfCodes() {
  static const std::array<float, 256> table = [] {
    std::array<float, 256> light{};
    for (std::size_t code = 0; code < light.size(); ++code) {
      light[code] = static_cast<float>(linearFromSrgb(static_cast<double>(code) / 255.0));
    }
    return light;
  }();
  return table;
}

}  // namespace

Image plainImage(int width, int height, const sk::float3& colour) {
  Image image = emptyImage(width, height);
  const std::array<std::uint8_t, 3> bytes{byteOf(colour.x), byteOf(colour.y), byteOf(colour.z)};
  for (std::size_t i = 0; i < image.rgb.size(); ++i) image.rgb[i] = bytes[i % 3];
  return image;
}

Image imageOf(int width, int height, std::span<const sk::float3> pixels) {
  Image image = emptyImage(width, height);
  if (pixels.size() * 3 != image.rgb.size()) {
    throw std::runtime_error(fmt::format("{} pixels are no image of {} x {}", pixels.size(), width, height));
  }
  std::uint8_t* to = image.rgb.data();
  for (const sk::float3& pixel : pixels) {
    *to++ = byteOf(pixel.x);
    *to++ = byteOf(pixel.y);
    *to++ = byteOf(pixel.z);
  }
  return image;
}

Image reduced(const Image& image, int factor) {
  const std::array<float, 256>& light = lightOfCodes();
  Image small = emptyImage(image.width / factor, image.height / factor);
  const float share = 1.0f / static_cast<float>(factor * factor);
  for (int y = 0; y < small.height; ++y) {
    for (int x = 0; x < small.width; ++x) {
      std::array<float, 3> sum{};
      for (int j = 0; j < factor; ++j) {
        const std::uint8_t* from = image.pixel(x * factor, y * factor + j);
        for (int i = 0; i < factor * 3; ++i) sum[static_cast<std::size_t>(i % 3)] += light[from[i]];
      }
      for (std::size_t c = 0; c < 3; ++c) {
        small.pixel(x, y)[c] =
            byteOf(static_cast<float>(srgbFromLinear(static_cast<double>(sum[c] * share))));
      }
    }
  }
  return small;
}

void paste(Image& image, const Image& part, int x, int y) {
  const int left = std::max(x, 0), right = std::min(x + part.width, image.width);
  for (int row = std::max(y, 0); row < std::min(y + part.height, image.height) && left < right; ++row) {
    std::copy_n(part.pixel(left - x, row - y), (right - left) * 3, image.pixel(left, row));
  }
}

void blend(Image& image, int x, int y, const sk::float3& colour, float share) {
  if (x < 0 || y < 0 || x >= image.width || y >= image.height) return;
  std::uint8_t* pixel = image.pixel(x, y);
  const std::array<float, 3> mixed{colour.x, colour.y, colour.z};
  for (std::size_t c = 0; c < 3; ++c) {
    pixel[c] = byteOf(static_cast<float>(pixel[c]) / 255.0f * (1.0f - share) + mixed[c] * share);
  }
}

void checkPngName(const std::filesystem::path& file) {
  if (file.extension() == ".png" || file.extension() == ".PNG") return;
  throw std::runtime_error(fmt::format("'{}' is no picture; its name must end in .png", file.string()));
}

void savePng(const std::filesystem::path& file, const Image& image) {
  checkPngName(file);
  std::error_code ignored;
  if (file.has_parent_path()) std::filesystem::create_directories(file.parent_path(), ignored);
  if (stbi_write_png(file.c_str(), image.width, image.height, 3, image.rgb.data(), image.width * 3) == 0) {
    throw std::runtime_error(
        fmt::format("cannot write '{}'; name a file in a folder that can be written", file.string()));
  }
}

}  // namespace examples
