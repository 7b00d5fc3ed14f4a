// SPDX-License-Identifier: MIT
//
// The functions by which a kernel's body reads a gather: at an index, near the current one, and between
// elements.
// Boundary modes are here; every index is brought inside before the region's origin is added, so
// that a view never shows what lies around it.
#pragma once

#include <functional>
#include <string>

#include "assemble/assemble.hpp"
#include "assemble/elements/domain.hpp"
#include "assemble/glsl/program_text.hpp"

namespace sk::assemble {

/// The first components of the current index: an int or an ivec2 to ivec4 expression.
using Position = std::function<std::string(int components)>;

/// Declares the gather's samplers and defines the functions that the body calls.
/// `domain`: of packed texels, where those of the gather lie as these do (and `access.nearby`), so that neighbours are found
/// by texels; else null.
void defineGather(ProgramText& program, const Position& here, const program::Parameter& parameter,
                  const StreamAccess& access, DomainText* domain = nullptr);

}  // namespace sk::assemble
