// SPDX-License-Identifier: MIT
//
// The spellings that print.hpp declares: operators, roles and types as the .sk file writes them.
#include <array>

#include "ir/operators.hpp"
#include "ir/print.hpp"

namespace skc::ir {

std::string_view spelling(BinaryOp op) { return row(op).spelling; }

std::string_view spelling(UnaryOp op) {
  constexpr std::array<std::string_view, 3> names = {"-", "~", "!"};
  return names[static_cast<std::size_t>(op)];
}

std::string spelling(Scalar scalar, int width) {
  std::string name(row(scalar).spelling);
  if (width == 1) return name;
  const bool endsInDigit = name.back() >= '0' && name.back() <= '9';   // "unorm8x4"
  return name + (endsInDigit ? "x" : "") + std::to_string(width);
}

std::string_view spelling(VarRole role) {
  constexpr std::array<std::string_view, 6> names = {"local", "in", "inout", "element", "gather", "append"};
  return names[static_cast<std::size_t>(role)];
}

std::string_view spelling(ParamRole role) {
  constexpr std::array<std::string_view, 9> names = {"uniform", "input",       "output",
                                                     "gather",  "accumulator", "variable output",
                                                     "scatter", "iterator",    "spec"};
  return names[static_cast<std::size_t>(role)];
}

std::string_view spelling(ScatterOp op) {
  constexpr std::array<std::string_view, 4> names = {"=", "+=", "min", "max"};
  return names[static_cast<std::size_t>(op)];
}

std::string_view spelling(Boundary boundary) {
  constexpr std::array<std::string_view, 4> names = {"clamp", "wrap", "mirror", "border"};
  return names[static_cast<std::size_t>(boundary)];
}

std::string qualifier(const std::vector<std::string>& scope) {
  std::string text;
  for (const std::string& name : scope) text += name + "::";
  return text;
}

std::string print(const Module& module, Type type) {
  switch (type.kind) {
    case Type::Kind::Void: return "void";
    case Type::Kind::Scalar:
    case Type::Kind::Vector: return spelling(type.scalar, type.width);
    case Type::Kind::Matrix: return "float" + std::to_string(type.width) + "x" + std::to_string(type.width);
    case Type::Kind::Struct: {
      const Struct& entry = module.structs[type.index];
      return qualifier(entry.scope) + entry.name;
    }
    case Type::Kind::Array: break;
  }
  const Array& array = module.arrays[type.index];
  return print(module, array.element) + "[" + std::to_string(array.length) + "]";
}

}  // namespace skc::ir
