// SPDX-License-Identifier: MIT
//
// Loads the kernels of a .sk file into this process: skc generates stubs and native code, a C++ compiler
// links them to a shared library, and the library is loaded. Messages of both go to standard error.
//
// A Subject is one of them: a kernel or a reduction, which are called in the same way. A reduction's results are streams
// of one element.
#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "sk/call.hpp"
#include "sk/library.hpp"

namespace sk_tool {

struct BuildOptions {
  /// Empty: the environment variable SK_SKC, else skc beside this program, else in PATH.
  std::string skc = {};
  std::vector<std::string> includes = {}, definitions = {};  ///< -I and -D options of skc
};

/// The compiler, with the options that a file needs.
std::vector<std::string> skcWords(const BuildOptions& options);

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

struct Subject {
  const sk::program::Kernel* kernel = nullptr;
  const sk::program::Reduction* reduction = nullptr;  ///< exactly one of the two is set

  bool isReduce() const { return reduction != nullptr; }
  const sk::program::Kernel& signature() const { return isReduce() ? reduction->fold : *kernel; }
  std::string name() const { return std::string(signature().name); }
  std::span<const sk::program::Parameter> parameters() const { return signature().parameters; }

  /// Throws sk::Error.
  void call(std::span<const sk::Argument> arguments, const sk::CallOptions& options) const {
    if (isReduce()) {
      sk::reduce(*reduction, arguments, options);
    } else {
      sk::run(*kernel, arguments, options);
    }
  }
};

/// Whether a call writes the parameter's stream.
inline bool isResult(const sk::program::Parameter& parameter) {
  return parameter.role == sk::program::Role::Output || parameter.role == sk::program::Role::Accumulator;
}

/// Whether its argument is a host value.
inline bool isValue(const sk::program::Parameter& parameter) {
  using sk::program::Role;
  return parameter.role == Role::Uniform || parameter.role == Role::Spec || parameter.role == Role::Iterator;
}

}  // namespace sk_tool
