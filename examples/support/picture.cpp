// SPDX-License-Identifier: MIT
#include "support/picture.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <memory>
#include <stdexcept>
#include <string>

#include <fmt/format.h>
#include <stb/stb_image.h>

#include "support/image.hpp"

namespace examples {
namespace {

/// Codes of red, green, blue and opacity as stb_image gives them, and their range.
template <class Code>
Picture onWhite(Code* codes, int width, int height, int white, const std::string& name) {
  const std::unique_ptr<Code, void (*)(void*)> owner(codes, stbi_image_free);
  if (codes == nullptr) {
    throw std::runtime_error(
        fmt::format("'{}' is no picture that can be read: {}", name, stbi_failure_reason()));
  }
  Picture picture{width, height, white, {}};
  picture.pixels.reserve(static_cast<std::size_t>(width) * static_cast<std::size_t>(height));
  const Code* end =
      codes + std::size_t{4} * static_cast<std::size_t>(width) * static_cast<std::size_t>(height);
  for (const Code* code = codes; code != end; code += 4) {
    const std::int64_t opacity = code[3];
    const auto seen = [&](Code c) {
      return static_cast<std::int32_t>((c * opacity + white * (white - opacity) + white / 2) / white);
    };
    picture.pixels.push_back({seen(code[0]), seen(code[1]), seen(code[2])});
  }
  return picture;
}

}  // namespace

Picture loadPicture(const std::filesystem::path& file) {
  const std::string name = file.string();
  std::error_code ignored;
  if (!std::filesystem::exists(file, ignored))
    throw std::runtime_error(fmt::format("'{}' does not exist", name));
  if (!std::filesystem::is_regular_file(file, ignored))
    throw std::runtime_error(fmt::format("'{}' is no file", name));
  int width = 0, height = 0, channels = 0;
  if (stbi_is_16_bit(name.c_str()) != 0) {
    stbi_us* codes = stbi_load_16(name.c_str(), &width, &height, &channels, 4);
    return onWhite(codes, width, height, 65535, name);
  }
  stbi_uc* codes = stbi_load(name.c_str(), &width, &height, &channels, 4);
  return onWhite(codes, width, height, 255, name);
}

void savePng(const std::filesystem::path& file, int width, int height, std::span<const sk::float3> pixels) {
  savePng(file, imageOf(width, height, pixels));
}

void savePng(const std::filesystem::path& file, const Picture& picture) {
  const auto byte = [&](std::int32_t code) {
    return static_cast<std::uint8_t>((std::int64_t{code} * 255 + picture.white / 2) / picture.white);
  };
  Image image{picture.width, picture.height, {}};
  image.rgb.reserve(picture.pixels.size() * 3);
  for (const sk::int3& pixel : picture.pixels)
    image.rgb.insert(image.rgb.end(), {byte(pixel.x), byte(pixel.y), byte(pixel.z)});
  savePng(file, image);
}

double linearFromSrgb(double encoded) {
  return encoded <= 0.04045 ? encoded / 12.92 : std::pow((encoded + 0.055) / 1.055, 2.4);
}

double srgbFromLinear(double linear) {
  return linear <= 0.0031308 ? linear * 12.92 : 1.055 * std::pow(linear, 1.0 / 2.4) - 0.055;
}

}  // namespace examples
