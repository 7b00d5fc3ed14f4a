// SPDX-License-Identifier: MIT
#include "frontend/foreign_names.hpp"

#include <fmt/format.h>

namespace skc::frontend {

std::optional<Instead> insteadOf(std::string_view name) {
#define SKC_FOREIGN_NAME(known, advice) \
  if (name == known) return Instead{advice};
#define SKC_FOREIGN_WORD(known, ours) \
  if (name == known) return Instead{fmt::format("use {}", ours), ours};
#include "frontend/foreign_names.def"
  return std::nullopt;
}

}  // namespace skc::frontend
