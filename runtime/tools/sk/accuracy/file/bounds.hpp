// SPDX-License-Identifier: MIT
//
// Bounds of the errors of a file's kernels, from `skc --emit=bounds`, for the ranges that inputs are drawn from.
#pragma once

#include <filesystem>
#include <string>

#include "accuracy/experiment.hpp"
#include "accuracy/file/kernel_library.hpp"
#include "accuracy/file/ranges.hpp"

namespace sk_tool {

class FileBounds {
 public:
  /// `isNative`: of native code, else of fragment programs.
  FileBounds(std::filesystem::path file, BuildOptions options, const Ranges& ranges, bool isNative)
      : file_(std::move(file)), options_(std::move(options)), ranges_(ranges), isNative_(isNative) {}

  /// Adds the bound of the absolute error to each row of a kernel's experiment that has one. It has none if an input has no range.
  void addTo(Experiment& experiment, const Subject& subject) const;

 private:
  Json boundsOf(const Subject& subject, const std::string& precision) const;

  std::filesystem::path file_;
  BuildOptions options_;
  const Ranges& ranges_;
  bool isNative_;
};

}  // namespace sk_tool
