// SPDX-License-Identifier: MIT
//
// GlDevice::run: runs a kernel over the domain that its outputs determine. A repeated call allocates no host
// memory, unless an output cannot be drawn in place.
#include <span>
#include <vector>

#include "call/precision.hpp"
#include "call/resolved_call.hpp"
#include "gl_device/append/append_call.hpp"
#include "gl_device/gl_device.hpp"
#include "gl_device/pass/kernel_operands.hpp"
#include "gl_device/pass/multipass_plan.hpp"
#include "gl_device/pass/output_targets.hpp"
#include "gl_device/pass/pass.hpp"

namespace sk {

namespace {

using program::Kernel;

/// Runs one call with checked arguments and a nonempty domain.
void runOverOutputs(GlDevice& device, const ResolvedCall& call) {
  const Kernel& kernel = call.kernel;
  const KernelOperands operands(device, kernel, call.arguments, call.specs, call.plan, {}, call.options.box,
                                call.place);
  OutputTargets targets(device, kernel, call.arguments, call.specs, operands.get(), operands.domain(),
                        operands.layout(), call.options.box);
  const DrawnRects rects(partOf(operands.domain(), call.domain.rank(), call.options.box), operands.layout());
  if (call.plan != nullptr) {
    const std::vector<std::span<RenderTarget>> drawn = targets.planesOfOutputs();
    runPlan(device, *call.plan, {operands.get(), drawn, operands.domain(), operands.layout(), rects.get()},
            [&] { targets.begin(); });
  } else {
    KernelProgram& program =
        device.programs().selected().kernelProgram(kernel, operands.get(), operands.domain());
    const PreparedPass pass = preparedPass(device, program, targets.planes());
    targets.begin();
    runKernel(device, pass, kernel, operands.get(), operands.domain(), rects.get(), targets.planes());
  }
  targets.putInPlace();
}

}  // namespace

void GlDevice::run(const ResolvedCall& call) {
  programs_.checkOptions(call.kernel, call.options);
  runUnchecked(call);
}

void GlDevice::runUnchecked(const Kernel& kernel, std::span<const Argument> arguments,
                            const CallOptions& options) {
  runUnchecked(resolveCall(kernel, arguments, limits, options));
}

void GlDevice::runUnchecked(const ResolvedCall& called) {
  const ResolvedCall call = called.of(precisionVariant(called.kernel, called.options), limits);
  const assemble::Stage stage = programs_.stageOf(call.kernel, classOf(call.kernel, call.options.order),
                                                  call.options, call.domain.size());
  const DeviceScope scope(*this);
  const gl::LabelGroup group(context().labels(), called.kernel.name);
  programs_.select(call.options, stage);
  checkStorages(call.kernel, call.arguments, call.specs, call.plan);
  if (!hasAppendOutputs(call.kernel)) {
    runOverOutputs(*this, call);
  } else if (call.domain.size() == 0) {
    runOverNothing(call);
  } else {
    runWithAppendOutputs(*this, call);
  }
}

}  // namespace sk
