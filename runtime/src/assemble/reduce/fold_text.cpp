// SPDX-License-Identifier: MIT
#include "assemble/reduce/fold_text.hpp"

#include <algorithm>
#include <array>

#include <fmt/format.h>

#include "assemble/elements/arguments.hpp"
#include "assemble/elements/gather.hpp"

namespace sk::assemble {

using program::Kernel;
using program::Parameter;
using program::Role;

namespace {

/// The layout of the texels that invocations or groups compute. Those that store results by themselves have none.
DomainLayout layoutOf(const ReduceVariant& variant) {
  const bool hasTexel = (variant.unit == ScanUnit::Item || variant.scan == ScanPass::Folds) &&
                        variant.rows != RowPass::Groups;  // whose invocations write texels of other numbers
  return {hasTexel ? variant.domain : Domain::Linear, variant.domainView, variant.domainRank,
          variant.domainLayered};
}

}  // namespace

FoldText::FoldText(const Profile& profile, const program::Reduction& reduction, const ReduceVariant& variant,
                   const Kernel& kernel)
    : profile_(profile),
      reduction_(reduction),
      variant_(variant),
      held_(kernel, variant.access),
      kernel_(held_.kernel()),
      program_(profile),
      domain_(program_, layoutOf(variant), "sk_result") {
  for (const Parameter& parameter : kernel_.parameters) {
    if (parameter.role == Role::Input) inputs_.push_back(&parameter);
    if (parameter.role == Role::Accumulator) accumulators_.push_back(&parameter);
  }
  // Digits of exact sums are those of any float.
  if (kernel_.body.find("sk_exact_flags(") != std::string_view::npos ||
      kernel_.body.find("sk_exact_product_flags(") != std::string_view::npos)
    program_.keepDenormals();
}

std::string FoldText::held(std::string_view name, const Parameter& accumulator) const {
  return accumulators_.size() == 1 ? std::string(name) : fmt::format("{}_{}", name, accumulator.symbol);
}

std::string FoldText::item() {
  program_.variable("ivec4", "sk_item");
  return "sk_item";
}

std::string FoldText::seenItem() {
  if (!variant_.placed) return item();
  return fmt::format("({} + {})", item(), program_.uniform("ivec4", "sk_item_low"));
}

std::string FoldText::seenShape() {
  return program_.uniform("ivec4", variant_.placed ? "sk_item_whole" : "sk_item_shape");
}

std::string FoldText::itemPosition(int components) {
  static constexpr std::array<std::string_view, 4> swizzles = {".x", ".xy", ".xyz", ""};
  return fmt::format("{}{}", seenItem(), swizzles[static_cast<std::size_t>(components - 1)]);
}

void FoldText::defineParameters() {
  if (kernel_.usesIndex) program_.function("ivec4 sk_index()", {fmt::format("return {};", seenItem())});
  if (kernel_.usesExtent) program_.function("ivec4 sk_extent()", {fmt::format("return {};", seenShape())});
  std::size_t specs = 0;
  for (std::size_t i = 0; i < kernel_.parameters.size(); ++i) {
    const Parameter& parameter = kernel_.parameters[i];
    if (parameter.role == Role::Spec) {
      arguments_.push_back(specConstant(program_, parameter, variant_.specs[specs++]));
    } else if (isNeeded(parameter, variant_.specs)) {
      defineParameter(parameter, access(i));
    } else {
      defineAbsent(program_, parameter);
    }
  }
}

void FoldText::defineParameter(const Parameter& parameter, const StreamAccess& access) {
  switch (parameter.role) {
    case Role::Uniform: arguments_.push_back(uniformValue(program_, parameter, access)); return;
    case Role::Iterator: arguments_.push_back(iteratorValue(program_, parameter, access, seenItem())); return;
    case Role::Input:
      declareSamplers(
          program_, parameter,
          variant_.walk == Walk::Index ? access.addressing == Addressing::Layered : variant_.sourceLayered);
      if (variant_.walk == Walk::Index) defineInputIndex(program_, parameter, access, item(), indexGetter());
      if (variant_.placed) {
        definePlacedGetters(program_, parameter, seenItem());
      } else {
        defineExtent(program_, parameter);
      }
      return;
    case Role::Gather:
      defineGather(program_, [&](int components) { return itemPosition(components); }, parameter, access);
      defineExtent(program_, parameter);
      return;
    case Role::Output:
      if (parameter.usesIndex) defineGetter(program_, "index", parameter, seenItem());
      if (parameter.usesExtent) defineGetter(program_, "extent", parameter, seenShape());
      return;
    case Role::Spec:
    case Role::Accumulator:
    case Role::VariableOutput:
    case Role::Scatter: return;
  }
}

std::string FoldText::element(std::size_t i, const Texel& texel) {
  const Parameter& input = kernel_.parameters[i];
  if (!isNeeded(input, variant_.specs)) return absentElement(input);
  if (variant_.walk != Walk::Index) return fetch(program_, input, texel);
  return fetch(program_, input, inputTexel(program_, input, access(i), indexGetter()));
}

Texel FoldText::numberedTexel(std::string_view number) {
  program_.require(Function::Texel);
  integers({"sk_shift"});
  return {fmt::format("sk_texel({}, sk_shift)", number), variant_.sourceLayered ? "sk_shift" : ""};
}

namespace {

std::string lanesOf(const Parameter& input) { return fmt::format("sk_in_{}", input.symbol); }

}  // namespace

void FoldText::declareLanes() {
  for (const Parameter* input : inputs_) {
    if (isNeeded(*input, variant_.specs))
      statement(fmt::format("{} {};", fourOf(*input).element->glsl, lanesOf(*input)));
  }
}

void FoldText::fetchLanes(const Texel& texel, std::string_view indent) {
  for (const Parameter* input : inputs_) {
    if (!isNeeded(*input, variant_.specs)) continue;
    statement(fmt::format("{}{} = {};", indent, lanesOf(*input), fetch(program_, fourOf(*input), texel)));
  }
}

std::string FoldText::elementOf(std::size_t i, std::string_view lane) const {
  const Parameter& input = kernel_.parameters[i];
  return isNeeded(input, variant_.specs) ? fmt::format("{}{}", lanesOf(input), lane) : absentElement(input);
}

void FoldText::startFromIdentities(std::string_view indent) {
  for (const Parameter* accumulator : accumulators_) {
    statement(fmt::format("{}{} {} = {};", indent, accumulator->element->glsl, total(*accumulator),
                          identityOf(*accumulator)));
  }
}

std::string_view FoldText::identityOf(const Parameter& accumulator) const {
  auto before = std::ranges::find(accumulators_, &accumulator) - accumulators_.begin();
  for (const Parameter& parameter : reduction_.fold.parameters) {
    if (parameter.role == Role::Accumulator && before-- == 0) return parameter.identity;
  }
  return {};
}

void FoldText::startFromElements(const std::function<std::string(std::size_t i)>& valueOf) {
  for (std::size_t k = 0; k < accumulators_.size(); ++k) {
    const auto i = static_cast<std::size_t>(inputs_[k] - kernel_.parameters.data());
    statement(
        fmt::format("{} {} = {};", accumulators_[k]->element->glsl, total(*accumulators_[k]), valueOf(i)));
  }
}

std::string FoldText::calling(const Kernel& kernel, const ElementOf& inputElement) {
  std::vector<std::string> arguments;
  std::size_t inputs = 0;
  std::size_t accumulators = 0;
  std::size_t values = 0;
  for (std::size_t i = 0; i < kernel.parameters.size(); ++i) {
    switch (kernel.parameters[i].role) {
      case Role::Uniform:
      case Role::Iterator:
      case Role::Spec: arguments.push_back(arguments_[values++]); break;
      case Role::Input: arguments.push_back(inputElement(i, inputs++)); break;
      case Role::Accumulator: arguments.push_back(total(*accumulators_[accumulators++])); break;
      case Role::Output: arguments.push_back(output(kernel.parameters[i])); break;
      case Role::Gather:
      case Role::VariableOutput:
      case Role::Scatter: break;
    }
  }
  return call(kernel.entry, arguments, "        ") + ";";
}

std::string FoldText::sharedName(const Parameter& accumulator) const {
  return fmt::format("sk_shared_{}", accumulator.symbol);
}

void FoldText::declareShared() {
  for (const Parameter* accumulator : accumulators_) {
    program_.variable("shared " + std::string(accumulator->element->glsl),
                      fmt::format("{}[{}]", sharedName(*accumulator), groupSize));
  }
}

void FoldText::foldShared(int blocks) {
  const auto keep = [&](std::string_view indent) {
    for (const Parameter* accumulator : accumulators_) {
      statement(fmt::format("{}{}[sk_i] = {};", indent, sharedName(*accumulator), total(*accumulator)));
    }
  };
  keep("");
  statement(fmt::format("for (int sk_s = {}; sk_s < {}; sk_s *= 2) {{", blocks, groupSize));
  statement("  memoryBarrierShared();");
  statement("  barrier();");
  statement(fmt::format("  if ((sk_i & (2 * sk_s - 1)) < {} && sk_i + sk_s < sk_runs) {{", blocks));
  statement("    " + calling(reduction_.combine, [&](std::size_t, std::size_t k) {
              return fmt::format("{}[sk_i + sk_s]", sharedName(*accumulators_[k]));
            }));
  keep("    ");
  statement("  }");
  statement("}");
}

std::string FoldText::output(const Parameter& parameter) {
  std::string name = fmt::format("sk_element_{}", parameter.symbol);
  program_.variable(parameter.element->glsl, name);
  return name;
}

void FoldText::integers(std::initializer_list<std::string_view> uniforms) {
  for (const std::string_view uniform : uniforms) program_.uniform("int", uniform);
}

void FoldText::vectors(std::initializer_list<std::string_view> uniforms) {
  for (const std::string_view uniform : uniforms) program_.uniform("ivec4", uniform);
}

std::string FoldText::unravel(std::string_view number, std::string_view strides) {
  if (variant_.axes == 1) return fmt::format("ivec4({}, 0, 0, 0)", number);
  program_.require(variant_.axes == 2   ? Function::Unravel2
                   : variant_.axes == 3 ? Function::Unravel3
                                        : Function::Unravel4);
  vectors({strides});
  return fmt::format("sk_unravel({}, {})", number, strides);
}

std::string FoldText::finish(std::string_view comment) {
  if (profile_.stage == Stage::Compute)
    program_.storeAt(place(program_, domain_.texel()), variant_.domainLayered);
  if (variant_.toBuffer) program_.storeInBuffer();
  if (reduction_.combine.usesLoops) program_.takeManyIterations();
  return program_.finish(profile_, fmt::format("{} for {}: {}", reduction_.fold.name, profile_.name, comment),
                         kernel_);
}

}  // namespace sk::assemble
