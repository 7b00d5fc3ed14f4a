// SPDX-License-Identifier: MIT
//
// `sk accuracy FILE.sk`: each kernel and reduce of a file in every mode, with inputs drawn for it, against the reference.
#pragma once

#include <cstdint>
#include <functional>
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

/// What came of a file, and a line for each kernel that was not measured, and why.
struct FileResults {
  std::vector<Experiment> experiments;  ///< one a kernel
  std::vector<std::string> skipped;
};

/// `report` gets each experiment as soon as it is there. Throws std::runtime_error where no kernel can be measured, or none
/// is of the name, and where parameters are named that are not there.
FileResults measureFile(sk::Device& device, const sk::program::Library& library,
                        const FileMeasurement& measurement,
                        const std::function<void(const Experiment&)>& report);

}  // namespace sk_tool
