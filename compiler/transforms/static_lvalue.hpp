// SPDX-License-Identifier: MIT
//
// Lvalues that are known at compile time: members and at most one swizzle of a variable.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "ir/ir.hpp"

namespace skc {

struct StaticLValue {
  ir::VarId root;
  std::vector<std::uint32_t> members;     ///< path from the variable
  ir::Type type;                          ///< of the variable or member
  std::vector<std::uint8_t> components;   ///< selected components, in order; all if there is no swizzle

  /// Bit i is set for component i.
  unsigned mask() const;
  bool operator==(const StaticLValue&) const = default;
};

std::optional<StaticLValue> staticLValue(const ir::Expr& expr);

}  // namespace skc
