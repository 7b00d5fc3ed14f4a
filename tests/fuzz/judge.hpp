// SPDX-License-Identifier: MIT
//
// Compiles a program in this process, in every way that skc has, and says what a compiler must not do. Crashes
// are for isolation.hpp to notice.
#pragma once

#include "corpus.hpp"
#include "isolation.hpp"

namespace fuzz {

/// Tallied as "accepted" or "refused". `withGlslang`: what is accepted is shown to glslang, too.
Verdict judge(const Program& program, bool withGlslang);

}  // namespace fuzz
