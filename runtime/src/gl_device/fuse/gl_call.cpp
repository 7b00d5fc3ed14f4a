// SPDX-License-Identifier: MIT
#include "gl_device/fuse/gl_call.hpp"

#include <algorithm>

#include <fmt/format.h>

#include "assemble/append/append_passes.hpp"
#include "device/region.hpp"
#include "gl_device/gl_device.hpp"
#include "gl_device/gl_stream.hpp"

namespace sk {

namespace {

using program::Parameter;
using program::Role;

std::string whyArgumentIsAlone(const ResolvedCall& call, std::size_t i) {
  const Parameter& parameter = call.kernel.parameters[i];
  const StreamRegion& region = call.arguments[i].region;
  if (!assemble::isNeeded(parameter, call.specs)) return fmt::format("it needs no '{}'", parameter.name);
  if (assemble::isAppendOutput(parameter))
    return fmt::format("'{}' gets elements in any order", parameter.name);
  if (region.stream == nullptr) return {};
  if (isPlaced(region)) return fmt::format("'{}' is a part of a whole", parameter.name);
  if (region.stream->storage != Storage::Single)
    return fmt::format("the stream of '{}' is stored in another precision", parameter.name);
  if (parameter.role == Role::Output && region.shape != region.stream->shape)
    return fmt::format("'{}' is a part of its stream", parameter.name);
  return {};
}

std::string whyAlone(const ResolvedCall& call) {
  const program::Kernel& kernel = call.kernel;
  if (kernel.definitions.empty()) return "an older skc has generated its code";
  if (call.plan != nullptr) return "it takes several passes";
  if (needsPrecisionVariant(call.options)) return "it computes in another precision than float";
  if (kernel.usesDoubles || kernel.usesLongs) return "it computes with numbers of 64 bits";
  if (!kernel.tables.empty() && call.options.tables != Tables::Off) return "it looks functions up in tables";
  if (!call.options.box.isWhole()) return "it computes a box of its domain";
  if (call.place.whole.rank() != 0) return "its domain is a part of a whole";
  bool writes = false;
  for (std::size_t i = 0; i < call.arguments.size(); ++i) {
    if (std::string why = whyArgumentIsAlone(call, i); !why.empty()) return why;
    writes = writes || kernel.parameters[i].role == Role::Output;
  }
  return writes && call.domain.size() > 0 ? "" : "it writes no elements";
}

}  // namespace

bool holdsExactly(const StreamState& stream) {
  return stream.storage == Storage::Single &&
         std::ranges::all_of(stream.element->fields, [](const program::Field& field) {
           using program::Scalar;
           return field.scalar == Scalar::Float || field.scalar == Scalar::Int ||
                  field.scalar == Scalar::Uint || field.scalar == Scalar::Bool;
         });
}

GlCall::GlCall(GlDevice& device, const ResolvedCall& call)
    : device_(device), call_(call), whyAlone_(sk::whyAlone(call)) {}

void GlCall::run() { device_.run(call_); }

std::unique_ptr<RecordedCall> GlDevice::prepare(const ResolvedCall& call) {
  const bool areBoxes =
      std::ranges::all_of(call.arguments, [](const Argument& argument) { return isBox(argument.region); });
  return areBoxes ? std::make_unique<GlCall>(*this, call) : nullptr;
}

}  // namespace sk
