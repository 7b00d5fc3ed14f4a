// SPDX-License-Identifier: MIT
//
// Streams whose planes hold floats in another precision than the kernel declares (sk::Storage): their
// elements, and the kernels that read and write them.
#pragma once

#include <memory>
#include <span>
#include <vector>

#include "assemble/assemble.hpp"
#include "sk/program.hpp"

namespace sk::assemble {

/// A stream's element, with halves or doubles instead of floats: the same order in host memory, without gaps.
/// Not movable, because `element` refers to `fields`.
struct HeldElement {
  HeldElement(const program::Element& declared, Storage storage);
  HeldElement(const HeldElement&) = delete;
  HeldElement& operator=(const HeldElement&) = delete;

  std::vector<program::Field> fields;
  program::Element element;
};

/// Whether an element has floats, which a stream may store differently.
bool holdsFloats(const program::Element& element);

/// A kernel for streams with the storage in `access`, one entry per parameter; the kernel itself if that is
/// as declared.
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
