// SPDX-License-Identifier: MIT
//
// Finds the float sums of a reduce: accumulators, or members of them, to which elements are added, and to
// which partial results are added as well, whether the compiler or the author combines them. Other members
// may be folded in any way. Splits what elements add to a sum into terms.
#pragma once

#include <cstdint>
#include <vector>

#include "ir/ir.hpp"
#include "transforms/fold_pattern.hpp"

namespace skc {

/// A float or a vector of floats, of which these components are sums; no other is folded by +.
using FloatSum = ir::AccumulatorPart;

/// The sums of a reduce, in the order of its parameters and their members. Outside of loop heads, the
/// reduce's statements only add values to them that depend on no accumulator, and the combining reduce only
/// adds the corresponding inputs.
std::vector<FloatSum> floatSums(const ir::Module& module, ir::KernelId id);

// Splits what a float sum adds into terms: `total += a * b - c` adds the product of a and b, and -c.
// Compensated and exact sums need this, since they also keep the rounding errors of the products.

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

/// What a place, which is a sum or components of one, selects of a variable of the sum's type.
ir::ExprPtr sameComponents(const ir::Function& function, const ir::Expr& place, ir::VarId var, Loc loc = {});

/// Component `component` of a vector; a scalar itself.
ir::ExprPtr componentOf(const ir::Expr& value, unsigned component);

// One scalar of a float sum. Exact sums work on these: each component of a vector is a sum of its own.

/// A component of a sum.
struct ScalarSum {
  FloatSum whole;
  unsigned component;
};

/// The terms, each one float, that a statement of the reduce adds to the scalar; empty if it adds none.
std::vector<Term> termsOf(const ir::Kernel& reduce, const ir::Stmt& stmt, const ScalarSum& sum);

}  // namespace skc
