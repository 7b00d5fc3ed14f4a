// SPDX-License-Identifier: MIT
//
// `sk accuracy --exhaustive FUNCTIONS`: the largest errors of functions, over all floats, or over drawn doubles and pairs of
// floats, beside the bounds of sk/error_bounds.def.
#pragma once

#include <cstdint>
#include <string>

#include "accuracy/experiment.hpp"

namespace CLI {
class App;
}

namespace sk_tool {

struct FunctionOptions {
  std::string functions = {};  ///< separated by commas, or "all"; empty: the option was not given
  std::uint64_t every = 1;
  std::string precision = "single";
  std::uint64_t draws = std::uint64_t{1} << 24;

  void addTo(CLI::App& command);
};

/// Prints a line for each function and device, and returns a record for each. Devices and profiles may be several, separated
/// by commas. Throws std::runtime_error if there is no such function, and sk::Error if there is no such device.
Json measureFunctions(const FunctionOptions& options, const std::string& devices,
                      const std::string& profiles);

}  // namespace sk_tool
