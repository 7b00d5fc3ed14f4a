// SPDX-License-Identifier: MIT
//
// Names and expressions that all programs for append outputs share.
#pragma once

#include <string>
#include <string_view>

#include "assemble/assemble.hpp"
#include "assemble/glsl/program_text.hpp"
#include "sk/program.hpp"

namespace sk::assemble {

/// The function that the body calls: "void sk_push_r(float sk_v)" or "void sk_put_r(ivec2 sk_i, float sk_v)".
std::string signatureOf(const program::Parameter& appendOutput);

/// "sk_KIND_r"
std::string named(std::string_view kind, const program::Parameter& appendOutput);

/// The texel of index `sk_i` of a scatter output. Streams of more than two dimensions are always linearised.
std::string targetTexel(ProgramText& program, const program::Parameter& appendOutput,
                        const StreamAccess& access);

/// Whether the index `sk_i` is in bounds. As unsigned integers, negative indices are too large.
std::string isInside(ProgramText& program, const program::Parameter& appendOutput);

}  // namespace sk::assemble
