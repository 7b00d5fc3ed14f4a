// SPDX-License-Identifier: MIT
//
// What is measured: a kernel or a reduce of a file, which are called alike, a reduce with streams of one element for its
// results.
#pragma once

#include <span>
#include <string>

#include "sk/call.hpp"

namespace sk_tool {

struct Subject {
  const sk::program::Kernel* kernel = nullptr;
  const sk::program::Reduction* reduction = nullptr;  ///< one of the two

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

/// Whether its argument is one host value a call.
inline bool isValue(const sk::program::Parameter& parameter) {
  using sk::program::Role;
  return parameter.role == Role::Uniform || parameter.role == Role::Spec || parameter.role == Role::Iterator;
}

}  // namespace sk_tool
