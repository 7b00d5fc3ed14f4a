// SPDX-License-Identifier: MIT
//
// Runs many programs with WebGL2 in one Chromium, which takes seconds to start.
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "cpp/samples.hpp"
#include "temporary_folder.hpp"

namespace fuzz::cpp {

class BrowserBatch {
 public:
  /// Compiles a program for the browser. May be called in a child process: all that it makes is in files. Throws
  /// std::runtime_error if skc refuses the program.
  void add(std::uint64_t number, const std::string& text, const std::vector<Outputs>& wanted) const;

  /// Runs all programs that were added; gives the differences by number. Throws std::runtime_error if that fails.
  std::map<std::uint64_t, std::string> run() const;

 private:
  TemporaryFolder folder_;
};

}  // namespace fuzz::cpp
