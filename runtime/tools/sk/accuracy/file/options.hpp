// SPDX-License-Identifier: MIT
//
// The options of `sk accuracy FILE.sk` that built-in programs have not.
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
  /// Throws std::runtime_error where a range or a value makes no sense.
  FileMeasurement measurement(const std::vector<std::int64_t>& extents, int rounds) const;
  /// The name of an option that is used; empty where none is.
  std::string_view used() const;
};

}  // namespace sk_tool
