// SPDX-License-Identifier: MIT
//
// Computes how the shape of a reduction's result divides its domain. Pure arithmetic.
#pragma once

#include <vector>

#include "sk/shape.hpp"

namespace sk {

/// Returns the grids of blocks, in each dimension of `domain`, for a result of shape `result`: inserts
/// extents of 1 into `result` in every possible way, up to the rank of `domain`, such that its extents divide
/// those of `domain` (0 divides 0). Empty if `result` does not fit; several grids if it is ambiguous.
std::vector<Shape> blockGrids(const Shape& domain, const Shape& result);

/// The grid of a single block that covers the domain.
Shape oneBlock(Shape domain);

}  // namespace sk
