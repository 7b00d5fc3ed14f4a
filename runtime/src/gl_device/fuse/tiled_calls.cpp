// SPDX-License-Identifier: MIT
#include "gl_device/fuse/tiled_calls.hpp"

#include <algorithm>
#include <array>
#include <map>
#include <utility>

#include <fmt/format.h>

#include "assemble/assemble.hpp"
#include "assemble/glsl/program_text.hpp"
#include "assemble/program/texture_units.hpp"
#include "call/halo_limits.hpp"
#include "device/loop_state.hpp"
#include "device/region.hpp"
#include "gl_device/fuse/fused_calls.hpp"
#include "gl_device/fuse/gl_call.hpp"
#include "gl_device/gl_device.hpp"
#include "gl_device/gl_stream.hpp"

namespace sk {

using assemble::TileCall;
using assemble::TilePlan;
using program::Boundary;
using program::Kernel;
using program::Parameter;
using program::Role;

namespace {

/// Window of texels around one in which a body finds its neighbours; farther ones would take too many registers.
constexpr int farthestNeighbour = 4;
/// Iterations call by call after which all streams must have new elements.
constexpr std::int64_t mostAfter = 8;

/// What a stream has at some point of an iteration: what it, or another one, had before it, or a value that a call has computed.
struct Value {
  StreamState* before = nullptr;
  int computed = -1;
};

/// What streams have in the course of an iteration.
class IterationValues {
 public:
  Value& of(StreamState* stream) { return values_.try_emplace(stream, Value{stream, -1}).first->second; }
  void exchange(StreamState* a, StreamState* b) {
    of(a);
    std::swap(of(a), of(b));
  }
  const std::map<StreamState*, Value>& all() const { return values_; }

 private:
  std::map<StreamState*, Value> values_;
};

/// Whether texels hold four of its elements, as programs compute with them.
bool isOneScalar(const program::Element& element) {
  using program::Scalar;
  const program::Field& field = element.fields.front();
  return element.fields.size() == 1 && field.width == 1 && field.path.empty() && field.part < 0 &&
         (field.scalar == Scalar::Float || field.scalar == Scalar::Int || field.scalar == Scalar::Uint);
}

struct TileShape {
  int columns, rows, invocations;
};
/// Shapes to try. Large tiles compute less of what is around them. Small groups, and invocations that hold few texels, leave a GPU
/// room for several groups, of which one computes while another waits for memory: on an H200, the first is the fastest with one
/// stream that is read at neighbours, the second with two.
constexpr std::array<TileShape, 5> shapes{
    {{16, 64, 256}, {16, 32, 256}, {16, 32, 128}, {8, 64, 128}, {8, 32, 64}}};

}  // namespace

std::string TiledIteration::whyNotParameter(const ResolvedCall& call, std::size_t i) const {
  const Parameter& parameter = call.kernel.parameters[i];
  const StreamRegion& region = call.arguments[i].region;
  switch (parameter.role) {
    case Role::Spec: return {};
    case Role::Uniform:
      return region.stream == nullptr ? std::string()
                                      : fmt::format("'{}' is a value in a stream", parameter.name);
    case Role::Iterator: return fmt::format("'{}' is an iterator", parameter.name);
    case Role::Accumulator:
    case Role::VariableOutput:
    case Role::Scatter: return fmt::format("'{}' gets elements in any order", parameter.name);
    case Role::Input:
    case Role::Output:
    case Role::Gather: break;
  }
  if (!isWhole(region) || region.shape != call.domain || call.arguments[i].fit != program::Fit::Same)
    return fmt::format("'{}' has another shape than the domain", parameter.name);
  if (!isOneScalar(*region.stream->element))
    return fmt::format("elements of '{}' are no floats or integers of 32 bits", parameter.name);
  return {};
}

/// Notes how far a gather is read.
std::string TiledIteration::findReach(const ResolvedCall& call, std::size_t i, TileCall& tile) {
  const Parameter& gather = call.kernel.parameters[i];
  if (gather.rank != 2 || gather.usesSample)
    return fmt::format("'{}' is not read as neighbours in a plane", gather.name);
  if (gather.usesNear && (gather.reach < 0 || gather.reach > farthestNeighbour))
    return fmt::format("neighbours of '{}' are more than {} elements away", gather.name, farthestNeighbour);
  for (std::size_t axis = 0; axis < 2; ++axis) {
    const auto limits =
        haloLimits(call.kernel, call.arguments, i, 1 - static_cast<int>(axis), call.specs, call.domain);
    if (!limits || std::max(limits->below, limits->above) > 64)
      return fmt::format("'{}' is read at any distance", gather.name);
    tile.reach[axis] = std::max(tile.reach[axis], static_cast<int>(std::max(limits->below, limits->above)));
  }
  return {};
}

std::string TiledIteration::addCall(const GlCall& recorded) {
  if (!recorded.whyAlone().empty()) return recorded.whyAlone();
  const ResolvedCall& call = recorded.resolved();
  const Kernel& kernel = call.kernel;
  const Target target = call.options.target != Target::Default ? call.options.target : device_.target;
  if (!kernel.dispatched || target == Target::Fragment) return "it is drawn";
  if (!assemble::mayWritePacked(kernel)) return "it has loops, or is too large";
  const Shape& domain = call.domain;
  if (domain.rank() != 2 || !mayPack(domain) || layoutOf(domain, device_.textureLimits(), true).whole.linear)
    return "its domain is no plane whose rows have a multiple of four elements";
  if (!calls_.empty()) {
    const ResolvedCall& first = *calls_.front();
    if (domain != first.domain) return "its domain has another shape";
    if (!haveSameOptions(call.options, first.options)) return "it has other options";
    if (!kernel.declarations.empty() && !first.kernel.declarations.empty() &&
        kernel.declarations != first.kernel.declarations)
      return "it declares other structs";
  }
  const std::size_t number = calls_.size();
  calls_.push_back(&call);
  TileCall tile{.kernel = &kernel, .entry = {}, .arguments = {}, .values = {}, .symbols = {}};
  std::size_t specs = 0;
  for (std::size_t i = 0; i < kernel.parameters.size(); ++i) {
    const Parameter& parameter = kernel.parameters[i];
    if (std::string why = whyNotParameter(call, i); !why.empty()) return why;
    tile.values.push_back(-1);
    tile.arguments.emplace_back();
    tile.symbols.emplace_back();
    const std::string symbol = fmt::format("c{}_{}", number, parameter.symbol);
    if (parameter.role == Role::Spec) {
      tile.arguments.back() = specValue(parameter, call.specs[specs++]);
    } else if (parameter.role == Role::Uniform) {
      tile.arguments.back() = "sk_arg_" + symbol;
      uniforms_.push_back({parameter, symbol, call.arguments[i]});
    } else {
      bytesOfCalls_ += elementBytes(call.arguments[i].region);
    }
    if (parameter.role != Role::Gather) continue;
    tile.symbols.back() = symbol;
    if (std::string why = findReach(call, i, tile); !why.empty()) return why;
  }
  const std::optional<std::string> entry = bodies_.add(kernel, tile.symbols);
  if (!entry) return "a call before it has functions of the same names";
  tile.entry = *entry;
  plan_.calls.push_back(std::move(tile));
  names_ += fmt::format("{}{}", names_.empty() ? "" : " + ", kernel.name);
  return {};
}

/// Numbers the values, first those of streams that are read before they are written.
std::string TiledIteration::findCarried(LoopState& loop) {
  std::vector<std::vector<Value>> read(calls_.size());
  IterationValues values;
  int computed = 0;
  const auto addCarried =
      [&](StreamState*
              stream) {  // in the order of their first use, so that programs are the same in each run
        const bool isNew = std::ranges::find(carried_, stream) == carried_.end();
        if (isNew) carried_.push_back(stream);
        return isNew;
      };
  for (std::size_t c = 0; c < calls_.size(); ++c) {
    const ResolvedCall& call = *calls_[c];
    read[c].resize(call.arguments.size());
    for (std::size_t i = 0; i < call.arguments.size(); ++i) {
      StreamState* const stream = call.arguments[i].region.stream;
      if (stream == nullptr || call.kernel.parameters[i].role == Role::Output) continue;
      read[c][i] = values.of(stream);
      if (read[c][i].before != nullptr) addCarried(read[c][i].before);
    }
    for (std::size_t i = 0; i < call.arguments.size(); ++i) {
      StreamState* const stream = call.arguments[i].region.stream;
      if (call.kernel.parameters[i].role != Role::Output) continue;
      read[c][i] = values.of(stream) = {nullptr, computed++};
      plan_.elements.push_back(stream->element);
    }
  }
  for (const auto& [a, b] : loop.exchanges()) values.exchange(a, b);
  for (std::size_t c = 0; c < carried_.size(); ++c) {  // which grows
    StreamState* const before = values.of(carried_[c]).before;
    if (before != nullptr) addCarried(before);
  }
  for (const StreamState* const stream : carried_) {
    if (stream->shape != calls_.front()->domain) return "its streams have different shapes";
  }
  const auto numberOf = [&](const Value& value) {
    if (value.before == nullptr) return static_cast<int>(carried_.size()) + value.computed;
    return static_cast<int>(std::ranges::find(carried_, value.before) - carried_.begin());
  };
  plan_.carried = carried_.size();
  bool changes = false;
  for (std::size_t c = 0; c < carried_.size(); ++c) {
    plan_.elements.insert(plan_.elements.begin() + static_cast<std::ptrdiff_t>(c), carried_[c]->element);
    plan_.next.push_back(numberOf(values.of(carried_[c])));
    changes = changes || plan_.next.back() != static_cast<int>(c);
  }
  if (!changes) return "an iteration does not depend on the one before";
  plan_.isNear.assign(plan_.elements.size(), false);
  for (std::size_t c = 0; c < calls_.size(); ++c) {
    for (std::size_t i = 0; i < read[c].size(); ++i) {
      if (calls_[c]->arguments[i].region.stream == nullptr) continue;
      const int value = numberOf(read[c][i]);
      plan_.calls[c].values[i] = value;
      if (calls_[c]->kernel.parameters[i].role == Role::Gather)
        plan_.isNear[static_cast<std::size_t>(value)] = true;
    }
  }
  for (const auto& [stream, value] : values.all()) {
    const bool isTouched = value.before != stream;
    if (isTouched && std::ranges::find(carried_, stream) == carried_.end()) stale_.push_back(stream);
  }
  return {};
}

/// Finds out how many iterations replace all that is stale.
std::string TiledIteration::findAfter(LoopState& loop) {
  std::map<StreamState*, bool> isStale;
  for (StreamState* const stream : stale_) isStale[stream] = true;
  while (std::ranges::any_of(isStale, [](const auto& entry) { return entry.second; })) {
    if (++after_ > mostAfter) return "its swaps keep elements for too many iterations";
    for (const ResolvedCall* const call : calls_) {
      for (std::size_t i = 0; i < call->arguments.size(); ++i) {
        if (call->kernel.parameters[i].role == Role::Output)
          isStale[call->arguments[i].region.stream] = false;
      }
    }
    for (const auto& [a, b] : loop.exchanges()) {
      isStale.try_emplace(a, false);
      isStale.try_emplace(b, false);
      std::swap(isStale[a], isStale[b]);
    }
  }
  return {};
}

std::string TiledIteration::analyse(LoopState& loop) {
  if (!device_.capabilities.hasCompute) return "the device dispatches no programs";
  for (const std::unique_ptr<RecordedCall>& recorded : loop.calls()) {
    const auto* const call = dynamic_cast<const GlCall*>(recorded->onDevice());
    const std::string why = call == nullptr ? std::string(recorded->whyNotOnDevice()) : addCall(*call);
    if (!why.empty()) return fmt::format("of {}: {}", recorded->name(), why);
  }
  if (calls_.empty()) return "it has no calls";
  bool wraps = false, doesNot = false;
  for (const ResolvedCall* const call : calls_) {
    for (const Parameter& parameter : call->kernel.parameters) {
      if (parameter.role != Role::Gather) continue;
      (parameter.boundary == Boundary::Wrap ? wraps : doesNot) = true;
    }
  }
  if (wraps && doesNot) return "some of its gathers wrap, and others do not";
  plan_.isPeriodic = wraps;
  if (std::string why = findCarried(loop); !why.empty()) return why;
  if (std::string why = findAfter(loop); !why.empty()) return why;
  const auto limit = [](std::int32_t given) { return static_cast<std::size_t>(given); };
  std::size_t components = 0;
  for (const Uniform& uniform : uniforms_) {
    for (const program::Field& field : uniform.parameter.element->fields) components += 2U * field.width;
  }
  std::size_t changed = 0;
  for (std::size_t c = 0; c < carried_.size(); ++c) changed += plan_.next[c] != static_cast<int>(c) ? 1U : 0U;
  if (carried_.size() > limit(device_.limits.textureUnits) || changed > limit(device_.limits.images))
    return "a pass would read or write too many streams";
  if (components > limit(device_.limits.uniformComponents)) return "a pass would have too many uniforms";
  std::uint32_t weight = 0;
  for (const ResolvedCall* const call : calls_) weight += call->kernel.weight;
  if (weight > assemble::greatestPackedWeight) return "a program of all calls would be too large";
  return {};
}

std::size_t TiledIteration::groupBytes() const {
  return device_.programs().computeProfile().subgroups ? std::size_t{48} << 10 : assemble::groupBytes;
}

std::vector<TilePlan> TiledIteration::plans(std::size_t bytes) const {
  std::vector<TilePlan> plans;
  const assemble::Index4 extent = xFirst(calls_.front()->domain);
  for (const int iterations : {4, 3, 2}) {
    if (!plans.empty()) break;  // the more at once, the fewer bytes
    for (const TileShape& shape : shapes) {
      TilePlan plan = plan_;
      plan.iterations = iterations;
      plan.texels = {shape.columns, shape.rows};
      plan.invocations = shape.invocations;
      if (plan.sharedBytes() > bytes) continue;
      const std::array<int, 2> stored = plan.stored();
      if (2 * stored[0] < shape.columns || 2 * stored[1] < shape.rows) continue;
      if (plan.isPeriodic && (extent[0] < 4 * shape.columns || extent[1] < shape.rows)) continue;
      plans.push_back(std::move(plan));
    }
  }
  return plans;
}

std::string TiledIteration::identity() const {
  const ResolvedCall& first = *calls_.front();
  const CallOptions& options = first.options;
  return fmt::format("{}, {} {} {} {}\n{}", toString(first.domain), static_cast<int>(options.target),
                     static_cast<int>(options.intrinsics), static_cast<int>(options.tables),
                     static_cast<int>(options.contraction), make(plan_)->body);
}

bool TiledIteration::isPlane() const {
  return std::ranges::none_of(carried_, [](const StreamState* stream) {
    return static_cast<const GlStream*>(stream)->layout.whole.linear;
  });
}

double TiledIteration::bytesOfTiles(const TilePlan& plan) const {
  const std::array<int, 2> stored = plan.stored();
  const double around = static_cast<double>(plan.texels[0] * plan.texels[1]) / (stored[0] * stored[1]);
  double bytes = 0;
  for (std::size_t c = 0; c < carried_.size(); ++c) {
    const auto whole =
        static_cast<double>(carried_[c]->element->size) * static_cast<double>(carried_[c]->shape.size());
    bytes += whole * around + (plan.next[c] != static_cast<int>(c) ? whole : 0);
  }
  return bytes / plan.iterations;
}

std::shared_ptr<MadeKernel> TiledIteration::make(const TilePlan& plan) const {
  auto made = std::make_shared<MadeKernel>();
  Kernel kernel{};
  std::vector<program::IntrinsicUse> intrinsics;
  for (const ResolvedCall* const call : calls_) {
    addNeeds(kernel, intrinsics, call->kernel);
    for (const Parameter& parameter : call->kernel.parameters) {
      kernel.usesIndex = kernel.usesIndex || parameter.usesIndex;
      kernel.usesExtent = kernel.usesExtent || parameter.usesExtent;
    }
  }
  const auto add = [&](Parameter parameter, std::string_view name, std::string_view symbol) {
    parameter.name = made->own(name);
    parameter.symbol = made->own(symbol);
    parameter.element = &made->own(*parameter.element);
    made->body += describeParameter(parameter);
    made->parameters.push_back(parameter);
  };
  for (std::size_t c = 0; c < carried_.size(); ++c) {
    add({.name = {},
         .symbol = {},
         .role = Role::Gather,
         .element = plan.elements[c],
         .rank = 2,
         .usesAt = true},
        "a stream of the loop", fmt::format("s{}", c));
  }
  for (std::size_t c = 0; c < carried_.size(); ++c) {
    if (plan.next[c] == static_cast<int>(c)) continue;
    add({.name = {}, .symbol = {}, .role = Role::Output, .element = plan.elements[c]}, "a stream of the loop",
        fmt::format("o{}", c));
  }
  for (const Uniform& uniform : uniforms_) {
    Parameter parameter = uniform.parameter;
    parameter.neededIf = {};
    add(parameter, parameter.name, uniform.symbol);
  }
  made->body = fmt::format("// {}\n{}{}{}", names_, assemble::describe(plan), made->body, bodies_.text());
  kernel.name = made->own(names_);
  kernel.body = made->body;
  kernel.declarations = made->own(kernel.declarations);
  kernel.parameters = made->parameters;
  kernel.intrinsics = made->own(std::move(intrinsics));
  made->kernel = kernel;
  return made;
}

TiledIteration::Call::Call(const TiledIteration& iteration, TilePlan plan)
    : device_(iteration.device_),
      first_(*iteration.calls_.front()),
      plan_(std::move(plan)),
      made_(iteration.device_.programs().fusedKernels().keep(iteration.make(plan_))),
      options_(first_.options) {
  const auto add = [&](StreamState* stream) {
    arguments_.push_back({.region = {stream, Index::origin(stream->shape.rank()), stream->shape}});
  };
  for (StreamState* const stream : iteration.carried_) add(stream);
  for (std::size_t c = 0; c < iteration.carried_.size(); ++c) {
    if (plan_.next[c] != static_cast<int>(c)) add(iteration.carried_[c]);
  }
  for (const Uniform& uniform : iteration.uniforms_) arguments_.push_back(uniform.argument);
  options_.over = {};
}

void TiledIteration::Call::run() const {
  const TraceScope traced(device_.trace.get(), "call", made_->kernel.name);
  traced.add("domain", first_.domain);
  traced.add("iterations", static_cast<std::int64_t>(plan_.iterations));
  device_.runTiles({made_->kernel, arguments_, options_, {}, first_.domain, nullptr}, plan_);
}

}  // namespace sk
