// SPDX-License-Identifier: MIT
#include "support/animated_png.hpp"

#include <array>
#include <stdexcept>
#include <string>

#include <fmt/format.h>
#include <stb/stb_image_write.h>

namespace examples {
namespace {

constexpr std::size_t signatureBytes = 8;

std::string bigEndian(std::uint32_t value, int bytes = 4) {
  std::string text;
  for (int i = bytes - 1; i >= 0; --i) text += static_cast<char>((value >> (8 * i)) & 0xff);
  return text;
}

std::uint32_t numberAt(std::string_view bytes, std::size_t at) {
  std::uint32_t value = 0;
  for (std::size_t i = 0; i < 4; ++i) value = (value << 8) | static_cast<unsigned char>(bytes[at + i]);
  return value;
}

/// The CRC of ISO 3309 that ends every chunk.
std::uint32_t checksum(std::string_view bytes) {
  static const std::array<std::uint32_t, 256> table = [] {
    std::array<std::uint32_t, 256> made{};
    for (std::uint32_t n = 0; n < 256; ++n) {
      std::uint32_t c = n;
      for (int bit = 0; bit < 8; ++bit) c = (c & 1) != 0 ? 0xedb88320u ^ (c >> 1) : c >> 1;
      made[n] = c;
    }
    return made;
  }();
  std::uint32_t c = 0xffffffffu;
  for (const char byte : bytes) c = table[(c ^ static_cast<unsigned char>(byte)) & 0xff] ^ (c >> 8);
  return c ^ 0xffffffffu;
}

/// A PNG of its own, of which a frame takes the compressed pixels.
std::string encoded(const Image& image) {
  std::string bytes;
  const auto append = [](void* to, void* data, int size) {
    static_cast<std::string*>(to)->append(static_cast<const char*>(data), static_cast<std::size_t>(size));
  };
  stbi_write_png_to_func(append, &bytes, image.width, image.height, 3, image.rgb.data(), image.width * 3);
  return bytes;
}

/// Calls visit(type, data) for each chunk of a PNG.
template <class Visit>
void forEachChunk(std::string_view png, Visit&& visit) {
  for (std::size_t at = signatureBytes; at + 12 <= png.size();) {
    const std::size_t length = numberAt(png, at);
    visit(png.substr(at + 4, 4), png.substr(at + 8, length));
    at += length + 12;
  }
}

}  // namespace

AnimatedPng::AnimatedPng(const std::filesystem::path& file, int framesPerSecond)
    : name_(file), framesPerSecond_(framesPerSecond) {
  std::error_code ignored;
  if (file.has_parent_path()) std::filesystem::create_directories(file.parent_path(), ignored);
  file_.open(file, std::ios::out | std::ios::binary | std::ios::trunc);
  if (!file_) {
    throw std::runtime_error(
        fmt::format("cannot write '{}'; name a file in a folder that can be written", file.string()));
  }
}

void AnimatedPng::writeChunk(std::string_view type, std::string_view data) {
  const std::string body = std::string(type) + std::string(data);
  file_ << bigEndian(static_cast<std::uint32_t>(data.size())) << body << bigEndian(checksum(body));
}

void AnimatedPng::begin(const Image& image) {
  const std::string png = encoded(image);
  file_.write(png.data(), signatureBytes);
  forEachChunk(png, [&](std::string_view type, std::string_view data) {
    if (type == "IHDR") writeChunk(type, data);
  });
  control_ = file_.tellp();
  writeChunk("acTL", bigEndian(0) + bigEndian(0));
}

void AnimatedPng::add(const Image& image) {
  if (frames_ == 0) begin(image);
  writeChunk("fcTL", bigEndian(sequence_++) + bigEndian(static_cast<std::uint32_t>(image.width)) +
                         bigEndian(static_cast<std::uint32_t>(image.height)) + bigEndian(0) + bigEndian(0) +
                         bigEndian(1, 2) + bigEndian(static_cast<std::uint32_t>(framesPerSecond_), 2) + '\0' +
                         '\0');
  forEachChunk(encoded(image), [&](std::string_view type, std::string_view data) {
    if (type != "IDAT") return;
    if (frames_ == 0) {
      writeChunk(type, data);
    } else {
      writeChunk("fdAT", bigEndian(sequence_++) + std::string(data));
    }
  });
  ++frames_;
}

void AnimatedPng::finish() {
  if (frames_ > 0) {
    writeChunk("IEND", "");
    file_.seekp(control_);
    writeChunk("acTL", bigEndian(frames_) + bigEndian(0));
  }
  file_.close();
  if (!file_)
    throw std::runtime_error(fmt::format("'{}' could not be written; is the disk full?", name_.string()));
}

}  // namespace examples
