// SPDX-License-Identifier: MIT
#include "raster_file.hpp"

#include <stdexcept>

#include <fmt/format.h>

namespace rays {

void needExr(const std::filesystem::path& file) {
  throw std::runtime_error(
      fmt::format("'{}': this build has no OpenEXR; take .pfm, or install libopenexr-dev and configure with "
                  "-DSK_OPENEXR=ON",
                  file.string()));
}

void saveExr(const std::filesystem::path& file, int /*width*/, int /*height*/,
             std::span<const sk::float3> /*pixels*/, const std::vector<Layer>& /*layers*/) {
  needExr(file);
}

Raster loadExr(const std::filesystem::path& file) {
  needExr(file);
  return {};
}

}  // namespace rays
