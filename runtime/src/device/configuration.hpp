// SPDX-License-Identifier: MIT
//
// A file of choices of accuracy and speed, for changing them without recompiling an application
// (docs/accuracy.md):
//
//   [kernels."heat::diffuse"]
//   precision = "extended"
//
//   [kernels."heat::total"]
//   accumulate = "tree"
//   force = true              # over what calls of it choose
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
//
//   [devices."llvmpipe"]
//   dispatchBelow = 0.5
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "gl/known_devices.hpp"
#include "sk/linked_file.hpp"
#include "sk/options.hpp"
#include "sk/program.hpp"

namespace sk {

class Configuration {
 public:
  Configuration() = default;
  /// Throws sk::Error, which names the file, the line and the valid choices.
  explicit Configuration(const std::string& file);

  /// Throws sk::Error if a kernel or a table of the file is not in the program but its name is nearly that of one
  /// that is. Other unknown names are of other programs with the same file.
  void checkNames(const program::LinkedFile::Names& linked) const;

  /// The options of a call: the call's own choices override the file's for the kernel, which override the
  /// file's for "*", which override the declaration's. Tables with `force = true` override the call's own choices, and
  /// replace those that exclude theirs: sums that are exact or compensated, and tables, are of floats.
  CallOptions resolve(const program::Kernel& kernel, const CallOptions& call) const;
  /// The storage of a stream of this name: the file's choice for it, else for "*", else Single.
  Storage storageOf(std::string_view stream) const;

  /// The range of a table: the file's, else the declaration's. Throws sk::Error if the combination is not a
  /// valid range.
  TableRange rangeOf(const program::Table& table) const;

  /// The constants of the device whose renderer has this name: the file's for parts of the name, in the order of the parts, else
  /// for "*".
  gl::TraitChoices traitsOf(std::string_view renderer) const;

  struct RangeChoice {
    std::optional<float> low = {}, high = {};
    std::optional<std::int32_t> intervals = {};
    std::string place = {};  ///< FILE:LINE
  };

 private:
  struct KernelChoice {
    CallOptions options;
    bool isForced = false;
    std::string place;  ///< FILE:LINE
  };

  std::map<std::string, KernelChoice, std::less<>> kernels_;
  std::map<std::string, RangeChoice, std::less<>> tables_;
  std::map<std::string, Storage, std::less<>> streams_;
  std::map<std::string, gl::TraitChoices, std::less<>> devices_;
};

/// The names of the choices that are not Default, as a file has them: "precision double".
std::vector<std::string> choicesOf(const CallOptions& options);
std::string_view nameOf(Storage storage);

}  // namespace sk
