// SPDX-License-Identifier: MIT
//
// `sk accuracy FILE.sk`: each kernel and reduce of a file in every mode, with inputs drawn for it, against the reference.
#pragma once

#include <string>
#include <vector>

#include "accuracy/experiment.hpp"
#include "accuracy/file/ranges.hpp"
#include "sk/device.hpp"
#include "sk/library.hpp"

namespace sk_tool {

struct FileMeasurement {
  std::string kernel = {};  ///< with or without its namespaces; empty: all that can be measured
  std::vector<std::int64_t> extents = {};  ///< of the domain, or one number of elements; empty: 2^20 of them
  int rounds = 0;
  bool hasExtremes = true;
  Ranges ranges = {};
};

/// One experiment a kernel. `skipped` gets a line for each kernel that is not measured, and why. Throws
/// std::runtime_error where none is left, where one is named that cannot be measured, or parameters that are not there.
std::vector<Experiment> measureFile(sk::Device& device, const sk::program::Library& library,
                                    const FileMeasurement& measurement, std::vector<std::string>& skipped);

}  // namespace sk_tool
