// SPDX-License-Identifier: MIT
//
// Options of `sk accuracy FILE.sk` that do not apply to built-in programs.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "accuracy/file/kernel_library.hpp"
#include "accuracy/file/measure.hpp"

namespace CLI {
class App;
}

namespace sk_tool {

struct FileOptions {
  std::string kernel = {};
  std::vector<std::string> ranges = {}, values = {};
  bool hasNoExtremes = false;
  BuildOptions build = {};

  void addTo(CLI::App& command);
  /// Throws std::runtime_error if a range or a value is invalid.
  FileMeasurement measurement(const std::vector<std::int64_t>& extents, int rounds) const;
  /// The name of an option that was used; empty if there is none.
  std::string_view used() const;
};

}  // namespace sk_tool
