// SPDX-License-Identifier: MIT
//
// Emits the intrinsics of the language in all lanes, as the column `native` of ir/intrinsics.def says.
#pragma once

#include <vector>

#include "ir/intrinsics.hpp"
#include "native/lanes.hpp"

namespace skc::native {

struct IntrinsicArgument {
  ir::Type type;
  Parts parts;
};

/// The components of a call's result.
Parts intrinsic(Lanes& lanes, ir::Intrinsic intrinsic, const std::vector<IntrinsicArgument>& arguments);

}  // namespace skc::native
