// SPDX-License-Identifier: MIT
//
// GlDevice::run: runs a kernel over the domain that its outputs determine. A repeated call allocates no host
// memory, unless an output cannot be drawn in place.
#include <span>
#include <vector>

#include "call/check_argument.hpp"
#include "call/precision.hpp"
#include "call/resolved_call.hpp"
#include "gl_device/append/append_call.hpp"
#include "gl_device/gl_device.hpp"
#include "gl_device/gl_stream.hpp"
#include "gl_device/pass/multipass_plan.hpp"
#include "gl_device/pass/output_targets.hpp"
#include "gl_device/pass/pass.hpp"

namespace sk {

namespace {

using assemble::Rect;
using assemble::RegionLayout;
using program::Kernel;
using program::Parameter;
using program::Role;

/// The rectangles of a pass over a region of a stream. Allocates a list only for a part of a linearised
/// stream.
class DrawnRects {
 public:
  DrawnRects(const RegionLayout& domain, const Layout& layout) {
    if (!domain.linear) {
      const RegionLayout texels = domain.packed ? assemble::texelsOf(domain) : domain;
      plane_ = {texels.origin[0], texels.origin[1], texels.extent[0], texels.extent[1]};
      rects_ = {&plane_, 1};
    } else if (!domain.view) {
      rects_ = layout.draws;
    } else {
      list_ = assemble::drawnTexels(domain);
      rects_ = list_;
    }
  }
  DrawnRects(const DrawnRects&) = delete;
  DrawnRects& operator=(const DrawnRects&) = delete;
  std::span<const Rect> get() const { return rects_; }

 private:
  Rect plane_{};
  std::vector<Rect> list_;
  std::span<const Rect> rects_;
};

/// One call with checked arguments and a nonempty domain.
class KernelCall {
 public:
  KernelCall(GlDevice& device, const ResolvedCall& call)
      : device_(device),
        kernel_(call.kernel),
        arguments_(call.arguments),
        specs_(call.specs),
        plan_(call.plan),
        operands_(device.operands) {
    operands_.resize(arguments_.size());
    while (!isOutput(first_)) {
      ++first_;
    }
    layOut();
    for (std::size_t i = 0; i < arguments_.size(); ++i) {
      operands_[i] = operandOf(i);
    }
  }

  void run() {
    const Layout& layout = *layout_;
    OutputTargets targets(device_, kernel_, arguments_, specs_, operands_, domain_, layout);
    const DrawnRects rects(domain_, layout);
    if (plan_ != nullptr) {
      const std::vector<std::span<RenderTarget>> drawn = targets.planesOfOutputs();
      runPlan(device_, *plan_, {operands_, drawn, domain_, layout, rects.get()}, [&] { targets.begin(); });
    } else {
      KernelProgram& program = device_.programs().kernelProgram(kernel_, operands_, domain_);
      const PreparedPass pass = preparedPass(device_, program, targets.planes());
      targets.begin();
      runKernel(device_, pass, kernel_, operands_, domain_, rects.get(), targets.planes());
    }
    targets.putInPlace();
  }

 private:
  /// Chooses the layout of the outputs: packed if possible. Streams that are written only in part keep their
  /// layout, or are unpacked.
  void layOut() {
    const StreamRegion& region = arguments_[first_].region;
    GlStream& stream = glStream(region);
    const bool packs = mayWritePacked();
    for (std::size_t i = 0; i < arguments_.size(); ++i) {
      if (needsUnpacked(i) || (!packs && isWrittenInPlace(i))) glStream(arguments_[i].region).unpack();
    }
    layout_ = &stream.layout;
    if (stream.layout.whole.packed != packs) {
      newLayout_ = layoutOf(stream.shape, device_.textureLimits(), packs);
      layout_ = &newLayout_;
    }
    domain_ = regionLayoutOf(region, *layout_);
  }

  /// Whether an output's planes cannot be replaced, because the output or the domain is only a part of a
  /// stream.
  bool isWrittenInPlace(std::size_t i) const {
    const auto isPart = [](const StreamRegion& region) { return region.shape != region.stream->shape; };
    return isOutput(i) && (isPart(arguments_[i].region) || isPart(arguments_[first_].region));
  }

  /// Whether the outputs can be written packed.
  bool mayWritePacked() const {
    bool may = plan_ == nullptr && assemble::mayWritePacked(kernel_);
    for (std::size_t i = 0; may && i < arguments_.size(); ++i) {
      if (!isOutput(i)) continue;
      const StreamRegion& region = arguments_[i].region;
      const GlStream& stream = glStream(region);
      may = stream.canPack();
      if (may && isWrittenInPlace(i)) {
        may = stream.layout.whole.packed && assemble::isWholeTexels(regionLayoutOf(region, stream.layout));
      }
    }
    return may;
  }

  /// Whether an argument must be unpacked before it is read: plans and linear filters do not support packed
  /// texels.
  bool needsUnpacked(std::size_t i) const {
    const Role role = kernel_.parameters[i].role;
    const bool isRead = (role == Role::Input || role == Role::Gather) && isNeeded(i);
    return isRead && (plan_ != nullptr || assemble::mayFilter(kernel_.parameters[i]));
  }

  Operand operandOf(std::size_t i) const {
    const Parameter& parameter = kernel_.parameters[i];
    const Argument& argument = arguments_[i];
    if (parameter.role == Role::Uniform) return uniformOperand(argument);
    if (parameter.role == Role::Spec) return {.value = argument.value};
    if (parameter.role == Role::Iterator) {
      return iteration(parameter, argument.value, arguments_[first_].region.shape);
    }
    if (!isNeeded(i)) {
      return {};
    }
    return regionOperand(argument, arguments_[first_].region.shape);
  }

  bool isNeeded(std::size_t i) const { return assemble::isNeeded(kernel_.parameters[i], specs_); }
  bool isOutput(std::size_t i) const { return kernel_.parameters[i].role == Role::Output && isNeeded(i); }

  GlDevice& device_;
  const Kernel& kernel_;
  std::span<const Argument> arguments_;
  const assemble::SpecValues& specs_;
  const program::Plan* const plan_;  ///< null if one pass is enough
  std::vector<Operand>& operands_;
  std::size_t first_ = 0;  ///< the first output, whose region is the domain
  Layout newLayout_;
  const Layout* layout_ = nullptr;  ///< of the first output's stream, after the call
  RegionLayout domain_;
};

}  // namespace

void GlDevice::run(const ResolvedCall& call) {
  checkOptions(call.kernel, call.options);
  runUnchecked(call);
}

void GlDevice::runUnchecked(const Kernel& kernel, std::span<const Argument> arguments,
                            const CallOptions& options) {
  runUnchecked(resolveCall(kernel, arguments, limits, options));
}

void GlDevice::runUnchecked(const ResolvedCall& called) {
  const ResolvedCall call = called.of(precisionVariant(called.kernel, called.options), limits);
  const assemble::Stage stage =
      stageOf(call.kernel, classOf(call.kernel, call.options.order), call.options, call.domain.size());
  const DeviceScope scope(*this);
  const gl::LabelGroup group(labels, called.kernel.name);
  selectPrograms(call.options, stage);
  checkStorages(call.kernel, call.arguments, call.specs, call.plan);
  if (!hasAppendOutputs(call.kernel)) {
    KernelCall(*this, call).run();
  } else if (call.domain.size() == 0) {
    runOverNothing(call);
  } else {
    runWithAppendOutputs(*this, call);
  }
}

}  // namespace sk
