// SPDX-License-Identifier: MIT
//
// Where a pass draws the element outputs of a call, or the accumulators of a reduction: in place if they have
// the layout of the domain and the call does not read them, else to new planes, which are swapped with the
// stream's or copied to them afterwards.
#pragma once

#include <array>
#include <memory>
#include <span>
#include <vector>

#include "assemble/condition.hpp"
#include "device/write_scope.hpp"
#include "gl_device/gl_device.hpp"
#include "gl_device/gl_stream.hpp"
#include "gl_device/memory/layout.hpp"
#include "sk/call.hpp"
#include "sk/program.hpp"

namespace sk {

class OutputTargets {
 public:
  /// The pass is drawn over `domain`, a region of a stream with the layout `layout`, or a box of it. The arguments have
  /// been checked. Throws sk::Error if new planes are needed and memory is exhausted.
  OutputTargets(GlDevice& device, const program::Kernel& kernel, std::span<const Argument> arguments,
                const assemble::SpecValues& specs, std::span<const Operand> operands,
                const assemble::RegionLayout& domain, const Layout& layout, const Box& box = {});

  /// The planes to draw to, in the order of outputs. Only for kernels that run in one pass.
  std::span<RenderTarget* const> planes() const { return std::span(targets_).first(count_); }
  void add(RenderTarget& plane) {
    if (count_ < targets_.size()) {
      targets_[count_] = &plane;
    }
    ++count_;
  }
  /// The planes to draw to, one entry per argument; empty if the argument is not an output.
  std::vector<std::span<RenderTarget>> planesOfOutputs() const;

  /// Must be called before passes draw: the outputs that are drawn in place change from here on, until putInPlace().
  void begin() noexcept { drawnInPlace_.begin(); }
  /// Moves outputs that were drawn to new planes to their streams; passes must not read the old elements any
  /// more. Copies come first, because they may fail.
  void putInPlace() {
    copy();
    exchange();
  }
  void copy();
  void exchange() noexcept;

 private:
  /// How the elements of an output reach its stream.
  enum class Placement {
    Direct,  ///< drawn in place
    /// Drawn to new planes, which replace the stream's: the call reads these, or they have another layout.
    Swap,
    Copy,  ///< drawn to new planes, and copied from there to the stream's
  };

  /// Whether an argument is an element output or an accumulator, and needed. A reduction may leave out the outputs of
  /// its fold.
  bool isOutput(std::size_t i) const {
    const program::Role role = kernel_.parameters[i].role;
    return arguments_[i].region.stream != nullptr &&
           (role == program::Role::Output || role == program::Role::Accumulator) && isNeeded(i);
  }
  /// The elements that are written, in new planes and in the output's stream.
  assemble::RegionLayout drawnPart(std::size_t output) const;
  assemble::RegionLayout writtenPart(std::size_t output) const;
  bool isNeeded(std::size_t i) const { return assemble::isNeeded(kernel_.parameters[i], specs_); }
  Placement placementOf(std::size_t output) const;
  void addNewPlanes(std::size_t output);
  /// The new planes of an output that is not drawn in place.
  struct NewPlanes {
    explicit NewPlanes(GlDevice& device) : drawn(device.memory()) {}

    PlanesLease drawn;
    Layout layout;  ///< of the stream after Placement::Swap
  };

  GlDevice& device_;
  const program::Kernel& kernel_;
  std::span<const Argument> arguments_;
  const assemble::SpecValues& specs_;
  std::span<const Operand> operands_;
  const assemble::RegionLayout& domain_;
  const Layout& layout_;
  const Box box_;
  std::array<RenderTarget*, gl::maxDrawBuffers> targets_{};
  std::size_t count_ = 0;
  WriteScope drawnInPlace_, copied_;
  std::vector<std::unique_ptr<NewPlanes>> newPlanes_;  ///< one per argument, null if drawn in place; or empty
};

}  // namespace sk
