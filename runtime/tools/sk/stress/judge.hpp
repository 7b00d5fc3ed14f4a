// SPDX-License-Identifier: MIT
//
// What is wrong with a run at an extreme, compared with the program as it is.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "application/process.hpp"
#include "stress/cases.hpp"
#include "stress/observation.hpp"

namespace sk_tool::stress {

struct Finding {
  enum class Kind : std::uint8_t {
    Crash,
    Unended,
    Status,
    NotFinite,
    Spread,
    Unconverged,
    Unstable,
    Inexact
  } kind;
  std::string text;
};

std::string_view nameOf(Finding::Kind kind);

struct Run {
  Case of;
  EndedProcess process = {};
  std::optional<Observation> seen = {};  ///< none if the program has opened no device
  std::vector<Finding> findings = {};

  /// Whether the program breaks where it must not: by a crash anywhere, or otherwise within its ranges and sizes.
  bool isBroken() const;
};

/// What is wrong with a run. `plain` is the program as it is, or the run itself.
std::vector<Finding> findingsIn(const Run& run, const Run& plain);

/// The digits that survive of a number with this relative error: 0 to 16.
double digitsOf(double error);

}  // namespace sk_tool::stress
