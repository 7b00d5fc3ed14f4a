// SPDX-License-Identifier: MIT
//
// What a call of a kernel reads and writes: the layout of its outputs, which it chooses, and the operands of its programs.
// Allocates no host memory in a repeated call.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "assemble/condition.hpp"
#include "assemble/region_layout.hpp"
#include "gl_device/gl_device.hpp"
#include "gl_device/memory/kept_scratch.hpp"
#include "gl_device/memory/layout.hpp"
#include "gl_device/program/variant.hpp"
#include "sk/call.hpp"
#include "sk/program.hpp"

namespace sk {

/// The rectangles of a pass over a region of a stream. Allocates a list only for a part of a linearised
/// stream.
class DrawnRects {
 public:
  DrawnRects(const assemble::RegionLayout& domain, const Layout& layout);
  DrawnRects(const DrawnRects&) = delete;
  DrawnRects& operator=(const DrawnRects&) = delete;
  std::span<const assemble::Rect> get() const { return rects_; }

 private:
  assemble::Rect plane_{};
  std::vector<assemble::Rect> list_;
  std::span<const assemble::Rect> rects_;
};

class KernelOperands {
 public:
  /// The arguments have been checked, and the domain is not empty. Packs or unpacks streams. A DeviceScope must be open.
  /// `plan` has the passes of the kernel; null if one is enough. `shape` is that of the domain of a kernel without outputs.
  /// `box` is what is written of the domain, and `place` says of which whole it is a part.
  KernelOperands(GlDevice& device, const program::Kernel& kernel, std::span<const Argument> arguments,
                 const assemble::SpecValues& specs, const program::Plan* plan, const Shape& shape = {},
                 const Box& box = {}, const Placement& place = {});
  KernelOperands(const KernelOperands&) = delete;
  KernelOperands& operator=(const KernelOperands&) = delete;

  /// One per parameter, valid as long as this object. Those of accumulators are empty.
  std::span<const Operand> get() const { return operands_; }
  /// The first output's region, and the layout of its stream, after the call. Without outputs, those that a stream of the
  /// domain's shape would have.
  const assemble::RegionLayout& domain() const { return domain_; }
  const Layout& layout() const { return *layout_; }

 private:
  void layOut();
  void layOutLikeStream();
  bool hasOutput() const { return first_ < arguments_.size(); }
  bool isWrittenInPlace(std::size_t i) const;
  bool mayWritePacked() const;
  bool needsUnpacked(std::size_t i) const;
  Operand operandOf(std::size_t i) const;
  assemble::RegionLayout placedLayout(std::size_t gather, const assemble::RegionLayout& region) const;
  bool isPlaced() const { return place_.whole.rank() != 0; }
  bool isNeeded(std::size_t i) const { return assemble::isNeeded(kernel_.parameters[i], specs_); }
  bool isOutput(std::size_t i) const {
    return kernel_.parameters[i].role == program::Role::Output && isNeeded(i);
  }

  GlDevice& device_;
  const program::Kernel& kernel_;
  std::span<const Argument> arguments_;
  const assemble::SpecValues& specs_;
  const program::Plan* const plan_;  ///< null if one pass is enough
  KeptScratch<Operand>::Lease scratch_;
  std::vector<Operand>& operands_ = scratch_.values;
  std::size_t first_ =
      0;  ///< the first output, whose region is the domain; the number of arguments if there is none
  Shape shape_;  ///< of the domain
  const Box box_;
  const Placement place_;
  Layout newLayout_;
  const Layout* layout_ = nullptr;
  assemble::RegionLayout domain_;
};

}  // namespace sk
