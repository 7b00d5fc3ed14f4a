// SPDX-License-Identifier: MIT
//
// Compiles a program in this process to every output that skc has, and finds what a compiler must not do. isolation.hpp
// notices crashes.
#pragma once

#include "corpus.hpp"
#include "isolation.hpp"

namespace fuzz {

/// The tally is "accepted" or "refused". `withGlslang`: checks the GLSL of accepted programs with glslang, too.
Verdict judge(const Program& program, bool withGlslang);

}  // namespace fuzz
