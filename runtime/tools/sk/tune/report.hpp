// SPDX-License-Identifier: MIT
//
// What a search has found: a configuration file with a comment at each line, a table for people, JSON for programs, and a chart.
#pragma once

#include <string>
#include <vector>

#include "tune/choices.hpp"
#include "tune/search.hpp"
#include "tune/trials.hpp"

namespace sk_tool::tune {

/// One input on which a setting was tried that the search did not see.
struct Verification {
  std::string command;
  Verdict asItIs, tuned;
  std::string failure = {};  ///< why it does not hold; empty if it does
};

struct Report {
  std::string command;
  std::string device;
  std::vector<Wanted> wanted;
  std::vector<std::string> ignored;  ///< reads that differ from run to run
  std::vector<std::string> notes;
  const Trial* base = nullptr;
  const Trial* tuned = nullptr;
  Comparison times = {};  ///< of the program as it is and tuned, in turns
  bool wasRaised = false;  ///< the program was not exact enough as it is
  const Found* found = nullptr;
  const Choices* choices = nullptr;
  const Trials* trials = nullptr;
  std::vector<Verification> verifications = {};
};

/// "error 1.2e-07 (0.12 of the tolerance; tuned::total)".
std::string describe(const Verdict& verdict);

/// The configuration file.
std::string fileOf(const Report& report);
void print(const Report& report);
/// Throws std::runtime_error if the file cannot be written.
void writeJson(const Report& report, const std::string& file);
/// Time to the right, error over the tolerance upwards, of all trials that ran. Throws std::runtime_error if gnuplot is missing or fails.
void drawTrials(const Report& report, const std::string& file);

}  // namespace sk_tool::tune
