// SPDX-License-Identifier: MIT
//
// The scenes of an example. Each example has its own scene.hpp with a readScene in the namespace SK_SCENES, and this source is built once
// with each.
#include "scene.hpp"

#include <stdexcept>

#include "parsers/entry.hpp"
#include "parsers/memory_file.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const fuzz::MemoryFile file;
  file.hold({data, size});
  try {
    SK_SCENES::readScene(file.path(), {});
  } catch (const std::runtime_error&) {
    return 0;
  }
  return 0;
}
