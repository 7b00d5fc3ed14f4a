// SPDX-License-Identifier: MIT
//
// The slots of a kernel (sk/native/code.hpp): its parameters and rows of neighbours whose elements a chunk has arrays for.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "ir/ir.hpp"
#include "sk/native/code.hpp"

namespace skc::native {

/// The slots of a kernel's chunks.
struct SlotPlan {
  std::vector<sk::native::Slot> slots;

  /// The first array of a slot that has this parameter and row.
  struct Place {
    std::size_t slot;
    std::size_t firstArray;
  };
  std::optional<Place> find(std::uint32_t parameter, const std::int8_t (&row)[3]) const;
  std::vector<std::size_t> firstArrays;  ///< of each slot
};

/// Inputs and outputs, and, except in folds, the rows of neighbours at constant offsets.
SlotPlan planSlots(const ir::Module& module, const ir::Kernel& kernel);

/// True of a constant offset whose row has a slot: rows farther away are gathers like any other.
bool isNear(const std::vector<std::int32_t>& offset);

/// The components of a constant offset, x first; nothing where it is not constant.
std::optional<std::vector<std::int32_t>> constantOffset(const ir::Module& module, const ir::Expr& offset);

}  // namespace skc::native
