// SPDX-License-Identifier: MIT
//
// The tables of the example stats. The first byte chooses between CSV with one of two separators, and raw floats with a number
// of columns.
#include <cstdlib>
#include <stdexcept>

#include "data.hpp"
#include "parsers/entry.hpp"
#include "parsers/memory_file.hpp"

namespace {

examples::Data tableOf(std::uint8_t choice, const std::string& path) {
  switch (choice % 4) {
    case 0: return examples::readCsv(path, {});
    case 1: return examples::readCsv(path, {.separator = ';', .select = {"a"}});
    case 2: return examples::readBinary(path, 1 + choice / 4, examples::BinaryOrder::Rows);
    default: return examples::readBinary(path, 1 + choice / 4, examples::BinaryOrder::Columns);
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const fuzz::MemoryFile file;
  if (size == 0) return 0;
  file.hold({data + 1, size - 1});
  try {
    const examples::Data table = tableOf(data[0], file.path());
    for (const examples::Column& column : table.columns) {
      if (column.values.size() != table.columns.front().values.size()) std::abort();
    }
  } catch (const std::runtime_error&) {
    return 0;
  }
  return 0;
}
