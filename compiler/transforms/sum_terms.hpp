// SPDX-License-Identifier: MIT
//
// What a sum of floats adds, taken apart: `total += a * b - c` adds the product of a and b, and -c. Forms of a sum that keep
// more than its roundings leave ask for this, since they keep what the products lose, too.
#pragma once

#include <vector>

#include "ir/ir.hpp"

namespace skc {

/// A value, or where `factor` is there, its product with it.
struct Term {
  ir::ExprPtr value, factor;
};

/// The terms of a statement that folds by +. A value that is no sum of products and others is one term, so that
/// `total += x - mean` adds a float as it is rounded. A dot product of vectors has a term for each component, fma() two, and
/// a vector of products, or a choice of some, is a product of what is made of their factors.
std::vector<Term> termsOf(const ir::Assign& fold);

/// The inputs that a term is, or is the product of; nothing where it is made of others. They are of one float.
std::vector<ir::VarId> inputsOf(const ir::Kernel& reduce, const Term& term);

/// Where all that an element does is to add itself to one float, or the product of two: those inputs. Nothing of others.
std::vector<ir::VarId> onlyTerm(const ir::Module& module, const ir::Kernel& reduce);

/// The value itself, or a vector of this type with a scalar in each component: so scalars are added to vectors.
ir::ExprPtr ofType(ir::Type type, ir::ExprPtr value);

/// Component `component` of a vector; a scalar itself.
ir::ExprPtr componentOf(const ir::Expr& value, unsigned component);

}  // namespace skc
