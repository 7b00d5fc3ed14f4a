// SPDX-License-Identifier: MIT
#include "program/stub_parameters.hpp"

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "ir/print.hpp"
#include "program/cpp_literals.hpp"
#include "program/cpp_names.hpp"
#include "program/descriptor_names.hpp"
#include "program/elements.hpp"
#include "program/stub_parts.hpp"
#include "sk/program.hpp"
#include "support/text.hpp"

namespace skc::emit {

using namespace ir;

namespace {

// Prints the options that a kernel's attributes choose as C++.

/// The initializer of a CallOptions in namespace sk::program.
std::string optionsText(const sk::CallOptions& options) {
  constexpr std::string_view accumulates[] = {"Default", "Tree", "Compensated", "Extended", "Exact"};
  constexpr std::string_view precisions[] = {"Default", "Half", "Single", "Extended", "Double"};
  constexpr std::string_view intrinsics[] = {"Default", "Fast", "Accurate"};
  constexpr std::string_view tables[] = {"Default", "Off", "On"};
  constexpr std::string_view contractions[] = {"Default", "Exact", "Fast"};
  constexpr std::string_view orders[] = {"Default", "Kept", "Any"};
  return fmt::format(
      "{{.accumulate = Accumulate::{}, .precision = Precision::{}, .intrinsics = Intrinsics::{}, "
      ".tables = Tables::{}, .contraction = Contraction::{}, .order = Order::{}}}",
      accumulates[static_cast<std::size_t>(options.accumulate)],
      precisions[static_cast<std::size_t>(options.precision)],
      intrinsics[static_cast<std::size_t>(options.intrinsics)],
      tables[static_cast<std::size_t>(options.tables)],
      contractions[static_cast<std::size_t>(options.contraction)],
      orders[static_cast<std::size_t>(options.order)]);
}

}  // namespace

std::string conditionName(const std::string& unit, const sk::program::Parameter& param) {
  return ofParameter(unit, Part::Needs, param.symbol);
}

std::string elementName(const std::string& unit, const sk::program::Parameter& param) {
  return ofParameter(unit, Part::Element, param.symbol);
}

namespace {

std::string haloName(const std::string& unit, const sk::program::Parameter& param) {
  return ofParameter(unit, Part::Halo, param.symbol);
}

std::string distanceText(const sk::program::Distance& distance) {
  std::size_t used = distance.perSpec.size();
  while (used > 0 && distance.perSpec[used - 1] == 0) --used;
  if (used == 0) return fmt::format("{{{}}}", distance.constant);
  const std::span<const std::int16_t> factors(distance.perSpec.data(), used);
  return fmt::format("{{{}, {{{}}}}}", distance.constant, fmt::join(factors, ", "));
}

}  // namespace

std::string haloText(const std::string& unit, const sk::program::Parameter& param) {
  if (param.halo.empty()) return {};
  constexpr std::string_view kinds[] = {"Near", "Computed", "Whole"};
  std::vector<std::string> rows;
  for (const sk::program::Reach& reach : param.halo) {
    std::string row =
        fmt::format("{{{}, Reach::Kind::{}", reach.dimension, kinds[static_cast<std::size_t>(reach.kind)]);
    if (reach.kind == sk::program::Reach::Kind::Near)
      row += fmt::format(", {}, {}", distanceText(reach.below), distanceText(reach.above));
    if (reach.isPromised) row += ", true";
    rows.push_back(row + "}");
  }
  const std::string head = fmt::format("constexpr Reach {}[] = {{", haloName(unit, param));
  return wrapLine(head + join(rows, ", ") + "};", 100, head.size()) + "\n\n";
}

std::string lastMembers(const std::string& unit, const sk::program::Parameter& param, std::size_t number) {
  std::string text;
  if (!param.layers.empty()) text += ", .layers = " + numbered(unit, Part::Layers, number);
  if (!param.halo.empty()) text += ", .halo = " + haloName(unit, param);
  if (param.haloShapes != 0) text += fmt::format(", .haloShapes = {}u", param.haloShapes);
  return text;
}

std::string elementOf(const Module& module, const TypeNames& types, Type type) {
  if (type.kind == Type::Kind::Struct && module.structs[type.index].isSynthesized) {
    return "&" + (synthesizedStructName(types.structName(type.index)) + Part::Element);
  }
  const std::string scope = type.kind == Type::Kind::Struct ? "::" : "";
  const std::string name = type.isVector() ? spelling(type.scalar, type.width) : cppType(module, type);
  return fmt::format("&ElementTraits<{}{}>::element()", scope, name);
}

std::string parameterText(const Module& module, const TypeNames& types, const std::string& unit,
                          const sk::program::Parameter& param, const KernelParam& declared) {
  constexpr std::string_view roles[] = {"Uniform",        "Input",   "Output",   "Gather", "Accumulator",
                                        "VariableOutput", "Scatter", "Iterator", "Spec"};
  constexpr std::string_view scatterOps[] = {"Store", "Add", "Min", "Max"};
  constexpr std::string_view boundaries[] = {"Clamp", "Wrap", "Mirror", "Border"};
  const std::string element = declared.type.kind == Type::Kind::Array
                                  ? "&" + elementName(unit, param)
                                  : elementOf(module, types, declared.type);
  std::string text =
      fmt::format("{{.name = \"{}\", .symbol = \"{}\", .role = Role::{}, .element = {}", param.name,
                  param.symbol, roles[static_cast<std::size_t>(param.role)], element);
  if (declared.held) text += ", .held = " + elementOf(module, types, *declared.held);
  if (param.rank > 0) text += fmt::format(", .rank = {}", param.rank);
  if (param.role == sk::program::Role::Gather) {
    text += fmt::format(", .boundary = Boundary::{}", boundaries[static_cast<std::size_t>(param.boundary)]);
  }
  if (param.role == sk::program::Role::Scatter) {
    text += fmt::format(", .scatter = ScatterOp::{}", scatterOps[static_cast<std::size_t>(param.scatter)]);
  }
  if (param.pushes >= 0) text += fmt::format(", .pushes = {}", param.pushes);
  if (!param.border.empty()) text += fmt::format(", .border = \"{}\"", param.border);
  if (!param.identity.empty()) text += fmt::format(", .identity = \"{}\"", param.identity);
  if (param.usesIndex) text += ", .usesIndex = true";
  if (param.usesExtent) text += ", .usesExtent = true";
  if (param.usesAt) text += ", .usesAt = true";
  if (param.usesNear) text += ", .usesNear = true";
  if (param.usesSample) text += ", .usesSample = true";
  if (param.filter) text += ", .filter = true";
  if (param.reach >= 0) text += fmt::format(", .reach = {}", param.reach);
  if (!param.neededIf.steps.empty()) {
    text += fmt::format(", .neededIf = {{{}, \"{}\"}}", conditionName(unit, param), param.neededIf.text);
  }
  if (param.planeCount > 0) {
    text += fmt::format(", .firstPlane = {}, .planeCount = {}", param.firstPlane, param.planeCount);
  }
  return text;
}

std::string kernelText(const sk::program::Kernel& kernel, const std::string& name, std::size_t column,
                       const std::string& codeSymbol) {
  const std::string declarations = kernel.declarations.empty() ? "{}" : name + Part::Declarations;
  const std::string body = kernel.body.empty() ? "{}" : name + Part::Body;
  std::vector<std::string> members = {
      fmt::format(".name = \"{}\"", kernel.name), fmt::format(".entry = \"{}\"", kernel.entry),
      ".declarations = " + declarations,          ".body = " + body,
      fmt::format(".bodyLength = {}", kernel.bodyLength),
      ".parameters = " + name + Part::Parameters, ".sources = sources"};
  if (kernel.usesIndex) members.emplace_back(".usesIndex = true");
  if (kernel.usesExtent) members.emplace_back(".usesExtent = true");
  if (kernel.usesLoops) members.emplace_back(".usesLoops = true");
  if (kernel.usesDoubles) members.emplace_back(".usesDoubles = true");
  if (kernel.usesExactSums) members.emplace_back(".usesExactSums = true");
  if (!kernel.intrinsics.empty()) members.push_back(fmt::format(".intrinsics = {}", name + Part::Intrinsics));
  if (kernel.planCount > 0) {
    members.push_back(fmt::format(".plans = {}", name + Part::Plans));
    members.push_back(fmt::format(".planCount = {}", kernel.planCount));
  }
  if (kernel.options != sk::CallOptions{}) members.push_back(".options = " + optionsText(kernel.options));
  if (kernel.half != nullptr) members.push_back(fmt::format(".half = &{}", name + Part::Half + Part::Kernel));
  if (kernel.wide != nullptr) members.push_back(fmt::format(".wide = &{}", name + Part::Wide + Part::Kernel));
  if (!kernel.whyNotHalf.empty()) members.push_back(".whyNotHalf = " + quoted(kernel.whyNotHalf));
  if (!kernel.whyNotWide.empty()) members.push_back(".whyNotWide = " + quoted(kernel.whyNotWide));
  if (!kernel.tables.empty()) members.push_back(fmt::format(".tables = {}", name + Part::Tables));
  if (!kernel.unrolled.empty()) members.push_back(fmt::format(".unrolled = {}", name + Part::Unrolled));
  if (!kernel.drawn) members.emplace_back(".drawn = false");
  if (!kernel.dispatched) members.emplace_back(".dispatched = false");
  if (!codeSymbol.empty()) members.push_back(".code = &native::" + codeSymbol);
  const std::string newLine = "\n" + std::string(column, ' ');
  return "{" + (column > 4 ? "" : newLine) + join(members, "," + newLine) + "}";
}

}  // namespace skc::emit
