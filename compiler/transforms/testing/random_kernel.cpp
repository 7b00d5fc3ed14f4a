// SPDX-License-Identifier: MIT
#include "transforms/testing/random_kernel.hpp"

#include <random>
#include <string>
#include <utility>
#include <vector>

#include "ir/kernel_builder.hpp"
#include "ir/lvalue.hpp"

namespace skc {

using namespace ir;

namespace {

constexpr Type int2Type = Type::of(Scalar::Int, 2);

/// Generates the body of a function. Each of its loops has at most three iterations.
class BodyGenerator {
 public:
  BodyGenerator(Module& module, Function& function, std::mt19937& random, std::vector<FunctionId> pure,
                std::vector<FunctionId> changing)
      : module_(module),
        function_(function),
        random_(random),
        pure_(std::move(pure)),
        changing_(std::move(changing)) {}

  void knows(VarId var, bool isMutable) {
    readable_.push_back(var);
    if (isMutable) mutable_.push_back(var);
  }
  void pushesTo(VarId appendOutput) {
    appendOutput_ = StreamRef{StreamRef::Space::KernelParameter, appendOutput};
  }

  Block body() {
    Block statements = block(3);
    if (!function_.result.isVoid()) statements.push_back(returnStmt(value(2)));
    return statements;
  }

 private:
  std::uint32_t below(std::uint32_t count) { return random_() % count; }
  bool oneIn(std::uint32_t count) { return below(count) == 0; }
  template <class T>
  const T& any(const std::vector<T>& list) {
    return list[below(static_cast<std::uint32_t>(list.size()))];
  }
  VarId local(const char* name, Type type) {
    return addVariable(function_, name + std::to_string(function_.variables.size()), type);
  }
  ExprPtr ref(VarId var) const { return varRef(function_, var); }

  // ---- expressions ------------------------------------------------------------------------------

  ExprPtr value(int depth) {
    if (depth == 0 || oneIn(4)) return leaf();
    switch (below(9)) {
      case 0: return select(condition(depth - 1), value(depth - 1), value(depth - 1));
      case 1:
        if (!pure_.empty()) return call(module_, any(pure_), exprs(value(depth - 1)));
        break;
      case 2: return guardedCall(value(0));
      case 3: return binary(BinaryOp::Sub, value(depth - 1), value(depth - 1));
      case 4: return binary(BinaryOp::Mul, value(depth - 1), literal(3));
      case 5: return binary(BinaryOp::BitXor, value(depth - 1), value(depth - 1));
      default: break;
    }
    return binary(BinaryOp::Add, value(depth - 1), value(depth - 1));
  }
  ExprPtr leaf() {
    if (oneIn(4)) return literal(static_cast<std::int32_t>(below(9)) - 2);
    if (oneIn(8)) return swizzle(indexOf({StreamRef::Space::Domain, 0}), oneIn(2) ? "x" : "y");
    const VarId var = any(readable_);
    const Type type = function_.variables[var].type;
    if (type == int2Type) return swizzle(ref(var), oneIn(2) ? "x" : "y");
    if (type != intType) return ir::index(module_, ref(var), small());
    return ref(var);
  }
  ExprPtr small() { return binary(BinaryOp::BitAnd, value(1), literal(3)); }
  ExprPtr condition(int depth) {
    if (depth > 0 && oneIn(3)) {
      return binary(oneIn(2) ? BinaryOp::LogicalAnd : BinaryOp::LogicalOr, condition(depth - 1),
                    condition(depth - 1));
    }
    return binary(oneIn(2) ? BinaryOp::Less : BinaryOp::Equal, small(), oneIn(2) ? literal(2) : small());
  }
  /// The first function iterates as often as its argument says, and does not end for negative arguments.
  ExprPtr guardedCall(ExprPtr rounds) {
    ExprPtr isAllowed =
        binary(BinaryOp::LogicalAnd, binary(BinaryOp::GreaterEqual, clone(rounds), literal(0)),
               binary(BinaryOp::Less, clone(rounds), literal(9)));
    return select(std::move(isAllowed), call(module_, 0, exprs(std::move(rounds))), literal(5));
  }

  // ---- statements -------------------------------------------------------------------------------

  Block block(int depth) {
    const std::size_t readable = readable_.size(), changeable = mutable_.size();
    Block statements;
    for (std::uint32_t i = 1 + below(4); i > 0; --i) {
      add(statements, depth);
      const bool isLeft = std::holds_alternative<Break>(statements.back().node) ||
                          std::holds_alternative<Continue>(statements.back().node) ||
                          std::holds_alternative<Return>(statements.back().node);
      if (isLeft) break;
    }
    readable_.resize(readable);
    mutable_.resize(changeable);
    return statements;
  }

  void add(Block& out, int depth) {
    switch (below(depth > 0 ? 14 : 7)) {
      case 0: return declareAny(out);
      case 1: return jump(out);
      case 2: return callAny(out);
      case 7: return counted(out, depth - 1);
      case 8: return whileLess(out, depth - 1);
      case 9: return doWhile(out, depth - 1);
      case 10: return choice(out, depth - 1);
      case 11:
      case 12:
      case 13: {
        ExprPtr cond = condition(1);
        Block then = block(depth - 1);
        return out.push_back(ifStmt(std::move(cond), std::move(then), oneIn(2) ? block(depth - 1) : Block{}));
      }
      default: return change(out);
    }
  }

  void declareAny(Block& out) {
    const std::uint32_t kind = below(4);
    if (kind == 0) {
      const VarId var = local("v", int2Type);
      out.push_back(declare(var, construct(int2Type, exprs(value(1), value(1)))));
      return knows(var, true);
    }
    if (kind == 1) {
      const Type type = arrayOf(module_, intType, 3);
      const VarId var = local("a", type);
      out.push_back(declare(var, construct(type, exprs(value(1), value(1), value(1)))));
      return knows(var, true);
    }
    const VarId var = local("i", intType);
    out.push_back(declare(var, value(2)));
    knows(var, true);
  }

  ExprPtr place() {
    const VarId var = any(mutable_);
    const Type type = function_.variables[var].type;
    if (type == int2Type) return swizzle(ref(var), oneIn(2) ? "x" : "y");
    return type == intType ? ref(var) : ir::index(module_, ref(var), small());
  }
  void change(Block& out) {
    if (appendOutput_ && oneIn(4)) return out.push_back(push(*appendOutput_, value(1)));
    if (oneIn(2)) return out.push_back(assign(place(), BinaryOp::Add, value(2)));
    out.push_back(assign(place(), value(2)));
  }
  void callAny(Block& out) {
    if (changing_.empty()) return change(out);
    ExprPtr changed = kept(place(), out);
    ExprPtr result = oneIn(2) ? kept(place(), out) : nullptr;
    if (result && !areDisjoint(module_, *changed, *result)) result = nullptr;
    out.push_back(callStmt(any(changing_), exprs(value(1), std::move(changed)), std::move(result)));
  }
  /// The lvalue with its index in a variable that nothing changes.
  ExprPtr kept(ExprPtr place, Block& out) {
    auto* index = std::get_if<Index>(&place->node);
    if (index == nullptr) return place;
    const VarId number = addVariable(function_, "kept", index->index->type);
    out.push_back(declare(number, std::move(index->index)));
    index->index = ref(number);
    return place;
  }
  void jump(Block& out) {
    Block left;
    const std::uint32_t kind = below(3);
    if (kind == 0 && loops_ + switches_ > 0) left.push_back(breakStmt());
    if (kind == 1 && loops_ > 0) left.push_back(continueStmt());
    if (left.empty()) left.push_back(returnStmt(function_.result.isVoid() ? nullptr : value(1)));
    if (oneIn(8)) return out.push_back(std::move(left.front()));
    out.push_back(ifStmt(condition(1), std::move(left)));
  }

  Block loopBody(int depth) {
    ++loops_;
    Block body = block(depth);
    --loops_;
    return body;
  }
  void counted(Block& out, int depth) {
    const VarId i = local("i", intType);
    ExprPtr limit = oneIn(2) ? literal(3) : small();
    readable_.push_back(i);
    Block body = loopBody(depth);
    readable_.pop_back();
    out.push_back(forLoop(ir::block(declare(i, literal(0))), binary(BinaryOp::Less, ref(i), std::move(limit)),
                          ir::block(assign(ref(i), BinaryOp::Add, literal(1))), std::move(body)));
  }
  void whileLess(Block& out, int depth) {
    const VarId i = local("w", intType);
    out.push_back(declare(i, literal(0)));
    ExprPtr cond = binary(BinaryOp::LogicalAnd, binary(BinaryOp::Less, ref(i), small()), condition(1));
    Block body = ir::block(assign(ref(i), BinaryOp::Add, literal(1)));
    for (Stmt& stmt : loopBody(depth)) body.push_back(std::move(stmt));
    out.push_back(whileLoop(std::move(cond), std::move(body)));
    readable_.push_back(i);
  }
  void doWhile(Block& out, int depth) {
    const VarId i = local("d", intType);
    out.push_back(declare(i, literal(0)));
    Block body = ir::block(assign(ref(i), BinaryOp::Add, literal(1)));
    for (Stmt& stmt : loopBody(depth)) body.push_back(std::move(stmt));
    out.push_back(doWhileLoop(std::move(body), binary(BinaryOp::LogicalAnd, condition(1),
                                                      binary(BinaryOp::Less, ref(i), small()))));
  }
  void choice(Block& out, int depth) {
    ExprPtr chosen = small();
    std::vector<Case> cases;
    ++switches_;
    for (std::int64_t i = 0; i < 3; ++i) {
      Case one{{i}, i == 1 && oneIn(2), block(depth), {}};
      if (oneIn(4)) one.values.push_back(i + 5);
      if (oneIn(2)) one.body.push_back(breakStmt());
      cases.push_back(std::move(one));
    }
    --switches_;
    out.push_back(switchStmt(std::move(chosen), std::move(cases)));
  }

  Module& module_;
  Function& function_;
  std::mt19937& random_;
  std::vector<FunctionId> pure_, changing_;
  std::vector<VarId> readable_, mutable_;
  std::optional<StreamRef> appendOutput_;
  int loops_ = 0, switches_ = 0;
};

/// int rounds(int n): adds 2 until n is 0.
void addRounds(Module& module) {
  Function rounds{.name = "rounds", .result = intType, .variables = {}, .body = {}, .loc = {}};
  const VarId n = addVariable(rounds, "n", intType, VarRole::In);
  const VarId sum = addVariable(rounds, "sum", intType);
  Block body = block(assign(varRef(rounds, n), BinaryOp::Sub, literal(1)),
                     assign(varRef(rounds, sum), BinaryOp::Add, literal(2)));
  Block whole = block(declare(sum, literal(0)),
                      whileLoop(binary(BinaryOp::NotEqual, varRef(rounds, n), literal(0)), std::move(body)),
                      returnStmt(varRef(rounds, sum)));
  addFunction(module, std::move(rounds), std::move(whole));
}

FunctionId addRandom(Module& module, std::mt19937& random, bool changes, const std::vector<FunctionId>& pure,
                     const std::vector<FunctionId>& changing) {
  const std::string name = (changes ? "changing" : "pure") + std::to_string(module.functions.size());
  Function function{.name = name, .result = intType, .variables = {}, .body = {}, .loc = {}};
  const VarId n = addVariable(function, "n", intType, VarRole::In);
  if (changes) addVariable(function, "changed", intType, VarRole::InOut);
  BodyGenerator builder(module, function, random, pure, changing);
  builder.knows(n, true);
  if (changes) builder.knows(n + 1, true);
  Block body = builder.body();
  return addFunction(module, std::move(function), std::move(body));
}

}  // namespace

Module randomKernel(std::uint32_t seed) {
  std::mt19937 random(seed);
  Module module = testModule();
  addRounds(module);
  std::vector<FunctionId> pure, changing;
  pure.push_back(addRandom(module, random, false, pure, changing));
  changing.push_back(addRandom(module, random, true, pure, changing));
  changing.push_back(addRandom(module, random, true, pure, changing));
  KernelBuilder k(module, "f");
  const VarId u = k.uniform("u", intType), x = k.input("x", intType), r = k.output("r", intType);
  const VarId out = k.variableOutput("out", intType);
  const VarId y = k.local("y", intType);
  BodyGenerator builder(module, k.function(), random, pure, changing);
  builder.knows(u, true);
  builder.knows(x, false);
  builder.knows(r, true);
  builder.knows(y, true);
  if (random() % 2 == 0) builder.pushesTo(out);
  Block body = block(declare(y, k.ref(u)), assign(k.ref(r), literal(0)));
  for (Stmt& stmt : builder.body()) body.push_back(std::move(stmt));
  k.finish(std::move(body));
  return module;
}

}  // namespace skc
