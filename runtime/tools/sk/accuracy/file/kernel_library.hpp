// SPDX-License-Identifier: MIT
//
// The kernels of a .sk file, brought into this process: skc writes stubs and native code, a C++ compiler links them to a
// shared library, which is loaded. Messages of the two go to standard error.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "sk/library.hpp"

namespace sk_tool {

struct BuildOptions {
  std::string skc =
      {};  ///< empty: environment variable SK_SKC, else the one beside this program, else in PATH
  std::vector<std::string> includes = {}, definitions = {};  ///< -I and -D of skc
};

/// Must outlive every device that runs its kernels, which knows them by their addresses.
class KernelLibrary {
 public:
  /// Throws std::runtime_error where there is no skc, no C++ compiler, or one of them fails, saying what to do.
  KernelLibrary(const std::filesystem::path& file, const BuildOptions& options);
  ~KernelLibrary();
  KernelLibrary(const KernelLibrary&) = delete;
  KernelLibrary& operator=(const KernelLibrary&) = delete;

  const sk::program::Library& list() const { return *list_; }

 private:
  void* object_;
  const sk::program::Library* list_;
};

}  // namespace sk_tool
