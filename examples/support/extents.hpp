// SPDX-License-Identifier: MIT
//
// Extents of grids and pictures on a command line: "256x128" and "64x64x64".
#pragma once

#include <cstdint>
#include <string_view>
#include <vector>

namespace examples {

/// What an option accepts.
struct ExtentLimits {
  std::int64_t least, most;  ///< of each extent, both included; most: at most 99999
  int mostCount = 2;  ///< 2: WxH; 3: WxH or WxHxD
};

/// The extents in `text`. Throws std::runtime_error, "OPTION: 'TEXT' is no size; write WxH, each from 2 to 16384".
std::vector<std::int64_t> extentsOf(std::string_view option, std::string_view text,
                                    const ExtentLimits& limits);

}  // namespace examples
