// SPDX-License-Identifier: MIT
//
// Types with double instead of float, and conversions between the two.
#pragma once

#include <map>

#include "ir/ir.hpp"

namespace skc {

class WideTypes {
 public:
  explicit WideTypes(ir::Module& module) : module_(module) {}

  /// True if the type contains a float or a vector of floats; matrices and half do not count.
  bool holdsFloat(ir::Type type) const;
  /// The wide type; the type itself if it contains no float. Structs get a second one, "Hit_wide".
  ir::Type of(ir::Type type);

  /// Converts a value to its wide type, and back.
  ir::ExprPtr widened(ir::ExprPtr value);
  ir::ExprPtr narrowed(ir::ExprPtr value, ir::Type to);

 private:
  ir::ExprPtr converted(ir::ExprPtr value, ir::Type to);

  ir::Module& module_;
  std::map<std::uint32_t, std::uint32_t> structs_;   ///< original to synthesized struct
};

}  // namespace skc
