// SPDX-License-Identifier: MIT
//
// IR types, compared by value. Structs and arrays are entries of the module's tables; a Type refers to them
// by index.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "support/loc.hpp"

namespace skc::ir {

/// From Half on, the narrow scalars: storage types, whose values are a subset of their arithmetic type's.
enum class Scalar : std::uint8_t {
#define SKC_SCALAR(Name, spelling, cpp, arithmetic, bits, one) Name,
#include "ir/scalars.def"
#undef SKC_SCALAR
};

/// A row of scalars.def.
struct ScalarRow {
  std::string_view name, spelling, cpp;
  Scalar arithmetic;
  std::uint8_t bits;
  std::uint16_t one;
};
inline constexpr ScalarRow scalarRows[] = {
#define SKC_SCALAR(Name, spelling, cpp, arithmetic, bits, one) \
  {#Name, spelling, cpp, Scalar::arithmetic, bits, one},
#include "ir/scalars.def"
#undef SKC_SCALAR
};
constexpr const ScalarRow& row(Scalar scalar) { return scalarRows[static_cast<std::size_t>(scalar)]; }

constexpr bool isNarrow(Scalar scalar) { return scalar >= Scalar::Half; }
/// Double, Long and Ulong: two words of a texel.
constexpr bool is64Bit(Scalar scalar) { return row(scalar).bits == 64; }
constexpr bool isReal(Scalar scalar) { return scalar == Scalar::Float || scalar == Scalar::Double; }

/// The arithmetic type of a scalar: Int or Float for a narrow one, else the scalar itself.
constexpr Scalar arithmeticScalar(Scalar scalar) { return row(scalar).arithmetic; }

struct Type {
  enum class Kind : std::uint8_t { Void, Scalar, Vector, Matrix, Struct, Array };
  Kind kind = Kind::Void;
  Scalar scalar = Scalar::Float;   ///< Scalar, Vector and Matrix (always Float)
  std::uint8_t width = 1;          ///< Scalar: 1; Vector: 2 to 4; Matrix: its rows and columns, 2 to 4
  std::uint32_t index = 0;         ///< Struct: into Module::structs; Array: into Module::arrays

  static constexpr Type voidType() { return {}; }
  static constexpr Type of(Scalar scalar, int width = 1) {
    return {width == 1 ? Kind::Scalar : Kind::Vector, scalar, static_cast<std::uint8_t>(width), 0};
  }
  static constexpr Type matrix(int size) {
    return {Kind::Matrix, Scalar::Float, static_cast<std::uint8_t>(size), 0};
  }
  static constexpr Type structType(std::uint32_t index) { return {Kind::Struct, Scalar::Float, 1, index}; }
  static constexpr Type arrayType(std::uint32_t index) { return {Kind::Array, Scalar::Float, 1, index}; }

  bool isVoid() const { return kind == Kind::Void; }
  bool isScalar() const { return kind == Kind::Scalar; }
  bool isVector() const { return kind == Kind::Vector; }
  bool isMatrix() const { return kind == Kind::Matrix; }
  bool isArithmetic() const { return isScalar() || isVector(); }
  /// True for a scalar or vector that + - * / and comparisons take.
  bool isNumber() const { return isArithmetic() && scalar >= Scalar::Int && !ir::isNarrow(scalar); }
  bool isNarrow() const { return isArithmetic() && ir::isNarrow(scalar); }
  bool isFloat() const { return isArithmetic() && scalar == Scalar::Float; }
  bool isDouble() const { return isArithmetic() && scalar == Scalar::Double; }
  bool isBool() const { return isArithmetic() && scalar == Scalar::Bool; }
  /// Integers of 64 bits.
  bool isLong() const { return isArithmetic() && (scalar == Scalar::Long || scalar == Scalar::Ulong); }
  bool is64Bit() const { return isArithmetic() && ir::is64Bit(scalar); }
  /// Integers of 32 bits, which alone are indices, counters and specialisation constants.
  bool isInteger() const { return isArithmetic() && (scalar == Scalar::Int || scalar == Scalar::Uint); }
  Type withScalar(Scalar s) const { return of(s, width); }
  Type component() const { return of(scalar); }
  /// The type of an element of a vector, or a row of a matrix.
  Type indexed() const { return isMatrix() ? of(scalar, width) : of(scalar); }
  Type arithmeticType() const { return isNarrow() ? withScalar(arithmeticScalar(scalar)) : *this; }
  bool operator==(const Type&) const = default;
};

/// The planes of a wide scalar, or of a vector of these; a texel holds two wide scalars.
inline std::vector<Type> widePlanes(Type type) {
  std::vector<Type> planes;
  for (int left = type.width; left > 0; left -= 2) planes.push_back(Type::of(type.scalar, left > 1 ? 2 : 1));
  return planes;
}

struct StructField {
  std::string name;
  Type type;
};
struct Struct {
  std::string name;                  ///< without namespaces
  std::vector<std::string> scope;    ///< enclosing namespaces, outermost first
  std::vector<StructField> fields;
  Loc loc;
  bool isSynthesized = false;               ///< synthesized by a transform: it does not exist in C++
  std::vector<std::string> aliases = {};  ///< other names for it in its scope, by typedef or using
};
struct Array {
  Type element;
  std::uint32_t length;
  bool operator==(const Array&) const = default;
};

}  // namespace skc::ir
