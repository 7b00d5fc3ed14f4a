// SPDX-License-Identifier: MIT
//
// Recognises reduces whose body only folds into accumulators, or members of them, by known operators: every
// statement that uses an accumulator is `place op= f`, `place = place op f` or `place = min(place, f)`, and
// no f reads one. Whatever its loops and branches, the body is then `accumulator op f(elements)`. A body that only folds
// the element itself, but more than once, as in `t += x; t += x;`, is not recognised: it could as well start from
// its first element, with another result. States the identities of these operators, too.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "ir/ir.hpp"

namespace skc {

/// The pattern of a reduce with this entry function. Once derive-combine has run, Reduction::pattern holds it.
std::optional<ir::FoldPattern> recogniseFold(const ir::Kernel& kernel, const ir::Function& entry);

/// True if the body only folds the element itself, but into some component more than once by one operator, as in
/// `t += x; t += x;`.
bool foldsElementTwice(const ir::Kernel& kernel, const ir::Function& entry);

/// The target that a statement of a reduce folds into, if the statement uses accumulators in no other way.
std::optional<ir::FoldTarget> foldedBy(const ir::Kernel& kernel, const ir::Stmt& stmt);

/// True for `place op= its element`, in any form, with the same member of the element.
bool foldsItsElement(const ir::Kernel& kernel, const ir::Stmt& stmt);

/// A value that a statement folding by + adds: f or g of `place += f`, `place = place + f - g`.
struct Summand {
  const ir::Expr* value;
  bool isNegative;
};
std::vector<Summand> summandsOf(const ir::Assign& fold);

/// True if a variable of the kernel's entry is an accumulator.
bool isAccumulator(const ir::Kernel& kernel, ir::VarId var);

/// True if inputs and accumulators have the same types in order, so that each accumulator has an element.
bool foldsAccumulators(const ir::Kernel& kernel);

/// The parameter of `in` of this role with the number that the accumulator has among the accumulators of `of`: of a reduce that
/// combines results, the partial result that corresponds to an accumulator, say.
ir::VarId counterpartOf(const ir::Kernel& of, ir::VarId accumulator, const ir::Kernel& in,
                        ir::ParamRole role);

// The identities of the operators that reduces fold by.

/// The identity of an associative operator of a FoldPattern, for a component type.
ir::ExprPtr neutralOf(ir::FoldOp op, ir::Scalar scalar);

/// True if folding a value twice equals folding it once, as for min: a given initial value then bounds the
/// result, but the result is always the same.
bool isIdempotent(ir::FoldOp op);

/// True if every accumulator of a reduce has an identity.
bool hasIdentities(const ir::Kernel& kernel);

}  // namespace skc
