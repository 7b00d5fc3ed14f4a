// SPDX-License-Identifier: MIT
#include "emit/native_stmt.hpp"

#include <optional>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "ir/print.hpp"
#include "support/overloaded.hpp"
#include "support/text.hpp"

namespace skc::emit {
namespace {

using namespace ir;

class FunctionWriter {
 public:
  FunctionWriter(const NativeContext& context, FunctionId id)
      : context_(context), function_(context.module.functions[id]), id_(id) {}

  std::string write() {
    line(1, head() + " {");
    block(function_.body, 2);
    line(1, "}");
    return std::move(text_);
  }

 private:
  std::string head() const {
    std::vector<std::string> parameters;
    for (VarId i = 0; i < function_.parameterCount; ++i) {
      const Variable& var = function_.variables[i];
      if (var.role == VarRole::Gather || var.role == VarRole::Sink) continue;
      const std::string_view reference = var.role == VarRole::InOut ? "&" : "";
      parameters.push_back(fmt::format("[[maybe_unused]] {}{} {}", type(var.type), reference, name(i)));
    }
    return fmt::format("{} {}({})", type(function_.result), context_.functions.at(id_),
                       join(parameters, ", "));
  }

  void block(const Block& statements, int depth) {
    for (const Stmt& stmt : statements) statement(stmt, depth);
  }

  void statement(const Stmt& stmt, int depth) {
    match(stmt.node, [&](const auto& node) { write(node, depth); });
  }

  void write(const Declare& n, int depth) {
    const Type declared = function_.variables[n.var].type;
    const std::string init = n.init ? " = " + expr(*n.init) : inSwitch_ ? "" : "{}";  // a label may skip it
    line(depth, fmt::format("[[maybe_unused]] {} {}{};", type(declared), name(n.var), init));
  }
  void write(const Assign& n, int depth) {
    line(depth, nativeAssignment(context_, id_, *n.place, n.op, *n.value) + ";");
  }

  /// Several components of a vector are no reference: they go through a variable.
  void write(const CallStmt& n, int depth) {
    const Function& callee = context_.module.functions[n.callee];
    std::vector<std::string> before;
    std::vector<std::string> args;
    std::vector<std::string> after;
    for (std::size_t i = 0; i < n.args.size(); ++i) {
      args.push_back(expr(*n.args[i]));
      if (callee.variables[i].role != VarRole::InOut || !isSeveralComponents(*n.args[i])) continue;
      const std::string copy = fmt::format("sk_place{}", i);
      before.push_back(fmt::format("auto {} = {};", copy, args.back()));
      after.push_back(nativeAssignment(context_, id_, *n.args[i], copy) + ";");
      args.back() = copy;
    }
    const std::string call = fmt::format("{}({})", context_.functions.at(n.callee), join(args, ", "));
    const std::string whole = n.result ? nativeAssignment(context_, id_, *n.result, call) : call;
    if (before.empty()) return line(depth, whole + ";");
    line(depth, "{");
    for (const std::string& text : before) line(depth + 1, text);
    line(depth + 1, whole + ";");
    for (const std::string& text : after) line(depth + 1, text);
    line(depth, "}");
  }

  void write(const If& n, int depth) {
    line(depth, fmt::format("if ({}) {{", expr(*n.cond)));
    block(n.then, depth + 1);
    if (!n.otherwise.empty()) {
      line(depth, "} else {");
      block(n.otherwise, depth + 1);
    }
    line(depth, "}");
  }

  void write(const Loop& n, int depth) {
    const std::string cond = n.cond ? expr(*n.cond) : "true";
    switch (n.kind) {
      case LoopKind::While: line(depth, fmt::format("while ({}) {{", cond)); break;
      case LoopKind::DoWhile: line(depth, "do {"); break;
      case LoopKind::For: return writeFor(n, cond, depth);
    }
    block(n.body, depth + 1);
    line(depth, n.kind == LoopKind::DoWhile ? fmt::format("}} while ({});", cond) : "}");
  }

  /// "int i = 0" or "i = i + 1" where a block is just that; nothing is text, too.
  std::optional<std::string> inHead(const Block& block) const {
    if (block.empty()) return "";
    if (block.size() > 1) return std::nullopt;
    if (const auto* n = std::get_if<Assign>(&block[0].node)) {
      return nativeAssignment(context_, id_, *n->place, n->op, *n->value);
    }
    const auto* n = std::get_if<Declare>(&block[0].node);
    if (n == nullptr || !n->init) return std::nullopt;
    return fmt::format("{} {} = {}", type(function_.variables[n->var].type), name(n->var), expr(*n->init));
  }

  /// What a head has no room for comes before the loop, and the step first in all rounds but the first, so that
  /// `continue` leads to it.
  void writeFor(const Loop& n, const std::string& cond, int depth) {
    const std::optional<std::string> init = inHead(n.init);
    const std::optional<std::string> step = inHead(n.step);
    if (init && step) {
      line(depth, fmt::format("for ({}; {}; {}) {{", *init, cond, *step));
      block(n.body, depth + 1);
      return line(depth, "}");
    }
    line(depth, "{");
    block(n.init, depth + 1);
    line(depth + 1, "for (bool sk_again = false;; sk_again = true) {");
    line(depth + 2, "if (sk_again) {");
    block(n.step, depth + 3);
    line(depth + 2, "}");
    if (n.cond) line(depth + 2, fmt::format("if (!({})) break;", cond));
    block(n.body, depth + 2);
    line(depth + 1, "}");
    line(depth, "}");
  }

  void write(const Switch& n, int depth) {
    line(depth, fmt::format("switch ({}.word()) {{", expr(*n.value, Precedence::Primary)));
    for (const Case& one : n.cases) {
      for (const std::int64_t value : one.values) {
        line(depth + 1, fmt::format("case {}{}:", value, n.value->type.scalar == Scalar::Uint ? "u" : ""));
      }
      if (one.isDefault) line(depth + 1, "default:");
      const bool wasInSwitch = std::exchange(inSwitch_, true);
      block(one.body, depth + 2);
      inSwitch_ = wasInSwitch;
      const bool isLast = &one == &n.cases.back();
      if (!isLast || one.body.empty()) line(depth + 2, isLast ? "break;" : "[[fallthrough]];");
    }
    line(depth, "}");
  }

  void write(const Break&, int depth) { line(depth, "break;"); }
  void write(const Continue&, int depth) { line(depth, "continue;"); }
  void write(const Return& n, int depth) {
    line(depth, n.value ? "return " + expr(*n.value) + ";" : "return;");
  }
  void write(const Scope& n, int depth) {
    line(depth, "{");
    block(n.body, depth + 1);
    line(depth, "}");
  }
  void write(const Push& n, int depth) {
    line(depth, fmt::format("{}.push({});", nativeParameter(context_, n.stream.id), expr(*n.value)));
  }
  void write(const Scatter& n, int depth) {
    const std::string stream = nativeParameter(context_, n.stream.id);
    const std::string place = expr(*n.index);
    const std::string value = expr(*n.value);
    std::string combined;
    switch (n.op) {
      case ScatterOp::Store: return line(depth, fmt::format("{}.put({}, {});", stream, place, value));
      case ScatterOp::Add:
        combined = fmt::format("sk_old + {}", expr(*n.value, Precedence::Multiplicative));
        break;
      case ScatterOp::Min: combined = fmt::format("native::min(sk_old, {})", value); break;
      case ScatterOp::Max: combined = fmt::format("native::max(sk_old, {})", value); break;
    }
    line(depth,
         fmt::format("{}.combine({}, [&](const auto& sk_old) {{ return {}; }});", stream, place, combined));
  }

  void line(int depth, const std::string& text) {
    text_ += wrapLine(std::string(static_cast<std::size_t>(depth) * 2, ' ') + text, 110,
                      static_cast<std::size_t>(depth) * 2 + 4) +
             "\n";
  }

  std::string type(Type t) const { return nativeType(context_.module, context_.types, t); }
  const std::string& name(VarId var) const { return context_.names.variable(id_, var); }
  std::string expr(const Expr& e, Precedence around = Precedence::Lowest) const {
    return nativeExpr(context_, id_, e, around);
  }

  const NativeContext& context_;
  const Function& function_;
  FunctionId id_;
  bool inSwitch_ = false;
  std::string text_;
};

}  // namespace

std::string nativeFunction(const NativeContext& context, FunctionId id) {
  return FunctionWriter(context, id).write();
}

}  // namespace skc::emit
