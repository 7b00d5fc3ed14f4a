// SPDX-License-Identifier: MIT
//
// Names of files that differ from process to process.
#pragma once

#include <string>
#include <string_view>

namespace sk {

/// The name with `process` in the place of each "%p", and a percent sign in the place of each "%%".
inline std::string withProcess(std::string_view name, std::string_view process) {
  std::string result;
  for (std::size_t i = 0; i < name.size(); ++i) {
    const char next = name[i] == '%' && i + 1 < name.size() ? name[i + 1] : '\0';
    if (next == 'p') {
      result += process;
    } else {
      result += name[i];
    }
    if (next == 'p' || next == '%') ++i;
  }
  return result;
}

/// What withProcess() turns into this name.
inline std::string withoutProcess(std::string_view name) {
  std::string result;
  for (const char c : name) {
    result += c;
    if (c == '%') result += c;
  }
  return result;
}

}  // namespace sk
