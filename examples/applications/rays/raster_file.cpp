// SPDX-License-Identifier: MIT
#include "raster_file.hpp"

#include <algorithm>
#include <cstring>
#include <fstream>
#include <stdexcept>
#include <string>
#include <system_error>
#include <vector>

#include <fmt/format.h>

#include "support/image.hpp"

namespace rays {
namespace {

[[noreturn]] void fail(const std::filesystem::path& file, std::string_view what) {
  throw std::runtime_error(fmt::format("{}: {}", file.string(), what));
}

float swapped(float value) {
  char raw[4];
  std::memcpy(raw, &value, 4);
  std::reverse(raw, raw + 4);
  std::memcpy(&value, raw, 4);
  return value;
}

Raster loadPfm(const std::filesystem::path& file) {
  std::ifstream stream(file, std::ios::binary);
  std::string kind;
  int width = 0, height = 0;
  double scale = 0.0;
  if (!(stream >> kind)) fail(file, "the picture does not exist or cannot be read");
  if (kind != "PF" && kind != "Pf") fail(file, "this is no PFM file, which begins with PF or Pf");
  if (!(stream >> width >> height >> scale) || width < 1 || height < 1 || width > 32768 || height > 32768 ||
      scale == 0.0)
    fail(file, "the header of a PFM file has a width and a height from 1 to 32768, and a scale");
  stream.get();
  const std::size_t planes = kind == "PF" ? 3 : 1;
  const std::size_t count = std::size_t(width) * std::size_t(height);
  std::error_code ignored;
  if (std::filesystem::file_size(file, ignored) < count * planes * 4) fail(file, "the file ends too early");
  std::vector<float> raw(count * planes);
  stream.read(reinterpret_cast<char*>(raw.data()), static_cast<std::streamsize>(raw.size() * 4));
  if (!stream) fail(file, "the file ends too early");
  if ((scale > 0) == (std::endian::native == std::endian::little))
    std::ranges::transform(raw, raw.begin(), swapped);
  Raster raster{width, height, std::vector<sk::float3>(count)};
  for (std::size_t y = 0; y < std::size_t(height); ++y) {
    for (std::size_t x = 0; x < std::size_t(width); ++x) {
      const float* p = raw.data() + ((std::size_t(height) - 1 - y) * std::size_t(width) + x) * planes;
      raster.pixels[y * std::size_t(width) + x] =
          planes == 3 ? sk::float3{p[0], p[1], p[2]} : sk::float3{p[0], p[0], p[0]};
    }
  }
  return raster;
}

}  // namespace

Raster loadRaster(const std::filesystem::path& file) {
  if (file.extension() == ".pfm") return loadPfm(file);
  if (file.extension() == ".exr") return loadExr(file);
  const examples::Picture picture = examples::loadPicture(file);
  std::vector<float> linear(static_cast<std::size_t>(picture.white) + 1);
  for (std::size_t i = 0; i < linear.size(); ++i)
    linear[i] = static_cast<float>(examples::linearFromSrgb(double(i) / picture.white));
  Raster raster{picture.width, picture.height, {}};
  raster.pixels.reserve(picture.pixels.size());
  for (const sk::int3& p : picture.pixels)
    raster.pixels.push_back({linear[std::size_t(p.x)], linear[std::size_t(p.y)], linear[std::size_t(p.z)]});
  return raster;
}

void savePfm(const std::filesystem::path& file, int width, int height, std::span<const sk::float3> pixels) {
  std::error_code ignored;
  if (file.has_parent_path()) std::filesystem::create_directories(file.parent_path(), ignored);
  std::ofstream stream(file, std::ios::binary);
  const bool isLittle = std::endian::native == std::endian::little;
  stream << fmt::format("PF\n{} {}\n{}\n", width, height, isLittle ? "-1.0" : "1.0");
  for (int y = height - 1; y >= 0; --y) {
    const auto row = pixels.subspan(std::size_t(y) * std::size_t(width), std::size_t(width));
    stream.write(reinterpret_cast<const char*>(row.data()), static_cast<std::streamsize>(row.size_bytes()));
  }
  if (!stream.flush()) fail(file, "cannot be written");
}

}  // namespace rays
