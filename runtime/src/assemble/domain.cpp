// SPDX-License-Identifier: MIT
//
// Index and number from the texel that is computed. In a plane the index is a swizzle away, so it is a function;
// in a linearised stream it takes divisions, so main() computes it once.
#include "assemble/domain.hpp"

#include <fmt/format.h>

namespace sk::assemble {

DomainText::DomainText(ProgramText& program, Domain domain, bool view, int rank, bool layered,
                       std::string_view function)
    : program_(program), domain_(domain), view_(view), rank_(rank), layered_(layered), function_(function) {
  if (domain_ == Domain::LinearBox) defineIndex();
}

std::string DomainText::index() {
  defineIndex();
  return fmt::format("{}()", function_);
}

std::string DomainText::position(int components) {
  const bool aligned = domain_ == Domain::Plane && !view_;
  if (aligned && components == 1) return std::string(program_.column());
  if (aligned && components == 2) return std::string(program_.texel());
  static constexpr std::string_view xyzw = "xyzw";
  const std::string whole = index();
  return components == 4 ? whole
                         : fmt::format("{}.{}", whole, xyzw.substr(0, static_cast<std::size_t>(components)));
}

std::string DomainText::number() {
  switch (domain_) {
    case Domain::Plane: {
      const std::string width = program_.uniform("ivec4", "sk_domain_shape") + ".x";
      return fmt::format("{0}.y * {1} + {0}.x", index(), width);
    }
    case Domain::Linear: return texelNumber();
    case Domain::LinearBox:
      program_.require(Function::Ravel);
      return fmt::format("sk_ravel({}, {})", index(), program_.uniform("ivec4", "sk_domain_step"));
    case Domain::Entry: return "sk_element";
  }
  return {};
}

void DomainText::leaveOutside() {
  if (!isDrawn()) return;  // nothing runs there
  const std::string shape = program_.uniform("ivec4", "sk_domain_shape");
  switch (domain_) {
    case Domain::Plane: {
      const std::string origin = view_ ? " - " + program_.uniform("ivec4", "sk_domain_origin") + ".xy" : "";
      program_.prologue(fmt::format("if (any(greaterThanEqual(uvec2({}{}), uvec2({}.xy)))) return;",
                                    program_.texel(), origin, shape));
      return;
    }
    case Domain::Linear: {
      const std::string stride = program_.uniform("ivec4", "sk_domain_stride");
      program_.prologue(fmt::format("if (({}) >= {}.w * {}.w) return;", texelNumber(), stride, shape));
      return;
    }
    case Domain::LinearBox: return;  // these are discarded
    case Domain::Entry: {
      const std::string stride = program_.uniform("ivec4", "sk_domain_stride");
      program_.prologue(fmt::format("if (sk_element >= {}.w * {}.w) return;", stride, shape));
      return;
    }
  }
}

Texel DomainText::texel() {
  const std::string texel(program_.texel());
  if (!layered_) return {texel};
  const std::string shift = program_.uniform("int", "sk_domain_shift");
  if (!isDrawn()) return {texel, shift};
  return {fmt::format("{} + ivec2(0, {})", texel, program_.uniform("int", "sk_domain_row")), shift};
}

std::string DomainText::texelNumber() {
  const std::string row =
      layered_ && isDrawn()
          ? fmt::format("({} + {})", program_.uniform("int", "sk_domain_row"), program_.row())
          : std::string(program_.row());
  return fmt::format("{} << {} | {}", row, program_.uniform("int", "sk_domain_shift"), program_.column());
}

void DomainText::defineIndex() {
  const std::string signature = fmt::format("ivec4 {}()", function_);
  if (program_.isDefined(signature)) return;
  if (domain_ == Domain::Plane) {
    const std::string origin = view_ ? " - " + program_.uniform("ivec4", "sk_domain_origin") + ".xy" : "";
    program_.function(signature, {fmt::format("return ivec4({}{}, 0, 0);", program_.texel(), origin)});
    return;
  }
  if (domain_ != Domain::Entry) program_.prologue(fmt::format("int sk_element = {};", texelNumber()));
  std::string value = "ivec4(sk_element, 0, 0, 0)";
  if (rank_ > 1) {
    program_.require(rank_ == 2 ? Function::Unravel2 : rank_ == 3 ? Function::Unravel3 : Function::Unravel4);
    value = fmt::format("sk_unravel(sk_element, {})", program_.uniform("ivec4", "sk_domain_stride"));
  }
  program_.variable("ivec4", "sk_here");
  program_.function(signature, {"return sk_here;"});
  if (domain_ != Domain::LinearBox) {
    program_.prologue(fmt::format("sk_here = {};", value));
    return;
  }
  const std::string origin = program_.uniform("ivec4", "sk_domain_origin");
  const std::string shape = program_.uniform("ivec4", "sk_domain_shape");
  program_.prologue(fmt::format("sk_here = {} - {};", value, origin));
  program_.prologue(fmt::format("if (any(greaterThanEqual(uvec4(sk_here), uvec4({})))) {};", shape,
                                isDrawn() ? "discard" : "return"));
}

}  // namespace sk::assemble
