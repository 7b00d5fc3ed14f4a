// SPDX-License-Identifier: MIT
//
// The surfaces that examples/applications/smooth reads, in OBJ files, and what it inspects of them before it computes.
#include <cmath>
#include <cstdlib>
#include <stdexcept>

#include "parsers/entry.hpp"
#include "parsers/memory_file.hpp"
#include "surface.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const fuzz::MemoryFile file;
  file.hold({data, size});
  try {
    const smooth::Surface surface = smooth::loadObj(file.path());
    for (const smooth::Triangle& face : surface.faces) {
      for (const std::int32_t corner : face) {
        if (corner < 0 || static_cast<std::size_t>(corner) >= surface.points.size()) std::abort();
      }
    }
    smooth::textOf(smooth::inspect(surface));
  } catch (const std::runtime_error&) {
    return 0;
  }
  return 0;
}
