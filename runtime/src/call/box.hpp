// SPDX-License-Identifier: MIT
//
// Calls for the elements of a box of the domain (CallOptions::box). A kernel runs with its whole domain, and devices write
// the box alone. A reduction folds views of its inputs instead, which is the same as long as it does not ask where an
// element is.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "sk/call.hpp"
#include "sk/options.hpp"
#include "sk/program.hpp"

namespace sk {

/// Throws sk::Error unless the box is a part of the domain with at least one element.
void checkBox(const program::Kernel& kernel, const Box& box, const Shape& domain);

/// Whether a box that has been checked is the whole domain.
bool isAll(const Box& box, const Shape& domain);

/// Throws sk::Error if a kernel cannot run over a box with these arguments, which have been checked: if it pushes or
/// scatters, or writes to strided views.
void checkBoxedCall(const program::Kernel& kernel, std::span<const Argument> arguments, const Box& box,
                    const Shape& domain);

std::string toString(const Box& box);

/// The box of an input that an element of the box of the domain reads: where the input's extent is 1, it is repeated.
Box boxIn(const Shape& input, const Shape& domain, const Box& box);

/// The part of a region with the domain's shape that lies in the box; all of it if the box is the whole domain.
StreamRegion partIn(const StreamRegion& region, const Box& box);

/// The arguments for folding the box alone, or all elements; they are not placed. Throws sk::Error if the box is not
/// inside the inputs' common shape, if placed arguments do not hold it, or if the fold asks where an element is.
std::vector<Argument> argumentsIn(const program::Kernel& fold, std::span<const Argument> arguments,
                                  const Box& box);

}  // namespace sk
