// SPDX-License-Identifier: MIT
#include "transforms/split_counters.hpp"

#include <algorithm>
#include <cstddef>
#include <optional>
#include <span>
#include <utility>

#include "ir/build.hpp"
#include "ir/lvalue.hpp"
#include "ir/walk.hpp"

namespace skc {

using namespace ir;

namespace {

/// The scalar variable that a statement changes by a literal.
std::optional<VarId> counterOf(const Stmt& stmt) {
  const auto* const n = std::get_if<Assign>(&stmt.node);
  if (n == nullptr || !n->op || !n->place->type.isScalar()) return std::nullopt;
  const auto* const counter = std::get_if<VarRef>(&n->place->node);
  const bool isSteady = std::holds_alternative<Literal>(n->value->node);
  return counter != nullptr && isSteady ? std::optional(counter->var) : std::nullopt;
}

/// The literal that a variable holds after these statements; null if it may hold anything else.
const Expr* literalAfter(std::span<const Stmt> statements, VarId var) {
  for (std::size_t i = statements.size(); i-- > 0;) {
    const Stmt& stmt = statements[i];
    const auto asLiteral = [](const Expr* value) {
      return value != nullptr && std::holds_alternative<Literal>(value->node) ? value : nullptr;
    };
    if (std::holds_alternative<CallStmt>(stmt.node)) return nullptr;
    if (const auto* const n = std::get_if<Declare>(&stmt.node); n != nullptr && n->var == var)
      return asLiteral(n->init.get());
    if (const auto* const n = std::get_if<Assign>(&stmt.node); n != nullptr && rootOf(*n->place) == var) {
      const bool isWhole = !n->op && std::holds_alternative<VarRef>(n->place->node);
      return isWhole ? asLiteral(n->value.get()) : nullptr;
    }
    bool isChanged = false;
    forEachBlock(stmt, [&](const Block& inner) { isChanged = isChanged || assigns(inner, var); });
    if (isChanged) return nullptr;
  }
  return nullptr;
}

bool continues(const Block& block) {
  bool found = false;
  walkStmts(block, [&](const Stmt& stmt) { found = found || std::holds_alternative<Continue>(stmt.node); });
  return found;
}

bool isDeclared(const Block& statements, VarId var) {
  return std::ranges::any_of(statements, [&](const Stmt& stmt) {
    const auto* const n = std::get_if<Declare>(&stmt.node);
    return n != nullptr && n->var == var;
  });
}

class CounterSplitter {
 public:
  CounterSplitter(Function& function, FunctionId id, const analysis::Uniformity& uniformity)
      : function_(function), id_(id), uniformity_(uniformity) {}

  /// From the last statement to the first: the analysis knows statements by address, and insertions move later ones.
  bool block(Block& statements) {
    bool changed = false;
    for (std::size_t i = statements.size(); i-- > 0;) {
      forEachBlock(statements[i], [&](Block& inner) { changed = block(inner) || changed; });
      auto* const loop = std::get_if<Loop>(&statements[i].node);
      if (loop == nullptr || !uniformity_.diverges(id_, statements[i])) continue;
      Block declared;
      const std::span<const Stmt> before(statements.data(), i);
      split(*loop, loop->step, before, declared);
      if (!continues(loop->body)) split(*loop, loop->body, before, declared);
      changed = changed || !declared.empty();
      statements.insert(statements.begin() + static_cast<std::ptrdiff_t>(i),
                        std::make_move_iterator(declared.begin()), std::make_move_iterator(declared.end()));
    }
    return changed;
  }

 private:
  /// Splits the counters that change in one block of the loop, its body or its step.
  void split(Loop& loop, Block& changing, std::span<const Stmt> before, Block& declared) {
    for (std::size_t i = 0; i < changing.size(); ++i) {
      const std::optional<VarId> counter = counterOf(changing[i]);
      if (!counter || isDeclared(loop.init, *counter)) continue;
      if (uniformity_.of(id_, *counter).front() == analysis::Shape::Uniform) continue;
      const Expr* const start =
          assigns(loop.init, *counter) ? literalAfter(loop.init, *counter) : literalAfter(before, *counter);
      if (start == nullptr) continue;
      // the counter's only change is taken out to see what else the loop does with it
      Stmt change = std::move(changing[i]);
      const auto place = changing.erase(changing.begin() + static_cast<std::ptrdiff_t>(i));
      const bool isOnly = !assigns(loop.body, *counter) && !assigns(loop.step, *counter);
      if (isOnly && isRead(loop, *counter)) {
        const Loc loc = change.loc;
        const VarId count =
            addVariable(function_, "count", function_.variables[*counter].type, VarRole::Local, loc);
        declared.push_back(declare(count, clone(*start), loc));
        rename(loop, *counter, count);
        Stmt copy = clone(change);
        std::get<VarRef>(std::get<Assign>(copy.node).place->node).var = count;
        changing.insert(changing.insert(place, std::move(change)), std::move(copy));
        ++i;
      } else {
        changing.insert(place, std::move(change));
      }
    }
  }

  template <class Visit>
  static void forEachRead(Loop& loop, VarId var, Visit&& visit) {
    const auto check = [&](Expr& expr) {
      auto* const n = std::get_if<VarRef>(&expr.node);
      if (n != nullptr && n->var == var) visit(*n);
    };
    if (loop.cond) walkExprs(*loop.cond, check);
    walkExprs(loop.body, check);
    walkExprs(loop.step, check);
  }
  static bool isRead(Loop& loop, VarId var) {
    bool found = false;
    forEachRead(loop, var, [&](VarRef&) { found = true; });
    return found;
  }
  static void rename(Loop& loop, VarId from, VarId to) {
    forEachRead(loop, from, [&](VarRef& ref) { ref.var = to; });
  }

  Function& function_;
  FunctionId id_;
  const analysis::Uniformity& uniformity_;
};

}  // namespace

bool splitCounters(Function& function, FunctionId id, const analysis::Uniformity& uniformity) {
  return CounterSplitter(function, id, uniformity).block(function.body);
}

}  // namespace skc
