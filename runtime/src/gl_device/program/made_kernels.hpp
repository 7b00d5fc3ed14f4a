// SPDX-License-Identifier: MIT
//
// Kernels that the runtime writes for a device, in as many forms as its calls need: for operations with scalars, for merging
// texels, and for calls of loops that run together. Programs are found by their kernels' addresses, so kernels are kept as long as their programs: the least recently
// used ones are deleted with them.
#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <map>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "sk/program.hpp"

namespace sk {

class GlPrograms;

/// A kernel and what it refers to.
struct MadeKernel {
  std::string body;
  std::vector<program::Parameter> parameters;
  program::Kernel kernel;

  /// Copies of names and of elements, for descriptors that may be unloaded before the kernel ends.
  std::string_view own(std::string_view name) { return names_.emplace_back(name); }
  const program::Element& own(const program::Element& element);
  std::span<const program::IntrinsicUse> own(std::vector<program::IntrinsicUse> intrinsics) {
    return intrinsics_ = std::move(intrinsics);
  }

 private:
  std::deque<std::string> names_;
  std::deque<std::vector<program::Field>> fields_;
  std::deque<program::Element> elements_;
  std::vector<program::IntrinsicUse> intrinsics_;
};

class MadeKernels {
 public:
  explicit MadeKernels(GlPrograms& owner) : owner_(owner) {}

  /// Returns the kernel with the body of `made`, which is `made` if there is none yet. It is kept while anybody holds it,
  /// and then until `most` others have been used after it.
  std::shared_ptr<const MadeKernel> keep(std::shared_ptr<const MadeKernel> made);

  std::size_t size() const { return kernels_.size(); }
  /// Sets the most kernels that are kept while nobody holds them, at least 1.
  void setMost(std::size_t most) { most_ = most; }

 private:
  struct Kept {
    std::shared_ptr<const MadeKernel> kernel;
    std::int64_t used = 0;
  };

  void makeRoom();

  GlPrograms& owner_;
  std::size_t most_ = 256;  // more than the passes of an iteration of a large loop need
  std::map<std::string_view, Kept> kernels_;  ///< by their bodies, which have all types
  std::int64_t clock_ = 0;
};

}  // namespace sk
