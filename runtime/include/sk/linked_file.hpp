// SPDX-License-Identifier: MIT
//
// Which code a program has, before any kernel runs: each FILE.sk.cpp registers the kinds of code that its
// kernels have. The best device can run the code of every file (sk::Device, docs/runtime.md).
#pragma once

namespace sk::program {

/// A .sk file that is linked into the program, registered from its stub's initialization until the stub is
/// unloaded. Stubs are initialized before all objects of applications, which may include devices.
class LinkedFile {
 public:
  struct Code {
    bool glsl;  ///< drawn or dispatched programs for GL devices
    bool native;  ///< native code
  };

  explicit LinkedFile(Code code) noexcept;
  ~LinkedFile();
  LinkedFile(const LinkedFile&) = delete;
  LinkedFile& operator=(const LinkedFile&) = delete;

  /// The kinds of code that every file of the program has. A program without .sk files, whose kernels are
  /// written by hand, has GLSL.
  static Code ofAll() noexcept;

 private:
  Code code_;
};

}  // namespace sk::program
