// SPDX-License-Identifier: MIT
//
// Generates the body of one function: statements and expressions over what is in scope. All that it makes is defined
// in C++: no overflow that does not wrap, no index outside, no unsequenced effects, and no float operation that rounds.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "cpp/sample_values.hpp"
#include "cpp/unit.hpp"

namespace fuzz::cpp {

/// The variables that an expression touches, one bit each. Two variables may share a bit.
struct Effects {
  std::uint64_t reads = 0;
  std::uint64_t writes = 0;  ///< by operators: unsequenced in the operands of most operators
  std::uint64_t calls = 0;  ///< written by functions, which are called one after the other

  friend Effects operator|(const Effects& a, const Effects& b) {
    return {a.reads | b.reads, a.writes | b.writes, a.calls | b.calls};
  }
  std::uint64_t written() const { return writes | calls; }
  std::uint64_t all() const { return reads | writes | calls; }
};

/// The float values of an expression: multiples of 2^-fraction up to 2^magnitude.
struct Range {
  int magnitude = 0, fraction = 0;
};

/// What every target computes exactly with floats or doubles, and what variables of them hold. Some targets have pairs of
/// floats for doubles; 42 bits leave these some room.
struct Precision {
  int bits;  ///< of any value
  int most;  ///< the magnitude of any value: `lim` converts to int
  int fraction;  ///< of what is stored, and of what `lim` gives
  int stored;  ///< the magnitude of what is stored, but for copies
  bool holds(Range range) const {
    return range.magnitude <= most && range.magnitude + range.fraction <= bits;
  }
  /// The range of every variable: sums in place add to what is stored.
  Range ofVariables() const { return {copyMagnitude, fraction}; }
  Range limited() const { return {6, fraction}; }

  static constexpr int copyMagnitude = 21;  ///< no other range has this one
};
constexpr Precision singlePrecision = {24, 24, 2, 14}, doublePrecision = {42, 28, 12, 18};
inline const Precision& precisionOf(const Type& type) {
  return type.scalar == Scalar::Double ? doublePrecision : singlePrecision;
}

struct Expr {
  NodePtr node;
  TypeId type;
  Effects effects = {};
  Range range = {};
  bool mayBeComponent = false;  ///< may be an lvalue that is a component of a vector
};

/// A list of expressions, which cannot be copied.
template <class... Parts>
std::vector<Expr> listOf(Parts... parts) {
  std::vector<Expr> list;
  (list.push_back(std::move(parts)), ...);
  return list;
}

/// The limits of Body for functions.
constexpr int functionCost = 200, functionSize = 120;

class Body {
 public:
  /// `limit` bounds how many expressions a call evaluates, and `sizeLimit` how many there are.
  Body(Unit& unit, TypeId result, int limit, int sizeLimit)
      : unit_(unit),
        random_(unit.random),
        types_(unit.types),
        result_(result),
        limit_(limit),
        sizeLimit_(sizeLimit) {}

  /// Adds a parameter or another variable to the current scope.
  Variable& declare(std::string name, TypeId type, bool isMutable);
  /// The method's object is `*this`: its members are variables.
  void declareObject(TypeId type, bool isMutable);
  void mayReturnObject() { returnsObject_ = true; }
  /// The function is a template over the rank N.
  void beOfAnyRank() { isOfAnyRank_ = true; }
  /// The function is a kernel with an output r0, which has an index.
  void beKernel() { isKernel_ = true; }

  /// A block's statements, with a return at the end if the function has a result.
  NodePtr statements(int count);
  /// Adds a call of a function to the list, and what it needs; false if the function has no room here.
  bool addCall(Node& list, const Function& function);
  /// Statements that fold all variables of the outermost scope into the outputs of a kernel.
  void foldInto(Node& list);

  /// An expression of exactly this type.
  Expr value(TypeId type, int depth);
  /// The initialiser of a variable, in braces for arrays and sometimes for structs; with less than all its entries,
  /// where that is defined.
  Expr initialiser(TypeId type, int depth);
  Expr braces(TypeId type, int depth);
  Expr literal(TypeId type);
  void declareConstants();
  /// Adds the function, whose body is complete, to those that can be called.
  void finish(Function function);
  /// Only literals and constants from here on.
  void stayConstant() { isConstant_ = true; }

  const std::set<std::size_t>& callees() const { return callees_; }
  int cost() const { return cost_; }
  int size() const { return size_; }

 private:
  struct Step {
    enum class Kind : std::uint8_t { Field, Index, Component, Element } kind;
    int field = 0;
  };
  struct Place {
    std::size_t variable;
    std::vector<Step> path;
    TypeId type;
    bool isReferable;
  };
  using Accepts = std::function<bool(TypeId)>;

  // Variables, lvalues (lvalues.cpp)
  void addPlaces(std::size_t variable, const Accepts& accepts, bool onlyReferable,
                 std::vector<Place>& places);
  std::vector<Place> places(const Accepts& accepts, bool onlyMutable, bool onlyReferable = false);
  std::optional<Place> place(const Accepts& accepts, bool onlyMutable);
  std::optional<Place> place(TypeId type, bool onlyMutable) {
    return place([&](TypeId id) { return id == type; }, onlyMutable);
  }
  Expr spelled(const Place& place, int depth);
  /// An lvalue that is written: the reducer leaves it one.
  Expr target(const Place& place, int depth);
  /// `(c ? x : y)`
  Expr targetChoice(const Place& yes, const Place& no, int depth);
  Expr index(int count, int depth);
  std::optional<Expr> read(const Accepts& accepts, int depth);
  const Variable& variableOf(const Place& place) const { return variables_[place.variable]; }
  static bool isComponent(const Place& place) {
    return !place.path.empty() && place.path.back().kind == Step::Kind::Component;
  }

  // All types (expressions.cpp)
  Expr made(std::string text, TypeId type, std::vector<Expr> parts, bool isGuard = false);
  Expr choice(TypeId type, int depth);
  /// A value instead of an lvalue that is a component of a vector.
  Expr noComponent(Expr expr);
  std::optional<Expr> assignment(TypeId type, int depth);
  std::optional<Expr> memberOf(TypeId type, int depth);
  Expr converted(Expr expr, TypeId type, bool mayStayImplicit);
  /// Something that C++ converts to this type in an initialisation or an assignment.
  Expr convertible(TypeId type, int depth);
  /// The second of two operands that are evaluated in any order.
  Expr unsequenced(const Expr& first, Expr second);
  Expr condition(int depth);
  Expr comparison(int depth);
  Expr structOf(TypeId type, int depth);
  Expr enumOf(TypeId type, int depth);
  Expr matrixOf(TypeId type, int depth);

  // Numbers (integers.cpp, floats.cpp, vectors.cpp)
  Expr integer(int depth);
  Expr integerBinary(int depth);
  Expr intrinsic(int depth);
  TypeId pickInteger();
  std::optional<Expr> integerAssignment(int depth);
  /// Float, or sometimes Double.
  TypeId pickFloating();
  bool hasFloating() const { return unit_.has("floats") || unit_.has("doubles"); }
  Expr floating(TypeId type, int depth);
  Expr floating(int depth) { return floating(pickFloating(), depth); }
  Expr floatLeaf(TypeId type, int depth);
  /// What stands beside a float or a double, and becomes one.
  Expr floatOperand(TypeId type, int depth);
  Expr floatBinary(TypeId type, int depth);
  Expr floatIntrinsic(TypeId type, int depth);
  Expr limited(Expr expr, int bits);
  /// A function that rounds, of which a few bits are looked at.
  Expr roundingFunction(TypeId type, int depth);
  std::optional<Expr> floatAssignment(TypeId type, int depth);
  Scalar pickVectorScalar();
  Expr vectorOf(TypeId type, int depth);
  Expr vectorBinary(TypeId type, int depth);
  Expr mask(Scalar scalar, int count, int depth);
  Expr vectorParts(TypeId type, int depth);
  Expr vectorIntrinsic(TypeId type, int depth);
  std::optional<Expr> swizzleAssignment(int depth);

  // Streams (streams.cpp)
  /// Makes the text of a gather that of one of its elements.
  void access(std::string& text, std::vector<Expr>& parts, int rank, int depth);
  Expr gatherIndex(int depth);
  Expr gatherOffset(int depth);
  Expr floatIndex(int width, int depth);
  std::optional<Expr> gather(const Accepts& accepts);
  /// The number of a dimension.
  std::string axis();
  Expr ofAnyRank(int depth);
  Expr offsetOfAnyRank(int depth);
  std::optional<Expr> streamInteger(int depth);
  std::optional<Expr> sampled(int depth);

  // Calls (calls.cpp)
  bool canCall(const Function& function) const;
  std::optional<int> rankFor(const Function& function);
  bool hasPlaceOf(TypeId type);
  std::optional<Expr> call(const Accepts& acceptsResult, int depth);
  std::optional<Expr> callOf(const Function& function, int depth);
  std::optional<Expr> callStatement(int depth);

  // Statements (statements.cpp)
  NodePtr statement();
  NodePtr block(int count);
  NodePtr declaration();
  NodePtr bindings();
  NodePtr effect();
  NodePtr branch();
  NodePtr loop();
  NodePtr loopOverAxes();
  NodePtr selection();
  NodePtr jump();
  NodePtr returning();
  Expr effectExpression(int depth);
  /// Declares a variable that is not const.
  NodePtr variable(TypeId type);
  NodePtr foldOf(const std::string& text, TypeId type);
  void addFolds(Node& list, const std::string& text, TypeId type, int& budget);
  int pickCount() { return random_.between(1, 3); }
  TypeId pickType(bool mayBeArray);

  /// Leaves the scope that began with this many variables.
  void leave(std::size_t variables) { variables_.resize(variables); }
  bool mayHaveEffects() const { return !isConstant_ && unit_.has("order"); }
  void spend(int count) {
    size_ += count;
    cost_ += multiplier_ * count;
  }
  bool isFull() const { return size_ > sizeLimit_ || cost_ > limit_; }

  Unit& unit_;
  Random& random_;
  Types& types_;
  TypeId result_;
  int limit_, sizeLimit_;
  bool isConstant_ = false, returnsObject_ = false, isOfAnyRank_ = false, isKernel_ = false;
  std::vector<Variable> variables_;
  std::set<std::size_t> callees_;
  int bits_ = 0;
  int cost_ = 0, size_ = 0, multiplier_ = 1;
  int nesting_ = 0, loops_ = 0, breakables_ = 0;
};

}  // namespace fuzz::cpp
