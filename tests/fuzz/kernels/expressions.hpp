// SPDX-License-Identifier: MIT
//
// Random expressions over the variables of a scope. They have no effects, except that a called function may change its own
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
  int length = 0;  ///< elements of an array; 0 if it is none
  bool isWritable = false;
};

struct Gather {
  std::string name;
  Type type;
  int rank = 1;
  int stream = 0;  ///< index into Frame::streams
  sk::program::Boundary boundary = sk::program::Boundary::Clamp;
  Value border = {};
  bool hasNeighbors = false;  ///< whether its rank is the domain's
};

/// A helper function, whose parameters and result are values.
struct Function {
  std::string name;
  Type result;
  std::vector<Variable> parameters;
  std::function<Value(Frame&)> call;  ///< expects the arguments in the parameters' slots
};

struct Scope {
  const Records* records = nullptr;
  std::vector<Variable> variables;
  std::vector<Gather> gathers;
  std::vector<Function> functions;
  std::vector<std::string> indexed;  ///< parameters of the domain's shape, for indexof and extentof
};

/// The element that a gather reads at an index, x first, which may be out of bounds.
Value gathered(const Gather& gather, const HostStream& stream, std::array<std::int64_t, 2> index);

class Expressions {
 public:
  Expressions(const Scope& scope, Random& random) : scope_(scope), random_(random) {}

  /// An expression of an arithmetic type or a vector of one; `depth` limits its nesting.
  Expr make(Type type, int depth);
  /// An initialiser for a variable of any type: tamed, converted, a struct in braces.
  Expr makeKept(Type type, int depth);
  /// The expression, reduced to the bound `kept` if it exceeds it.
  Expr tamed(Expr expr);
  /// A random part of a random writable variable, if there is one.
  std::optional<Place> writable(int depth);
  /// The value of a place, in its arithmetic type; for a normalized type, the integer that it stores.
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
