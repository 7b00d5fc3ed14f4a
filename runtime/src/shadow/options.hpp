// SPDX-License-Identifier: MIT
//
// What the environment variable SK_SHADOW asks for (docs/accuracy.md): a report, and what it follows.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace sk::shadow {

/// A number to put in the place of those that the host gives a parameter.
struct Setting {
  std::string kernel;  ///< a pattern
  std::string parameter;
  std::int64_t element = -1;  ///< of a stream, row-major; all of them if it is negative
  double value = 0;
};

/// SK_SHADOW=report.html,every=16,kernels=heat::*,kernels=other,decisions=follow,memory=8G,quad=heat::residual,inputs=recorded.npz
struct Options {
  std::string report;  ///< the page; the report as JSON lies beside it
  std::int64_t every = 1;  ///< compares every n-th call of a kernel; the reference runs all of them
  std::vector<std::string> kernels;  ///< compares these alone; empty: all
  bool followsDecisions = false;  ///< the reference takes over integers and booleans of the device
  std::int64_t memory =
      0;  ///< the most bytes for the reference's streams; 0: half of the memory that is free
  std::vector<std::string> quad;  ///< kernels whose own error is measured in __float128
  std::string inputs;  ///< a .npz file for the inputs of each kernel's worst call; empty: none

  bool listsGiven = false;  ///< the report lists what the host gives to kernels
  std::vector<Setting> settings;  ///< what is put in its place

  /// Where the report goes as JSON: the same name with the ending .json.
  std::string json() const;
};

/// A name as part of SK_SHADOW's value: a comma or a backslash in it has a backslash before it.
std::string asOption(std::string_view text);

/// Reads the value of SK_SHADOW. Throws sk::Error, which names the option and the valid ones.
Options parseOptions(std::string_view text);

/// Whether a name matches one of several patterns, in which `*` stands for any characters.
bool matchesAny(const std::vector<std::string>& patterns, std::string_view name);

}  // namespace sk::shadow
