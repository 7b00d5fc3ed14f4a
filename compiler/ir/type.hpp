// SPDX-License-Identifier: MIT
//
// Types of the IR: values that compare by content. Structs and arrays are entries of the module's
// tables, and a Type names them by index.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "support/loc.hpp"

namespace skc::ir {

enum class Scalar : std::uint8_t { Bool, Int, Uint, Float };

struct Type {
  enum class Kind : std::uint8_t { Void, Scalar, Vector, Struct, Array };
  Kind kind = Kind::Void;
  Scalar scalar = Scalar::Float;   ///< Scalar and Vector
  std::uint8_t width = 1;          ///< Scalar: 1; Vector: 2 to 4
  std::uint32_t index = 0;         ///< Struct: into Module::structs; Array: into Module::arrays

  static constexpr Type voidType() { return {}; }
  static constexpr Type of(Scalar scalar, int width = 1) {
    return {width == 1 ? Kind::Scalar : Kind::Vector, scalar, static_cast<std::uint8_t>(width), 0};
  }
  static constexpr Type structType(std::uint32_t index) { return {Kind::Struct, Scalar::Float, 1, index}; }
  static constexpr Type arrayType(std::uint32_t index) { return {Kind::Array, Scalar::Float, 1, index}; }

  bool isVoid() const { return kind == Kind::Void; }
  bool isScalar() const { return kind == Kind::Scalar; }
  bool isVector() const { return kind == Kind::Vector; }
  bool isArithmetic() const { return isScalar() || isVector(); }
  bool isFloat() const { return isArithmetic() && scalar == Scalar::Float; }
  bool isBool() const { return isArithmetic() && scalar == Scalar::Bool; }
  bool isInteger() const { return isArithmetic() && (scalar == Scalar::Int || scalar == Scalar::Uint); }
  Type withScalar(Scalar s) const { return of(s, width); }
  Type component() const { return of(scalar); }
  bool operator==(const Type&) const = default;
};

struct StructField {
  std::string name;
  Type type;
};
struct Struct {
  std::string name;                  ///< without namespaces
  std::vector<std::string> scope;    ///< enclosing namespaces, outermost first
  std::vector<StructField> fields;
  Loc loc;
};
struct Array {
  Type element;
  std::uint32_t length;
  bool operator==(const Array&) const = default;
};

}  // namespace skc::ir
