// SPDX-License-Identifier: MIT
//
// The command line options that all fuzzers share, and how they report findings. The exit status is 1 after a finding.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <map>
#include <string>

#include "isolation.hpp"

namespace CLI {
class App;
}

namespace fuzz {

/// Which inputs to try, and what to do with them.
struct Command {
  std::uint64_t seed = 1, first = 0, count = 1000;
  unsigned seconds = 10;
  std::string out = "fuzz-findings";
  bool show = false;

  /// `input` is the word for what the program makes, such as "mutant".
  void addTo(CLI::App& app, const std::string& input);

  /// A campaign over these inputs, without its checks.
  Campaign campaign() const { return {.first = first, .count = count, .seconds = seconds}; }

  /// Writes an input with a finding into `out`, as PREFIX-SEED-NUMBER and the suffix. Returns its path.
  std::filesystem::path keep(const std::string& prefix, const Finding& finding, const std::string& text,
                             const std::string& suffix = ".sk") const;
};

/// The options of a fuzzer that runs slices of inputs, for some time or until it has found much.
struct SlicedCommand : Command {
  double minutes = 0;
  std::uint64_t mostFindings = 20;

  void addTo(CLI::App& app, const std::string& input);

  /// Calls `run` for slices of inputs: for all of `count`, or, if `minutes` > 0, for that long. `run` returns the number of findings
  /// so far, and the last slice is the one in which there are `mostFindings`.
  void forSlices(std::uint64_t slice,
                 const std::function<std::uint64_t(std::uint64_t first, std::uint64_t count)>& run) const;
};

/// Counts findings by what they have in common.
using Kinds = std::map<std::string, int>;
/// Prints how often there was each kind.
void conclude(const Kinds& kinds);

/// The text of a file. Throws std::runtime_error if there is none.
std::string textOf(const std::filesystem::path& file);

/// Prints a finding, such as "mutant 7: died by signal 11"; `input` is "mutant", and `again` the command that reproduces it.
void tell(const std::string& input, const Finding& finding, const std::string& again);

/// Prints the summary.
void conclude(const Summary& summary);

/// Returns the status of `work`, or 1 after printing what it throws.
int guarded(const char* program, const std::function<int()>& work);

}  // namespace fuzz
