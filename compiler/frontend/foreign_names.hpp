// SPDX-License-Identifier: MIT
//
// Names that people bring from elsewhere, and that kernels do not have.
#pragma once

#include <string_view>

namespace skc::frontend {

/// What to do in place of `name` (foreign_names.def); "" for one that is not known.
std::string_view insteadOf(std::string_view name);

}  // namespace skc::frontend
