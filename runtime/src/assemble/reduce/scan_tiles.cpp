// SPDX-License-Identifier: MIT
#include "assemble/reduce/scan_tiles.hpp"

#include <algorithm>
#include <bit>
#include <cstddef>

#include "assemble/elements/planes.hpp"
#include "assemble/glsl/program_text.hpp"

namespace sk::assemble {

using program::Kernel;
using program::Parameter;
using program::Reduction;

namespace {

/// The bytes of shared memory that an accumulator takes, or more.
std::size_t sharedBytes(const program::Element& element) {
  std::size_t bytes = 0;
  for (const program::Field& field : element.fields) {
    const std::size_t scalar = field.scalar == program::Scalar::Double ? 8 : 4;
    bytes += scalar * std::bit_ceil(std::size_t{field.width});
  }
  return bytes;
}

std::size_t sharedBytes(const Kernel& fold) {
  std::size_t bytes = 0;
  for (const Parameter& parameter : fold.parameters) {
    if (parameter.role == program::Role::Accumulator) bytes += sharedBytes(*parameter.element);
  }
  return bytes;
}

}  // namespace

std::int32_t longestRunInTile(const Reduction& reduction, bool packed) {
  constexpr std::size_t runBytes = 64;  // a tile of such runs takes half of groupBytes
  const std::size_t bytes = sharedBytes(reduction.fold);
  if (bytes * tileGroup > groupBytes / 2) return 0;
  const std::size_t most = packed ? 4 : 16;
  return static_cast<std::int32_t>(
      std::clamp<std::size_t>(std::bit_floor(runBytes / (packed ? lanes * bytes : bytes)), 1, most));
}

bool mayChain(const Reduction& reduction) {
  constexpr std::size_t mostAccumulators = 4;
  std::size_t count = 0;
  for (const Parameter& parameter : reduction.fold.parameters) {
    if (parameter.role != program::Role::Accumulator) continue;
    const auto fields = parameter.element->fields;
    const program::Scalar scalar = fields.front().scalar;
    if (isStruct(*parameter.element) || fields.front().width != 1) return false;
    if (scalar != program::Scalar::Int && scalar != program::Scalar::Uint) return false;
    ++count;
  }
  return count <= mostAccumulators && combinesInFold(reduction);
}

bool combinesInFold(const Reduction& reduction) {
  return !reduction.addition.empty() ||
         (reduction.combine.entry == reduction.fold.entry && reduction.combine.body == reduction.fold.body);
}

}  // namespace sk::assemble
