// SPDX-License-Identifier: MIT
//
// sk::run: a kernel over the domain that its outputs fix. A call like one before allocates no host
// memory, unless an output cannot be drawn to where it lies.
#include <span>
#include <vector>

#include "check.hpp"
#include "check_argument.hpp"
#include "gl_device.hpp"
#include "gl_stream.hpp"
#include "iterator.hpp"
#include "output_targets.hpp"
#include "pass.hpp"
#include "plan_run.hpp"
#include "precision.hpp"
#include "sink_call.hpp"
#include "sk/call.hpp"

namespace sk {

namespace {

using assemble::Placement;
using assemble::Rect;
using program::Kernel;
using program::Parameter;
using program::Role;

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
  KernelCall(GlDevice& device, const Kernel& kernel, std::span<const Argument> arguments)
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
    const Layout& layout = glStream(arguments_[first_].region).layout;
    OutputTargets targets(device_, kernel_, arguments_, specs_, operands_, domain(), layout);
    const DrawnRects rects(domain(), layout);
    if (const program::Plan* plan = planFor(kernel_, device_.limits)) {
      const std::vector<std::span<Surface>> drawn = targets.planesOfOutputs();
      runPlan(device_, *plan, {operands_, drawn, domain(), layout, rects.get()});
    } else {
      drawKernel(device_, kernel_, operands_, domain(), rects.get(), targetOf(device_, targets.planes()));
    }
    targets.putInPlace();
  }

 private:
  Operand operandOf(std::size_t i) const {
    const Parameter& parameter = kernel_.parameters[i];
    const Argument& argument = arguments_[i];
    if (parameter.role == Role::Uniform || parameter.role == Role::Spec) {
      return {.value = argument.value};
    }
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
  const Placement& domain() const { return operands_[first_].placement; }

  GlDevice& device_;
  const Kernel& kernel_;
  std::span<const Argument> arguments_;
  const assemble::SpecValues specs_;
  std::vector<Operand>& operands_;
  std::size_t first_ = 0;                               ///< output: its region is the domain
};

}  // namespace

void GlDevice::run(const Kernel& kernel, std::span<const Argument> arguments, const CallOptions& options) {
  checkOptions(kernel, options);
  runUnchecked(kernel, arguments, options);
}

void GlDevice::runUnchecked(const Kernel& kernel, std::span<const Argument> arguments,
                            const CallOptions& options) {
  const DeviceScope scope(*this);
  const gl::LabelGroup group(labels, kernel.name);
  choose(options);
  const Kernel& form = formOf(kernel, options);
  checkStorages(form, arguments);
  if (!hasSinks(form)) {
    KernelCall(*this, form, arguments).run();
    return;
  }
  const Shape domain = domainOf(form, arguments, specsOf(form, arguments));
  if (domain.size() == 0) {
    runOverNothing(form, arguments);
  } else {
    runWithSinks(*this, form, arguments, domain);
  }
}

void run(const Kernel& kernel, std::span<const Argument> arguments, const CallOptions& options) {
  if (options.accumulate != Accumulate::Default) {
    fail(kernel, "it is no reduce, which alone accumulates; call it without Accumulate");
  }
  if (DeviceState* device = checkCall(kernel, arguments)) {
    const TraceScope traced(device->trace.get(), "call", kernel.name);
    if (device->trace) traced.add("domain", domainOf(kernel, arguments, specsOf(kernel, arguments)));
    const CallOptions chosen = device->configuration.resolve(kernel, options);
    checkTables(kernel, chosen);
    device->run(kernel, arguments, chosen);
  }
}

}  // namespace sk
