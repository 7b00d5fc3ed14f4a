// SPDX-License-Identifier: MIT
//
// Splits what a float sum adds into terms: `total += a * b - c` adds the product of a and b, and -c.
// Compensated and exact sums need this, since they also keep the rounding errors of the products.
#pragma once

#include <vector>

#include "ir/ir.hpp"

namespace skc {

/// A value, or its product with `factor` if there is one.
struct Term {
  ir::ExprPtr value, factor;
};

/// The terms of a statement that folds by +. A value that is not a sum with products is a single term, so
/// that `total += x - mean` adds a rounded float. A dot product of vectors has a term for each component,
/// fma() two; a vector or a selection of products is one product of combined factors.
std::vector<Term> termsOf(const ir::Assign& fold);

/// The one-float inputs that a term is, or is the product of; empty if it contains anything else.
std::vector<ir::VarId> inputsOf(const ir::Kernel& reduce, const Term& term);

/// The inputs, if each element only adds one input, or the product of two, to one float; otherwise empty.
std::vector<ir::VarId> onlyTerm(const ir::Module& module, const ir::Kernel& reduce);

/// Whether each element only adds, to one float, an input, an element of a gather, or the product of two such floats, and
/// the indices are computed from integers: doubles represent such a term exactly.
bool addsDoubles(const ir::Module& module, const ir::Kernel& reduce);

/// The value itself, or a scalar as a vector of this type, as when a scalar is added to a vector.
ir::ExprPtr ofType(ir::Type type, ir::ExprPtr value);

/// Component `component` of a vector; a scalar itself.
ir::ExprPtr componentOf(const ir::Expr& value, unsigned component);

}  // namespace skc
