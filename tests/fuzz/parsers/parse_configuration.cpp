// SPDX-License-Identifier: MIT
//
// The TOML file that SK_CONFIG names.
#include "device/configuration.hpp"
#include "parsers/entry.hpp"
#include "parsers/memory_file.hpp"
#include "sk/error.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const fuzz::MemoryFile file;
  file.hold({data, size});
  try {
    const sk::Configuration configuration(file.path());
    sk::program::Kernel kernel{};
    kernel.name = "heat::diffuse";
    configuration.resolve(kernel, {});
    configuration.storageOf("heat::u");
    sk::program::Table table{};
    table.function = "heat::response";
    table.range = {0, 1, 16};
    configuration.rangeOf(table);
  } catch (const sk::Error& error) {
    if (error.kind() != sk::Error::Kind::File) throw;
  }
  return 0;
}
