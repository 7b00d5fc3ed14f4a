// SPDX-License-Identifier: MIT
//
// Names from other languages that kernels do not have.
#pragma once

#include <optional>
#include <string>
#include <string_view>

namespace skc::frontend {

/// What to use instead of such a name.
struct Instead {
  std::string advice;             ///< what to do
  std::string_view word = {};     ///< a word of ours that means the same; "" if there is none
};

/// The advice for `name` in foreign_names.def; nullopt if it is not there.
std::optional<Instead> insteadOf(std::string_view name);

}  // namespace skc::frontend
