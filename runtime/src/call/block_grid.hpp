// SPDX-License-Identifier: MIT
//
// How the shape of a reduction's result divides the shape that is folded. Plain arithmetic.
#pragma once

#include <vector>

#include "sk/shape.hpp"

namespace sk {

/// The numbers of blocks in each dimension of `domain` for a result of shape `result`: every way to put
/// extents of 1 into `result`, up to the rank of `domain`, so that its extents divide those of `domain`
/// (0 divides 0). None where it does not fit, several where it could mean several things.
std::vector<Shape> blockGrids(const Shape& domain, const Shape& result);

/// One block that is all of the domain.
Shape oneBlock(Shape domain);

}  // namespace sk
