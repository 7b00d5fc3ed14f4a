// SPDX-License-Identifier: MIT
//
// Reads pictures by stb, whose own warnings are not ours. Without it, sk says so.
#include <memory>
#include <stdexcept>

#include <fmt/format.h>

#include "tune/application.hpp"

#if __has_include(<stb/stb_image.h>)
#define SK_READS_PICTURES
#define STB_IMAGE_STATIC
#define STB_IMAGE_IMPLEMENTATION
#define STBI_ONLY_PNG
#define STBI_ONLY_JPEG
#define STBI_ONLY_BMP
#define STBI_ONLY_TGA
#include <stb/stb_image.h>
#endif

namespace sk_tool::tune {

std::vector<double> pictureIn([[maybe_unused]] const std::string& file) {
#ifdef SK_READS_PICTURES
  int width = 0, height = 0, channels = 0;
  std::vector<double> numbers;
  const auto take = [&](auto* texels, double most) {
    if (texels == nullptr) {
      throw std::runtime_error(
          fmt::format("cannot read the picture '{}': {}", file, ::stbi_failure_reason()));
    }
    const std::unique_ptr<void, void (*)(void*)> owner(texels, ::stbi_image_free);
    const std::size_t count = static_cast<std::size_t>(width) * static_cast<std::size_t>(height) *
                              static_cast<std::size_t>(channels);
    for (std::size_t i = 0; i < count; ++i) numbers.push_back(static_cast<double>(texels[i]) / most);
  };
  if (::stbi_is_16_bit(file.c_str()) != 0) {
    take(::stbi_load_16(file.c_str(), &width, &height, &channels, 0), 65535);
  } else {
    take(::stbi_load(file.c_str(), &width, &height, &channels, 0), 255);
  }
  return numbers;
#else
  throw std::runtime_error("this sk reads no pictures, since it was built without stb (Debian: libstb-dev)");
#endif
}

}  // namespace sk_tool::tune
