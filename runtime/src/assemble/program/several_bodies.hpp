// SPDX-License-Identifier: MIT
//
// Joins the bodies of several kernels to the text of one program. Functions of skc's own, which several bodies begin with,
// are there once; functions and constants of .sk files that share a name, and the functions by which bodies read their
// streams, get names of their own.
#pragma once

#include <optional>
#include <set>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "sk/program.hpp"

namespace sk::assemble {

class SeveralBodies {
 public:
  /// Adds what a call of `kernel` needs, and returns the name of its entry. `symbols` has for each parameter the suffix of the
  /// functions by which the call reads it, in place of Parameter::symbol; if it is empty, the parameter has the domain's index
  /// and extent. Returns nullopt, without effect, if two bodies have names that cannot be told apart, or if the kernel's
  /// definitions are not known.
  std::optional<std::string> add(const program::Kernel& kernel, std::span<const std::string> symbols);

  /// The text of all bodies.
  std::string text() const { return helpers_ + bodies_; }

 private:
  struct Instance {
    std::string_view body;
    std::string accessors;  ///< the macros for its parameters
    std::string entry;
  };

  std::string helpers_, bodies_;
  std::vector<std::string_view> helperTexts_;
  std::set<std::string, std::less<>> taken_;  ///< names of functions and constants of the .sk files
  std::vector<Instance> instances_;
};

}  // namespace sk::assemble
