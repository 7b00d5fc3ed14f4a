// SPDX-License-Identifier: MIT
//
// Recognises reduces whose body only folds into the accumulator, or into members of it, by operators
// that are known: every statement that names the accumulator is `place op= f`, `place = place op f`
// or `place = min(place, f)`, and no f reads it. Whatever loops and branches stand around them, the
// body is then `accumulator op (something made from the element)`.
#pragma once

#include <cstdint>
#include <optional>
#include <variant>
#include <vector>

#include "ir/ir.hpp"

namespace skc {

/// An operator of a compound assignment, && or ||; or Min or Max.
using FoldOp = std::variant<ir::BinaryOp, ir::Intrinsic>;

/// Some components of the accumulator, or of a scalar or vector member of it, and their operator.
struct FoldPart {
  std::vector<std::uint32_t> members;   ///< way from the accumulator to the member
  ir::Type type;                        ///< of the member
  unsigned components;                  ///< bit i: component i
  FoldOp op;
  Loc loc;                          ///< of the first statement that folds into it
  bool isWhole() const { return components == (1U << type.width) - 1; }
};

struct FoldPattern {
  std::vector<FoldPart> parts;   ///< in the order of the statements; no component in two of them
  bool isPlain;  ///< the body is `accumulator op= element`, whole or by member, and nothing else
};

/// The pattern of the entry function of a reduce: variable 0 the element, 1 the accumulator.
std::optional<FoldPattern> recogniseFold(const ir::Function& entry);

}  // namespace skc
