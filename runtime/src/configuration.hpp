// SPDX-License-Identifier: MIT
//
// Choices of accuracy from a file, so that an application need not be compiled again (docs/accuracy.md):
//
//   [kernels."heat::diffuse"]
//   precision = "extended"
//
//   [kernels."*"]
//   intrinsics = "fast"
#pragma once

#include <map>
#include <string>
#include <string_view>

#include "sk/options.hpp"
#include "sk/program.hpp"

namespace sk {

class Configuration {
 public:
  Configuration() = default;
  /// Throws sk::Error naming the file, the line and what would be right.
  explicit Configuration(const std::string& file);

  /// What a call computes with: its own choices, then those of the file for the kernel, then for "*", then the
  /// declaration's.
  CallOptions resolve(const program::Kernel& kernel, const CallOptions& call) const;

 private:
  std::map<std::string, CallOptions, std::less<>> kernels_;
};

}  // namespace sk
