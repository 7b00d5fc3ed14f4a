// SPDX-License-Identifier: MIT
//
// Whether a method, a preconditioner and a matrix go together.
#pragma once

#include "method.hpp"
#include "operator.hpp"
#include "preconditioner.hpp"

namespace sk::linear {

/// Throws sk::Error if the method cannot take the preconditioner, or this number of its sweeps. To be asked before anything is copied to a device.
void checkChoice(const MethodKind& method, const PreconditionerKind& preconditioner, int sweepsBefore,
                 int sweepsAfter);

/// Throws sk::Error, with a place, if one of them needs a symmetric matrix and this one is not. `matrix` is a.scale * A on the device.
void checkSymmetry(sk::Device& device, Matrix& matrix, const Arithmetic& arithmetic, const MethodKind& method,
                   const PreconditionerKind& preconditioner, const Operator& a);

/// Throws sk::Error unless the rows, columns and lengths of a matrix that somebody else made are those of compressed rows, and its entries finite.
void checkStructure(const SparseMatrix& a);

/// The same for grids: two or three dimensions, coefficients that are finite, pairs of ends, and the offsets of a neighbourhood.
void checkGrid(const Stencil& a);
void checkGrid(const VaryingStencil& a);

/// Throws sk::Error if a grid has more elements than can be solved, or takes more memory of the host than there is. `entries` of a row are stored, in
/// coordinates, compressed rows and by the grid; none of a stencil.
void checkGridSize(const sk::Shape& grid, int entries);

}  // namespace sk::linear
