// SPDX-License-Identifier: MIT
#include "native/lane_count.hpp"

#include "analysis/stream_uses.hpp"
#include "ir/reach.hpp"
#include "native/leaves.hpp"

namespace skc::native {

using namespace ir;

std::uint32_t laneCount(const Module& module, const Kernel& kernel, sk::native::Real real,
                        const CpuLevel& level) {
  const std::uint32_t bits = real == sk::native::Real::Float ? 32 : 64;
  const std::uint32_t one = level.vectorBits / bits;
  std::size_t scalars = 0;
  for (const FunctionId id : functionsOf(module, kernel)) {
    for (const Variable& variable : module.functions[id].variables)
      scalars += componentCount(module, variable.type);
  }
  // a chain of dependent operations leaves units idle; a second vector fills them
  constexpr std::size_t few = 16;
  const bool waits = analysis::streamUses(module, kernel).loops;
  return waits && scalars <= few ? 2 * one : one;
}

}  // namespace skc::native
