// SPDX-License-Identifier: MIT
//
// Choices of accuracy and speed from a file, so that an application need not be compiled again (docs/accuracy.md):
//
//   [kernels."heat::diffuse"]
//   precision = "extended"
//
//   [kernels."*"]
//   intrinsics = "fast"
//   target = "fragment"
//   contraction = "fast"
//
//   [tables."heat::response"]
//   low = -4.0
//   high = 4.0
//   intervals = 4096
//
//   [streams."heat::u"]
//   storage = "half"
#pragma once

#include <cstdint>
#include <map>
#include <optional>
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
  /// What a stream of this name holds its floats as: the file's choice for it, then for "*", then Single.
  Storage storageOf(std::string_view stream) const;

  /// The range of a table: the file's, or what the declaration says. Throws sk::Error where both together make none.
  TableRange rangeOf(const program::Table& table) const;

  struct RangeChoice {
    std::optional<float> low = {}, high = {};
    std::optional<std::int32_t> intervals = {};
    std::string place = {};  ///< FILE:LINE
  };

 private:
  std::map<std::string, CallOptions, std::less<>> kernels_;
  std::map<std::string, RangeChoice, std::less<>> tables_;
  std::map<std::string, Storage, std::less<>> streams_;
};

}  // namespace sk
