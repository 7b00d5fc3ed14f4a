// SPDX-License-Identifier: MIT
//
// How a kernel's functions use its streams: the flags of program::Parameter and program::Kernel.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "ir/ir.hpp"

namespace skc::analysis {

struct StreamUse {
  bool index = false;
  bool extent = false;
  bool at = false;
  bool near = false;
  bool sample = false;
  std::int32_t reach = -1;   ///< largest |offset| of constant neighbour reads; -1 if one is not constant
};

struct StreamUses {
  std::vector<StreamUse> params;
  bool domainIndex = false;
  bool domainExtent = false;   ///< asked for where no parameter has the domain's shape
  bool loops = false;   ///< has a loop with a data-dependent trip count
};

StreamUses streamUses(const ir::Module& module, const ir::Kernel& kernel);

/// The largest |component| of a neighbour's offset; nullopt if a component is not constant.
std::optional<std::int32_t> reachOf(const ir::Module& module, const ir::Expr& offset);

/// The parameter whose shape is the domain's: the first output, or params.size() if there is none.
std::uint32_t domainParam(const ir::Kernel& kernel);

}  // namespace skc::analysis
