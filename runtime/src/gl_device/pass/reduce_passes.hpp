// SPDX-License-Identifier: MIT
//
// The passes of one reduction on a GL device, by the assembler's schedule: from the inputs' planes through temporary ones to
// the results'. Where the results belong is reduce.cpp's business.
#pragma once

#include <cstddef>
#include <functional>
#include <span>
#include <string_view>
#include <vector>

#include "assemble/reduce/reduce_plan.hpp"
#include "assemble/region_layout.hpp"
#include "call/resolved_reduction.hpp"
#include "gl_device/gl_device.hpp"
#include "gl_device/program/variant.hpp"
#include "sk/program.hpp"

namespace sk {

/// Planes of all accumulators.
std::size_t accumulatorPlanes(const program::Kernel& fold);

/// New planes of all accumulators, in their order.
void takeAccumulators(const program::Kernel& fold, const assemble::TextureShape& shape,
                      std::string_view whatFor, PlanesLease& lease);

std::vector<RenderTarget*> pointersTo(std::span<RenderTarget> planes);

class ReducePasses {
 public:
  /// A scope of the device is open, and the programs of the call are chosen. Inputs that the reduction cannot read packed
  /// are unpacked.
  ReducePasses(GlDevice& device, const ResolvedReduction& call);

  /// Of the fold, one a parameter.
  std::span<const Operand> operands() const { return operands_; }

  /// Whether the value that is left of some elements may stay in the device's buffer of values.
  bool mayEndInBuffer() const;

  /// Folds the elements to the planes of all results, or, where there are none, stores the identities. Without targets, there is
  /// a value, which goes to the device's buffer of values. `begin` is called before the targets change, when everything is there that
  /// a driver may refuse.
  void run(const assemble::RegionLayout& result, std::span<RenderTarget* const> targets,
           const std::function<void()>& begin);

 private:
  void findOperands(std::span<const Argument> arguments, const Shape& domain);
  /// In software a pass costs as much as some thousand texels, and a few threads have enough to do with few invocations.
  assemble::ReduceLimits limitsOfPasses() const;
  /// Of so many texels that a large GPU has enough work groups anyway, longer runs leave less to the passes behind.
  std::int32_t longRunOfGroups() const;
  /// Whether work groups may fold partial results together: they share an element of each accumulator an invocation.
  bool mayGroup() const;
  /// Whether all inputs are packed and blocks made of whole texels, which are then read as such.
  bool foldsByTexel(const assemble::Index4& blocks) const;
  Operand operandOf(std::size_t i, const Argument& argument, const Shape& domain) const;
  /// That of the first input which does not repeat. Where all do, each in another dimension, there is no
  /// such place, and elements are found by their index.
  assemble::RegionLayout layoutOfElements(const assemble::Index4& shape) const;
  bool isRead(std::size_t i) const;
  /// Whether a run has to know where each of its elements is.
  bool foldsByIndex() const;
  /// The operands of the combining kernel: planes of partial results, where there are some by now, and arguments
  /// of the fold.
  std::vector<Operand> operandsOfCombine(std::span<RenderTarget> partials) const;
  /// Draws a pass, for as many of the targets at a time as the device draws to.
  void draw(const assemble::ReducePass& pass, std::span<RenderTarget> partials,
            std::span<RenderTarget* const> targets);
  /// Makes what draw() needs: programs, and framebuffers over several planes.
  void prepare(const assemble::ReducePass& pass, std::span<RenderTarget* const> targets);
  /// Throws sk::Error where there is no memory for the buffer of values.
  void bindValues();
  /// Lets the driver begin with the programs of a pass. False where they are there already.
  bool start(const assemble::ReducePass& pass);
  /// visit(variant, first, count) for as many of the planes at a time as the device draws to.
  template <class Visit>
  void forEachPart(const assemble::ReducePass& pass, std::span<const Operand> operands, Visit&& visit) const;
  /// Adds the choices that depend on the operands.
  void addAccess(assemble::ReduceVariant& variant, const program::Kernel& kernel,
                 std::span<const Operand> operands) const;

  GlDevice& device_;
  const program::Reduction& reduction_;
  const assemble::SpecValues specs_;
  std::vector<Operand> operands_;  ///< of the fold
  assemble::RegionLayout elements_;
  bool byTexel_ = false;
  const assemble::Index4 blocks_;
};

}  // namespace sk
