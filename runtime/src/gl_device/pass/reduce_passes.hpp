// SPDX-License-Identifier: MIT
//
// Runs the passes of one reduction on a GL device, by the assembler's schedule: from the inputs' planes
// through temporaries to the results' planes, which reduce.cpp chooses.
#pragma once

#include <cstddef>
#include <functional>
#include <span>
#include <string_view>
#include <vector>

#include "assemble/program/texture_units.hpp"
#include "assemble/reduce/reduce_plan.hpp"
#include "assemble/region_layout.hpp"
#include "call/resolved_call.hpp"
#include "gl_device/gl_device.hpp"
#include "gl_device/program/variant.hpp"
#include "sk/program.hpp"

namespace sk {

/// The bytes of a plane in PassBuffer::Values, four components of 32 bits, and of the buffer.
inline constexpr std::size_t valuePlaneBytes = 16, valueBytes = valuePlaneBytes * gl::maxImageUnits;

/// Adds new planes for all accumulators, in order, to `lease`.
void takeAccumulators(const program::Kernel& fold, const assemble::TextureShape& shape,
                      std::string_view whatFor, PlanesLease& lease);

std::vector<RenderTarget*> pointersTo(std::span<RenderTarget> planes);

class RowsState;

class ReducePasses {
 public:
  /// Unpacks the inputs unless the reduction can read all of them by packed texels. A DeviceScope must be
  /// open, and GlPrograms::select() must have been called.
  ReducePasses(GlDevice& device, const ResolvedReduction& call);

  /// The operands of the fold, one per parameter.
  std::span<const Operand> operands() const { return operands_; }

  /// Whether a reduction of a nonempty domain to a value may write it to the device's value buffer.
  bool mayEndInBuffer() const;

  /// Folds the elements and writes the results, or the identities if the domain is empty, to `targets`: the
  /// planes of all results, which have the layout `result`. If there are no targets, writes a value to the
  /// device's value buffer. Calls begin() before the targets change, after everything that may fail; throws
  /// sk::Error before that.
  void run(const assemble::RegionLayout& result, std::span<RenderTarget* const> targets,
           const std::function<void()>& begin);
  /// Folds each row of the domain and writes the results, as run() does. `rows` has its tables.
  void foldRows(const RowsState& rows, const assemble::RegionLayout& result,
                std::span<RenderTarget* const> targets, const std::function<void()>& begin);
  /// Scans each row of the domain, which is not empty, as scan() does.
  void scanRows(const RowsState& rows, const assemble::RegionLayout& result,
                std::span<RenderTarget* const> targets, bool isExclusive, const std::function<void()>& begin);

  /// Whether a scan also writes packed texels: its results must not be unpacked then.
  bool scansByTexel() const { return isScan_ && byTexel_; }
  /// Scans the elements, which are not none, along lines, to `targets`. Calls begin() like run().
  void scan(const assemble::RegionLayout& result, std::span<RenderTarget* const> targets, bool isExclusive,
            const std::function<void()>& begin);

 private:
  /// What a pass reads.
  struct Source {
    std::span<RenderTarget> partials = {};  ///< of passes over partial results
    std::span<RenderTarget> carries = {};  ///< of passes of scans that continue from them
    std::span<const Operand> tables = {};  ///< of passes over rows
  };
  void findOperands(std::span<const Argument> arguments, const Shape& domain);
  /// The limits for planReduction().
  assemble::ReduceLimits limitsOfPasses() const;
  /// ReduceLimits::longRun for dispatches. If there are enough texels to occupy a large GPU, long runs leave
  /// fewer partial results to later passes.
  std::int32_t longRunOfGroups() const;
  /// Whether work groups may fold partial results together: their shared memory must have room for the
  /// accumulators of all invocations.
  bool mayGroup() const;
  /// Whether a scan in one pass has buffers besides its images.
  bool mayChain() const;
  /// Whether runs step by packed texels: all inputs are packed, and blocks consist of whole texels.
  bool foldsByTexel(const assemble::Index4& blocks) const;
  /// Whether work groups fold blocks: these have enough elements side by side for their invocations.
  bool foldsByGroups() const;
  /// Whether these read whole texels: all inputs are packed, and repeat in no block.
  bool readsTexelsTogether() const;
  /// Whether runs of a scan do: its results, too, are packed, and lines are whole texels that are consecutive.
  bool mayScanByTexel(std::span<const Argument> arguments) const;
  Operand operandOf(std::size_t i, const Argument& argument, const Shape& domain) const;
  /// The region layout of the first input that has the shape of the domain. If there is none, for example
  /// because all inputs are broadcast, only the extent of the result is meaningful, and elements are read by
  /// index.
  assemble::RegionLayout layoutOfElements(const assemble::Index4& shape) const;
  bool isRead(std::size_t i) const;
  /// Whether runs need the index of each element: the fold uses it, or the inputs' layouts differ.
  bool foldsByIndex() const;
  /// The operands of the combining kernel: the planes of partial results, and operands of the fold.
  /// `partials` may be empty to choose a program.
  std::vector<Operand> operandsOfCombine(std::span<RenderTarget> partials) const;
  /// The operands of the accumulators' results of earlier runs (assemble::ContinuedKernel).
  void addCarries(std::vector<Operand>& operands, std::span<RenderTarget> carries) const;
  /// A pass over rows at a level: it reads elements, or partial results of this layout.
  assemble::ReducePass passOverRows(const assemble::RegionLayout& partials, bool ofElements) const;
  /// Whether all inputs are packed, and begin at the same component of a texel.
  bool beginAtOneLane() const;
  /// Writes the identities, since there are no elements.
  void writeIdentities(const assemble::RegionLayout& result, std::span<RenderTarget* const> targets,
                       const std::function<void()>& begin);
  /// Draws a pass, once for each group of targets that the device can draw to together.
  void draw(const assemble::ReducePass& pass, const Source& source, std::span<RenderTarget* const> targets);
  /// Makes the driver start compiling the programs of all passes, up to the first that exists.
  void startAll(std::span<const assemble::ReducePass> passes);
  /// Prepares what draw() needs: programs, and framebuffers over several planes. Throws sk::Error if the
  /// driver rejects one.
  void prepare(const assemble::ReducePass& pass, std::span<RenderTarget* const> targets);
  /// Binds the buffer of a chained scan. Throws sk::Error if memory is exhausted.
  void bindChain(const assemble::ReducePass& pass);
  /// Makes the driver start compiling the programs of a pass. False if they exist already.
  bool start(const assemble::ReducePass& pass);
  /// Calls visit(variant, first, count) for each group of planes that the device can draw to together.
  template <class Visit>
  void forEachPart(const assemble::ReducePass& pass, std::span<const Operand> operands, Visit&& visit) const;
  /// Sets the choices of a variant that depend on the operands.
  void addAccess(assemble::ReduceVariant& variant, const program::Kernel& kernel,
                 std::span<const Operand> operands) const;

  GlDevice& device_;
  const program::Reduction& reduction_;
  const assemble::SpecValues specs_;
  std::vector<Operand> operands_;  ///< of the fold
  assemble::RegionLayout elements_;
  const bool isScan_;
  const bool isInRows_;  ///< of different lengths
  const bool ofDigits_;  ///< folds the terms of an exact sum
  const FoldedBox placed_;
  bool byGroups_ = false;
  bool byTexel_ = false;
  const assemble::Index4 blocks_;
};

}  // namespace sk
