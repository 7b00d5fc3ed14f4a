// SPDX-License-Identifier: MIT
//
// What all programs are asked on their command lines, and how they tell what they found. Exit status 1 after a
// finding.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>

#include "isolation.hpp"

namespace CLI {
class App;
}

namespace fuzz {

/// Which inputs, and what of them.
struct Command {
  std::uint64_t seed = 1, first = 0, count = 1000;
  unsigned seconds = 10;
  std::string out = "fuzz-findings";
  bool show = false;

  /// `input` is what the program makes: "mutant".
  void addTo(CLI::App& app, const std::string& input);

  /// A campaign over these inputs, without its checks.
  Campaign campaign() const { return {.first = first, .count = count, .seconds = seconds}; }

  /// Writes an input with a finding into `out`, as PREFIX-SEED-NUMBER and the suffix; where it lies.
  std::filesystem::path keep(const std::string& prefix, const Finding& finding, const std::string& text,
                             const std::string& suffix = ".sk") const;
};

/// `input` as in "mutant 7: died by signal 11"; `again` is the command that makes the finding again.
void tell(const std::string& input, const Finding& finding, const std::string& again);

/// The summary's line.
void conclude(const Summary& summary);

/// The status of `work`; what it throws is told, and gives 1.
int guarded(const char* program, const std::function<int()>& work);

}  // namespace fuzz
