// SPDX-License-Identifier: MIT
//
// The types of a generated program, and C++'s rules of conversion between its scalars.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace fuzz::cpp {

enum class Scalar : std::uint8_t { Bool, Char, Uchar, Short, Ushort, Int, Uint, Long, Ulong, Float, Double };
constexpr int scalarCount = 11;

/// What is known of a scalar type.
struct ScalarFacts {
  const char* name;
  int bits;
  bool isSigned = true;
  std::string zero = {};  ///< the simplest expression
  std::vector<std::string> literals = {};  ///< of floating-point numbers, see Body::literal()
};
const ScalarFacts& factsOf(Scalar scalar);

using TypeId = int;

struct Field {
  std::string name;
  TypeId type;
  bool hasDefault = false;
  bool isSpec = false;  ///< of a bundle
  std::string mode = {},
              border =
                  {};  ///< of a gather in a bundle: the boundary mode as C++ names it, and the border's value
};

/// The rank of what depends on the parameter N of a template.
constexpr int anyRank = 0;

struct Type {
  enum class Kind : std::uint8_t { Scalar, Vector, Matrix, Struct, Enum, Array, Gather, Index, Bundle };
  Kind kind = Kind::Scalar;
  Scalar scalar = Scalar::Int;  ///< of a scalar; a component; an enumeration: the underlying type
  int count = 1;  ///< components, rows or elements; of a gather or a bundle of any rank, the rank
  TypeId element = -1;  ///< of an array or a gather; of a matrix, the row; of a vector, the component
  std::string name = {};  ///< with its namespaces; arrays have none
  std::vector<Field> fields = {};
  std::vector<std::string> enumerators = {};  ///< with all that is needed to name them
  bool isScoped = false;  ///< enum class
  bool isFixed = false;  ///< an enumeration whose underlying type is declared
  TypeId family = -1;  ///< of a bundle that is a template: the one of anyRank
  bool isWide = false;  ///< an enumeration of 64 bits, whose values have the 32 of `scalar`
};

/// All types of a program. Scalars are their own ids.
class Types {
 public:
  Types();

  const Type& operator[](TypeId id) const { return all_[static_cast<std::size_t>(id)]; }
  Type& operator[](TypeId id) { return all_[static_cast<std::size_t>(id)]; }
  int size() const { return static_cast<int>(all_.size()); }

  static constexpr TypeId of(Scalar scalar) { return static_cast<TypeId>(scalar); }
  static TypeId vector(Scalar scalar, int count);  ///< of any scalar but Bool
  TypeId matrix(int count) const;
  TypeId array(TypeId element, int count);
  TypeId gather(TypeId element, int rank);
  static TypeId indexOfAnyRank();  ///< index<N>
  TypeId add(Type type);
  /// A type of anyRank at a rank. All others stay what they are.
  TypeId atRank(TypeId id, int rank);
  bool isOfAnyRank(TypeId id) const;

  bool isScalar(TypeId id) const { return (*this)[id].kind == Type::Kind::Scalar; }
  bool isInteger(TypeId id) const { return isScalar(id) && (*this)[id].scalar < Scalar::Float; }
  /// Integers, and what becomes one by itself.
  bool isLikeInteger(TypeId id) const {
    return isInteger(id) || ((*this)[id].kind == Type::Kind::Enum && !(*this)[id].isScoped);
  }
  /// Float or Double.
  bool isFloating(TypeId id) const { return isScalar(id) && (*this)[id].scalar >= Scalar::Float; }
  /// Float or Double, or a vector of them.
  bool hasFloats(TypeId id) const {
    const Type& type = (*this)[id];
    return (type.kind == Type::Kind::Scalar || type.kind == Type::Kind::Vector) &&
           type.scalar >= Scalar::Float;
  }
  /// A scalar or a vector of 8 or 16 bits, not a bool.
  bool isNarrow(TypeId id) const {
    const Type& type = (*this)[id];
    return (type.kind == Type::Kind::Scalar || type.kind == Type::Kind::Vector) &&
           type.scalar > Scalar::Bool && type.scalar < Scalar::Int;
  }
  bool isAggregate(TypeId id) const {
    return (*this)[id].kind == Type::Kind::Struct || (*this)[id].kind == Type::Kind::Array;
  }
  bool isGather(TypeId id) const { return (*this)[id].kind == Type::Kind::Gather; }
  bool isBundle(TypeId id) const { return (*this)[id].kind == Type::Kind::Bundle; }
  bool isIndex(TypeId id) const { return (*this)[id].kind == Type::Kind::Index; }
  /// Parameters of kernels, which are no values.
  bool isOfStreams(TypeId id) const { return isGather(id) || isBundle(id); }
  /// Without what a kernel's uniforms lack, or, unless `mayHaveArrays`, the elements of streams.
  bool isUniform(TypeId id, bool mayHaveArrays) const;
  /// How many textures the gathers of a type take, and how many spec members it has.
  int planes(TypeId id) const;
  int specs(TypeId id) const;
  /// Without vectors and matrices, whose constants only .sk can compute.
  bool isOfScalars(TypeId id) const;
  /// How many scalars a value has.
  int leaves(TypeId id) const;
  /// The type of an integer in arithmetic.
  TypeId promoted(TypeId id) const;
  bool isWideInteger(TypeId id) const;  ///< of 64 bits, or a vector of them
  /// What a count of a shift of a promoted type is masked by, in the type of the count.
  std::string shiftMask(TypeId id) const { return isWideInteger(id) ? "63" : "31"; }
  /// The type of `a + b` for integers, or what becomes one.
  TypeId common(TypeId a, TypeId b) const;
  /// "int x", "int x[3]" or "gather<int, 2> x".
  std::string declare(TypeId id, const std::string& name) const;
  /// "int& x", or "int (&x)[3]".
  std::string declareReference(TypeId id, const std::string& name) const;
  std::string spell(TypeId id) const;
  /// The simplest expression of this type; empty for arrays.
  std::string simplest(TypeId id) const;

 private:
  std::vector<Type> all_;
};

}  // namespace fuzz::cpp
