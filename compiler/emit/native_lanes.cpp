// SPDX-License-Identifier: MIT
#include "emit/native_lanes.hpp"

#include <algorithm>
#include <optional>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "ir/print.hpp"
#include "ir/walk.hpp"
#include "support/overloaded.hpp"
#include "support/text.hpp"

namespace skc::emit {
namespace {

using namespace ir;

class LanesWriter {
 public:
  LanesWriter(const NativeContext& context, FunctionId id)
      : context_(context),
        divergence_(*context.divergence),
        own_(divergence_.of(id)),
        function_(context.module.functions[id]),
        id_(id) {}

  std::string write() {
    line(1, head() + " {");
    if (own_.returnsApart && !own_.isCalledApart) line(2, "native::Mask sk_on(true);");
    if (own_.returnsApart && !function_.result.isVoid()) line(2, resultType() + " sk_result{};");
    for (VarId i = 0; i < function_.parameterCount; ++i) {
      if (divergence_.isInStep(id_, i))
        line(2, "[[maybe_unused]] " + scalarType(i) + " " + firstLane(name(i)) + "{};");
    }
    if (own_.returnsApart || own_.isCalledApart) masks_.push_back({"sk_on", Mask::Function, nullptr});
    block(function_.body, 2);
    if (own_.returnsApart && !function_.result.isVoid()) line(2, "return sk_result;");
    line(1, "}");
    return std::move(text_);
  }

 private:
  /// A variable that says which lanes take part, from the function's outwards to that of the current statement.
  struct Mask {
    std::string name;
    enum Kind : std::uint8_t { Function, Branch, Loop, Round } kind;
    const Stmt* loop;  ///< of Loop and Round
  };

  std::string head() const {
    std::vector<std::string> parameters;
    if (own_.isCalledApart) parameters.emplace_back("[[maybe_unused]] native::Mask sk_on");
    for (VarId i = 0; i < function_.parameterCount; ++i) {
      const Variable& var = function_.variables[i];
      if (var.role == VarRole::Gather || var.role == VarRole::Sink) continue;
      parameters.push_back(
          fmt::format("[[maybe_unused]] {}{} {}", type(i), var.role == VarRole::InOut ? "&" : "", name(i)));
    }
    return fmt::format("{} {}({})", resultType(), lanesFunction(context_, id_), join(parameters, ", "));
  }
  std::string resultType() const {
    return own_.result ? lanesType(context_, function_.result)
                       : nativeType(context_.module, context_.types, function_.result);
  }

  /// What follows a jump is never reached.
  void block(const Block& statements, int depth) {
    for (const Stmt& stmt : statements) {
      match(stmt.node, [&](const auto& node) { write(stmt, node, depth); });
      if (std::holds_alternative<Break>(stmt.node) || std::holds_alternative<Continue>(stmt.node) ||
          std::holds_alternative<Return>(stmt.node))
        return;
    }
  }

  void write(const Stmt&, const Declare& n, int depth) {
    const bool isInStep = divergence_.isInStep(id_, n.var);
    if (isInStep || divergence_.isIndex(id_, n.var) || divergence_.isRamp(id_, n.var)) {
      line(depth,
           fmt::format("[[maybe_unused]] {}{} {}{};", isInStep ? "" : "const ", scalarType(n.var),
                       firstLane(name(n.var)), n.init ? " = " + nativeExpr(context_, id_, *n.init) : "{}"));
    }
    const std::string init = n.init ? " = " + value(n.var, *n.init) : "{}";
    line(depth, fmt::format("[[maybe_unused]] {} {}{};", type(n.var), name(n.var), init));
  }
  void write(const Stmt& stmt, const Assign& n, int depth) {
    const auto* var = std::get_if<VarRef>(&n.place->node);
    if (var != nullptr && divergence_.isInStep(id_, var->var)) return assignInStep(stmt, n, var->var, depth);
    if (!differs(*n.place) && !differsAtRoot(*n.place)) {
      return line(depth, nativeAssignment(context_, id_, *n.place, n.op, *n.value) + ";");
    }
    std::string assigned = spread(*n.value);
    if (n.op) {
      assigned = fmt::format("{} {} {}", text(*n.place), spelling(*n.op),
                             isOperation(*n.value) ? "(" + text(*n.value) + ")" : text(*n.value));
    }
    assign(*n.place, assigned, divergence_.isBlended(stmt), depth);
  }

  /// A number that is the same for all lanes in a loop is computed once, and those that are in it take it.
  void assignInStep(const Stmt& stmt, const Assign& n, VarId var, int depth) {
    line(depth, nativeAssignment(context_, id_, *n.place, n.op, *n.value) + ";");
    const auto* by = std::get_if<Literal>(&n.value->node);
    const bool isCount = n.op == BinaryOp::Add && by != nullptr && by->bits == 1 && n.value->type.isInteger();
    if (!divergence_.isBlended(stmt)) {
      line(depth, fmt::format("{} = native::spread({});", name(var), firstLane(name(var))));
    } else if (isCount) {
      line(depth, fmt::format("native::count({}, {});", on(), name(var)));
    } else {
      line(depth,
           fmt::format("native::put({}, {}, native::spread({}));", on(), name(var), firstLane(name(var))));
    }
  }

  void assign(const Expr& place, const std::string& assigned, bool isBlended, int depth) {
    const auto* swizzle = std::get_if<Swizzle>(&place.node);
    if (swizzle != nullptr && isSeveralComponents(place)) {
      const Components whole = flattened(*swizzle);
      const std::string base = text(*whole.base);
      const std::string blended =
          isBlended ? fmt::format("native::select({}, {}, {})", on(), assigned, text(place)) : assigned;
      return line(depth,
                  fmt::format("native::assign<{}>({}, {});", numbers(whole.components), base, blended));
    }
    line(depth, isBlended ? fmt::format("native::put({}, {}, {});", on(), text(place), assigned)
                          : fmt::format("{} = {};", text(place), assigned));
  }

  /// Several components of a vector are no reference: they go through a variable.
  void write(const Stmt& stmt, const CallStmt& n, int depth) {
    const FunctionDivergence& called = divergence_.of(n.callee);
    const Function& callee = context_.module.functions[n.callee];
    const bool isOfLanes = called.differs();
    std::vector<std::string> before, args, after;
    if (isOfLanes && called.isCalledApart) args.push_back(mask());
    for (std::size_t i = 0; i < n.args.size(); ++i) {
      const bool isInOut = callee.variables[i].role == VarRole::InOut;
      args.push_back(isOfLanes && called.variables[i] && !isInOut ? spread(*n.args[i]) : text(*n.args[i]));
      if (!isInOut || !isSeveralComponents(*n.args[i])) continue;
      const std::string copy = fmt::format("sk_place{}", i);
      before.push_back(fmt::format("auto {} = {};", copy, args.back()));
      const Components whole = flattened(std::get<Swizzle>(n.args[i]->node));
      after.push_back(
          fmt::format("native::assign<{}>({}, {});", numbers(whole.components), text(*whole.base), copy));
      args.back() = copy;
    }
    const std::string function =
        isOfLanes ? lanesFunction(context_, n.callee) : context_.functions.at(n.callee);
    const std::string call = fmt::format("{}({})", function, join(args, ", "));
    line(depth, "{");
    for (const std::string& text : before) line(depth + 1, text);
    if (!n.result) {
      line(depth + 1, call + ";");
    } else if (!differsAtRoot(*n.result)) {
      line(depth + 1, nativeAssignment(context_, id_, *n.result, call) + ";");
    } else {
      assign(*n.result, called.result ? call : fmt::format("native::spread({})", call),
             divergence_.isBlended(stmt), depth + 1);
    }
    for (const std::string& text : after) line(depth + 1, text);
    line(depth, "}");
  }

  void write(const Stmt& stmt, const If& n, int depth) {
    if (!divergence_.isApart(stmt)) {
      line(depth, fmt::format("if ({}) {{", text(*n.cond)));
      block(n.then, depth + 1);
      if (!n.otherwise.empty()) {
        line(depth, "} else {");
        block(n.otherwise, depth + 1);
      }
      return line(depth, "}");
    }
    line(depth, "{");
    const std::string condition = newName("sk_if");
    line(depth + 1, fmt::format("const native::Mask {} = {};", condition, text(*n.cond)));
    branch(n.then, condition, depth + 1);
    if (!n.otherwise.empty()) branch(n.otherwise, "!" + condition, depth + 1);
    line(depth, "}");
    const bool mayBeOver = masks_.size() == 1 && masks_.back().kind == Mask::Function && own_.returnsApart &&
                           (hasReturn(n.then) || hasReturn(n.otherwise));
    if (mayBeOver) {
      line(depth, fmt::format("if (!native::any({})) return{};", on(),
                              function_.result.isVoid() ? "" : " sk_result"));
    }
  }
  void branch(const Block& statements, const std::string& condition, int depth) {
    const std::string inner = newName("sk_on");
    line(depth,
         fmt::format("native::Mask {} = {};", inner, masks_.empty() ? condition : on() + " & " + condition));
    line(depth, fmt::format("if (native::any({})) {{", inner));
    masks_.push_back({inner, Mask::Branch, nullptr});
    block(statements, depth + 1);
    masks_.pop_back();
    line(depth, "}");
  }
  static bool hasReturn(const Block& statements) {
    bool has = false;
    walkStmts(statements, [&](const Stmt& stmt) { has = has || std::holds_alternative<Return>(stmt.node); });
    return has;
  }

  // ---- loops ------------------------------------------------------------------------------------

  /// for (;;) with the step, or the condition of do-while, last; or first in all rounds but the first, where a `continue` that
  /// all lanes take has to lead there.
  void write(const Stmt& stmt, const Loop& n, int depth) {
    const bool isApart = divergence_.isApart(stmt);
    const bool isDoWhile = n.kind == LoopKind::DoWhile;
    line(depth, "{");
    block(n.init, depth + 1);
    if (isApart) {
      const std::string inside = newName("sk_on");
      line(depth + 1, fmt::format("native::Mask {} = {};", inside, mask()));
      masks_.push_back({inside, Mask::Loop, &stmt});
    }
    const bool isLast = !continues(n.body);
    const bool hasEnd = !n.step.empty() || isDoWhile;
    const auto end = [&](int at) {
      block(n.step, at);
      if (isDoWhile) condition(stmt, n, at);
    };
    if (hasEnd && !isLast) {
      line(depth + 1, "for (bool sk_again = false;; sk_again = true) {");
      line(depth + 2, "if (sk_again) {");
      end(depth + 3);
      line(depth + 2, "}");
    } else {
      line(depth + 1, "for (;;) {");
    }
    if (!isDoWhile) condition(stmt, n, depth + 2);
    round(stmt, n.body, depth + 2);
    if (hasEnd && isLast) end(depth + 2);
    line(depth + 1, "}");
    if (isApart) masks_.pop_back();
    line(depth, "}");
  }

  void condition(const Stmt& stmt, const Loop& n, int depth) {
    const Expr* cond = n.cond.get();
    if (cond != nullptr && !differs(*cond)) {
      const auto* always = std::get_if<Literal>(&cond->node);
      if (always == nullptr || always->bits == 0) line(depth, fmt::format("if (!({})) break;", text(*cond)));
      cond = nullptr;
    }
    // what holds for all lanes or none is asked first, and once
    for (const auto* both = conjunction(cond); both != nullptr && !differs(*both->lhs);
         both = conjunction(cond)) {
      line(depth, fmt::format("if (!({})) break;", text(*both->lhs)));
      cond = both->rhs.get();
    }
    if (!divergence_.isApart(stmt)) return;
    if (cond != nullptr) {
      const std::string inside = isOperation(*cond) ? "(" + text(*cond) + ")" : text(*cond);
      line(depth, fmt::format("{} = {} & {};", on(), on(), inside));
    }
    line(depth, fmt::format("if (!native::any({})) break;", on()));
  }

  static const Binary* conjunction(const Expr* cond) {
    const auto* n = cond == nullptr ? nullptr : std::get_if<Binary>(&cond->node);
    return n != nullptr && n->op == BinaryOp::LogicalAnd ? n : nullptr;
  }

  void round(const Stmt& stmt, const Block& body, int depth) {
    const bool skips = divergence_.skipsApart(stmt);
    if (!skips) {
      line(depth, "{");
      block(body, depth + 1);
      return line(depth, "}");
    }
    line(depth, "{");
    const std::string inside = newName("sk_on");
    line(depth + 1, fmt::format("native::Mask {} = {};", inside, mask()));
    masks_.push_back({inside, Mask::Round, &stmt});
    block(body, depth + 1);
    masks_.pop_back();
    line(depth, "}");
  }

  /// Whether all lanes together go on with the next round of the loop that has this body.
  bool continues(const Block& body) const {
    return std::ranges::any_of(body, [&](const Stmt& stmt) {
      if (std::holds_alternative<Continue>(stmt.node)) return !divergence_.isApart(stmt);
      if (std::holds_alternative<Loop>(stmt.node)) return false;
      bool inside = false;
      forEachBlock(stmt, [&](const Block& inner) { inside = inside || continues(inner); });
      return inside;
    });
  }

  void write(const Stmt& stmt, const Break&, int depth) {
    if (!divergence_.isApart(stmt)) return line(depth, "break;");
    leave(depth, Mask::Loop);
  }
  void write(const Stmt& stmt, const Continue&, int depth) {
    if (!divergence_.isApart(stmt)) return line(depth, "continue;");
    leave(depth, Mask::Round);
  }
  void write(const Stmt& stmt, const Return& n, int depth) {
    if (!own_.returnsApart) {
      if (!n.value) return line(depth, "return;");
      return line(depth, fmt::format("return {};", own_.result ? spread(*n.value) : text(*n.value)));
    }
    if (n.value) line(depth, fmt::format("native::put({}, sk_result, {});", on(), spread(*n.value)));
    if (!divergence_.isApart(stmt)) return line(depth, n.value ? "return sk_result;" : "return;");
    leave(depth, Mask::Function);
  }
  /// The current lanes leave all masks up to the nearest of a kind.
  void leave(int depth, Mask::Kind last) {
    for (std::size_t i = masks_.size(); i-- > 0;) {
      if (i + 1 < masks_.size()) {
        line(depth, fmt::format("{0} = native::without({0}, {1});", masks_[i].name, on()));
      }
      if (masks_[i].kind == last) break;
    }
    line(depth, fmt::format("{} = native::Mask(false);", on()));
  }

  void write(const Stmt&, const Scope& n, int depth) {
    line(depth, "{");
    block(n.body, depth + 1);
    line(depth, "}");
  }
  void write(const Stmt&, const Switch&, int) {}  // these have no form for lanes
  void write(const Stmt&, const Push&, int) {}
  void write(const Stmt&, const Scatter&, int) {}

  // ---- text -------------------------------------------------------------------------------------

  const std::string& on() const { return masks_.back().name; }
  std::string mask() const { return masks_.empty() ? "native::Mask(true)" : on(); }
  std::string newName(std::string_view base) { return fmt::format("{}{}", base, ++names_); }

  bool differs(const Expr& expr) const { return divergence_.differs(id_, expr); }
  bool differsAtRoot(const Expr& place) const {
    bool does = false;
    walkExprs(place, [&](const Expr& inner) {
      const auto* n = std::get_if<VarRef>(&inner.node);
      does = does || (n != nullptr && divergence_.differs(id_, n->var));
    });
    return does;
  }
  static bool isOperation(const Expr& expr) {
    return std::holds_alternative<Binary>(expr.node) || std::holds_alternative<Unary>(expr.node) ||
           std::holds_alternative<Select>(expr.node);
  }
  std::string text(const Expr& expr) const {
    return lanesExpr(context_, id_, expr, masks_.empty() ? "" : on());
  }
  std::string spread(const Expr& expr) const {
    return spreadExpr(context_, id_, expr, masks_.empty() ? "" : on());
  }
  std::string value(VarId var, const Expr& expr) const {
    return divergence_.differs(id_, var) ? spread(expr) : text(expr);
  }
  std::string type(VarId var) const {
    return divergence_.differs(id_, var) ? lanesType(context_, function_.variables[var].type)
                                         : scalarType(var);
  }
  std::string scalarType(VarId var) const {
    return nativeType(context_.module, context_.types, function_.variables[var].type);
  }
  const std::string& name(VarId var) const { return context_.names.variable(id_, var); }

  void line(int depth, const std::string& text) {
    const std::size_t indent = static_cast<std::size_t>(depth) * 2;
    text_ += wrapLine(std::string(indent, ' ') + text, 110, indent + 4) + "\n";
  }

  const NativeContext& context_;
  const Divergence& divergence_;
  const FunctionDivergence& own_;
  const Function& function_;
  FunctionId id_;
  std::vector<Mask> masks_;
  int names_ = 0;
  std::string text_;
};

}  // namespace

std::string lanesFunctionText(const NativeContext& context, FunctionId id) {
  return LanesWriter(context, id).write();
}

}  // namespace skc::emit
