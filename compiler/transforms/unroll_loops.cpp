// SPDX-License-Identifier: MIT
#include "transforms/passes.hpp"

#include <algorithm>
#include <cstdint>
#include <iterator>
#include <map>
#include <optional>
#include <unordered_set>
#include <utility>

#include <fmt/format.h>

#include "ir/build.hpp"
#include "ir/call_graph.hpp"
#include "ir/counted_loop.hpp"
#include "ir/evaluate.hpp"
#include "ir/ir.hpp"
#include "ir/lvalue.hpp"
#include "ir/op_weight.hpp"
#include "ir/walk.hpp"
#include "transforms/condition.hpp"
#include "transforms/fold_copy.hpp"

namespace skc {

using namespace ir;

namespace {

// Removes `continue` and `break` from an iteration of a loop that is being unrolled, and has no loop around
// it any more: a certain jump cuts the iteration off, and the rest after a possible one becomes the other
// branch of its `if`.
//
//   before   if (-1 == 0) continue;  if (x > 1.0) { r += 1.0; continue; }  r = 0.0;
//   after    if (x > 1.0) { r += 1.0; } else { r = 0.0; }

enum class IterationEnd : std::uint8_t {
  Completes,  ///< the next iteration follows
  LeavesLoop,  ///< this is the last iteration
  Unknown,  ///< depends on the elements: do not use the iteration
};

/// True if a statement contains a jump of the loop around it; a `break` in a switch belongs to the switch.
bool mayLeave(const Stmt& stmt, bool inSwitch = false) {
  if (std::holds_alternative<Continue>(stmt.node)) return true;
  if (std::holds_alternative<Break>(stmt.node)) return !inSwitch;
  if (std::holds_alternative<Loop>(stmt.node)) return false;
  inSwitch = inSwitch || std::holds_alternative<Switch>(stmt.node);
  bool may = false;
  forEachBlock(stmt, [&](const Block& inner) {
    for (const Stmt& one : inner) may = may || mayLeave(one, inSwitch);
  });
  return may;
}

/// How part of an iteration ends: control reaches what follows, or all of it leaves.
enum class End : std::uint8_t { GoesOn, Continues, Breaks, Unknown };

class JumpRemover {
 public:
  explicit JumpRemover(const Module& module) : module_(module) {}

  /// `endsIteration`: the block ends the iteration, so that some elements may leave it earlier than others.
  End leave(Block& block, bool endsIteration) const {
    for (std::size_t i = 0; i < block.size(); ++i) {
      decide(block, i);
      if (i == block.size()) break;
      if (!mayLeave(block[i])) continue;
      const End end = leave(block, i, endsIteration);
      if (end != End::GoesOn) return end;
    }
    return End::GoesOn;
  }

 private:
  /// Replaces an `if` that may leave the iteration and whose condition is known by the branch taken.
  void decide(Block& block, std::size_t i) const {
    while (i < block.size() && mayLeave(block[i])) {
      auto* n = std::get_if<If>(&block[i].node);
      const auto cond = n == nullptr ? std::nullopt : evaluate(module_, *n->cond, Constants::LookThrough);
      if (!cond) return;
      Block taken = std::move(*cond != 0 ? n->then : n->otherwise);
      const auto at = block.erase(block.begin() + static_cast<std::ptrdiff_t>(i));
      block.insert(at, std::make_move_iterator(taken.begin()), std::make_move_iterator(taken.end()));
    }
  }

  /// Processes statement `i`, which may leave the iteration. GoesOn if the next
  /// one is still to be processed.
  End leave(Block& block, std::size_t i, bool endsIteration) const {
    Stmt& stmt = block[i];
    if (std::holds_alternative<Continue>(stmt.node)) return cut(block, i, End::Continues);
    if (std::holds_alternative<Break>(stmt.node)) return cut(block, i, End::Breaks);
    if (auto* n = std::get_if<Scope>(&stmt.node)) {
      const End end = leave(n->body, false);
      return end == End::GoesOn ? end : cut(block, i + 1, end);
    }
    if (std::holds_alternative<If>(stmt.node)) return divide(block, i, endsIteration);
    return End::Unknown;
  }

  static End cut(Block& block, std::size_t size, End end) {
    block.erase(block.begin() + static_cast<std::ptrdiff_t>(size), block.end());
    return end;
  }

  /// An `if` with one branch that continues: the rest of the iteration moves to the other branch.
  End divide(Block& block, std::size_t i, bool endsIteration) const {
    auto& choice = std::get<If>(block[i].node);
    const End then = leave(choice.then, false);
    const End otherwise = leave(choice.otherwise, false);
    if (then == otherwise && then != End::GoesOn) return cut(block, i + 1, then);
    const bool oneContinues = (then == End::Continues && otherwise == End::GoesOn) ||
                              (then == End::GoesOn && otherwise == End::Continues);
    if (!oneContinues || !endsIteration) return End::Unknown;
    Block& rest = then == End::Continues ? choice.otherwise : choice.then;
    const auto next = block.begin() + static_cast<std::ptrdiff_t>(i) + 1;
    rest.insert(rest.end(), std::make_move_iterator(next), std::make_move_iterator(block.end()));
    block.erase(next, block.end());
    const End end = leave(rest, true);
    if (choice.then.empty()) {
      choice.cond = notOf(*choice.cond);
      std::swap(choice.then, choice.otherwise);
    }
    return end == End::Breaks || end == End::Unknown ? End::Unknown : End::Continues;
  }

  const Module& module_;
};

/// Removes the jumps of the surrounding loop from the block of one iteration.
IterationEnd removeJumps(const Module& module, Block& iteration) {
  switch (JumpRemover(module).leave(iteration, true)) {
    case End::GoesOn:
    case End::Continues: return IterationEnd::Completes;
    case End::Breaks: return IterationEnd::LeavesLoop;
    case End::Unknown: break;
  }
  return IterationEnd::Unknown;
}

/// A loop that unrolls to no more expressions is always unrolled: its head alone takes as many.
constexpr std::int64_t tinyExpressions = 24;

/// Variables whose values depend on a loop's counter, or on anything else that the loop changes.
class LoopVariantVariables {
 public:
  explicit LoopVariantVariables(const Loop& loop) {
    for (const Stmt& stmt : loop.init) follow(stmt, true);
    walkStmts(loop.step, [&](const Stmt& stmt) { follow(stmt, true); });
    // a `while` loop counts in its body
    const bool countsInBody = loop.step.empty();
    walkStmts(loop.body, [&](const Stmt& stmt) { follow(stmt, countsInBody); });
  }

  bool mentions(const Expr& expr) const {
    bool found = false;
    walkExprs(expr, [&](const Expr& inner) {
      const auto* ref = std::get_if<VarRef>(&inner.node);
      found = found || (ref != nullptr && variables_.contains(ref->var));
    });
    return found;
  }

 private:
  void follow(const Stmt& stmt, bool always) {
    if (const auto* n = std::get_if<Declare>(&stmt.node)) {
      if (always || (n->init && mentions(*n->init))) variables_.insert(n->var);
    }
    if (const auto* n = std::get_if<Assign>(&stmt.node)) {
      if (always || mentions(*n->value)) variables_.insert(rootOf(*n->place));
    }
  }

  std::unordered_set<VarId> variables_;
};

/// fn(index) for each neighbour's offset, and each index of a gather, an array, a vector or a scatter output.
template <class Fn>
void forEachIndex(const Block& body, Fn&& fn) {
  walkExprs(body, [&](const Expr& expr) {
    if (const auto* n = std::get_if<NeighborRead>(&expr.node)) fn(*n->offset);
    if (const auto* n = std::get_if<GatherRead>(&expr.node)) fn(*n->index);
    if (const auto* n = std::get_if<Index>(&expr.node)) fn(*n->index);
  });
  walkStmts(body, [&](const Stmt& stmt) {
    if (const auto* n = std::get_if<Scatter>(&stmt.node)) fn(*n->index);
  });
}

std::int64_t expressionsIn(const Block& statements) {
  std::int64_t count = 0;
  walkExprs(statements, [&](const Expr&) { ++count; });
  return count;
}

class Unroller {
 public:
  Unroller(const Module& module, Kernel& kernel) : module_(module), kernel_(kernel) {}

  void run(Function& function) {
    function_ = &function;
    if (needsKnownValues(function.body)) foldIntegers(module_, function);
    do {
      hasUnrolled_ = false;
      block(function.body);
      if (hasUnrolled_) foldIntegers(module_, function);
    } while (hasUnrolled_);
  }

 private:
  /// The iterations of a loop, or the reason why it stays.
  struct Attempt {
    Block iterations;
    std::string whyNot;
  };

  /// True if a loop would be unrolled if its bounds, which may be locals with known values, were constants.
  bool needsKnownValues(const Block& statements) const {
    bool needs = false;
    walkStmts(statements, [&](const Stmt& stmt) {
      const auto* loop = std::get_if<Loop>(&stmt.node);
      needs = needs || (loop != nullptr && !countedLoop(module_, *loop) && makesIndices(*loop));
    });
    return needs;
  }

  void block(Block& statements) {
    Block result;
    for (Stmt& stmt : statements) {
      const auto* loop = std::get_if<Loop>(&stmt.node);
      if (loop != nullptr && isWanted(*loop) && unrollNest(*loop, stmt.loc, result)) continue;
      if (loop != nullptr) around_.emplace_back(*loop);
      forEachBlock(stmt, [&](Block& inner) { block(inner); });
      if (loop != nullptr) around_.pop_back();
      result.push_back(std::move(stmt));
    }
    statements = std::move(result);
  }

  /// Appends all iterations of a loop and of the loops in it; or nothing, and returns false.
  bool unrollNest(const Loop& loop, Loc loc, Block& result) {
    const std::size_t variables = function_->variables.size();
    iterations_ = 0;
    inner_.clear();
    Attempt attempt = written(loop, loc);
    const std::int64_t expressions = written_ + expressionsIn(attempt.iterations);
    if (attempt.whyNot.empty() && expressions > mostUnrolledExpressions)
      attempt.whyNot = tooLong(expressions);
    const std::optional<CountedLoop> counted = countedLoop(module_, loop);
    note({loc, counted ? std::optional(counted->count) : std::nullopt, attempt.whyNot});
    if (!attempt.whyNot.empty()) {
      function_->variables.resize(variables);
      return false;
    }
    written_ = expressions;
    hasUnrolled_ = true;
    for (LoopNote& one : inner_) note(std::move(one));
    std::ranges::move(attempt.iterations, std::back_inserter(result));
    return true;
  }

  bool isWanted(const Loop& loop) const {
    if (makesIndices(loop)) return true;
    const std::optional<std::int64_t> count = tripCount(module_, loop);
    return count && *count * expressionsIn(loop.body) <= tinyExpressions && *count <= tinyExpressions;
  }

  /// True if indices depend on the loop's counter, but not on the counter of a surrounding loop that stays.
  bool makesIndices(const Loop& loop) const {
    const LoopVariantVariables variant(loop);
    bool makes = false;
    forEachIndex(loop.body, [&](const Expr& index) {
      makes = makes ||
              (variant.mentions(index) && std::ranges::none_of(around_, [&](const LoopVariantVariables& one) {
                 return one.mentions(index);
               }));
    });
    return makes;
  }

  // ---- reasons ----------------------------------------------------------------------------------

  static std::string tooLong(std::int64_t expressions) {
    return fmt::format("the unrolled loops of the kernel would come to {} expressions, and may come to {}",
                       expressions, mostUnrolledExpressions);
  }

  std::string whyUnknown(const Loop& loop) const {
    const auto* init = loop.init.size() == 1 ? std::get_if<Declare>(&loop.init.front().node) : nullptr;
    if (init == nullptr || loop.step.size() != 1 || !loop.cond) {
      return "it does not count like 'for (int i = a; i < b; ++i)'";
    }
    const std::string& name = function_->variables[init->var].name;
    if (assigns(module_, loop.body, init->var)) return fmt::format("its body changes the counter '{}'", name);
    return fmt::format("the bounds of its counter '{}' are not constants", name);
  }

  // ---- iterations ---------------------------------------------------------------------------------

  Attempt written(const Loop& loop, Loc loc) {
    const std::optional<CountedLoop> counted = countedLoop(module_, loop);
    if (!counted) return {{}, whyUnknown(loop)};
    iterations_ += counted->count;
    if (iterations_ > mostUnrolledIterations) {
      return {{},
              fmt::format("with the loops in it, it has {} iterations or more, and at most {} are unrolled",
                          iterations_, mostUnrolledIterations)};
    }
    const std::int64_t expressions = counted->count * expressionsIn(loop.body);
    if (expressions > mostUnrolledExpressions) return {{}, tooLong(expressions)};
    Attempt result;
    for (std::int64_t iteration = 0; iteration < counted->count; ++iteration) {
      Block body = bodyOf(loop, *counted, iteration);
      const IterationEnd end = removeJumps(module_, body);
      if (end == IterationEnd::Unknown)
        return {{}, "elements may leave it, or a part of an iteration, at different times"};
      result.whyNot = writeInner(body);
      if (!result.whyNot.empty()) return result;
      append(result.iterations, std::move(body), loc);
      if (end == IterationEnd::LeavesLoop) break;
    }
    return result;
  }

  /// Unrolls the loops in an iteration; returns why one of them stays, or "".
  std::string writeInner(Block& statements) {
    Block result;
    std::string whyNot;
    for (Stmt& stmt : statements) {
      const auto* loop = std::get_if<Loop>(&stmt.node);
      if (loop == nullptr || !isWanted(*loop)) {
        forEachBlock(stmt, [&](Block& inner) {
          if (whyNot.empty()) whyNot = writeInner(inner);
        });
        result.push_back(std::move(stmt));
      } else {
        Attempt attempt = written(*loop, stmt.loc);
        whyNot = std::move(attempt.whyNot);
        inner_.push_back({stmt.loc, tripCount(module_, *loop)});
        std::ranges::move(attempt.iterations, std::back_inserter(result));
      }
      if (!whyNot.empty()) return whyNot;
    }
    statements = std::move(result);
    return {};
  }

  /// The body with a literal for the counter; all iterations but the first have locals of their own.
  Block bodyOf(const Loop& loop, const CountedLoop& counted, std::int64_t iteration) {
    Block body = clone(loop.body);
    std::map<VarId, VarId> locals;
    if (iteration > 0) {
      walkStmts(body, [&](Stmt& stmt) {
        if (auto* n = std::get_if<Declare>(&stmt.node)) n->var = locals[n->var] = copyOf(n->var);
      });
    }
    rewriteExprs(body, [&](ExprPtr& slot) {
      auto* ref = std::get_if<VarRef>(&slot->node);
      if (ref == nullptr) return;
      if (ref->var == counted.counter) {
        slot = counted.value(iteration, slot->loc);
      } else if (const auto local = locals.find(ref->var); local != locals.end()) {
        ref->var = local->second;
      }
    });
    return body;
  }

  VarId copyOf(VarId var) {
    Variable copy = function_->variables[var];
    function_->variables.push_back(std::move(copy));
    return static_cast<VarId>(function_->variables.size() - 1);
  }

  /// Appends an iteration, in a scope if it declares anything.
  static void append(Block& result, Block&& iteration, Loc loc) {
    const bool declares = std::ranges::any_of(
        iteration, [](const Stmt& stmt) { return std::holds_alternative<Declare>(stmt.node); });
    if (declares) {
      result.push_back(scope(std::move(iteration), loc));
    } else {
      std::ranges::move(iteration, std::back_inserter(result));
    }
  }

  /// A loop inside an unrolled loop is seen in each iteration, but noted once.
  void note(LoopNote found) {
    const auto known = std::ranges::find_if(kernel_.loops, [&](const LoopNote& one) {
      return one.loc.file == found.loc.file && one.loc.token == found.loc.token;
    });
    if (known == kernel_.loops.end()) {
      kernel_.loops.push_back(std::move(found));
    } else {
      *known = std::move(found);
    }
  }

  const Module& module_;
  Kernel& kernel_;
  Function* function_ = nullptr;
  std::int64_t written_ = 0;  ///< expressions in all unrolled code
  bool hasUnrolled_ = false;
  std::int64_t iterations_ = 0;  ///< of the loop being unrolled and the loops in it
  std::vector<LoopNote> inner_;
  std::vector<LoopVariantVariables> around_;  ///< of the loops around the current block that stay
};

}  // namespace

void unrollLoops(Module& module, Diagnostics&) {
  for (Kernel& kernel : module.kernels) unrollLoops(module, kernel);
}

void unrollLoops(Module& module, Kernel& kernel) {
  Unroller unroller(module, kernel);
  for (const FunctionId id : functionsOf(module, kernel)) unroller.run(module.functions[id]);
}

namespace {

/// Whether an expression or a block reads a variable.
template <class Node>
bool mentions(const Node& node, VarId var) {
  bool found = false;
  walkExprs(node, [&](const Expr& expr) {
    const auto* ref = std::get_if<VarRef>(&expr.node);
    found = found || (ref != nullptr && ref->var == var);
  });
  return found;
}

/// The first integer Spec parameter that occurs in the head of a loop, and that nothing changes.
std::optional<VarId> boundOfLoops(const Module& module, const Kernel& kernel) {
  const Function& entry = module.functions[kernel.entry];
  for (VarId p = 0; p < kernel.params.size(); ++p) {
    const KernelParam& param = kernel.params[p];
    if (param.role != ParamRole::Spec || !param.type.isScalar() || !param.type.isInteger()) continue;
    if (assigns(module, entry.body, p)) continue;
    bool bounds = false;
    walkStmts(entry.body, [&](const Stmt& stmt) {
      const auto* loop = std::get_if<Loop>(&stmt.node);
      bounds = bounds || (loop != nullptr && (mentions(loop->init, p) || mentions(loop->step, p) ||
                                              (loop->cond && mentions(*loop->cond, p))));
    });
    if (bounds) return p;
  }
  return std::nullopt;
}

/// Adds the variant for one value of a parameter to the module.
KernelId addVariant(Module& module, KernelId id, VarId spec, std::uint32_t value) {
  FunctionCopies copies;
  Kernel variant = variantOf(module, id, copies);
  Function& entry = module.functions[variant.entry];
  const Type type = entry.variables[spec].type;
  rewriteExprs(entry.body, [&](ExprPtr& slot) {
    const auto* ref = std::get_if<VarRef>(&slot->node);
    if (ref != nullptr && ref->var == spec) slot = makeExpr(type, Literal{value}, slot->loc);
  });
  unrollLoops(module, variant);
  variant.loops.clear();
  module.kernels.push_back(std::move(variant));
  return static_cast<KernelId>(module.kernels.size() - 1);
}

void addVariants(Module& module, KernelId id, VarId spec) {
  std::uint32_t expressions = 0;
  for (std::uint32_t value = 1; value <= mostUnrolledValue; ++value) {
    const std::size_t functions = module.functions.size();
    const KernelId variant = addVariant(module, id, spec, value);
    // a variant with a loop weighs as much as the limit
    expressions += weigh(module, module.functions[module.kernels[variant].entry].body,
                         {.node = 1, .countsCalls = false}, mostUnrolledExpressions + 1);
    if (expressions > mostUnrolledExpressions) {
      module.kernels.pop_back();
      module.functions.resize(functions);
      return;
    }
    module.kernels[id].unrolled.push_back({spec, value, variant});
  }
}

}  // namespace

void unrollSpecLoops(Module& module, Diagnostics&) {
  forEachDeclaredKernel(module, [&](KernelId id) {
    const Kernel& kernel = module.kernels[id];
    if (kernel.isSynthesized || kernel.isPart || kernel.reduction) return;
    if (const std::optional<VarId> spec = boundOfLoops(module, kernel)) addVariants(module, id, *spec);
  });
}

}  // namespace skc
