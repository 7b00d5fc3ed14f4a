// SPDX-License-Identifier: MIT
//
// Calls of pipelines: allocates the local streams, and calls the kernels. Must not depend on the kind of device.
#include <algorithm>
#include <optional>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "call/check_written.hpp"
#include "device/device_state.hpp"
#include "device/loop_state.hpp"
#include "device/region.hpp"
#include "device/stream_state.hpp"
#include "sk/call.hpp"
#include "sk/error.hpp"
#include "support/checked_size.hpp"

namespace sk {

namespace {

using program::Kernel;
using program::Pipeline;
using program::PipelinePass;
using program::Role;

class PipelineCall {
 public:
  PipelineCall(const Pipeline& pipeline, std::span<const Argument> arguments, const CallOptions& options)
      : pipeline_(pipeline), arguments_(arguments), options_(options) {}

  void run() {
    if (arguments_.size() != pipeline_.parameters.size()) {
      fail(Error::Kind::Misuse, "it takes {} arguments, and {} were given", pipeline_.parameters.size(),
           arguments_.size());
    }
    refuseOptions();
    checkStreams();
    domain_ = domain();
    checkOutputs();
    for (std::size_t i = 0; i < pipeline_.passes.size(); ++i) checkLaterReads(i);
    allocate();
    if (!runTogether()) {
      for (const PipelinePass& pass : pipeline_.passes) run(pass);
    }
    keepLocals();
  }

 private:
  template <class... Values>
  [[noreturn]] void fail(Error::Kind kind, fmt::format_string<Values...> format, Values&&... values) const {
    throw Error(fmt::format("{}: {}", pipeline_.name, fmt::format(format, std::forward<Values>(values)...)),
                kind);
  }

  /// Checks that all streams are there, and of one device, before a message could name a local stream instead.
  void checkStreams() const {
    const program::PipelineParameter* first = nullptr;
    const StreamState* stream = nullptr;
    for (std::size_t i = 0; i < arguments_.size(); ++i) {
      const program::PipelineParameter& parameter = pipeline_.parameters[i];
      const Argument& argument = arguments_[i];
      const bool isValue =
          parameter.role == Role::Spec || parameter.role == Role::Iterator || argument.value != nullptr;
      if (isValue || argument.isNone || argument.region.distributed != nullptr) continue;
      const StreamState* const own = argument.region.stream;
      if (own == nullptr && parameter.role != Role::Uniform && parameter.role != Role::Gather) {
        fail(Error::Kind::Lost,
             "'{}' holds no stream: it was default-constructed or moved from; make one by "
             "device.stream<T>(shape)",
             parameter.name);
      }
      if (own == nullptr || own->device == nullptr) continue;
      if (stream == nullptr) {
        stream = own;
        first = &parameter;
      } else if (stream->device != own->device) {
        fail(Error::Kind::Device,
             "'{}' and '{}' are streams of two devices ('{}' and '{}'); copy one of them through host memory",
             first->name, parameter.name, stream->device->name(), own->device->name());
      }
    }
  }

  void refuseOptions() const {
    const bool isPart = !options_.box.isWhole();
    if (!isPart && options_.scan == Scan::Default && !options_.along) return;
    fail(Error::Kind::Misuse, "{}; call its kernels one by one with this option",
         isPart ? "a pipeline computes its whole domain, not a box" : "a pipeline takes no options of scans");
  }

  /// The shape of the outputs or, without any, of what over() gives, or of the inputs together.
  Shape domain() const {
    Shape shape;
    for (std::size_t i = 0; i < arguments_.size(); ++i) {
      const Shape& own = arguments_[i].region.shape;
      if (pipeline_.parameters[i].role == Role::Output) return own;
      if (pipeline_.parameters[i].role != Role::Input) continue;
      if (shape.rank() == 0) shape = own;
      for (int d = 0; d < shape.rank() && d < own.rank(); ++d) {
        if (own.rank() == shape.rank() && shape[d] == 1) shape = shape.with(d, own[d]);
      }
    }
    return options_.over ? options_.over->shape : shape;
  }

  void checkOutputs() const {
    const program::PipelineParameter* first = nullptr;
    for (std::size_t i = 0; i < arguments_.size(); ++i) {
      if (pipeline_.parameters[i].role != Role::Output) continue;
      if (first == nullptr) first = &pipeline_.parameters[i];
      if (arguments_[i].region.shape == domain_) continue;
      fail(Error::Kind::Shape, "outputs '{}' and '{}' have the shapes {} and {}; give them one shape",
           first->name, pipeline_.parameters[i].name, toString(domain_),
           toString(arguments_[i].region.shape));
    }
    if (options_.over && first != nullptr && options_.over->shape != domain_) {
      fail(Error::Kind::Shape, "over() gives the domain {}, and output '{}' has {}",
           toString(options_.over->shape), first->name, toString(domain_));
    }
  }

  /// A pass sees its own arguments as they were before it, also if it writes one of them; a later pass does not.
  void checkLaterReads(std::size_t number) const {
    const PipelinePass& pass = pipeline_.passes[number];
    for (std::size_t i = 0; i < pass.operands.size(); ++i) {
      if (pass.operands[i].isTemporary || !isWritten(pass.kernel->parameters[i].role)) continue;
      const std::size_t written = pass.operands[i].index;
      for (const PipelinePass& later : pipeline_.passes.subspan(number + 1)) {
        for (std::size_t k = 0; k < later.operands.size(); ++k) {
          const std::size_t read = later.operands[k].index;
          if (later.operands[k].isTemporary || read == written) continue;
          const StreamRegion &to = arguments_[written].region, &from = arguments_[read].region;
          if (to.stream == nullptr || from.stream == nullptr || !overlap(to, from)) continue;
          fail(Error::Kind::Misuse,
               "'{}' and '{}' are one stream, of which one kernel writes elements before another uses them; "
               "give them different streams",
               pipeline_.parameters[written].name, pipeline_.parameters[read].name);
        }
      }
    }
  }

  static bool isMap(const Kernel& kernel) {
    return std::ranges::none_of(kernel.parameters, [](const program::Parameter& parameter) {
      return parameter.role == Role::VariableOutput || parameter.role == Role::Scatter;
    });
  }

  static bool isWritten(Role role) {
    return role == Role::Output || role == Role::Accumulator || role == Role::Scatter ||
           role == Role::VariableOutput;
  }

  void allocate() {
    if (pipeline_.locals.empty()) return;
    DeviceState& device = this->device();
    for (std::size_t local = 0; local < pipeline_.locals.size(); ++local) {
      const program::Element& element = elementOf(local);
      const auto kept = std::ranges::find_if(device.keptLocals, [&](const detail::StreamOwner& stream) {
        return stream.get() != nullptr && stream->element == &element && stream->shape == domain_;
      });
      if (kept != device.keptLocals.end() && device.recording == nullptr)
        locals_.push_back(std::move(*kept));
      else
        locals_.emplace_back(device.createStream(element, domain_, Storage::Single).release());
    }
    device.keptLocals.clear();
  }

  /// Keeps the local streams for the next call: fresh memory from the system costs as much as a pass.
  void keepLocals() {
    if (locals_.empty()) return;
    DeviceState& device = *locals_.front()->device;
    if (device.recording == nullptr && device.interposed == nullptr && !device.hasQueue())
      device.keptLocals = std::move(locals_);
  }

  /// Lets the device run all kernels together, if it does and nothing has to see each of them.
  bool runTogether() const {
    if (locals_.empty()) return false;
    DeviceState& device = *locals_.front()->device;
    const bool isSeen = device.runsCallByCall || device.recording != nullptr || device.isChecking ||
                        device.interposed != nullptr || device.results != nullptr || checksHalos() ||
                        checksAsserts();
    if (isSeen || !device.mayRunTogether(domain_.size())) return false;
    for (const PipelinePass& pass : pipeline_.passes) {
      if (pass.reduction != nullptr || !isMap(*pass.kernel)) return false;
    }
    LoopState calls(device);
    for (const PipelinePass& pass : pipeline_.passes) run(pass);
    calls.finish();
    std::vector<StreamState*> locals;
    for (const detail::StreamOwner& local : locals_) locals.push_back(local.get());
    if (!device.runTogether(calls, locals)) calls.runOnce();
    return true;
  }

  /// The device of the streams, which are all streams of this process alone.
  DeviceState& device() const {
    DeviceState* found = options_.over ? options_.over->device : nullptr;
    for (std::size_t i = 0; i < arguments_.size(); ++i) {
      const StreamRegion& region = arguments_[i].region;
      if (region.distributed != nullptr || region.placement.whole.rank() != 0) {
        fail(Error::Kind::Misuse,
             "'{}' is a part of a domain, and '{}' is a local stream, which is a whole one; call the kernels "
             "one by one with streams of the domain between them",
             pipeline_.parameters[i].name, pipeline_.locals.front());
      }
      if (found == nullptr && region.stream != nullptr) found = region.stream->device;
    }
    if (found == nullptr) fail(Error::Kind::Misuse, "none of its arguments is a stream of a device");
    return *found;
  }

  /// The element type of a local stream, which is an output of the pass that writes it.
  const program::Element& elementOf(std::size_t local) const {
    for (const PipelinePass& pass : pipeline_.passes) {
      for (std::size_t i = 0; i < pass.operands.size(); ++i) {
        if (pass.operands[i].isTemporary && pass.operands[i].index == local)
          return program::heldBy(pass.kernel->parameters[i]);
      }
    }
    fail(Error::Kind::Misuse, "no kernel uses its local stream '{}'", pipeline_.locals[local]);
  }

  void run(const PipelinePass& pass) const {
    std::vector<Argument> arguments;
    bool hasOutputs = false;
    for (std::size_t i = 0; i < pass.operands.size(); ++i) {
      const program::PassOperand& operand = pass.operands[i];
      arguments.push_back(operand.isTemporary
                              ? Argument{.region = detail::wholeRegion(locals_[operand.index].get())}
                              : arguments_[operand.index]);
      hasOutputs = hasOutputs || pass.kernel->parameters[i].role == Role::Output;
    }
    CallOptions options = options_;
    options.over.reset();
    if (pass.isOverDomain && !hasOutputs)
      options.over = GivenDomain{domain_, options_.over ? options_.over->device : nullptr};
    if (pass.reduction == nullptr) options.accumulate = Accumulate::Default;
    if (pass.isScan)
      scan(*pass.reduction, arguments, options);
    else if (pass.reduction == nullptr)
      sk::run(*pass.kernel, arguments, options);
    else if (hasOutputs)
      fold(*pass.reduction, arguments, options);
    else
      reduce(*pass.reduction, arguments, options);
  }

  const Pipeline& pipeline_;
  const std::span<const Argument> arguments_;
  const CallOptions& options_;
  Shape domain_;
  std::vector<detail::StreamOwner> locals_;
};

}  // namespace

void run(const Pipeline& pipeline, std::span<const Argument> arguments, const CallOptions& options) {
  withHostMemory(pipeline.name, [&] { PipelineCall(pipeline, arguments, options).run(); });
}

}  // namespace sk
