// SPDX-License-Identifier: MIT
//
// Dispatches a call if that is possible. Else draws the counts, the pyramids and the lists, then scatters the lists or makes them the elements of
// variable outputs. All passes that run the kernel come before any change of a stream that the kernel may
// read.

#include "gl_device/append/append_call.hpp"

#include <algorithm>
#include <list>
#include <optional>
#include <tuple>
#include <utility>
#include <vector>

#include "assemble/append/append_passes.hpp"
#include "call/check_call.hpp"
#include "device/write_scope.hpp"
#include "gl_device/append/append_dispatch.hpp"
#include "gl_device/append/histo_pyramid.hpp"
#include "gl_device/append/scatter_lists.hpp"
#include "gl_device/gl_device.hpp"
#include "gl_device/gl_stream.hpp"
#include "gl_device/pass/output_targets.hpp"
#include "gl_device/pass/pass.hpp"
#include "sk/limits.hpp"

namespace sk {

using program::Parameter;
using program::Role;

namespace {

/// Whether an element output is a part of its stream, which must then be unpacked, because the domain is.
bool isPartlyWritten(const ResolvedCall& call, std::size_t i) {
  const StreamRegion& region = call.arguments[i].region;
  const Parameter& parameter = call.kernel.parameters[i];
  return parameter.role == Role::Output && assemble::isNeeded(parameter, call.specs) &&
         region.shape != region.stream->shape;
}

Operand operandOf(const ResolvedCall& call, std::size_t i) {
  const Parameter& parameter = call.kernel.parameters[i];
  const Argument& argument = call.arguments[i];
  if (parameter.role == Role::Uniform) return uniformOperand(argument);
  if (parameter.role == Role::Spec) return {.value = argument.value};
  if (parameter.role == Role::Iterator) {
    return iteration(parameter, argument.value, call.domain);
  }
  if (parameter.role == Role::VariableOutput || !assemble::isNeeded(parameter, call.specs)) {
    return {};
  }
  return regionOperand(argument, call.domain);
}

}  // namespace

bool isScattered(const ResolvedCall& call, std::size_t i) {
  const Parameter& parameter = call.kernel.parameters[i];
  return parameter.role == Role::Scatter && assemble::isNeeded(parameter, call.specs);
}

void unpackWritten(const ResolvedCall& call) {
  for (std::size_t i = 0; i < call.arguments.size(); ++i) {
    if (isScattered(call, i) || isPartlyWritten(call, i)) glStream(call.arguments[i].region).unpack();
  }
}

std::vector<Operand> appendOperands(const ResolvedCall& call) {
  std::vector<Operand> operands;
  for (std::size_t i = 0; i < call.arguments.size(); ++i) operands.push_back(operandOf(call, i));
  return operands;
}

bool hasRoom(const Parameter& pushed, std::int64_t elements, std::int32_t textureSize) {
  const std::int64_t most = std::int64_t{textureSize} * textureSize / 2;
  return pushed.pushes >= 0 && pushed.pushes <= mostRoom && elements * pushed.pushes <= most;
}

void failForPushes(const program::Kernel& kernel, const Parameter& appendOutput) {
  fail(Error::Kind::Shape, kernel, "it {} '{}' more than {} values in one call; divide the domain",
       appendOutput.role == Role::Scatter ? "scatters to" : "pushes to", appendOutput.name, mostPushes);
}

namespace {

using assemble::Task;
using assemble::Work;
using program::Kernel;

/// The list of one append output.
struct List {
  explicit List(GlDevice& device) : planes(device.memory()), total(device.memory()) {}

  std::size_t appendOutput = 0;
  Layout layout;  ///< of `planes`
  PlanesLease planes;  ///< none if the list is empty; a scatter output's target texels come first
  PlanesLease total;  ///< HistoPyramid::totalTexture() if the number of entries is not read; else none
};

class AppendCall {
 public:
  AppendCall(GlDevice& device, const ResolvedCall& call)
      : device_(device),
        call_(call),
        kernel_(call.kernel),
        arguments_(call.arguments),
        specs_(call.specs),
        layout_(layoutOf(call.domain, device.textureLimits())),
        counts_(device.memory()) {
    unpackWritten(call);
    operands_ = appendOperands(call);
  }

  /// Everything that may fail precedes changes of streams, except of outputs that the counting pass draws in
  /// place. Streams that get new planes change last.
  void run() {
    OutputTargets outputs(device_, kernel_, arguments_, specs_, operands_, layout_.whole, layout_);
    drawCounts(outputs);
    std::vector<std::unique_ptr<List>> lists;
    std::size_t counted = 0;
    for (std::size_t i = 0; i < operands_.size(); ++i) {
      const Parameter& parameter = kernel_.parameters[i];
      if (!assemble::isAppendOutput(parameter)) {
        continue;
      }
      RenderTarget* counts = assemble::isCounted(parameter) ? &counts_.planes[counted++] : nullptr;
      lists.push_back(makeList(i, counts));
    }
    std::list<std::pair<GlStream*, Scatterer>> scatterers;
    for (const std::unique_ptr<List>& list : lists) {
      if (!isScattered(call_, list->appendOutput) || list->planes.planes.empty()) continue;
      GlStream& stream = glStream(arguments_[list->appendOutput].region);
      scatterers.emplace_back(
          std::piecewise_construct, std::tuple(&stream),
          std::forward_as_tuple(device_, kernel_.parameters[list->appendOutput], list->planes.planes,
                                list->layout.whole, operands_[list->appendOutput].regionLayout,
                                stream.planes));
    }
    outputs.copy();
    for (auto& [stream, scatterer] : scatterers) {
      StreamState* const written[] = {stream};
      WriteScope writes(written);
      scatterer.run();
      writes.commit();
    }
    outputs.exchange();
    for (const std::unique_ptr<List>& list : lists) {
      if (kernel_.parameters[list->appendOutput].role == Role::VariableOutput) storeList(*list);
    }
  }

 private:
  /// Draws the element outputs, and the counts of each counted append output.
  void drawCounts(OutputTargets& targets) {
    const auto counted = std::count_if(
        kernel_.parameters.begin(), kernel_.parameters.end(),
        [](const Parameter& p) { return assemble::isAppendOutput(p) && assemble::isCounted(p); });
    for (std::ptrdiff_t i = 0; i < counted; ++i) {
      counts_.add(ElementTraits<int>::element(), layout_.texture, "the numbers of what a kernel pushes");
    }
    for (RenderTarget& plane : counts_.planes) {
      targets.add(plane);
    }
    if (targets.planes().empty()) {
      return;
    }
    const Task task{Work::Counts};
    KernelProgram& program =
        device_.programs().selected().kernelProgram(kernel_, operands_, layout_.whole, task);
    const PreparedPass pass = preparedPass(device_, program, targets.planes());
    targets.begin();
    runKernel(device_, pass, kernel_, operands_, layout_.whole, layout_.draws, targets.planes(), {}, task);
  }

  /// Draws the list of an append output. `counts` is null if it is not counted: its list then has slots.
  std::unique_ptr<List> makeList(std::size_t i, RenderTarget* counts) {
    const Parameter& appendOutput = kernel_.parameters[i];
    const std::int64_t elements = assemble::elements(layout_.whole.extent);
    auto list = std::make_unique<List>(device_);
    list->appendOutput = i;
    std::optional<HistoPyramid> pyramid;
    std::int64_t length = elements * appendOutput.pushes;
    if (counts != nullptr) {
      pyramid.emplace(device_, *counts, layout_);
      if (appendOutput.role == Role::VariableOutput &&
          hasRoom(appendOutput, elements, device_.limits.textureSize)) {
        list->total.planes = pyramid->totalTexture();
      } else {
        length = pyramid->total();
        if (length > mostPushes) failForPushes(kernel_, appendOutput);
      }
    }
    list->layout = listLayout(length, device_.textureLimits());
    if (length > 0) {
      drawList(*list, pyramid ? &*pyramid : nullptr);
    }
    return list;
  }

  void drawList(List& list, HistoPyramid* pyramid) {
    const Parameter& appendOutput = kernel_.parameters[list.appendOutput];
    const auto take = [&](const program::Element& element) {
      list.planes.add(element, list.layout.texture, "what a kernel pushes or scatters");
    };
    if (appendOutput.role == Role::Scatter) {
      take(ElementTraits<int2>::element());
    }
    take(*appendOutput.element);
    std::vector<RenderTarget*> targets;
    for (RenderTarget& plane : list.planes.planes) {
      targets.push_back(&plane);
    }
    // decodes the elements' numbers; list.layout.draws are the texels to draw
    assemble::RegionLayout domain;
    domain.linear = true;
    domain.extent = layout_.whole.extent;
    domain.stride = assemble::stridesOf(domain.extent);
    domain.layered = list.layout.whole.layered;
    domain.shift = list.layout.whole.shift;
    const Task task{Work::List, static_cast<std::uint8_t>(list.appendOutput),
                    pyramid != nullptr && pyramid->plan().isLayered()};
    if (pyramid != nullptr) {
      bindPyramid(task, domain, *pyramid);
    }
    runKernel(device_, kernel_, operands_, domain, list.layout.draws, targets, {}, task);
  }

  void bindPyramid(const Task& task, const assemble::RegionLayout& domain, HistoPyramid& pyramid) {
    KernelProgram& program = device_.programs().selected().kernelProgram(kernel_, operands_, domain, task);
    device_.bound().program(program.program.name());
    bindPlanes(device_, {&pyramid.odd(), 1}, program.units);
    bindPlanes(device_, {&pyramid.even(), 1}, program.units + 1);
    program.pyramid.set(device_.bound(), pyramid.plan());
  }

  void storeList(List& list) noexcept {
    const bool isKnown = list.total.planes.empty();
    glStream(arguments_[list.appendOutput].region)
        .replaceElements(list.planes.planes, std::move(list.layout),
                         isKnown ? nullptr : &list.total.planes.front());
    list.total.planes.clear();
  }

  GlDevice& device_;
  const ResolvedCall& call_;
  const Kernel& kernel_;
  std::span<const Argument> arguments_;
  const assemble::SpecValues& specs_;
  Layout layout_;  ///< of the domain
  PlanesLease counts_;  ///< one plane per counted append output
  std::vector<Operand> operands_;
};

}  // namespace

bool hasAppendOutputs(const Kernel& kernel) {
  return std::any_of(kernel.parameters.begin(), kernel.parameters.end(), assemble::isAppendOutput);
}

void runWithAppendOutputs(GlDevice& device, const ResolvedCall& call) {
  if (device.programs().areDispatched()) {
    if (dispatchAppends(device, call)) return;
    device.programs().selectDrawn(call.kernel, call.options);
  }
  AppendCall(device, call).run();
}

void runOverNothing(const ResolvedCall& call) {
  for (std::size_t i = 0; i < call.arguments.size(); ++i) {
    if (call.kernel.parameters[i].role == Role::VariableOutput) {
      std::vector<RenderTarget> nothing;
      glStream(call.arguments[i].region).replaceElements(nothing, listLayout(0, {1, 1}), nullptr);
    }
  }
}

}  // namespace sk
