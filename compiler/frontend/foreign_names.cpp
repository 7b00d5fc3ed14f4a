// SPDX-License-Identifier: MIT
#include "frontend/foreign_names.hpp"

namespace skc::frontend {

std::string_view insteadOf(std::string_view name) {
#define SKC_FOREIGN_NAME(known, advice) \
  if (name == known) return advice;
#include "frontend/foreign_names.def"
#undef SKC_FOREIGN_NAME
  return {};
}

}  // namespace skc::frontend
