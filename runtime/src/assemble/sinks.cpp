// SPDX-License-Identifier: MIT
#include "assemble/sinks.hpp"

#include <array>
#include <string_view>

#include <fmt/format.h>

#include "assemble/count_tree.hpp"
#include "assemble/planes.hpp"

namespace sk::assemble {
namespace {

using program::Parameter;
using program::Role;

/// Up to so many pushes an element, slots are cheaper than counting.
constexpr int mostSlots = 4;

std::string_view indexType(const Parameter& scatter) {
  static constexpr std::array<std::string_view, 5> types = {"", "int", "ivec2", "ivec3", "ivec4"};
  return types[scatter.rank];
}

/// What the body calls: "void sk_push_r(float sk_v)" or "void sk_put_r(ivec2 sk_i, float sk_v)".
std::string signatureOf(const Parameter& sink) {
  if (sink.role == Role::VariableOutput) {
    return fmt::format("void sk_push_{}({} sk_v)", sink.symbol, sink.element->glsl);
  }
  return fmt::format("void sk_put_{}({} sk_i, {} sk_v)", sink.symbol, indexType(sink), sink.element->glsl);
}

std::string named(std::string_view kind, const Parameter& sink) {
  return fmt::format("sk_{}_{}", kind, sink.symbol);
}

/// The texel of index `sk_i` of a scatter output. Streams of more than two dimensions never lie as they are.
std::string targetTexel(ProgramText& program, const Parameter& sink, const StreamAccess& access) {
  static constexpr std::array<std::string_view, 5> swizzles = {"", ".x", ".xy", ".xyz", ""};
  const auto origin = [&](int rank) {
    return access.view
               ? fmt::format(" + {}{}", program.uniform("ivec4", named("origin", sink)), swizzles[rank])
               : "";
  };
  if (access.addressing == Addressing::Plane) {
    return sink.rank == 1 ? fmt::format("ivec2(sk_i{}, 0)", origin(1))
                          : fmt::format("sk_i{}{}", sink.rank == 2 ? "" : ".xy", origin(2));
  }
  program.require(Function::Texel);
  const std::string shift = program.uniform("int", named("shift", sink));
  const std::string index = "sk_i" + origin(sink.rank);
  if (sink.rank == 1) return fmt::format("sk_texel({}, {})", index, shift);
  const std::string stride = program.uniform("ivec4", named("stride", sink));
  std::string number = fmt::format("({}).x", index);
  for (int c = 1; c < sink.rank; ++c)
    number += fmt::format(" + ({0}).{1} * {2}.{1}", index, "xyzw"[c], stride);
  return fmt::format("sk_texel({}, {})", number, shift);
}

/// Negative indices are large unsigned ones.
std::string isInside(ProgramText& program, const Parameter& sink) {
  const std::string shape = program.uniform("ivec4", named("shape", sink));
  if (sink.rank == 1) return fmt::format("uint(sk_i) < uint({}.x)", shape);
  static constexpr std::array<std::string_view, 5> swizzles = {"", "", ".xy", ".xyz", ""};
  return fmt::format("all(lessThan(uvec{0}(sk_i), uvec{0}({1}{2})))", sink.rank, shape, swizzles[sink.rank]);
}

}  // namespace

bool isSink(const Parameter& parameter) {
  return parameter.role == Role::VariableOutput || parameter.role == Role::Scatter;
}

bool isCounted(const Parameter& sink) {
  return sink.role == Role::VariableOutput || sink.pushes < 0 || sink.pushes > mostSlots;
}

int slotsOf(const Parameter& sink) { return sink.pushes; }

void defineCounting(ProgramText& program, const Parameter& sink) {
  if (!isCounted(sink)) return defineIgnored(program, sink);
  program.variable("int", named("pushed", sink));
  program.prologue(named("pushed", sink) + " = 0;");
  program.function(signatureOf(sink), {fmt::format("++{};", named("pushed", sink))});
}

void storeCount(ProgramText& program, const Parameter& sink) {
  if (isCounted(sink)) {
    program.output("int", named("count", sink));
    program.statement(fmt::format("{} = {};", named("count", sink), named("pushed", sink)));
  }
}

void defineIgnored(ProgramText& program, const Parameter& sink) { program.function(signatureOf(sink), {}); }

void findEntry(ProgramText& program, DomainText& domain, const Parameter& sink, bool treeLayered) {
  program.variable("int", "sk_wanted");
  program.prologue(fmt::format("int sk_entry = {};", domain.texelNumber()));
  if (!isCounted(sink)) {
    const bool isOnly = slotsOf(sink) == 1;
    program.prologue(isOnly ? "int sk_element = sk_entry;"
                            : fmt::format("int sk_element = sk_entry / {};", slotsOf(sink)));
    program.prologue(isOnly ? "sk_wanted = 0;"
                            : fmt::format("sk_wanted = sk_entry - sk_element * {};", slotsOf(sink)));
    return;
  }
  program.uniform(samplerType("isampler2D", treeLayered), "sk_odd");
  program.uniform(samplerType("isampler2D", treeLayered), "sk_even");
  program.uniform("int", "sk_tree_shift");
  program.uniform("int", fmt::format("sk_rows[{}]", mostTreeLevels + 1));
  program.uniform("int", "sk_levels");
  const std::string node = place(program, {"sk_t", treeLayered ? "sk_tree_shift" : ""});
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

void defineListed(ProgramText& program, const Parameter& sink, const StreamAccess& access) {
  const std::string kept = named("kept", sink);
  const std::string pushed = named("pushed", sink);
  program.variable("int", pushed);
  program.variable(sink.element->glsl, kept);
  program.prologue(pushed + " = 0;");
  if (sink.role == Role::VariableOutput) {
    declareOutputs(program, sink);
    program.function(signatureOf(sink), {fmt::format("if ({}++ == sk_wanted) {} = sk_v;", pushed, kept)});
    return;
  }
  const std::string target = named("target", sink);
  program.output("ivec2", target);
  declareOutputs(program, sink);
  program.prologue(target + " = ivec2(-1);");
  const std::string texel = targetTexel(program, sink, access);
  program.function(signatureOf(sink),
                   {fmt::format("if ({}++ != sk_wanted) return;", pushed), kept + " = sk_v;",
                    fmt::format("if ({}) {} = {};", isInside(program, sink), target, texel)});
}

void storeListed(ProgramText& program, const Parameter& sink) { store(program, sink, named("kept", sink)); }

}  // namespace sk::assemble
