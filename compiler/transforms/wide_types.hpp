// SPDX-License-Identifier: MIT
//
// Types with double in the place of float, and values from the one to the other.
#pragma once

#include <map>

#include "ir/ir.hpp"

namespace skc {

class WideTypes {
 public:
  explicit WideTypes(ir::Module& module) : module_(module) {}

  /// Whether the type holds a float or a vector of them; matrices and half do not count.
  bool holdsFloat(ir::Type type) const;
  /// The type itself where it holds none. Structs get a second one, "Hit_wide".
  ir::Type of(ir::Type type);

  /// A value of a type as one of of(type), and back.
  ir::ExprPtr widened(ir::ExprPtr value);
  ir::ExprPtr narrowed(ir::ExprPtr value, ir::Type to);

 private:
  ir::ExprPtr converted(ir::ExprPtr value, ir::Type to);

  ir::Module& module_;
  std::map<std::uint32_t, std::uint32_t> structs_;   ///< made of which, and which
};

}  // namespace skc
