// SPDX-License-Identifier: MIT
//
// What the functions of one generated program share: types, functions that can be called, constants, and random choices.
#pragma once

#include <cstdint>
#include <set>
#include <string>
#include <vector>

#include "cpp/tree.hpp"
#include "cpp/types.hpp"
#include "random.hpp"

namespace fuzz::cpp {

/// The constructs that can be left out, one name each.
extern const std::vector<std::string> constructs;

enum class Passing : std::uint8_t { Value, Reference, ConstReference };

struct Parameter {
  TypeId type;
  Passing passing = Passing::Value;
  bool hasDefault = false;
  bool takesConst = true;  ///< of an array as a value: C++ passes a pointer to const
};

struct Function {
  std::string
      name;  ///< with its namespace and template arguments; of a method or an operator, as a call spells it
  TypeId result = -1;  ///< -1: none
  std::vector<Parameter> parameters = {};
  TypeId owner = -1;  ///< of a method: its struct
  bool isConst = false;  ///< a method that does not change its object
  bool returnsObject = false;  ///< a method that returns its object by reference
  bool isInfix = false;  ///< `name` stands between its operands
  bool isOfAnyRank = false;  ///< a template over N, or a method of one
  bool isExact = false;  ///< arguments must have the types of the parameters
  int cost = 0;  ///< how many expressions a call evaluates at most, roughly
  int size = 0;  ///< how many expressions it has, with those of the functions that it calls
  std::set<std::size_t> callees = {};  ///< by their numbers in Unit::functions
  bool isReached = false;  ///< a kernel calls it
};

/// A variable, or a constant, that expressions can name.
struct Variable {
  std::string name;
  TypeId type = 0;
  bool isMutable = false;
  bool isReferable = true;  ///< can be bound to a reference
  bool isPointer = false;  ///< an array that C++ passes as a pointer
  bool isAxis = false;  ///< from 0 to N, exclusive
  int bit = 0;  ///< its bit in Effects
  int below = 0;  ///< if not 0: an integer from 0 to this, exclusive
};

struct Unit {
  Unit(std::uint64_t seed, std::uint64_t number, const std::set<std::string>& without)
      : random(seed, number), without(without) {}

  bool has(const char* construct) const { return without.count(construct) == 0; }
  bool hasAnyRank() const { return has("gathers") && has("any_rank"); }
  /// True with probability `count` / `of`, if the construct is not left out.
  bool with(const char* construct, std::size_t count, std::size_t of) {
    return random.chance(count, of) && has(construct);
  }
  /// Chooses among the types that are not left out, some more seldom than others.
  bool mayHave(TypeId id) {
    const Type& type = types[id];
    if (types.isOfStreams(id) || types.isIndex(id)) return false;
    if (types.isWideInteger(id) && !has("longs")) return false;
    if (type.kind == Type::Kind::Struct || type.kind == Type::Kind::Enum || type.kind == Type::Kind::Array)
      return true;
    const bool isVector = type.kind == Type::Kind::Vector;
    if (isVector && !has("vectors")) return false;
    if (type.kind == Type::Kind::Matrix && !has("matrices")) return false;
    if (type.scalar == Scalar::Float && !has("floats")) return false;
    if (type.scalar == Scalar::Double && (!has("doubles") || random.chance(1, 2))) return false;
    if (!types.isNarrow(id)) return true;
    return has(isVector ? "narrow_vectors" : "narrow") && (!isVector || random.chance(1, 3));
  }
  /// Marks functions, and those that they call, as reached.
  void reach(const std::set<std::size_t>& called) {
    for (const std::size_t number : called) {
      if (functions[number].isReached) continue;
      functions[number].isReached = true;
      reach(functions[number].callees);
    }
  }
  std::string newName(const char* stem) { return stem + std::to_string(++names_); }

  Random random;
  Types types;
  std::vector<Function> functions;
  std::vector<Variable> constants;
  std::set<std::string> without;

 private:
  int names_ = 0;
};

}  // namespace fuzz::cpp
