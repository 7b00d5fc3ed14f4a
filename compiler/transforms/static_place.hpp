// SPDX-License-Identifier: MIT
//
// Places that are known before the program runs: those made of members and at most one swizzle.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "ir/ir.hpp"

namespace skc {

struct StaticPlace {
  ir::VarId root;
  std::vector<std::uint32_t> members;     ///< way from the variable
  ir::Type type;                          ///< of the variable or member there
  std::vector<std::uint8_t> components;   ///< of it, in their order; all where there is no swizzle

  /// Bit i: component i.
  unsigned mask() const;
  bool operator==(const StaticPlace&) const = default;
};

std::optional<StaticPlace> staticPlace(const ir::Expr& expr);

}  // namespace skc
