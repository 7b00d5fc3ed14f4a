// SPDX-License-Identifier: MIT
//
// `sk accuracy FILE.sk`: measures each kernel and reduction of a file in every mode, with drawn or recorded inputs, against the
// reference, and has the options that do not apply to built-in programs.
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "accuracy/experiment.hpp"
#include "accuracy/file/kernel_library.hpp"
#include "accuracy/file/ranges.hpp"
#include "sk/device.hpp"
#include "sk/library.hpp"

namespace sk_tool {

struct FileMeasurement {
  std::string kernel = {};  ///< with or without namespaces; empty: all that can be measured
  std::vector<std::int64_t> extents = {};  ///< of the domain, or one number of elements; empty: 2^20 elements
  int rounds = 0;
  bool hasExtremes = true;
  Ranges ranges = {};
  std::string inputs =
      {};  ///< a .npz file with recorded inputs, which take the place of drawn ones; empty: none
  /// Called with each experiment before it is reported; may be empty.
  std::function<void(Experiment&, const Subject&)> addBounds = {};
};

/// The results of a file, and for each kernel that was not measured a line that says why.
struct FileResults {
  std::vector<Experiment> experiments;  ///< one per kernel
  std::vector<std::string> skipped;
};

/// `precise` has the same kernels, whose reference MPFR computes; it may be null. Passes each experiment to `report` as soon as it is finished. Throws std::runtime_error if no kernel can
/// be measured or has the name, or if options name parameters that do not exist.
FileResults measureFile(sk::Device& device, const sk::program::Library& library,
                        const sk::program::Library* precise, const FileMeasurement& measurement,
                        const std::function<void(const Experiment&)>& report);

}  // namespace sk_tool

namespace CLI {
class App;
}

namespace sk_tool {

struct FileOptions {
  std::string kernel = {};
  std::vector<std::string> ranges = {}, values = {};
  std::string inputs = {};
  bool hasNoExtremes = false;
  BuildOptions build = {};

  void addTo(CLI::App& command);
  /// Throws std::runtime_error if a range or a value is invalid.
  FileMeasurement measurement(const std::vector<std::int64_t>& extents, int rounds) const;
  /// The name of an option that was used; empty if there is none.
  std::string_view used() const;
};

}  // namespace sk_tool
