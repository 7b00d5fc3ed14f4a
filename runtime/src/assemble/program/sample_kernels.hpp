// SPDX-License-Identifier: MIT
//
// Descriptors like those that the compiler writes, for the tests of this folder.
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
/// A five-point stencil.
extern const program::Kernel diffuse;
/// Pushes the positive elements of x to r.
extern const program::Kernel keepPositive;
/// A sum; an associative, noncommutative operation on structs; a fold with a separate combining kernel; and a
/// fold of two inputs into two accumulators, with a uniform, a gather and indices.
extern const program::Reduction sum, firstHit, countTrue, weigh;

/// A kernel that reads and writes elements of a type in all possible ways: an input, a gather of a given rank
/// and boundary with sk_at and sk_near, and an output, with all index functions.
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
