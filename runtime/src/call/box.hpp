// SPDX-License-Identifier: MIT
//
// Calls for the elements of a box of the domain (CallOptions::box). A kernel runs with its whole domain, and devices write
// the box alone. A reduction folds views of its inputs instead. If it asks where an element is, these are placed in the
// whole.
//
// Computes how the shape of a reduction's result divides its domain. Pure arithmetic.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "call/resolved_call.hpp"
#include "sk/call.hpp"
#include "sk/options.hpp"
#include "sk/program.hpp"
#include "sk/shape.hpp"

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

/// Whether a fold depends on the place of an element in the domain.
bool asksPlace(const program::Kernel& fold);

/// What folds a box alone.
struct BoxedArguments {
  std::vector<Argument> arguments;
  FoldedBox placed = {};  ///< if the fold asks where its elements are
  /// If the call has one: the whole if the box is placed in it, else the box.
  std::optional<GivenDomain> over = {};
};

/// The arguments for folding the box alone, or all elements. Throws sk::Error if the box is not inside the domain, which
/// `over` gives or is the inputs' common shape, or if placed arguments do not hold what is folded and gathered.
BoxedArguments argumentsIn(const program::Kernel& fold, std::span<const Argument> arguments, const Box& box,
                           const std::optional<GivenDomain>& over);

/// Returns the grids of blocks, in each dimension of `domain`, for a result of shape `result`: inserts
/// extents of 1 into `result` in every possible way, up to the rank of `domain`, such that its extents divide
/// those of `domain` (0 divides 0). Empty if `result` does not fit; several grids if it is ambiguous.
std::vector<Shape> blockGrids(const Shape& domain, const Shape& result);

/// The grid of a single block that covers the domain.
Shape oneBlock(Shape domain);

}  // namespace sk
