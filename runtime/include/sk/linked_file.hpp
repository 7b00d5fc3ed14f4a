// SPDX-License-Identifier: MIT
//
// What a program contains before any kernel runs: each FILE.sk.cpp registers the kinds of code that its kernels
// have, and their names. The best device can run the code of every file (sk::Device, docs/runtime.md).
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace sk::program {

/// A .sk file that is linked into the program, registered from its stub's initialization until the stub is
/// unloaded. Stubs are initialized before all objects of applications, which may include devices.
class LinkedFile {
 public:
  struct Code {
    bool glsl;  ///< drawn or dispatched programs for GL devices
    bool native;  ///< native code
  };
  /// Qualified names, which configuration files use.
  struct Names {
    std::vector<std::string> kernels;  ///< of kernels and reductions
    std::vector<std::string> tables;  ///< of tabulated functions
  };

  explicit LinkedFile(Code code) noexcept : LinkedFile(code, {}, {}) {}
  /// The names must live as long as this object.
  LinkedFile(Code code, std::span<const std::string_view> kernels,
             std::span<const std::string_view> tables) noexcept;
  ~LinkedFile();
  LinkedFile(const LinkedFile&) = delete;
  LinkedFile& operator=(const LinkedFile&) = delete;

  /// The kinds of code that every file of the program has. A program without .sk files, whose kernels are
  /// written by hand, has GLSL.
  static Code ofAll() noexcept;
  /// The names in all files of the program.
  static Names namesOfAll();

 private:
  Code code_;
  std::span<const std::string_view> kernels_, tables_;
  LinkedFile* next_ = nullptr;  ///< in the list of all linked files
};

}  // namespace sk::program
