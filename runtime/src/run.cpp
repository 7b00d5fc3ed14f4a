// SPDX-License-Identifier: MIT
//
// sk::run: a kernel over the domain that its outputs fix. A call like one before allocates no host
// memory, unless an output cannot be drawn to where it lies.
#include <array>
#include <memory>
#include <span>
#include <vector>

#include "check.hpp"
#include "device_state.hpp"
#include "iterator.hpp"
#include "pass.hpp"
#include "plan_run.hpp"
#include "sk/call.hpp"
#include "stream_state.hpp"

namespace sk {

namespace {

using assemble::Placement;
using assemble::Rect;
using program::Kernel;
using program::Parameter;
using program::Role;

/// How the elements of an output get to where they belong.
enum class Way {
  Direct,   ///< drawn in place
  Swap,     ///< drawn to new planes, which become the stream's: the call reads the old ones
  Copy,     ///< drawn to new planes, and copied from there
};

/// The rectangles of a pass over a region of a stream; makes a list only where none is known.
class DrawnRects {
 public:
  DrawnRects(const Placement& domain, const Layout& layout) {
    if (!domain.linear) {
      plane_ = {domain.origin[0], domain.origin[1], domain.extent[0], domain.extent[1]};
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

/// One call, its arguments checked and its domain not empty.
class KernelCall {
 public:
  KernelCall(DeviceState& device, const Kernel& kernel, std::span<const Argument> arguments)
      : device_(device),
        kernel_(kernel),
        arguments_(arguments),
        specs_(specsOf(kernel, arguments)),
        operands_(device.operands) {
    operands_.resize(arguments.size());
    while (!isOutput(first_)) {
      ++first_;
    }
    for (std::size_t i = 0; i < arguments.size(); ++i) {
      operands_[i] = operandOf(i);
    }
  }

  void run() {
    const program::Plan* plan = planFor(kernel_, device_.limits);
    if (plan != nullptr) {
      drawAside(plan);
      return;
    }
    for (std::size_t i = first_; i < arguments_.size(); ++i) {
      if (isOutput(i) && wayOf(i) != Way::Direct) {
        drawAside(nullptr);
        return;
      }
    }
    for (std::size_t i = first_; i < arguments_.size(); ++i) {
      if (isOutput(i)) {
        addTargets(operands_[i].planes);
      }
    }
    draw();
  }

 private:
  Operand operandOf(std::size_t i) const {
    const Parameter& parameter = kernel_.parameters[i];
    const Argument& argument = arguments_[i];
    if (parameter.role == Role::Uniform || parameter.role == Role::Spec) {
      return {.value = argument.value};
    }
    if (parameter.role == Role::Iterator) {
      const Shape& shape = arguments_[first_].region.shape;
      Placement placement;
      placement.extent = xFirst(shape);
      placement.stride = assemble::stridesOf(placement.extent);
      return {.value = argument.value,
              .placement = placement,
              .step = stepOf(parameter, argument.value, shape),
              .rank = shape.rank()};
    }
    if (!isNeeded(i)) {
      return {};
    }
    StreamState& stream = *argument.region.stream;
    return {.placement = placementOf(argument.region, stream.layout), .planes = stream.planes};
  }

  bool isNeeded(std::size_t i) const { return assemble::isNeeded(kernel_.parameters[i], specs_); }
  bool isOutput(std::size_t i) const { return kernel_.parameters[i].role == Role::Output && isNeeded(i); }
  bool isRead(std::size_t i) const {
    const Role role = kernel_.parameters[i].role;
    return (role == Role::Input || role == Role::Gather) && isNeeded(i);
  }
  StreamState& streamOf(std::size_t i) const { return *arguments_[i].region.stream; }
  const Placement& domain() const { return operands_[first_].placement; }

  Way wayOf(std::size_t output) const {
    bool isReadToo = false;
    bool isWrittenBefore = false;
    for (std::size_t i = 0; i < arguments_.size(); ++i) {
      const bool isSame = arguments_[i].region.stream == arguments_[output].region.stream;
      isReadToo = isReadToo || (isSame && isRead(i));
      isWrittenBefore = isWrittenBefore || (isSame && isOutput(i) && i < output);
    }
    const Placement& placement = operands_[output].placement;
    if (isWrittenBefore || !haveSameTexels(placement, domain())) {
      return Way::Copy;
    }
    return !isReadToo ? Way::Direct : placement.view ? Way::Copy : Way::Swap;
  }

  void addTargets(std::span<Surface> planes) {
    for (Surface& plane : planes) {
      targets_[targetCount_++] = &plane;
    }
  }

  void draw() {
    const DrawnRects rects(domain(), streamOf(first_).layout);
    drawKernel(device_, kernel_, operands_, domain(), rects.get(),
               framebufferOf(device_, std::span(targets_).first(targetCount_)));
  }

  /// For calls of which an output is not drawn in place, and for those that take several passes. New
  /// planes lie as the domain does, or are those that the stream is to have.
  void drawAside(const program::Plan* plan) {
    std::vector<std::unique_ptr<PlanesLease>> aside(arguments_.size());
    std::vector<std::span<Surface>> drawn(arguments_.size());
    for (std::size_t i = first_; i < arguments_.size(); ++i) {
      if (!isOutput(i)) {
        continue;
      }
      drawn[i] = operands_[i].planes;
      const Way way = wayOf(i);
      if (way == Way::Direct) {
        continue;
      }
      const Layout& layout = streamOf(way == Way::Swap ? i : first_).layout;
      aside[i] = std::make_unique<PlanesLease>(device_);
      aside[i]->planes = device_.takePlanes(*streamOf(i).element, layout.width, layout.height,
                                            "an output that the kernel reads too");
      drawn[i] = aside[i]->planes;
    }
    if (plan != nullptr) {
      const DrawnRects rects(domain(), streamOf(first_).layout);
      runPlan(device_, *plan, {operands_, drawn, domain(), streamOf(first_).layout, rects.get()});
    } else {
      for (const std::span<Surface> planes : drawn) {
        addTargets(planes);
      }
      draw();
    }
    for (std::size_t i = first_; i < arguments_.size(); ++i) {
      if (aside[i]) {
        putInPlace(i, aside[i]->planes);
      }
    }
  }

  void putInPlace(std::size_t output, std::vector<Surface>& planes) {
    StreamState& stream = streamOf(output);
    if (wayOf(output) == Way::Swap) {
      std::swap(stream.planes, planes);
    } else {
      copyRegion(device_, *stream.element, planes, domain(), stream.planes, operands_[output].placement);
    }
  }

  DeviceState& device_;
  const Kernel& kernel_;
  std::span<const Argument> arguments_;
  const assemble::SpecValues specs_;
  std::vector<Operand>& operands_;
  std::size_t first_ = 0;                               ///< output: its region is the domain
  std::array<Surface*, gl::maxDrawBuffers> targets_{};
  std::size_t targetCount_ = 0;
};

}  // namespace

void run(const Kernel& kernel, std::span<const Argument> arguments) {
  DeviceState* device = checkCall(kernel, arguments);
  if (device == nullptr) {
    return;
  }
  const DeviceScope scope(*device);
  KernelCall(*device, kernel, arguments).run();
}

}  // namespace sk
