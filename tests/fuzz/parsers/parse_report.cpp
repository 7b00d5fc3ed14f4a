// SPDX-License-Identifier: MIT
//
// What `sk info` keeps about a device. Any text must either be rejected, or be reported and written as JSON.
#include <string>

#include "info/report.hpp"
#include "parsers/entry.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const sk_tool::Json info = sk_tool::readKept({reinterpret_cast<const char*>(data), size});
  if (!info.is_null()) sk_tool::report(info), info.dump(2);
  return 0;
}
