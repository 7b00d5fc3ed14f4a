// SPDX-License-Identifier: MIT
#include "support/image.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <fstream>
#include <iterator>
#include <limits>
#include <memory>
#include <stdexcept>
#include <string>
#include <string_view>

#include <fmt/format.h>
#include <stb/stb_image.h>
#include <stb/stb_image_write.h>

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
