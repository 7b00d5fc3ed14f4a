// SPDX-License-Identifier: MIT
//
// Values of spec parameters, and which streams a kernel needs for them.
#pragma once

#include <array>
#include <cstdint>
#include <string>

#include "sk/program.hpp"

namespace sk::assemble {

/// The values of a kernel's Spec parameters, in order: a bool as 0 or 1, others as their bits.
using SpecValues = std::array<std::uint32_t, program::maxSpecs>;

bool holds(const program::Condition& condition, const SpecValues& specs);

/// Whether the kernel uses a parameter: false only for streams whose condition is false.
inline bool isNeeded(const program::Parameter& parameter, const SpecValues& specs) {
  return parameter.neededIf.steps.empty() || holds(parameter.neededIf, specs);
}

/// A Spec parameter's value as a constant expression in GLSL, exactly.
std::string glslLiteral(program::Scalar scalar, std::uint32_t bits);

}  // namespace sk::assemble
