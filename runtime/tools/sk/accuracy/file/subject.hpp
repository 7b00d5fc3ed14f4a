// SPDX-License-Identifier: MIT
//
// The kernel or reduction of a file that is measured. Both are called in the same way: a reduction's results
// are streams of one element.
#pragma once

#include <span>
#include <string>

#include "sk/call.hpp"

namespace sk_tool {

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
