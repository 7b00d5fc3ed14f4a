// SPDX-License-Identifier: MIT
#include "assemble/append/append_passes.hpp"

#include <array>
#include <string_view>

#include <fmt/format.h>

#include "assemble/append/histo_pyramid.hpp"
#include "assemble/elements/planes.hpp"
#include "sk/scalar_bytes.hpp"

namespace sk::assemble {
namespace {

using program::Field;
using program::Kernel;
using program::Parameter;
using program::Role;
using program::Scalar;
using program::ScatterOp;

/// Up to this many pushes per element, slots are cheaper than counting.
constexpr int mostSlots = 4;

}  // namespace

bool isAppendOutput(const Parameter& parameter) {
  return parameter.role == Role::VariableOutput || parameter.role == Role::Scatter;
}

bool isCounted(const Parameter& appendOutput) {
  return appendOutput.role == Role::VariableOutput || appendOutput.pushes < 0 ||
         appendOutput.pushes > mostSlots;
}

int slotsOf(const Parameter& appendOutput) { return appendOutput.pushes; }

void defineCounting(ProgramText& program, const Parameter& appendOutput) {
  if (!isCounted(appendOutput)) return defineIgnored(program, appendOutput);
  program.variable("int", named("pushed", appendOutput));
  program.prologue(named("pushed", appendOutput) + " = 0;");
  program.function(signatureOf(appendOutput), {fmt::format("++{};", named("pushed", appendOutput))});
}

void storeCount(ProgramText& program, const Parameter& appendOutput) {
  if (isCounted(appendOutput)) {
    program.output("int", named("count", appendOutput));
    program.statement(fmt::format("{} = {};", named("count", appendOutput), named("pushed", appendOutput)));
  }
}

void defineIgnored(ProgramText& program, const Parameter& appendOutput) {
  program.function(signatureOf(appendOutput), {});
}

void findEntry(ProgramText& program, DomainText& domain, const Parameter& appendOutput, bool pyramidLayered) {
  program.variable("int", "sk_wanted");
  program.prologue(fmt::format("int sk_entry = {};", domain.texelNumber()));
  if (!isCounted(appendOutput)) {
    const bool isOnly = slotsOf(appendOutput) == 1;
    program.prologue(isOnly ? "int sk_element = sk_entry;"
                            : fmt::format("int sk_element = sk_entry / {};", slotsOf(appendOutput)));
    program.prologue(isOnly ? "sk_wanted = 0;"
                            : fmt::format("sk_wanted = sk_entry - sk_element * {};", slotsOf(appendOutput)));
    return;
  }
  program.uniform(samplerType("isampler2D", pyramidLayered), "sk_odd");
  program.uniform(samplerType("isampler2D", pyramidLayered), "sk_even");
  program.uniform("int", "sk_tree_shift");
  program.uniform("int", fmt::format("sk_rows[{}]", mostPyramidLevels + 1));
  program.uniform("int", "sk_levels");
  const std::string node = place(program, {"sk_t", pyramidLayered ? "sk_tree_shift" : ""});
  program.function(
      "ivec4 sk_node(int sk_l, int sk_n)",
      {"ivec2 sk_t = ivec2(sk_n & ((1 << sk_tree_shift) - 1), (sk_n >> sk_tree_shift) + sk_rows[sk_l]);",
       fmt::format("return (sk_l & 1) == 1 ? texelFetch(sk_odd, {0}, 0) : texelFetch(sk_even, {0}, 0);",
                   node)});
  for (const std::string_view line :
       {"sk_wanted = sk_entry;", "int sk_element = 0;", "for (int sk_l = sk_levels; sk_l > 0; --sk_l) {",
        "  ivec4 sk_p = sk_node(sk_l, sk_element);", "  if (sk_wanted >= sk_p.w) return;",
        "  bvec3 sk_past = greaterThanEqual(ivec3(sk_wanted), sk_p.xyz);",
        "  sk_wanted -= sk_past.z ? sk_p.z : sk_past.y ? sk_p.y : sk_past.x ? sk_p.x : 0;",
        "  sk_element = 4 * sk_element + int(sk_past.x) + int(sk_past.y) + int(sk_past.z);", "}"}) {
    program.prologue(line);
  }
}

void defineListed(ProgramText& program, const Parameter& appendOutput, const StreamAccess& access) {
  const std::string kept = named("kept", appendOutput);
  const std::string pushed = named("pushed", appendOutput);
  program.variable("int", pushed);
  program.variable(appendOutput.element->glsl, kept);
  program.prologue(pushed + " = 0;");
  if (appendOutput.role == Role::VariableOutput) {
    declareOutputs(program, appendOutput);
    program.function(signatureOf(appendOutput),
                     {fmt::format("if ({}++ == sk_wanted) {} = sk_v;", pushed, kept)});
    return;
  }
  const std::string target = named("target", appendOutput);
  program.output("ivec2", target);
  declareOutputs(program, appendOutput);
  program.prologue(target + " = ivec2(-1);");
  const std::string texel = targetTexel(program, appendOutput, access);
  program.function(signatureOf(appendOutput),
                   {fmt::format("if ({}++ != sk_wanted) return;", pushed), kept + " = sk_v;",
                    fmt::format("if ({}) {} = {};", isInside(program, appendOutput), target, texel)});
}

void storeListed(ProgramText& program, const Parameter& appendOutput) {
  store(program, appendOutput, named("kept", appendOutput));
}

namespace {

std::string_view indexType(const Parameter& scatter) {
  static constexpr std::array<std::string_view, 5> types = {"", "int", "ivec2", "ivec3", "ivec4"};
  return types[scatter.rank];
}

}  // namespace

std::string signatureOf(const Parameter& appendOutput) {
  if (appendOutput.role == Role::VariableOutput) {
    return fmt::format("void sk_push_{}({} sk_v)", appendOutput.symbol, appendOutput.element->glsl);
  }
  return fmt::format("void sk_put_{}({} sk_i, {} sk_v)", appendOutput.symbol, indexType(appendOutput),
                     appendOutput.element->glsl);
}

std::string named(std::string_view kind, const Parameter& appendOutput) {
  return fmt::format("sk_{}_{}", kind, appendOutput.symbol);
}

std::string targetTexel(ProgramText& program, const Parameter& appendOutput, const StreamAccess& access) {
  static constexpr std::array<std::string_view, 5> swizzles = {"", ".x", ".xy", ".xyz", ""};
  const auto origin = [&](int rank) {
    return access.view ? fmt::format(" + {}{}", program.uniform("ivec4", named("origin", appendOutput)),
                                     swizzles[rank])
                       : "";
  };
  if (access.addressing == Addressing::Plane) {
    return appendOutput.rank == 1 ? fmt::format("ivec2(sk_i{}, 0)", origin(1))
                                  : fmt::format("sk_i{}{}", appendOutput.rank == 2 ? "" : ".xy", origin(2));
  }
  program.require(Function::Texel);
  const std::string shift = program.uniform("int", named("shift", appendOutput));
  const std::string index = "sk_i" + origin(appendOutput.rank);
  if (appendOutput.rank == 1) return fmt::format("sk_texel({}, {})", index, shift);
  const std::string stride = program.uniform("ivec4", named("stride", appendOutput));
  std::string number = fmt::format("({}).x", index);
  for (int c = 1; c < appendOutput.rank; ++c)
    number += fmt::format(" + ({0}).{1} * {2}.{1}", index, "xyzw"[c], stride);
  return fmt::format("sk_texel({}, {})", number, shift);
}

std::string isInside(ProgramText& program, const Parameter& appendOutput) {
  const std::string shape = program.uniform("ivec4", named("shape", appendOutput));
  if (appendOutput.rank == 1) return fmt::format("uint(sk_i) < uint({}.x)", shape);
  static constexpr std::array<std::string_view, 5> swizzles = {"", "", ".xy", ".xyz", ""};
  return fmt::format("all(lessThan(uvec{0}(sk_i), uvec{0}({1}{2})))", appendOutput.rank, shape,
                     swizzles[appendOutput.rank]);
}

namespace {

/// Pushes of up to this many bytes in a tile go through shared memory.
constexpr std::size_t stagedBytes = std::size_t{16} << 10;
/// The most elements that an invocation computes, and the most that it holds in packed texels, all of which it fetches before it waits.
/// With more, it needs more registers, and fewer groups run side by side.
constexpr int mostOfInvocation = 8, mostHeldInTexels = 16;

/// Bytes of a staged element.
std::size_t bytesOf(const program::Element& element) {
  std::size_t bytes = 0;
  for (const Field& field : element.fields) {
    const int width = field.width == 3 ? 4 : field.width;
    bytes += static_cast<std::size_t>(width) * (program::is64Bit(field.scalar) ? 8 : 4);
  }
  return bytes;
}

/// The only field of an element that is one scalar, which no two invocations can each store a part of; else null.
const Field* scalarField(const Parameter& scatter) {
  const Field& field = scatter.element->fields.front();
  const bool isOne = scatter.element->fields.size() == 1 && field.path.empty() && field.width == 1;
  return isOne ? &field : nullptr;
}

/// The part of a program that stores a list's planes, or shares memory with them, takes this many bytes for an entry.
std::size_t bytesOfEntry(const Parameter& pushed) {
  return bytesOf(*pushed.element) + (pushed.role == Role::Scatter ? sizeof(std::uint32_t) : 0);
}

}  // namespace

GroupPlan planGroups(const Kernel& kernel, bool isPacked, Order order) {
  const int elements = isPacked ? lanes : 1;
  const int most = mostOfInvocation / elements;
  std::size_t bytesPerElement = 0;
  bool pushesOnce = true;
  for (const Parameter& parameter : kernel.parameters) {
    if (!isPushed(parameter, order)) continue;
    if (parameter.pushes < 0) return {most, false};
    pushesOnce = pushesOnce && parameter.pushes <= 1;
    bytesPerElement += bytesOfEntry(parameter) * static_cast<std::size_t>(parameter.pushes);
  }
  const int mostStaged = isPacked && pushesOnce ? mostHeldInTexels / elements : most;
  for (int rounds = mostStaged; rounds > 1; rounds /= 2) {
    const std::size_t bytes = bytesPerElement * static_cast<std::size_t>(elements * rounds * appendGroup);
    if (bytes <= stagedBytes) return {rounds, bytes > 0, bytes > 0 && pushesOnce};
  }
  return {most, false};
}

bool isListed(const Parameter& appendOutput, Order order) {
  if (appendOutput.role != Role::Scatter || appendOutput.scatter == ScatterOp::Store) return false;
  const Field* const field = scalarField(appendOutput);
  if (field == nullptr) return true;
  return field->scalar == Scalar::Float && appendOutput.scatter == ScatterOp::Add && order != Order::Any;
}

bool isPushed(const Parameter& appendOutput, Order order) {
  return appendOutput.role == Role::VariableOutput || isListed(appendOutput, order);
}

bool isPair(const Parameter& listed) { return scalarField(listed) != nullptr; }

std::size_t imagesOf(const Parameter& appendOutput, Order order) {
  const bool hasTargets = isListed(appendOutput, order) && !isPair(appendOutput);
  return appendOutput.element->fields.size() + (hasTargets ? 1 : 0);
}

bool hasOwners(const Parameter& scatter, Order order) {
  if (scatter.role != Role::Scatter || scatter.scatter != ScatterOp::Store) return false;
  const Field* const field = scalarField(scatter);
  return order != Order::Any || field == nullptr || program::is64Bit(field->scalar);
}

}  // namespace sk::assemble
