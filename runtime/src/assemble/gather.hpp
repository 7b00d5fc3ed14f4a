// SPDX-License-Identifier: MIT
//
// The two functions by which a kernel's body reads a gather: at an index, and near the current one.
// Boundary modes are here; every index is brought inside before the region's origin is added, so
// that a view never shows what lies around it.
#pragma once

#include "assemble/assemble.hpp"
#include "assemble/domain.hpp"
#include "assemble/program_text.hpp"

namespace sk::assemble {

/// Declares the gather's samplers and defines the functions that the body calls.
void defineGather(ProgramText& program, DomainText& domain, const program::Parameter& parameter,
                  const StreamAccess& access);

}  // namespace sk::assemble
