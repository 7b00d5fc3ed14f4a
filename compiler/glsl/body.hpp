// SPDX-License-Identifier: MIT
//
// The GLSL text of one kernel (program::Kernel::declarations and body): structs, constants, polyfills
// and functions in the subset that GLSL 3.30 and ESSL 3.00 share. Streams are reached through
// functions that the assembler writes between the two; neither they nor main() are made here.
#pragma once

#include <optional>
#include <string>

#include "glsl/expressions.hpp"

namespace skc::emit {

struct GlslBody {
  std::string declarations;   ///< structs, and the constants that borders and identities name
  std::string body;
};

GlslBody glslBody(const GlslContext& context);

/// What a program that holds the body of `first` has to add in order to run `second`, whose bodies glslBody() has made; nothing
/// where that takes more than functions, or two would have one name.
std::optional<std::string> glslAddition(const GlslContext& first, const GlslContext& second);

}  // namespace skc::emit
