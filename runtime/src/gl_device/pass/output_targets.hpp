// SPDX-License-Identifier: MIT
//
// Where a pass draws the element outputs of a call: in place where they lie as the domain does and nobody
// reads them, else aside, from where they are brought to their places afterwards.
#pragma once

#include <array>
#include <memory>
#include <span>
#include <vector>

#include "assemble/condition.hpp"
#include "gl_device/gl_device.hpp"
#include "gl_device/gl_stream.hpp"
#include "gl_device/memory/layout.hpp"
#include "sk/call.hpp"
#include "sk/program.hpp"

namespace sk {

class OutputTargets {
 public:
  /// `domain` and `layout`: what the pass is drawn over. The arguments have been checked.
  OutputTargets(GlDevice& device, const program::Kernel& kernel, std::span<const Argument> arguments,
                const assemble::SpecValues& specs, std::span<const Operand> operands,
                const assemble::RegionLayout& domain, const Layout& layout);

  /// Planes to draw to, in the order of outputs; for kernels that one pass writes.
  std::span<RenderTarget* const> planes() const { return std::span(targets_).first(count_); }
  void add(RenderTarget& plane) {
    if (count_ < targets_.size()) {
      targets_[count_] = &plane;
    }
    ++count_;
  }
  /// The same, output by output: empty where an argument is none.
  std::vector<std::span<RenderTarget>> planesOfOutputs() const;

  /// From here on, passes write outputs in place: these are broken until putInPlace().
  void begin() noexcept;
  /// Brings what was drawn aside to its place, once nothing reads the old elements any more. All copies come first, since they may
  /// fail.
  void putInPlace() {
    copy();
    exchange();
  }
  void copy();
  void exchange() noexcept;

 private:
  /// How the elements of an output get to where they belong.
  enum class Way {
    Direct,  ///< drawn in place
    Swap,  ///< drawn to new planes, which become the stream's: the call reads the old ones, or they lie otherwise
    Copy,  ///< drawn to new planes, and copied from there
  };

  /// Of a reduction: an accumulator.
  bool isOutput(std::size_t i) const {
    const program::Role role = kernel_.parameters[i].role;
    return (role == program::Role::Output || role == program::Role::Accumulator) && isNeeded(i);
  }
  bool isNeeded(std::size_t i) const { return assemble::isNeeded(kernel_.parameters[i], specs_); }
  Way wayOf(std::size_t output) const;
  void addAside(std::size_t output);
  /// What an output is drawn to, if that is not its place.
  struct Aside {
    explicit Aside(GlDevice& device) : drawn(device) {}

    PlanesLease drawn;
    Layout layout;  ///< Way::Swap
  };

  GlDevice& device_;
  const program::Kernel& kernel_;
  std::span<const Argument> arguments_;
  const assemble::SpecValues& specs_;
  std::span<const Operand> operands_;
  const assemble::RegionLayout& domain_;
  const Layout& layout_;
  std::array<RenderTarget*, gl::maxDrawBuffers> targets_{};
  std::size_t count_ = 0;
  std::vector<std::unique_ptr<Aside>> aside_;  ///< one an argument, or none at all
};

}  // namespace sk
