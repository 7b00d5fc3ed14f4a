// SPDX-License-Identifier: MIT
//
// Operators on devices: the matrix of a grid in its own layout, which stores least, or its entries in another one.
#pragma once

#include <cstdint>
#include <memory>
#include <string_view>
#include <vector>

#include "layout.hpp"
#include "operator.hpp"

namespace sk::linear {

/// Entries of the matrix; of a stencil, those that it would have, with those beyond Dirichlet ends.
std::int64_t entriesOf(const Operator& a);
/// The shape of vectors: the grid's, or {unknowns}.
sk::Shape shapeOf(const Operator& a);

/// Bytes that makeMatrix() takes of a device for the layout; 0 for a stencil of constant coefficients. Throws sk::Error for an unknown layout.
std::int64_t matrixBytes(const Operator& a, std::string_view layout, std::int64_t entryBytes);

/// Copies the scaled matrix to a device: a stencil where "auto" or "stencil" asks for a grid's layout. The space has the shape of the operator's vectors. Throws sk::Error if
/// the matrix does not have the layout, or cannot be divided over ranks as the space is.
std::unique_ptr<Matrix> makeMatrix(const Space& space, const Operator& a, std::string_view layout,
                                   const Arithmetic& arithmetic, std::vector<LayoutCost>* costs = nullptr);

}  // namespace sk::linear
