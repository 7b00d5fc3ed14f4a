// SPDX-License-Identifier: MIT
#include "assemble/reduce/scan_text.hpp"

#include <fmt/format.h>

namespace sk::assemble {

using program::Kernel;
using program::Parameter;
using program::Reduction;
using program::Role;

ContinuedKernel::ContinuedKernel(const Kernel& kernel)
    : parameters_(kernel.parameters.begin(), kernel.parameters.end()),
      ownParameters_(parameters_.size()),
      kernel_(kernel) {
  for (const Parameter& parameter : kernel.parameters) {
    if (parameter.role != Role::Accumulator) continue;
    parameters_.push_back({.name = parameter.name,
                           .symbol = parameter.symbol,
                           .role = Role::Input,
                           .element = parameter.element});
  }
  kernel_.parameters = parameters_;
}

ScanText::ScanText(const Profile& profile, const Reduction& reduction, const ReduceVariant& variant)
    : FoldText(profile, reduction, variant, isOfPartials(variant.walk) ? reduction.combine : reduction.fold),
      continued_(kernel_) {}

std::vector<Parameter> ScanText::declareParameters() {
  defineParameters();
  if (variant_.carried) {
    for (const Parameter& carry : continued_.carries())
      declareSamplers(program_, carry, variant_.carryLayered);
  }
  std::vector<Parameter> written = withPlanes(accumulators_, variant_.firstPlane, variant_.planeCount);
  if (keepsLanes()) {
    for (Parameter& parameter : written) parameter = fourOf(parameter);
  }
  for (const Parameter& parameter : written) declareOutputs(program_, parameter);
  return written;
}

std::string ScanText::comment() const {
  const std::string_view items = isOfPartials(variant_.walk)    ? "results of runs"
                                 : variant_.walk == Walk::Index ? "elements by index"
                                                                : "elements of a line";
  const std::string_view results = variant_.scan == ScanPass::Folds       ? "a result for each run"
                                   : variant_.scan == ScanPass::Inclusive ? "a result for each"
                                                                          : "a result before each";
  const std::string_view unit = variant_.unit == ScanUnit::Tile  ? ", by tiles"
                                : variant_.unit == ScanUnit::Run ? ", by runs"
                                                                 : "";
  return fmt::format("{}{}, {}{}", variant_.packed ? "packed " : "", items, results, unit);
}

void ScanText::moveTo(std::string_view number, std::string_view indent) {
  if (variant_.walk != Walk::Index) return;
  std::string index = fmt::format("ivec4({}, 0, 0, 0)", number);
  if (variant_.axes > 1) {
    program_.require(variant_.axes == 2   ? Function::Unravel2
                     : variant_.axes == 3 ? Function::Unravel3
                                          : Function::Unravel4);
    vectors({"sk_item_step"});
    index = fmt::format("sk_unravel({}, sk_item_step)", number);
  }
  statement(fmt::format("{}{} = {};", indent, item(), index));
}

std::string ScanText::elementAt(std::size_t i, std::string_view number) {
  return element(i, variant_.walk == Walk::Index ? Texel{} : numbered(number));
}

Texel ScanText::numbered(std::string_view number) {
  if (variant_.walk == Walk::Plane) {
    integers({"sk_width"});
    vectors({"sk_origin"});
    program_.function(
        "ivec2 sk_in_rows(int sk_n)",
        {"int sk_y = sk_n / sk_width;", "return sk_origin.xy + ivec2(sk_n - sk_y * sk_width, sk_y);"});
    return {fmt::format("sk_in_rows({})", number)};
  }
  if (variant_.walk != Walk::Line) return numberedTexel(number);
  integers({"sk_start"});
  return numberedTexel(fmt::format("sk_start + {}", number));
}

void ScanText::takeCarry(std::string_view number, std::string_view indent) {
  integers({"sk_carry_shift"});
  program_.require(Function::Texel);
  statement(fmt::format("{}int sk_carry = {};", indent, number));
  const Texel texel{"sk_texel(sk_carry, sk_carry_shift)", variant_.carryLayered ? "sk_carry_shift" : ""};
  for (std::size_t k = 0; k < accumulators_.size(); ++k) {
    statement(fmt::format("{}{} = {};", indent, total(*accumulators_[k]),
                          fetch(program_, continued_.carries()[k], texel)));
  }
}

Texel ScanText::resultTexel(const std::string& number) {
  const auto uniform = [&](std::string_view type, std::string_view name) {
    return program_.uniform(type, name);
  };
  switch (variant_.domain) {
    case Domain::Plane: {
      const std::string origin =
          variant_.domainView ? uniform("ivec4", "sk_domain_origin") + ".xy + " : std::string();
      const std::string width = uniform("ivec4", "sk_domain_shape") + ".x";
      program_.function("ivec2 sk_place_of(int sk_n)",
                        {fmt::format("int sk_y = sk_n / {};", width),
                         fmt::format("return {}ivec2(sk_n - sk_y * {}, sk_y);", origin, width)});
      return {fmt::format("sk_place_of({})", number)};
    }
    case Domain::LinearBox: {
      program_.require(variant_.domainRank <= 2   ? Function::Unravel2
                       : variant_.domainRank == 3 ? Function::Unravel3
                                                  : Function::Unravel4);
      program_.require(Function::Ravel);
      program_.require(Function::Texel);
      const std::string shift = uniform("int", "sk_domain_shift");
      const std::string index = variant_.domainRank == 1 ? fmt::format("ivec4({}, 0, 0, 0)", number)
                                                         : fmt::format("sk_unravel({}, {})", number,
                                                                       uniform("ivec4", "sk_domain_step"));
      return {fmt::format("sk_texel(sk_ravel({} + {}, {}), {})", index, uniform("ivec4", "sk_domain_origin"),
                          uniform("ivec4", "sk_domain_stride"), shift),
              variant_.domainLayered ? shift : ""};
    }
    case Domain::Linear:
    case Domain::Entry: break;
    case Domain::Strided:  // of copies only
    case Domain::StridedRows:
    case Domain::StridedLinear: break;
  }
  program_.require(Function::Texel);
  const std::string shift = uniform("int", "sk_domain_shift");
  return {fmt::format("sk_texel({}, {})", number, shift), variant_.domainLayered ? shift : ""};
}

}  // namespace sk::assemble
