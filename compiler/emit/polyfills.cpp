// SPDX-License-Identifier: MIT
#include "emit/polyfills.hpp"

#include <algorithm>
#include <string_view>
#include <utility>

#include <fmt/format.h>

#include "emit/type_names.hpp"
#include "support/text.hpp"

namespace skc::emit {
namespace {

using namespace ir;

/// "a.x && b.x, a.y && b.y" for a pattern with `@` in place of the component.
std::string byComponent(std::string_view pattern, int width) {
  std::vector<std::string> items;
  for (int i = 0; i < width; ++i) {
    std::string item(pattern);
    std::replace(item.begin(), item.end(), '@', "xyzw"[i]);
    items.push_back(std::move(item));
  }
  return join(items, ", ");
}

}  // namespace

std::string withTypes(std::string_view pattern, Type argument) {
  std::string text;
  for (std::size_t i = 0; i < pattern.size(); ++i) {
    const char letter = pattern[i] == '$' && i + 1 < pattern.size() ? pattern[i + 1] : '\0';
    switch (letter) {
      case 'T': text += glslSpelling(argument.scalar, argument.width); break;
      case 'I': text += glslSpelling(Scalar::Int, argument.width); break;
      case 'U': text += glslSpelling(Scalar::Uint, argument.width); break;
      case 'B': text += glslSpelling(Scalar::Bool, argument.width); break;
      default: text += pattern[i]; continue;   // any other character, `$0` among them
    }
    ++i;
  }
  return text;
}

void Polyfills::add(std::string function) {
  if (std::find(functions_.begin(), functions_.end(), function) == functions_.end()) {
    functions_.push_back(std::move(function));
  }
}

void Polyfills::intrinsic(Intrinsic intrinsic, Type argument) {
  const std::string_view polyfill = row(intrinsic).polyfill;
  if (!polyfill.empty()) add(withTypes(polyfill, argument) + "\n");
}

std::string Polyfills::logical(BinaryOp op, int width) {
  const bool isAnd = op == BinaryOp::LogicalAnd;
  const std::string name = isAnd ? "sk_and" : "sk_or";
  add(fmt::format("bvec{0} {1}(bvec{0} a, bvec{0} b) {{ return bvec{0}({2}); }}\n", width, name,
                  byComponent(isAnd ? "a.@ && b.@" : "a.@ || b.@", width)));
  return name;
}

std::string Polyfills::remainder(Type lhs, Type rhs) {
  const Type result = lhs.isVector() ? lhs : rhs;
  add(fmt::format("{} sk_rem({} a, {} b) {{ return a - a / b * b; }}\n",
                  glslSpelling(Scalar::Int, result.width), glslSpelling(Scalar::Int, lhs.width),
                  glslSpelling(Scalar::Int, rhs.width)));
  return "sk_rem";
}

std::string Polyfills::select(Type type) {
  add(fmt::format("{0} sk_select(bvec{1} c, {0} yes, {0} no) {{\n  return {0}({2});\n}}\n",
                  glslSpelling(type.scalar, type.width), type.width,
                  byComponent("c.@ ? yes.@ : no.@", type.width)));
  return "sk_select";
}

}  // namespace skc::emit
