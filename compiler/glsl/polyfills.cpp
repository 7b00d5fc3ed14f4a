// SPDX-License-Identifier: MIT
#include "glsl/polyfills.hpp"

#include <algorithm>
#include <bit>
#include <string_view>
#include <utility>

#include <fmt/format.h>

#include "glsl/type_names.hpp"
#include "ir/build.hpp"
#include "ir/call_graph.hpp"
#include "ir/operators.hpp"
#include "ir/print.hpp"
#include "ir/scalar_operations.hpp"
#include "sk/arithmetic_marks.hpp"
#include "support/text.hpp"

namespace skc::emit {
namespace {

using namespace ir;
namespace mark = sk::program::mark;

/// "a.x && b.x, a.y && b.y" from a pattern with `@` for the component.
std::string byComponent(std::string_view pattern, int width) {
  std::vector<std::string> items;
  for (int i = 0; i < width; ++i) {
    std::string item(pattern);
    std::replace(item.begin(), item.end(), '@', "xyzw"[i]);
    items.push_back(std::move(item));
  }
  return join(items, ", ");
}

/// What a value in the range of a normalized type is rounded to.
std::string fraction(Scalar narrow, std::string_view value) {
  const float scale = normalizedScale(narrow);
  return fmt::format("{}roundEven({} * {:.1f}){}{}{}", mark::fraction, value, scale, mark::fractionEnd,
                     std::bit_width(static_cast<unsigned>(scale)), mark::fractionBitsEnd);
}

/// The function that rounds a value of the arithmetic type to a narrow scalar, as scalar_operations.hpp specifies.
std::string quantizing(Scalar narrow) {
  switch (narrow) {
    case Scalar::Char: return "int sk_char(int x) { return (x << 24) >> 24; }\n";
    case Scalar::Uchar: return "int sk_uchar(int x) { return x & 255; }\n";
    case Scalar::Short: return "int sk_short(int x) { return (x << 16) >> 16; }\n";
    case Scalar::Ushort: return "int sk_ushort(int x) { return x & 65535; }\n";
    case Scalar::Half:
      return "float sk_half(float x) {\n"
             "  uint bits = floatBitsToUint(x), m = bits & 0x7fffffffu;\n"
             "  if (m > 0x7f800000u) return x;\n"
             "  uint r = (m + 0xfffu + ((m >> 13) & 1u)) & 0xffffe000u;\n"
             "  if (r > 0x477fe000u) r = 0x7f800000u;\n"
             "  if (m < 0x38800000u) {\n"
             "    r = floatBitsToUint(roundEven(uintBitsToFloat(m) * 16777216.0) * 5.9604645e-8);\n"
             "  }\n"
             "  return uintBitsToFloat((bits & 0x80000000u) | r);\n"
             "}\n";
    case Scalar::Unorm8:
    case Scalar::Unorm16:
      return fmt::format(
          "float sk_{0}(float x) {{\n"
          "  return x > 0.0 ? {1} : 0.0;\n}}\n",
          spelling(narrow), fraction(narrow, "min(x, 1.0)"));
    case Scalar::Snorm8:
    case Scalar::Snorm16:
      return fmt::format(
          "float sk_{0}(float x) {{\n"
          "  float y = x > -1.0 ? min(x, 1.0) : x <= -1.0 ? -1.0 : 0.0;\n"
          "  return {1};\n}}\n",
          spelling(narrow), fraction(narrow, "y"));
    case Scalar::Bool:
    case Scalar::Int:
    case Scalar::Uint:
    case Scalar::Float:
    case Scalar::Double:
    case Scalar::Long:
    case Scalar::Ulong: break;
  }
  return {};
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
      case 'F': text += glslSpelling(Scalar::Float, argument.width); break;
      case 'B': text += glslSpelling(Scalar::Bool, argument.width); break;
      case 's': text += argument.scalar == Scalar::Int ? 'i' : 'u'; break;
      default: text += pattern[i]; continue;   // any other character, `$0` among them
    }
    ++i;
  }
  return text;
}

std::vector<FunctionId> ownFunctionsOf(const Module& module, const Kernel& kernel) {
  std::vector<FunctionId> functions = functionsOf(module, kernel);
  std::erase_if(functions, [&](FunctionId id) { return module.functions[id].isLibrary; });
  return functions;
}

std::string parameterList(const std::vector<Type>& types, char first) {
  std::vector<std::string> list;
  for (const Type type : types)
    list.push_back(fmt::format("{} {}", glslSpelling(type.scalar, type.width), first++));
  return join(list, ", ");
}

FunctionId Polyfills::add(std::string_view name, Type result, const std::vector<Type>& parameters,
                          Polyfill polyfill) {
  const auto [entry, isNew] = ids_.emplace(fmt::format("{}({})", name, parameterList(parameters)),
                                           static_cast<FunctionId>(module_->functions.size()));
  if (!isNew) return entry->second;
  Function function;
  function.name = name;
  function.result = result;
  function.isLibrary = true;
  for (const Type type : parameters) addVariable(function, {}, type, VarRole::In);
  module_->functions.push_back(std::move(function));
  polyfills_.emplace(entry->second, std::move(polyfill));
  return entry->second;
}

FunctionId Polyfills::addByComponent(std::string_view name, Type result, const std::vector<Type>& parameters,
                                     Polyfill scalar) {
  std::vector<Type> components;
  int width = 1;
  for (const Type type : parameters) {
    components.push_back(type.component());
    width = std::max<int>(width, type.width);
  }
  const FunctionId one = add(name, result.component(), components, std::move(scalar));
  if (width == 1) return one;
  const bool isConversion = parameters.size() == 1 && !parameters[0].is64Bit() && !result.is64Bit();
  char first = isConversion ? 'x' : 'a';
  const std::string list = parameterList(parameters, first);
  std::vector<std::string> args;
  for (const Type parameter : parameters)
    args.push_back(fmt::format("{}{}", first++, parameter.isVector() ? ".@" : ""));
  const std::string type = glslSpelling(result.scalar, width);
  const std::string text = fmt::format("{0} {1}({2}) {{ return {0}({3}); }}", type, name, list,
                                       byComponent(fmt::format("{}({})", name, join(args, ", ")), width));
  return add(name, result, parameters, {.text = wrapLine(text) + "\n", .callees = {one}});
}

ExprPtr Polyfills::call(FunctionId function, std::vector<ExprPtr> args) const {
  return ir::call(*module_, function, std::move(args));
}

FunctionId Polyfills::logical(BinaryOp op, Type type) {
  const std::string name = op == BinaryOp::LogicalAnd ? "sk_and" : "sk_or";
  return add(name, type, {type, type},
             {fmt::format("bvec{0} {1}(bvec{0} a, bvec{0} b) {{ return bvec{0}({2}); }}\n", type.width, name,
                          byComponent(fmt::format("a.@ {} b.@", spelling(op)), type.width))});
}

FunctionId Polyfills::quotient(BinaryOp op, Type lhs, Type rhs) {
  const bool isRemainder = op == BinaryOp::Rem;
  const std::string name = isRemainder ? "sk_rem" : "sk_div";
  const std::string text =
      lhs.scalar == Scalar::Int
          ? fmt::format(
                "int {}(int a, int b) {{\n"
                "  int d = b == 0 || (b == -1 && a == -2147483647 - 1) ? 1 : b;\n"
                "  return {};\n}}\n",
                name, isRemainder ? "a - a / d * d" : "a / d")
          : fmt::format("uint {}(uint a, uint b) {{ return a {} (b == 0u ? 1u : b); }}\n", name,
                        spelling(op));
  return addByComponent(name, lhs.isVector() ? lhs : rhs, {lhs, rhs}, {text});
}

FunctionId Polyfills::magnitude(Type type) {
  return add(
      "sk_abs", type, {type},
      {fmt::format("{0} sk_abs({0} x) {{ return max(x, -x); }}\n", glslSpelling(type.scalar, type.width))});
}

FunctionId Polyfills::nonzero() {
  return add("sk_nonzero", Type::of(Scalar::Bool), {Type::of(Scalar::Float)},
             {"bool sk_nonzero(float x) { return (floatBitsToUint(x) & 0x7fffffffu) != 0u; }\n"});
}

FunctionId Polyfills::truncated(Type to) {
  const bool isInt = arithmeticScalar(to.scalar) == Scalar::Int;
  return addByComponent(
      isInt ? "sk_int" : "sk_uint", to.arithmeticType(), {to.withScalar(Scalar::Float)},
      {isInt
           ? "int sk_int(float x) {\n"
             "  if (x >= 2147483648.0) return 2147483647;\n"
             "  return x > -2147483648.0 ? int(x) : x <= -2147483648.0 ? -2147483647 - 1 : 0;\n"
             "}\n"
           : "uint sk_uint(float x) { return x >= 4294967296.0 ? 0xffffffffu : x > 0.0 ? uint(x) : 0u; }\n"});
}

FunctionId Polyfills::quantize(Type type) {
  return addByComponent("sk_" + spelling(type.scalar), type.arithmeticType(), {type.arithmeticType()},
                        {quantizing(type.scalar)});
}

FunctionId Polyfills::select(Type type) {
  const Type cond = type.withScalar(Scalar::Bool);
  return add("sk_select", type, {cond, type, type},
             {fmt::format("{0} sk_select(bvec{1} c, {0} yes, {0} no) {{\n  return {0}({2});\n}}\n",
                          glslSpelling(type.scalar, type.width), type.width,
                          byComponent(type.is64Bit() ? "sk_choose(c.@, yes.@, no.@)" : "c.@ ? yes.@ : no.@",
                                      type.width))});
}

FunctionId Polyfills::component(Type vector, Type index) {
  const bool isUint = index.scalar == Scalar::Uint;
  std::string choice;
  for (int i = 0; i + 1 < vector.width; ++i)
    choice += fmt::format("i < {}{} ? v.{} : ", i + 1, isUint ? "u" : "", "xyzw"[i]);
  return add("sk_component", vector.component(), {vector, index},
             {fmt::format("{} sk_component({} v, {} i) {{\n  return {}v.{};\n}}\n",
                          glslSpelling(vector.scalar, 1), glslSpelling(vector.scalar, vector.width),
                          glslSpelling(index.scalar, 1), choice, "xyzw"[vector.width - 1])});
}

}  // namespace skc::emit
