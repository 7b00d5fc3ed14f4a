// SPDX-License-Identifier: MIT
//
// The scenes of an example. cloth and lattice each have their own scene.hpp, and this source is built once with each.
#include "scene.hpp"

#include <stdexcept>

#include "parsers/entry.hpp"
#include "parsers/memory_file.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const fuzz::MemoryFile file;
  file.hold({data, size});
  try {
    examples::readScene(file.path(), {});
  } catch (const std::runtime_error&) {
    return 0;
  }
  return 0;
}
