// SPDX-License-Identifier: MIT
//
// Index and number of the element, from the texel. In a plane the index is only a swizzle, so it is a
// function; in a linearised stream it takes divisions, so main() computes it once.
#include "assemble/elements/domain.hpp"

#include <cassert>

#include <fmt/format.h>

namespace sk::assemble {

DomainText::DomainText(ProgramText& program, const DomainLayout& layout, std::string_view function)
    : program_(program), layout_(layout), function_(function) {
  if (layout_.domain == Domain::LinearBox || isStrided()) defineIndex();
}

std::string DomainText::lane() {
  usesLane_ = true;
  program_.variable("int", "sk_lane");
  return "sk_lane";
}

/// The index of the current element, from the index of the first element in its texel.
std::string DomainText::plus(std::string index, int components) {
  if (!layout_.packed) return index;
  if (components == 1) return fmt::format("({} + {})", index, lane());
  return fmt::format("({} + ivec{}({}{}))", index, components, lane(), components == 2 ? ", 0" : ", 0, 0, 0");
}

std::string DomainText::index() {
  defineIndex();
  return fmt::format("{}()", function_);
}

std::string DomainText::seenIndex() {
  const std::string within = index();
  if (!layout_.placed) return within;
  const std::string signature = "ivec4 sk_index()";
  if (!program_.isDefined(signature)) {
    program_.function(signature,
                      {fmt::format("return {} + {};", within, program_.uniform("ivec4", "sk_domain_low"))});
  }
  return "sk_index()";
}

std::string DomainText::seenShape() {
  return program_.uniform("ivec4", layout_.placed ? "sk_domain_whole" : "sk_domain_shape");
}

std::string DomainText::seenPosition(int components) {
  const std::string within = position(components);
  if (!layout_.placed) return within;
  static constexpr std::string_view xyzw = "xyzw";
  return fmt::format("({} + {}.{})", within, program_.uniform("ivec4", "sk_domain_low"),
                     xyzw.substr(0, static_cast<std::size_t>(components)));
}

std::string DomainText::position(int components) {
  const bool aligned = layout_.domain == Domain::Plane && !layout_.view;
  if (aligned && components == 1) {
    return plus(fmt::format("{}{}", layout_.packed ? "4 * " : "", program_.column()), 1);
  }
  if (aligned && components == 2) return plus(fmt::format("{}{}", program_.texel(), inElements()), 2);
  static constexpr std::string_view xyzw = "xyzw";
  const std::string whole = index();
  return components == 4 ? whole
                         : fmt::format("{}.{}", whole, xyzw.substr(0, static_cast<std::size_t>(components)));
}

std::string DomainText::texelPosition(int components) {
  assert(layout_.domain == Domain::Plane && layout_.packed && components <= 2);
  const std::string texel(components == 1 ? program_.column() : program_.texel());
  if (!layout_.view) return texel;
  const std::string origin = program_.uniform("ivec4", "sk_domain_origin");
  return components == 1 ? fmt::format("({} - ({}.x >> 2))", texel, origin)
                         : fmt::format("({} - ({}.xy >> ivec2(2, 0)))", texel, origin);
}

std::string DomainText::number() {
  switch (layout_.domain) {
    case Domain::Plane: {
      const std::string width = program_.uniform("ivec4", "sk_domain_shape") + ".x";
      return fmt::format("{0}.y * {1} + {0}.x", index(), width);
    }
    case Domain::Linear:
      return layout_.packed ? fmt::format("{} | {}", firstElement(), lane()) : texelNumber();
    case Domain::LinearBox:
      program_.require(Function::Ravel);
      return fmt::format("sk_ravel({}, {})", index(), program_.uniform("ivec4", "sk_domain_step"));
    case Domain::Strided:
    case Domain::StridedRows:
    case Domain::StridedLinear:
      assert(!"only copies, which number nothing, go to strided regions");
      return {};
    case Domain::Entry: return "sk_element";
  }
  return {};
}

void DomainText::leaveOutside() {
  if (!isDrawn()) return;  // dispatches have no such invocations
  const std::string shape = program_.uniform("ivec4", "sk_domain_shape");
  switch (layout_.domain) {
    case Domain::Plane: {
      const std::string origin =
          layout_.view ? " - " + program_.uniform("ivec4", "sk_domain_origin") + ".xy" : "";
      program_.prologue(fmt::format("if (any(greaterThanEqual(uvec2({}{}{}), uvec2({}.xy)))) return;",
                                    program_.texel(), inElements(), origin, shape));
      return;
    }
    case Domain::Linear: {
      const std::string stride = program_.uniform("ivec4", "sk_domain_stride");
      program_.prologue(fmt::format("if (({}) >= {}.w * {}.w) return;", firstElement(), stride, shape));
      return;
    }
    case Domain::LinearBox:
    case Domain::Strided:
    case Domain::StridedRows:
    case Domain::StridedLinear: return;  // main() discards these
    case Domain::Entry: {
      const std::string stride = program_.uniform("ivec4", "sk_domain_stride");
      program_.prologue(fmt::format("if (sk_element >= {}.w * {}.w) return;", stride, shape));
      return;
    }
  }
}

Texel DomainText::texel() {
  const std::string texel(program_.texel());
  if (layout_.domain == Domain::Strided && !isDrawn()) {
    return {fmt::format("{}.xy + sk_here.xy * {}.xy", program_.uniform("ivec4", "sk_domain_origin"),
                        program_.uniform("ivec4", "sk_domain_stride"))};
  }
  if (!layout_.layered) return {texel};
  const std::string shift = program_.uniform("int", "sk_domain_shift");
  if (!isDrawn()) return {texel, shift};
  return {fmt::format("{} + ivec2(0, {})", texel, program_.uniform("int", "sk_domain_row")), shift};
}

std::string DomainText::texelNumber() {
  const std::string row =
      layout_.layered && isDrawn()
          ? fmt::format("({} + {})", program_.uniform("int", "sk_domain_row"), program_.row())
          : std::string(program_.row());
  return fmt::format("{} << {} | {}", row, program_.uniform("int", "sk_domain_shift"), program_.column());
}

/// The number of the first element in the texel.
std::string DomainText::firstElement() {
  return layout_.packed ? fmt::format("({}) << 2", texelNumber()) : texelNumber();
}

void DomainText::defineIndex() {
  const std::string signature = fmt::format("ivec4 {}()", function_);
  if (program_.isDefined(signature)) return;
  if (isStrided()) {
    program_.variable("ivec4", "sk_here");
    program_.function(signature, {"return sk_here;"});
    return defineStridedIndex();
  }
  if (layout_.domain == Domain::Plane) {
    const std::string origin =
        layout_.view ? " - " + program_.uniform("ivec4", "sk_domain_origin") + ".xy" : "";
    const std::string first = fmt::format("ivec4({}{}{}, 0, 0)", program_.texel(), inElements(), origin);
    program_.function(signature, {fmt::format("return {};", plus(first, 4))});
    return;
  }
  if (layout_.domain != Domain::Entry) program_.prologue(fmt::format("int sk_element = {};", firstElement()));
  std::string value = "ivec4(sk_element, 0, 0, 0)";
  if (layout_.rank > 1) {
    program_.require(layout_.rank == 2   ? Function::Unravel2
                     : layout_.rank == 3 ? Function::Unravel3
                                         : Function::Unravel4);
    value = fmt::format("sk_unravel(sk_element, {})", program_.uniform("ivec4", "sk_domain_stride"));
  }
  program_.variable("ivec4", "sk_here");
  program_.function(signature, {fmt::format("return {};", plus("sk_here", 4))});
  if (layout_.domain != Domain::LinearBox) {
    program_.prologue(fmt::format("sk_here = {};", value));
    return;
  }
  const std::string origin = program_.uniform("ivec4", "sk_domain_origin");
  const std::string shape = program_.uniform("ivec4", "sk_domain_shape");
  program_.prologue(fmt::format("sk_here = {} - {};", value, origin));
  program_.prologue(fmt::format("if (any(greaterThanEqual(uvec4(sk_here), uvec4({})))) {};", shape,
                                isDrawn() ? "discard" : "return"));
}

/// The index of a texel's element, if it has one: what is left of its distance from the first element is 0 after whole
/// strides, the longest first. Compute programs run for the elements of a strided plane alone.
void DomainText::defineStridedIndex() {
  const std::string origin = program_.uniform("ivec4", "sk_domain_origin");
  const std::string shape = program_.uniform("ivec4", "sk_domain_shape");
  const std::string stride = program_.uniform("ivec4", "sk_domain_stride");
  const std::string_view leave = isDrawn() ? "discard" : "return";
  if (layout_.domain == Domain::Strided && !isDrawn()) {
    program_.prologue(fmt::format("sk_here = ivec4({}, 0, 0);", program_.texel()));
    return;
  }
  if (layout_.domain == Domain::Strided) {
    program_.prologue(fmt::format("ivec2 sk_left = {} - {}.xy;", program_.texel(), origin));
    // exact, since texels number less than 2^16 in each dimension
    program_.prologue(fmt::format("sk_here = ivec4((vec2(sk_left) + 0.5) / vec2({}.xy), 0, 0);", stride));
    program_.prologue(fmt::format("if (sk_here.xy * {}.xy != sk_left) {};", stride, leave));
    return;
  }
  const std::string number = layout_.domain == Domain::StridedLinear
                                 ? texelNumber()
                                 : fmt::format("{} * {} + {}", program_.row(),
                                               program_.uniform("int", "sk_domain_shift"), program_.column());
  program_.prologue(fmt::format("int sk_left = ({}) - {}.x;", number, origin));
  program_.prologue(fmt::format("if (sk_left < 0) {};", leave));
  program_.require(Function::Divide);
  program_.prologue("sk_here = ivec4(0);");
  for (int d = layout_.rank; d-- > 0;) {
    program_.prologue(fmt::format(
        "sk_here.{0} = sk_divide(sk_left, {1}.{0}); sk_left -= sk_here.{0} * {1}.{0};", "xyzw"[d], stride));
  }
  program_.prologue(fmt::format("if (sk_left != 0 || any(greaterThanEqual(sk_here, {}))) {};", shape, leave));
}

}  // namespace sk::assemble
