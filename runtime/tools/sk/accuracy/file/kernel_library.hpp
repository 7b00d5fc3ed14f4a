// SPDX-License-Identifier: MIT
//
// Loads the kernels of a .sk file into this process: skc generates stubs and native code, a C++ compiler
// links them to a shared library, and the library is loaded. Messages of both go to standard error.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "sk/library.hpp"

namespace sk_tool {

struct BuildOptions {
  /// Empty: the environment variable SK_SKC, else skc beside this program, else in PATH.
  std::string skc = {};
  std::vector<std::string> includes = {}, definitions = {};  ///< -I and -D options of skc
};

/// Must outlive every device that runs its kernels, because devices identify kernels by their addresses.
class KernelLibrary {
 public:
  /// Throws std::runtime_error, which says what to do, if skc or a C++ compiler is missing or fails.
  KernelLibrary(const std::filesystem::path& file, const BuildOptions& options);
  ~KernelLibrary();
  KernelLibrary(const KernelLibrary&) = delete;
  KernelLibrary& operator=(const KernelLibrary&) = delete;

  const sk::program::Library& list() const { return *list_; }
  /// The same kernels, whose reference computes by MPFR; null if there is no MPFR for the C++ compiler, or if it is not an x86-64.
  const sk::program::Library* precise() const { return preciseList_; }

 private:
  void* object_;
  const sk::program::Library* list_;
  void* preciseObject_ = nullptr;
  const sk::program::Library* preciseList_ = nullptr;
};

}  // namespace sk_tool
