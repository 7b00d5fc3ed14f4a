// SPDX-License-Identifier: MIT
//
// What the runtime hands to native code: where the elements of each argument lie. A stream has one array for
// each scalar component of its element, row-major; a uniform argument is a stream of one element, an
// iterator one of two, its ends. Indices and extents have the fastest dimension first, as in kernels.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "native/memory.hpp"
#include "sk/native/table.hpp"

namespace sk::native {

using Extents = std::array<std::int64_t, 4>;

/// Elements pushed to a variable output: an array for each component; none where the domain was empty.
struct Pushed {
  std::vector<ArrayMemory> arrays;
  std::int64_t count = 0;
};

/// An argument of a call, in the order of the parameters.
struct Operand {
  std::span<void* const> components;   ///< none where the stream is left out (sk::none)
  std::int64_t first = 0;              ///< number of the region's first element
  Extents stride{};                    ///< of the stream, in elements
  Extents extent{1, 1, 1, 1};          ///< of the region
  Extents multiply{1, 1, 1, 1};        ///< an element input's index is the domain's, times this,
  Extents divide{1, 1, 1, 1};          ///< divided by this
  bool holdsFloats = false;     ///< element inputs: where the code has doubles, the arrays hold floats
  bool countsElements = false;  ///< iterators: by element number, else by the index in each dimension
  Pushed* pushed = nullptr;  ///< variable outputs
};

/// A kernel over a domain.
struct Call {
  std::span<const Operand> operands;
  Extents domain{1, 1, 1, 1};
  std::span<const Table> tables = {};  ///< as the kernel's; none where their functions are computed
};

/// A reduction of a domain in equal blocks, each to one element of the accumulators, whose Operands describe
/// the results.
struct ReduceCall {
  Call fold;
  Call combine;  ///< its Inputs and Accumulators are not looked at
  Extents block{1, 1, 1, 1};  ///< divides the domain
};

}  // namespace sk::native
