// SPDX-License-Identifier: MIT
//
// Streams whose planes hold floats in another precision than the kernel declares (sk::Storage): what an element is
// then, and kernels that read and write such streams.
#pragma once

#include <memory>
#include <span>
#include <vector>

#include "assemble/assemble.hpp"
#include "sk/program.hpp"

namespace sk::assemble {

/// An element as a stream holds it, with halves or doubles in the place of floats: laid out in host memory in the same
/// order, without gaps. Never moved, because `element` refers to `fields`.
struct HeldElement {
  HeldElement(const program::Element& declared, Storage storage);
  HeldElement(const HeldElement&) = delete;
  HeldElement& operator=(const HeldElement&) = delete;

  std::vector<program::Field> fields;
  program::Element element;
};

/// Whether an element has floats that a stream may hold otherwise.
bool holdsFloats(const program::Element& element);

/// A kernel whose streams hold what `access` says, one entry a parameter; the kernel itself where that is what it declares.
class HeldKernel {
 public:
  HeldKernel(const program::Kernel& kernel, std::span<const StreamAccess> access);
  HeldKernel(const HeldKernel&) = delete;
  HeldKernel& operator=(const HeldKernel&) = delete;

  const program::Kernel& kernel() const { return kernel_; }

 private:
  program::Kernel kernel_;
  std::vector<program::Parameter> parameters_;
  std::vector<std::unique_ptr<HeldElement>> elements_;
};

}  // namespace sk::assemble
