// SPDX-License-Identifier: MIT
//
// Random expressions over the variables of a scope. They have no effects, but for what calls do to their own
// parameters.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "kernels/model.hpp"
#include "kernels/types.hpp"
#include "random.hpp"

namespace fuzz {

/// A local, a parameter, or an array of them in consecutive slots.
struct Variable {
  std::string name;
  Type type;
  int slot = 0;
  int length = 0;            ///< of an array; 0: none
  bool isWritable = false;
};

struct Gather {
  std::string name;
  Type type;
  int rank = 1;
  int stream = 0;            ///< into Frame::streams
  sk::program::Boundary boundary = sk::program::Boundary::Clamp;
  Value border = {};
  bool hasNeighbors = false; ///< its rank is the domain's
};

/// A helper that takes values and gives one.
struct Function {
  std::string name;
  Type result;
  std::vector<Variable> parameters;
  std::function<Value(Frame&)> call;   ///< with the arguments in the parameters' slots
};

struct Scope {
  const Records* records = nullptr;
  std::vector<Variable> variables;
  std::vector<Gather> gathers;
  std::vector<Function> functions;
  std::vector<std::string> indexed;  ///< parameters that indexof and extentof take, all of the domain's shape
};

/// What is read of a stream at an index, x first, that may lie outside.
Value gathered(const Gather& gather, const HostStream& stream, std::array<std::int64_t, 2> index);

class Expressions {
 public:
  Expressions(const Scope& scope, Random& random) : scope_(scope), random_(random) {}

  /// Of a carrier type or a vector of one; `depth` bounds how deep it nests.
  Expr make(Type type, int depth);
  /// Of any type, as a variable of that type takes it: tamed, converted, a struct in braces.
  Expr makeKept(Type type, int depth);
  /// Brought back to `kept` if it is not.
  Expr tamed(Expr expr);
  /// Some part of some variable that can be written, if there is one.
  std::optional<Place> writable(int depth);
  /// What a place holds, as its carrier.
  Expr read(const Place& place);
  Expr condition(int depth) { return make({Scalar::Bool, 1}, depth); }

 private:
  Expr makeFloat(int width, int depth);
  Expr makeInteger(Scalar scalar, int width, int depth);
  Expr makeBool(int width, int depth);
  Expr makeLiteral(Type type);
  Expr leaf(Type type, int depth);
  Expr fit(Expr expr, int width, int depth);
  Expr chosen(Type type, int depth);
  Expr matrix(int width, int depth);
  Expr product(int width, int depth);
  Expr comparison(int width, int depth);
  std::optional<Expr> call(Type type, int depth);
  std::optional<Expr> gatherRead(Type type, int depth);
  Expr position(int width);

  Place whole(const Variable& variable, int depth);
  std::vector<Place> partsOf(const Place& place);
  Place component(const Place& place, int depth);

  const Scope& scope_;
  Random& random_;
};

}  // namespace fuzz
