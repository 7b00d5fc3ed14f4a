// SPDX-License-Identifier: MIT
#include "support/picture.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <fstream>
#include <iterator>
#include <limits>
#include <memory>
#include <stdexcept>
#include <string>
#include <string_view>

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

std::size_t byteAt(std::string_view bytes, std::size_t at) {
  return at < bytes.size() ? static_cast<unsigned char>(bytes[at]) : 0;
}

std::size_t wordAt(std::string_view bytes, std::size_t at) {
  return 256 * byteAt(bytes, at) + byteAt(bytes, at + 1);
}

/// Whether a segment of a JPEG file, whose length is at `at`, has a Huffman table of more than 256 codes.
bool hasLongTable(std::string_view jpeg, std::size_t at) {
  const std::size_t end = at + wordAt(jpeg, at);
  for (at += 2; at < end;) {
    std::size_t codes = 0;
    for (std::size_t length = 1; length <= 16; ++length) codes += byteAt(jpeg, at + length);
    if (codes > 256) return true;
    at += 17 + codes;
  }
  return false;
}

/// stb_image (2.27) writes beyond such tables. It takes segments as long as they say they are up to the first scan, behind which
/// everything counts that may be a table.
bool hasLongTable(std::string_view jpeg) {
  constexpr std::size_t startOfImage = 0xd8, startOfScan = 0xda, huffmanTables = 0xc4;
  bool isBeforeScan = true;
  for (std::size_t at = 0; at < jpeg.size(); ++at) {
    const std::size_t marker = byteAt(jpeg, at + 1);
    if (byteAt(jpeg, at) != 0xff || marker == 0xff) continue;
    if (marker == huffmanTables && hasLongTable(jpeg, at + 2)) return true;
    if (marker == startOfScan) isBeforeScan = false;
    if (isBeforeScan) at += 1 + (marker == startOfImage ? 0 : wordAt(jpeg, at + 2));
  }
  return false;
}

/// Whether a chunk of a PNG file says that it is longer than the file; stb_image takes memory for it.
bool hasLongChunk(std::string_view png) {
  constexpr std::size_t signature = 8, frame = 12;
  for (std::size_t at = signature; at + 4 <= png.size();) {
    const std::size_t length = (wordAt(png, at) << 16) + wordAt(png, at + 2);
    if (length > png.size()) return true;
    at += frame + length;
  }
  return false;
}

std::string bytesOf(const std::string& name) {
  std::ifstream stream(name, std::ios::binary);
  std::string bytes(std::istreambuf_iterator<char>(stream), {});
  if (!stream || bytes.size() > std::numeric_limits<int>::max())
    throw std::runtime_error(fmt::format("'{}' cannot be read", name));
  return bytes;
}

}  // namespace

Picture loadPicture(const std::filesystem::path& file) {
  const std::string name = file.string();
  std::error_code ignored;
  if (!std::filesystem::exists(file, ignored))
    throw std::runtime_error(fmt::format("'{}' does not exist", name));
  if (!std::filesystem::is_regular_file(file, ignored))
    throw std::runtime_error(fmt::format("'{}' is no file", name));
  const std::string bytes = bytesOf(name);
  if ((bytes.starts_with("\xff") && hasLongTable(bytes)) ||
      (bytes.starts_with("\x89PNG") && hasLongChunk(bytes)))
    throw std::runtime_error(fmt::format("'{}' is no picture that can be read: it is damaged", name));
  const auto* data = reinterpret_cast<const stbi_uc*>(bytes.data());
  const int size = static_cast<int>(bytes.size());
  int width = 0, height = 0, channels = 0;
  // A few bytes may name any size, and some formats fill up what is missing. A file that has no size is refused below.
  constexpr std::int64_t most = std::int64_t{1} << 26;
  if (stbi_info_from_memory(data, size, &width, &height, &channels) != 0 &&
      std::int64_t{width} * height > most) {
    throw std::runtime_error(
        fmt::format("'{}' has {} x {} pixels, which is more than {}", name, width, height, most));
  }
  if (stbi_is_16_bit_from_memory(data, size) != 0) {
    stbi_us* codes = stbi_load_16_from_memory(data, size, &width, &height, &channels, 4);
    return onWhite(codes, width, height, 65535, name);
  }
  stbi_uc* codes = stbi_load_from_memory(data, size, &width, &height, &channels, 4);
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
