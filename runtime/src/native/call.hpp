// SPDX-License-Identifier: MIT
//
// The arguments of native code: where the elements of each argument lie. A stream has one array per scalar
// component of its element, row-major; a uniform argument is a stream of one element, an iterator one of two,
// its ends. Indices and extents have the fastest dimension first, as in kernels. Also how an input's extents fit a domain's.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "native/memory.hpp"
#include "sk/native/table.hpp"
#include "sk/program.hpp"
#include "sk/shape.hpp"

namespace sk {
class RowPieces;
}  // namespace sk

namespace sk::native {

using Extents = std::array<std::int64_t, 4>;

/// Elements pushed to a variable output: one array per component; none if the domain was empty.
struct Pushed {
  std::vector<ArrayMemory> arrays;
  std::int64_t count = 0;
  std::int64_t capacity = 0;  ///< elements that the arrays have room for
};

/// Indices from `low` to `high` (exclusive), in each dimension.
struct HeldIndices {
  Extents low{}, high{};
};

/// The argument for one parameter.
struct Operand {
  std::span<void* const> components;  ///< empty if the stream is omitted (sk::none)
  std::int64_t first = 0;  ///< number of the element at index 0
  Extents stride{};  ///< of the stream, in elements
  Extents extent{1, 1, 1, 1};  ///< of the region, or of the whole
  Extents multiply{1, 1, 1, 1};  ///< an element input's index is the domain's, times this,
  Extents divide{1, 1, 1, 1};  ///< divided by this
  bool holdsFloats =
      false;  ///< element inputs, results of scans: the arrays hold floats, but the code has doubles
  bool countsElements = false;  ///< iterators: advances with the element number, else with the index
  Pushed* pushed = nullptr;  ///< variable outputs
  /// Placed streams: the indices whose elements are at first + sum(index * stride). Otherwise all indices of the region.
  std::optional<HeldIndices> held = std::nullopt;
};

/// A box of a domain.
struct Part {
  Extents first{0, 0, 0, 0}, extent{1, 1, 1, 1};
};

/// A kernel over a domain.
struct Call {
  std::span<const Operand> operands;
  Extents domain{1, 1, 1, 1};
  std::span<const Table> tables = {};  ///< one per tabulated function; empty if these are computed
  /// The elements that a kernel computes, or a reduction folds; nullopt stands for the whole domain.
  std::optional<Part> part = std::nullopt;
  bool isSilent = false;  ///< printf in the kernel prints nothing

  Part computed() const { return part.value_or(Part{.extent = domain}); }
};

/// What a scan stores for each element of its domain.
struct ScanOf {
  bool isExclusive = false;  ///< the accumulators before folding it, else those after
  /// Accumulators are combined with the identity after each run (leafRounds), because those of exact sums have no room for
  /// more terms (sk/exact_digits.hpp).
  bool combinesRuns = false;
};

/// A reduction of a domain that is divided into equal blocks. Each block is folded to one element of the
/// accumulators, whose Operands describe the results.
struct ReduceCall {
  Call fold;
  Call combine;  ///< ignores its Inputs and Accumulators
  Extents block{1, 1, 1, 1};  ///< divides the domain
  std::optional<ScanOf> scan = std::nullopt;
  const RowPieces* rows = nullptr;  ///< the blocks of a one-dimensional domain, if their lengths differ
  bool holdsFloats = false;  ///< rows: all operands hold floats, but the code computes in double
};

}  // namespace sk::native

namespace sk {

/// Extents with x first; missing dimensions have extent 1.
inline native::Extents fastestFirst(const Shape& shape) {
  native::Extents extents{1, 1, 1, 1};
  for (int d = 0; d < shape.rank(); ++d) {
    extents[static_cast<std::size_t>(shape.rank() - 1 - d)] = shape[d];
  }
  return extents;
}

/// Sets how the index in an element input follows from that in the domain.
inline void fit(native::Operand& operand, program::Fit way, const native::Extents& domain) {
  for (std::size_t d = 0; d < domain.size(); ++d) {
    const std::int64_t extent = operand.extent[d];
    if (way == program::Fit::Same) {
      operand.multiply[d] = extent == 1 ? 0 : 1;
    } else {  // one of the two is 1
      operand.divide[d] = std::max<std::int64_t>(domain[d] / extent, 1);
      operand.multiply[d] = std::max<std::int64_t>(extent / domain[d], 1);
    }
  }
}

}  // namespace sk
