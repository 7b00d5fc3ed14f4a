// SPDX-License-Identifier: MIT
//
// The functions with which a body reads a gather: at an index, near the current index, and between elements.
// Implements boundary modes. Every index is brought into bounds before the region's origin is added, so that
// a view never exposes the elements around it.
#pragma once

#include <functional>
#include <string>

#include "assemble/assemble.hpp"
#include "assemble/elements/domain.hpp"
#include "assemble/glsl/program_text.hpp"

namespace sk::assemble {

/// The first components of the current index: an int or an ivec2 to ivec4 expression.
using Position = std::function<std::string(int components)>;

/// Declares the gather's samplers and defines the functions that the body calls. `domain` is not null if
/// texels are packed and the gather has the domain's layout (and `access.nearby`): neighbours are then found
/// by texels.
void defineGather(ProgramText& program, const Position& here, const program::Parameter& parameter,
                  const StreamAccess& access, DomainText* domain = nullptr);

}  // namespace sk::assemble
