// SPDX-License-Identifier: MIT
//
// Recognises reduces whose body only folds into the accumulators, or into members of them, by operators
// that are known: every statement that names an accumulator is `place op= f`, `place = place op f`
// or `place = min(place, f)`, and no f reads one. Whatever loops and branches stand around them, the
// body is then `accumulator op (something made from the elements)`.
#pragma once

#include <cstdint>
#include <optional>
#include <variant>
#include <vector>

#include "ir/ir.hpp"

namespace skc {

/// An operator of a compound assignment, && or ||; or Min or Max.
using FoldOp = std::variant<ir::BinaryOp, ir::Intrinsic>;

/// Some components of an accumulator, or of a scalar, vector or matrix member of one, and their operator.
struct FoldPart {
  ir::VarId accumulator;
  std::vector<std::uint32_t> members;   ///< way from the accumulator to the member
  ir::Type type;                        ///< of the member
  unsigned components;                  ///< bit i: component i
  FoldOp op;
  Loc loc;                          ///< of the first statement that folds into it
  bool isWhole() const { return components == (1U << type.width) - 1; }
};

struct FoldPattern {
  std::vector<FoldPart> parts;   ///< in the order of the statements; no component in two of them
  bool isPlain;  ///< the body is `accumulator op= its element`, whole or by member, and nothing else
};

/// The pattern of a reduce with this entry function.
std::optional<FoldPattern> recogniseFold(const ir::Kernel& kernel, const ir::Function& entry);

/// What a statement of a reduce folds into an accumulator, if that is all it does with them.
std::optional<FoldPart> foldedBy(const ir::Kernel& kernel, const ir::Stmt& stmt);

/// What such a statement adds: f and g of `place += f`, `place = place + f - g`. It folds by +.
struct Summand {
  const ir::Expr* value;
  bool isNegative;
};
std::vector<Summand> summandsOf(const ir::Assign& fold);

/// Whether its inputs have the types of its accumulators, one by one, so that each accumulator has an element.
bool foldsAccumulators(const ir::Kernel& kernel);

/// Of such a reduce: the input that stands where an accumulator does among them.
ir::VarId elementOf(const ir::Kernel& kernel, ir::VarId accumulator);

}  // namespace skc
