// SPDX-License-Identifier: MIT
//
// Descriptors as the compiler would write them, for the tests of this folder.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "sk/program.hpp"

namespace sk::assemble::samples {

extern const program::Element floatElement, float3Element, intElement, int3Element, uint2Element, boolElement,
    bool3Element, hitElement;

/// v = a * x + y.
extern const program::Kernel saxpy;
/// Five-point stencil.
extern const program::Kernel diffuse;
/// Sum and an associative operation on structs that does not commute; a fold that another kernel combines; one of
/// two inputs to two accumulators, with a uniform, a gather and indices.
extern const program::Reduction sum, firstHit, countTrue, weigh;

/// A kernel that reads and writes elements of a type in every way that there is: an input, a gather
/// of a rank and boundary by sk_at and sk_near, and an output, with all the index functions.
class EveryAccess {
 public:
  EveryAccess(const program::Element& element, std::string_view border, int rank, program::Boundary boundary,
              int reach);
  EveryAccess(const EveryAccess&) = delete;
  EveryAccess& operator=(const EveryAccess&) = delete;

  const program::Kernel& kernel() const { return kernel_; }

 private:
  std::string body_;
  std::vector<program::Parameter> parameters_;
  program::Kernel kernel_;
};

}  // namespace sk::assemble::samples
