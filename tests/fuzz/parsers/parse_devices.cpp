// SPDX-License-Identifier: MIT
//
// The JSON file of `skc --device=FILE`. skc reports every std::runtime_error and exits with status 1.
#include <cstdlib>
#include <stdexcept>

#include "driver/options.hpp"
#include "parsers/entry.hpp"
#include "parsers/memory_file.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const fuzz::MemoryFile file;
  file.hold({data, size});
  try {
    for (const skc::driver::MeasuredDevice& device : skc::driver::readDevices(file.path())) {
      if (device.limits.drawBuffers < 4 || device.limits.textureUnits < 16) std::abort();
    }
  } catch (const std::runtime_error&) {
    return 0;
  }
  return 0;
}
