// SPDX-License-Identifier: MIT
#include "gl_device/fuse/fused_calls.hpp"

#include <algorithm>
#include <array>

#include <fmt/format.h>

#include "assemble/assemble.hpp"
#include "assemble/program/texture_units.hpp"
#include "call/check_call.hpp"
#include "device/region.hpp"
#include "gl_device/fuse/gl_call.hpp"
#include "gl_device/gl_device.hpp"
#include "sk/arithmetic_marks.hpp"

namespace sk {

using program::Kernel;
using program::Parameter;
using program::Role;

namespace {

/// Drivers take longer than proportionally to compile large programs.
constexpr std::uint32_t greatestWeight = 2 * assemble::greatestPackedWeight;

/// Whether two parameters read their streams by the same functions.
bool areReadAlike(const Parameter& a, const Parameter& b) {
  return a.role == b.role && a.element == b.element && a.held == b.held && a.rank == b.rank &&
         a.boundary == b.boundary && a.border == b.border && a.filter == b.filter && a.usesNear == b.usesNear;
}

}  // namespace

std::string specValue(const Parameter& parameter, std::uint32_t bits) {
  namespace mark = program::mark;
  const program::Scalar scalar = parameter.element->fields.front().scalar;
  const std::string literal = assemble::glslLiteral(scalar, bits);
  return scalar == program::Scalar::Float ? fmt::format("{}{}{}", mark::known, literal, mark::knownEnd)
                                          : literal;
}

bool haveSameOptions(CallOptions a, CallOptions b) {
  a.box = b.box = {};
  a.over = b.over = {};
  return a == b;
}

std::int64_t elementBytes(const StreamRegion& region) {
  return region.shape.size() * static_cast<std::int64_t>(region.stream->element->size);
}

std::string describeParameter(const Parameter& p) {
  std::string fields;
  for (const program::Field& field : p.element->fields)
    fields += fmt::format(" {}.{}x{}", field.path, static_cast<int>(field.scalar), field.width);
  return fmt::format("// {}: {} {}{} {} {} {} {} {}{}{}{}{}{}\n", p.symbol, static_cast<int>(p.role),
                     p.element->name, fields, p.rank, static_cast<int>(p.boundary), p.border, p.reach,
                     p.filter ? "f" : "", p.usesIndex ? "i" : "", p.usesExtent ? "e" : "",
                     p.usesAt ? "a" : "", p.usesNear ? "n" : "", p.usesSample ? "s" : "");
}

void addNeeds(Kernel& whole, std::vector<program::IntrinsicUse>& intrinsics, const Kernel& part) {
  whole.weight += part.weight;
  whole.usesIndex = whole.usesIndex || part.usesIndex;
  whole.usesExtent = whole.usesExtent || part.usesExtent;
  whole.usesLoops = whole.usesLoops || part.usesLoops;
  whole.usesExactSums = whole.usesExactSums || part.usesExactSums;
  whole.drawn = whole.drawn && part.drawn;
  whole.dispatched = whole.dispatched && part.dispatched;
  if (whole.declarations.empty()) whole.declarations = part.declarations;
  for (const program::IntrinsicUse& use : part.intrinsics) {
    const auto same = std::ranges::find(intrinsics, use.intrinsic, &program::IntrinsicUse::intrinsic);
    if (same == intrinsics.end()) {
      intrinsics.push_back(use);
    } else {
      same->widths = static_cast<std::uint8_t>(same->widths | use.widths);
      same->ofDouble = same->ofDouble || use.ofDouble;
    }
  }
}

std::string FusedCalls::add(const ResolvedCall& call) {
  FusedCalls longer = *this;
  std::string why = longer.tryAdd(call);
  if (why.empty()) *this = std::move(longer);
  return why;
}

FusedCalls::Written* FusedCalls::writtenOf(const StreamState* stream) {
  const auto found = std::ranges::find(written_, stream, &Written::stream);
  return found == written_.end() ? nullptr : &*found;
}

/// Why the call does not run in the pass of those before, apart from what it reads.
std::string FusedCalls::whyNotWith(const ResolvedCall& call) const {
  if (calls_.empty()) return {};
  const ResolvedCall& first = *calls_.front();
  if (call.domain != first.domain) return "its domain has another shape";
  if (!haveSameOptions(call.options, first.options)) return "it has other options";
  for (const ResolvedCall* const other : calls_) {
    if (!other->kernel.declarations.empty() && !call.kernel.declarations.empty() &&
        other->kernel.declarations != call.kernel.declarations)
      return "it declares other structs";
    if (assemble::mayWritePacked(other->kernel) != assemble::mayWritePacked(call.kernel))
      return "its texels hold another number of elements";
  }
  return {};
}

std::string FusedCalls::symbolOf(std::size_t parameter) const {
  return fmt::format("c{}_{}", calls_.size(), calls_.back()->kernel.parameters[parameter].symbol);
}

FusedCalls::Outer& FusedCalls::addOuter(const ResolvedCall& call, std::size_t i) {
  const Parameter& parameter = call.kernel.parameters[i];
  Outer& outer =
      outers_.emplace_back(Outer{parameter, symbolOf(i), std::string(parameter.name), call.arguments[i]});
  outer.parameter.neededIf = {};
  outer.parameter.halo = {};
  return outer;
}

std::string FusedCalls::sharedInput(const Parameter& parameter, const Argument& argument) {
  for (Outer& outer : outers_) {
    const StreamRegion& region = outer.argument.region;
    if (!areReadAlike(outer.parameter, parameter) || region.stream != argument.region.stream) continue;
    if (outer.argument.fit != argument.fit || !isSameRegion(region, argument.region)) continue;
    outer.parameter.usesIndex = outer.parameter.usesIndex || parameter.usesIndex;
    outer.parameter.usesExtent = outer.parameter.usesExtent || parameter.usesExtent;
    outer.parameter.usesAt = outer.parameter.usesAt || parameter.usesAt;
    outer.parameter.usesSample = outer.parameter.usesSample || parameter.usesSample;
    const bool isFar = outer.parameter.reach < 0 || parameter.reach < 0;
    outer.parameter.reach = isFar ? -1 : std::max(outer.parameter.reach, parameter.reach);
    return outer.symbol;
  }
  return {};
}

std::string FusedCalls::tryAdd(const ResolvedCall& call) {
  if (std::string why = whyNotWith(call); !why.empty()) return why;
  calls_.push_back(&call);
  const Kernel& kernel = call.kernel;
  std::vector<std::string> symbols(kernel.parameters.size()), values;
  std::vector<Written> results;
  std::size_t specs = 0;
  for (std::size_t i = 0; i < kernel.parameters.size(); ++i) {
    const Parameter& parameter = kernel.parameters[i];
    const Argument& argument = call.arguments[i];
    const StreamState* const stream = argument.region.stream;
    const Written* const before = stream == nullptr ? nullptr : writtenOf(stream);
    if (stream != nullptr && parameter.role != Role::Output) bytesOfCalls_ += elementBytes(argument.region);
    switch (parameter.role) {
      case Role::Spec: values.push_back(specValue(parameter, call.specs[specs++])); break;
      case Role::Output:
        bytesOfCalls_ += elementBytes(argument.region);
        values.push_back(fmt::format("sk_t{}", variables_));
        statements_ += fmt::format("  {} {};\n", parameter.element->glsl, values.back());
        results.push_back({argument.region.stream, values.back(), &parameter, argument});
        ++variables_;
        break;
      case Role::Input:
        if (before != nullptr) {
          if (!isWhole(argument.region) || argument.fit != program::Fit::Same)
            return fmt::format("'{}' is a part of what a call before it writes", parameter.name);
          if (!holdsExactly(*stream))
            return fmt::format("'{}' reads what its stream has rounded", parameter.name);
          values.push_back(before->variable);
          break;
        }
        symbols[i] = sharedInput(parameter, argument);
        if (symbols[i].empty()) symbols[i] = addOuter(call, i).symbol;
        values.push_back(symbols[i]);
        break;
      case Role::Gather:
        if (before != nullptr)
          return fmt::format("'{}' reads more than its own element of what a call before it writes",
                             parameter.name);
        symbols[i] = sharedInput(parameter, argument);
        if (symbols[i].empty()) symbols[i] = addOuter(call, i).symbol;
        break;
      case Role::Uniform:
      case Role::Iterator:
        if (before != nullptr && argument.value == nullptr)
          return fmt::format("'{}' is a value that a call before it writes", parameter.name);
        values.push_back(addOuter(call, i).symbol);
        break;
      case Role::Accumulator:
      case Role::VariableOutput:
      case Role::Scatter: return fmt::format("'{}' gets elements in any order", parameter.name);
    }
  }
  const std::optional<std::string> entry = bodies_.add(kernel, symbols);
  if (!entry) return "a call before it has functions of the same names";
  statements_ += fmt::format("  {}({});\n", *entry, fmt::join(values, ", "));
  for (Written& result : results) {
    if (Written* const before = writtenOf(result.stream)) {
      *before = std::move(result);
    } else {
      written_.push_back(std::move(result));
    }
  }
  return whyTooLarge();
}

std::string FusedCalls::whyTooLarge() const {
  if (calls_.size() < 2) return {};
  const std::shared_ptr<const MadeKernel> made = make();
  const Kernel& kernel = made->kernel;
  const DeviceLimits& limits = device_->limits;
  std::vector<Argument> arguments;
  for (const Outer& outer : outers_) arguments.push_back(outer.argument);
  const std::size_t units =
      assemble::textureUnits(kernel, {}) + uniformPlanes(kernel, std::span<const Argument>(arguments));
  if (!assemble::fitsOnePass(kernel, {limits.drawBuffers, limits.textureUnits}, {}) ||
      units > static_cast<std::size_t>(limits.textureUnits))
    return "a pass would read or write too many streams";
  std::size_t components = 0;
  for (const Parameter& parameter : kernel.parameters) {
    if (parameter.role != Role::Uniform && parameter.role != Role::Iterator) continue;
    for (const program::Field& field : parameter.element->fields) components += 2U * field.width;
  }
  if (components > static_cast<std::size_t>(limits.uniformComponents))
    return "a pass would have too many uniforms";
  const bool isPacked = assemble::mayWritePacked(calls_.front()->kernel);
  if (kernel.weight > (isPacked ? assemble::greatestPackedWeight : greatestWeight))
    return "a program of both would be too large";
  if (!kernel.drawn && !kernel.dispatched) return "it has no programs of the same target";
  return {};
}

std::shared_ptr<MadeKernel> FusedCalls::make() const {
  auto made = std::make_shared<MadeKernel>();
  std::string names, list;
  Kernel kernel{};
  std::vector<program::IntrinsicUse> intrinsics;
  for (const ResolvedCall* const call : calls_) {
    names += fmt::format("{}{}", names.empty() ? "" : " + ", call->kernel.name);
    addNeeds(kernel, intrinsics, call->kernel);
    for (const Parameter& parameter : call->kernel.parameters) {
      // what is handed on has the domain's index and extent
      kernel.usesIndex = kernel.usesIndex || parameter.usesIndex;
      kernel.usesExtent = kernel.usesExtent || parameter.usesExtent;
    }
  }
  const auto add = [&](Parameter parameter, std::string_view symbol) {
    parameter.symbol = made->own(symbol);
    parameter.name = made->own(parameter.name);
    parameter.border = made->own(parameter.border);
    parameter.element = &made->own(*parameter.element);
    made->body += describeParameter(parameter);
    if (parameter.role != Role::Gather) {
      list += fmt::format("{}{}{} {}", list.empty() ? "" : ", ", parameter.role == Role::Output ? "out " : "",
                          parameter.element->glsl, symbol);
    }
    made->parameters.push_back(parameter);
  };
  for (const Outer& outer : outers_) add(outer.parameter, outer.symbol);
  std::string stores;
  for (std::size_t i = 0; i < written_.size(); ++i) {
    Parameter parameter = *written_[i].parameter;
    parameter.usesIndex = parameter.usesExtent = false;
    parameter.neededIf = {};
    const std::string symbol = fmt::format("o{}", i);
    add(parameter, symbol);
    stores += fmt::format("  {} = {};\n", symbol, written_[i].variable);
  }
  made->body = fmt::format("// {}\n{}{}\nvoid sk_fused({}) {{\n{}{}}}\n", names, made->body, bodies_.text(),
                           list, statements_, stores);
  kernel.name = made->own(names);
  kernel.entry = "sk_fused";
  kernel.body = made->body;
  kernel.declarations = made->own(kernel.declarations);
  kernel.parameters = made->parameters;
  kernel.intrinsics = made->own(std::move(intrinsics));
  made->kernel = kernel;
  return made;
}

void FusedCalls::finish() {
  made_ = device_->programs().fusedKernels().keep(make());
  arguments_.clear();
  for (const Outer& outer : outers_) arguments_.push_back(outer.argument);
  for (const Written& written : written_) arguments_.push_back(written.argument);
}

void FusedCalls::run() const {
  const TraceScope traced(device_->trace.get(), "call", name());
  const ResolvedCall& first = *calls_.front();
  traced.add("domain", first.domain);
  CallOptions options = first.options;
  options.over = {};
  device_->run({made_->kernel, arguments_, options, {}, first.domain, nullptr});
}

std::int64_t FusedCalls::bytes() const {
  std::int64_t bytes = 0;
  for (const Outer& outer : outers_) {
    if (outer.argument.region.stream != nullptr) bytes += elementBytes(outer.argument.region);
  }
  for (const Written& written : written_) bytes += elementBytes(written.argument.region);
  return bytes;
}

}  // namespace sk
