// SPDX-License-Identifier: MIT
#include "raster_file.hpp"

#include <array>
#include <cstddef>
#include <stdexcept>
#include <string>
#include <system_error>

#include <ImfChannelList.h>
#include <ImfCompression.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfInputFile.h>
#include <ImfOutputFile.h>
#include <fmt/format.h>

namespace rays {
namespace {

constexpr std::size_t pixelSize = sizeof(sk::float3);

/// A channel of a picture whose first pixel is at `first`, `step` bytes from one to the next.
Imf::Slice sliceOf(Imf::PixelType type, const void* first, std::size_t step, int width) {
  // The library takes pointers to what it does not change as it takes others.
  return {type, const_cast<char*>(static_cast<const char*>(first)), step,
          step * static_cast<std::size_t>(width)};
}

/// A header and where its channels lie.
struct Channels {
  Imf::Header header;
  Imf::FrameBuffer buffer;
  int width;

  void add(const std::string& name, Imf::PixelType type, const void* first, std::size_t step) {
    header.channels().insert(name, Imf::Channel(type));
    buffer.insert(name, sliceOf(type, first, step, width));
  }
  void addThree(const std::string& prefix, std::string_view letters, std::span<const sk::float3> pixels) {
    const auto* first = reinterpret_cast<const float*>(pixels.data());
    for (std::size_t i = 0; i < 3; ++i) add(prefix + letters[i], Imf::FLOAT, first + i, pixelSize);
  }
};

void addLayer(Channels& channels, const Layer& layer) {
  if (!layer.whole.empty())
    channels.add(layer.name, Imf::UINT, layer.whole.data(), sizeof(std::int32_t));
  else if (layer.isSingle)
    channels.add(layer.name == "depth" ? "Z" : layer.name, Imf::FLOAT, layer.pixels.data(), pixelSize);
  else
    channels.addThree(layer.name + ".", layer.name == "normal" ? "XYZ" : "RGB", layer.pixels);
}

[[noreturn]] void fail(const std::filesystem::path& file, std::string_view what) {
  throw std::runtime_error(fmt::format("{}: {}", file.string(), what));
}

Raster readRgb(const std::filesystem::path& file) {
  Imf::InputFile input(file.c_str());
  const Imath::Box2i window = input.header().dataWindow();
  const std::int64_t width = std::int64_t{window.max.x} - window.min.x + 1,
                     height = std::int64_t{window.max.y} - window.min.y + 1;
  if (width < 1 || height < 1 || width > 32768 || height > 32768)
    fail(file, fmt::format("a picture has 1 to 32768 pixels in width and height, and this one {} x {}", width,
                           height));
  const Imf::ChannelList& channels = input.header().channels();
  const bool isGrey = channels.findChannel("R") == nullptr && channels.findChannel("Y") != nullptr;
  Raster raster{static_cast<int>(width), static_cast<int>(height), {}};
  raster.pixels.resize(static_cast<std::size_t>(width * height));
  // Slices count pixels from (0, 0), wherever the window is.
  auto* const first = reinterpret_cast<char*>(raster.pixels.data());
  const std::ptrdiff_t offset =
      (std::ptrdiff_t{window.min.x} + std::ptrdiff_t{window.min.y} * width) * std::ptrdiff_t{pixelSize};
  Imf::FrameBuffer buffer;
  const std::array<const char*, 3> names = {isGrey ? "Y" : "R", "G", "B"};
  for (std::size_t i = 0; i < (isGrey ? 1 : 3); ++i) {
    const Imf::Channel* channel = channels.findChannel(names[i]);
    if (channel == nullptr || channel->xSampling != 1 || channel->ySampling != 1)
      fail(file, "the picture needs channels R, G and B, or Y, one value for each pixel");
    buffer.insert(names[i], Imf::Slice(Imf::FLOAT, first + sizeof(float) * i - offset, pixelSize,
                                       pixelSize * static_cast<std::size_t>(width)));
  }
  input.setFrameBuffer(buffer);
  input.readPixels(window.min.y, window.max.y);
  if (isGrey)
    for (sk::float3& p : raster.pixels) p = {p.x, p.x, p.x};
  return raster;
}

}  // namespace

void needExr(const std::filesystem::path& /*file*/) {}

void saveExr(const std::filesystem::path& file, int width, int height, std::span<const sk::float3> pixels,
             const std::vector<Layer>& layers) {
  std::error_code ignored;
  if (file.has_parent_path()) std::filesystem::create_directories(file.parent_path(), ignored);
  Channels channels{Imf::Header(width, height), {}, width};
  channels.header.compression() = Imf::ZIP_COMPRESSION;
  channels.addThree("", "RGB", pixels);
  for (const Layer& layer : layers) addLayer(channels, layer);
  try {
    Imf::OutputFile output(file.c_str(), channels.header);
    output.setFrameBuffer(channels.buffer);
    output.writePixels(height);
  } catch (const std::exception& error) {
    fail(file, fmt::format("cannot be written ({})", error.what()));
  }
}

Raster loadExr(const std::filesystem::path& file) {
  std::error_code ignored;
  if (!std::filesystem::exists(file, ignored)) fail(file, "the picture does not exist or cannot be read");
  try {
    return readRgb(file);
  } catch (const std::exception& error) {
    const std::string what = error.what();
    if (what.starts_with(file.string())) throw std::runtime_error(what);
    fail(file, fmt::format("this is no OpenEXR picture that can be read ({})", what));
  }
}

}  // namespace rays
