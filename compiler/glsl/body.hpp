// SPDX-License-Identifier: MIT
//
// Prints the GLSL of one kernel (program::Kernel::declarations and body): structs, constants, polyfills and
// functions in the common subset of GLSL 3.30 and ESSL 3.00. Streams are accessed through functions that the
// assembler writes between the two; this code writes neither them nor main().
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "glsl/expressions.hpp"

namespace skc::emit {

struct GlslBody {
  std::string declarations;   ///< structs, and constants that borders and identities use
  std::string body;
  std::vector<sk::program::IntrinsicUse> intrinsics;  ///< those that the assembler must define
  std::vector<std::size_t> helpers = {};  ///< the lengths of the polyfills with which the body begins
  std::vector<std::string> names = {};  ///< of the constants and functions that follow
};

GlslBody glslBody(const GlslContext& context);

/// What a program that contains the body of `first` must add in order to run `second`. Returns nullopt if that takes more than functions, or if two functions would share a name.
std::optional<std::string> glslAddition(const GlslContext& first, const GlslContext& second);

}  // namespace skc::emit
