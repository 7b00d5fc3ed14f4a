// SPDX-License-Identifier: MIT
//
// What a program contains before any kernel runs: each FILE.sk.cpp registers the kinds of code that its kernels
// have, and their names. The best device can run the code of every file (sk::Device, docs/runtime.md). Also tells descriptors
// of a library that has been unloaded from those of another one that was loaded in its place.
#pragma once

#include <cstdint>
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

  /// The loaded object (the program or a shared library) that holds a descriptor: a number that no other object gets, or 0
  /// for descriptors in other memory and for objects without linked files. Whoever keeps something for a descriptor under its
  /// address also keeps this number, and drops what it keeps once isLoaded() is false: another descriptor may get the address.
  static std::uint64_t objectOf(const void* descriptor) noexcept;
  /// Whether the object with this number is still loaded. True for 0.
  static bool isLoaded(std::uint64_t object) noexcept;
  /// How many files have been unloaded so far. As long as this does not change, isLoaded() does not change either. Costs
  /// no more than reading a number.
  static std::uint64_t unloads() noexcept;

 private:
  Code code_;
  std::span<const std::string_view> kernels_, tables_;
  const void* const base_;  ///< where the object is loaded that this file is a part of; null if unknown
  std::uint64_t number_ = 0;
  LinkedFile* next_ = nullptr;  ///< in the list of all linked files
};

}  // namespace sk::program
