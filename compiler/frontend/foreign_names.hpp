// SPDX-License-Identifier: MIT
//
// Names that people bring from elsewhere, and that kernels do not have.
#pragma once

#include <optional>
#include <string>
#include <string_view>

namespace skc::frontend {

/// What stands in for a name that kernels do not have.
struct Instead {
  std::string advice;             ///< what to do
  std::string_view word = {};     ///< a word of ours that means the same; "" where there is none
};

/// What to do in place of `name` (foreign_names.def); nothing for one that is not known.
std::optional<Instead> insteadOf(std::string_view name);

}  // namespace skc::frontend
