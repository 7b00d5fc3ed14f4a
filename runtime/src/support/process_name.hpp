// SPDX-License-Identifier: MIT
//
// Names of files that differ from process to process.
#pragma once

#include <string>
#include <string_view>

namespace sk {

/// The name with `process` in the place of the first "%p".
inline std::string withProcess(std::string name, std::string_view process) {
  constexpr std::string_view variable = "%p";
  if (const std::size_t place = name.find(variable); place != std::string::npos)
    name.replace(place, variable.size(), process);
  return name;
}

}  // namespace sk
