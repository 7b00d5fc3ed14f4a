// SPDX-License-Identifier: MIT
//
// The scenes of an example. cloth and lattice each have a scene.hpp of their own, and each gets a program of this source.
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
