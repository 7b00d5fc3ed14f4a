// SPDX-License-Identifier: MIT
//
// What a program is made of, known before any kernel runs: each FILE.sk.cpp registers which code its kernels have. The
// best device is one that has code of every file (sk::Device, docs/runtime.md).
#pragma once

namespace sk::program {

/// A .sk file that is linked into the program, from its stub's initialization on until the stub is unloaded. Stubs
/// initialize theirs before all objects of applications, among which devices may be.
class LinkedFile {
 public:
  struct Code {
    bool glsl;  ///< programs for devices with GL, drawn or dispatched
    bool native;  ///< native code
  };

  explicit LinkedFile(Code code) noexcept;
  ~LinkedFile();
  LinkedFile(const LinkedFile&) = delete;
  LinkedFile& operator=(const LinkedFile&) = delete;

  /// What every file of the program has. A program without .sk files, whose kernels are written by hand, has GLSL.
  static Code ofAll() noexcept;

 private:
  Code code_;
};

}  // namespace sk::program
