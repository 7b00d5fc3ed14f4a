// SPDX-License-Identifier: MIT
#include "glsl/statements.hpp"

#include <algorithm>
#include <optional>
#include <set>
#include <string_view>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "glsl/simple.hpp"
#include "ir/build.hpp"
#include "ir/ir.hpp"
#include "ir/print.hpp"
#include "ir/walk.hpp"
#include "support/overloaded.hpp"
#include "support/text.hpp"

namespace skc::emit {

using namespace ir;

namespace {

// Finds `for` loops whose steps NVIDIA's drivers (580) execute once too often: a `return` in the body, or a `break` from a loop
// that the driver unrolls, skips the rest of the body, but not the step. A break keeps the counter of a loop that has no other step.
//
//   for (int i = 0; i < n; ++i, ++r) {       the element that returns at i = 2 gets r = 3
//     if (i == x) return;
//   }
//
// A step that only changes what the loop itself declares does no harm: nobody reads it after the jump.

/// How a block may leave the loop around it.
struct Exits {
  bool returns = false, breaks = false;
};

/// `isInner`: a `break` leaves something in that loop.
void findExits(const Block& statements, bool isInner, Exits& exits) {
  for (const Stmt& stmt : statements) {
    exits.returns = exits.returns || std::holds_alternative<Return>(stmt.node);
    exits.breaks = exits.breaks || (!isInner && std::holds_alternative<Break>(stmt.node));
    const bool catches = std::holds_alternative<Loop>(stmt.node) || std::holds_alternative<Switch>(stmt.node);
    forEachBlock(stmt, [&](const Block& inner) { findExits(inner, isInner || catches, exits); });
  }
}

/// True if the step is one assignment to a variable that the condition reads, as in `for (i = 0; i < n; ++i)`.
bool onlyCounts(const Loop& loop) {
  const auto* step = loop.step.size() == 1 ? std::get_if<Assign>(&loop.step[0].node) : nullptr;
  const auto* counter = step != nullptr ? std::get_if<VarRef>(&step->place->node) : nullptr;
  if (counter == nullptr || !loop.cond) return false;
  bool isRead = false;
  walkExprs(*loop.cond, [&](const Expr& expr) {
    const auto* n = std::get_if<VarRef>(&expr.node);
    isRead = isRead || (n != nullptr && n->var == counter->var);
  });
  return isRead;
}

/// What a loop's step changes.
class Changes {
 public:
  Changes(const Module& module, const Loop& loop) : module_(module) {
    for (const Block* block : {&loop.init, &loop.step}) {
      walkStmts(*block, [&](const Stmt& stmt) {
        if (const auto* n = std::get_if<Declare>(&stmt.node)) own_.insert(n->var);
      });
    }
    walkStmts(loop.step, [&](const Stmt& stmt) { add(stmt); });
  }

  /// True if that is more than variables of the loop.
  bool areLasting() const { return areLasting_; }

 private:
  void add(const Stmt& stmt) {
    if (const auto* n = std::get_if<Assign>(&stmt.node)) {
      write(*n->place);
    } else if (const auto* call = std::get_if<CallStmt>(&stmt.node)) {
      if (call->result) write(*call->result);
      const Function& callee = module_.functions[call->callee];
      for (VarId i = 0; i < call->args.size(); ++i) {
        const VarRole role = callee.variables[i].role;
        if (role == VarRole::InOut) write(*call->args[i]);
        areLasting_ = areLasting_ || role == VarRole::AppendOutput;
      }
    } else if (std::holds_alternative<Push>(stmt.node) || std::holds_alternative<Scatter>(stmt.node) ||
               std::holds_alternative<Print>(stmt.node)) {
      areLasting_ = true;
    }
  }

  void write(const Expr& place) { areLasting_ = areLasting_ || !own_.contains(rootOf(place)); }

  const Module& module_;
  std::set<VarId> own_;
  bool areLasting_ = false;
};

/// True if the body may leave the loop and the step changes what can be read afterwards.
bool stepShowsAfterJump(const Module& module, const Loop& loop) {
  if (loop.step.empty()) return false;
  Exits exits;
  findExits(loop.body, false, exits);
  const bool isWrong = exits.returns || (exits.breaks && !onlyCounts(loop));
  return isWrong && Changes(module, loop).areLasting();
}

constexpr Loc nowhere = {};

class FunctionWriter {
 public:
  FunctionWriter(const GlslContext& context, FunctionId id, LineWriter& writer, bool isTrial = false)
      : context_(context), id_(id), writer_(writer), isTrial_(isTrial) {}

  void write() {
    const Function& function = context_.module.functions[id_];
    const Loc loc = headLoc(function);
    writer_.restart(loc);
    writer_.put(0, loc, glslHead(context_, id_));
    braces(function.body, 0, 0);
  }

 private:
  /// The line before the body, if the head has several lines in the .sk file.
  static Loc headLoc(const Function& function) {
    constexpr std::uint32_t longestHead = 5;
    Loc loc = function.loc;
    if (function.body.empty()) return loc;
    const Loc first = function.body[0].loc;
    const bool isNear =
        first.file == loc.file && first.line > loc.line && first.line - loc.line <= longestHead;
    if (isNear) loc.line = first.line - 1;
    return loc;
  }

  /// `next` is the line of the next statement in the .sk file, 0 if unknown.
  void block(const Block& statements, int depth, std::uint32_t next) {
    for (std::size_t i = 0; i < statements.size();) {
      const bool hasPlace = statements[i].loc.line != 0;
      const std::size_t count = hasPlace ? declaratorsFrom(context_, id_, statements, i) : 0;
      if (count > 1) {
        begin(depth, statements[i].loc, declaratorList(context_, id_, statements, i, count) + ";");
      } else {
        const std::uint32_t following = i + 1 < statements.size() ? statements[i + 1].loc.line : next;
        statement(statements[i], depth, following);
      }
      i += std::max<std::size_t>(count, 1);
    }
  }

  void statement(const Stmt& stmt, int depth, std::uint32_t next) {
    const Loc loc = stmt.loc;
    match(
        stmt.node, [&](const Declare&) { put(depth, stmt); }, [&](const Assign&) { put(depth, stmt); },
        [&](const CallStmt&) { put(depth, stmt); }, [&](const Push&) { put(depth, stmt); },
        [&](const Scatter&) { put(depth, stmt); }, [](const Print&) {},
        [&](const Break&) { put(depth, stmt); }, [&](const Continue&) { put(depth, stmt); },
        [&](const Return&) { put(depth, stmt); },
        [&](const If& n) {
          begin(depth, loc, ifHead(n));
          ifRest(n, depth, loc, next);
        },
        [&](const Loop& n) { loop(n, depth, loc, next); }, [&](const Switch& n) { choice(n, depth, loc); },
        [&](const Scope& n) {
          if (n.body.empty()) return begin(depth, loc, "{}");
          begin(depth, loc, "{");
          closeAfter(n.body, depth, next);
        });
  }

  // ---- simple statements ------------------------------------------------------------------------

  void put(int depth, const Stmt& stmt) { begin(depth, stmt.loc, *simpleText(context_, id_, stmt) + ";"); }

  // ---- blocks -----------------------------------------------------------------------------------

  /// Prints a block whose "{" is written. Statements on one line of the .sk file stay on one line if they all
  /// fit, and otherwise take a line each.
  void closeAfter(const Block& body, int depth, std::uint32_t next) {
    const bool wasSplit = std::exchange(isSplit_, !isTrial_ && !fitsOnLine(body, depth));
    const std::uint32_t openedAt = isSplit_ ? 0 : writer_.row();
    block(body, depth + 1, next == 0 ? 0 : next - 1);  // leave a line for the bracket
    writer_.close(depth, openedAt, "}");
    isSplit_ = wasSplit;
  }

  /// Also true if the block has several lines in the .sk file.
  bool fitsOnLine(const Block& body, int depth) const {
    if (body.empty() || !writer_.isAt(body[0].loc)) return true;
    const Loc last = body.back().loc;
    if (last.line != 0 && !writer_.isAt(last)) return true;
    LineWriter trial = writer_.trial();
    FunctionWriter(context_, id_, trial, true).closeAfter(body, depth, 0);
    return trial.row() == writer_.row();
  }

  /// Begins a statement, on the current line if it shared that line in the .sk file.
  void begin(int depth, Loc loc, const std::string& text) {
    if (isSplit_) writer_.endLine();
    writer_.put(depth, loc, text);
  }

  void braces(const Block& body, int depth, std::uint32_t next) {
    if (body.empty()) return writer_.append(" {}");
    writer_.append(" {");
    closeAfter(body, depth, next);
  }

  /// True for one simple statement that is not a declaration.
  bool isSimple(const Block& body) const {
    return body.size() == 1 && !std::holds_alternative<Declare>(body[0].node) &&
           simpleText(context_, id_, body[0]).has_value();
  }

  /// True if the .sk file has no line for the "}" after a simple body.
  static bool omitsBraces(const Block& body, Loc head, std::uint32_t next) {
    const std::uint32_t line = body[0].loc.line;
    return line == head.line || (next != 0 && next <= line + 1);
  }

  void bodyOf(const Block& body, int depth, Loc head, std::uint32_t next) {
    if (isSimple(body) && omitsBraces(body, head, next)) return unbracedBody(body, depth, next);
    braces(body, depth, next);
  }

  void unbracedBody(const Block& body, int depth, std::uint32_t next) {
    const bool wasSplit = std::exchange(isSplit_, false);  // the body may stay on its head's line
    statement(body[0], depth + 1, next);
    isSplit_ = wasSplit;
  }

  // ---- if ---------------------------------------------------------------------------------------

  std::string ifHead(const If& n) const { return "if (" + expr(*n.cond) + ")"; }

  /// The `if` of an `else if`.
  static const If* chained(const Block& otherwise) {
    return otherwise.size() == 1 ? std::get_if<If>(&otherwise[0].node) : nullptr;
  }

  /// True if an `if` with an `else`, and every `if` in its chain, prints without braces.
  bool chainOmitsBraces(const If& n, Loc loc, std::uint32_t next) const {
    if (!isSimple(n.then)) return false;
    if (n.otherwise.empty()) return omitsBraces(n.then, loc, next);
    const Loc elseLoc = n.otherwise[0].loc;
    if (const If* inner = chained(n.otherwise)) {
      return omitsBraces(n.then, loc, elseLoc.line) && chainOmitsBraces(*inner, elseLoc, next);
    }
    return isSimple(n.otherwise) && omitsBraces(n.otherwise, loc, next);
  }

  void ifRest(const If& n, int depth, Loc loc, std::uint32_t next) {
    if (n.otherwise.empty()) return bodyOf(n.then, depth, loc, next);
    if (chainOmitsBraces(n, loc, next)) return bareIfElse(n, depth, next);
    const Loc elseLoc = n.otherwise[0].loc;
    braces(n.then, depth, elseLoc.line);
    if (const If* inner = chained(n.otherwise)) {
      const std::string head = "else " + ifHead(*inner);
      if (elseLoc.line == 0 || writer_.isNumbered(elseLoc)) {
        writer_.append(" " + head);
      } else {
        writer_.endLine();
        writer_.put(depth, elseLoc, head);
      }
      ifRest(*inner, depth, elseLoc, next);
    } else {
      writer_.append(" else");
      braces(n.otherwise, depth, next);
    }
  }

  void bareIfElse(const If& n, int depth, std::uint32_t next) {
    const std::uint32_t openedAt = writer_.row();
    unbracedBody(n.then, depth, next);
    if (n.otherwise.empty()) return;
    const If* inner = chained(n.otherwise);
    const std::string word = inner != nullptr ? "else " + ifHead(*inner) : "else";
    if (writer_.row() == openedAt && writer_.isAt(n.otherwise[0].loc)) {
      writer_.append(" " + word);
    } else {
      writer_.endLine();
      const Loc loc =
          n.otherwise[0].loc;  // an `else` without a line of its own in the .sk file shares this one
      writer_.put(depth, inner != nullptr || writer_.isNext(loc) ? loc : nowhere, word);
    }
    if (inner != nullptr) return bareIfElse(*inner, depth, next);
    unbracedBody(n.otherwise, depth, next);
  }

  // ---- loops ------------------------------------------------------------------------------------

  void loop(const Loop& n, int depth, Loc loc, std::uint32_t next) {
    const std::string cond = n.cond ? expr(*n.cond) : "true";
    switch (n.kind) {
      case LoopKind::While:
        begin(depth, loc, "while (" + cond + ")");
        return bodyOf(n.body, depth, loc, next);
      case LoopKind::DoWhile:
        begin(depth, loc, "do");
        braces(n.body, depth, next);
        return writer_.append(" while (" + cond + ");");
      case LoopKind::For: break;
    }
    const std::optional<std::string> head =
        stepShowsAfterJump(context_.module, n) ? std::nullopt : forHead(context_, id_, n);
    if (!head) return longFor(n, depth, loc, next);
    begin(depth, loc, *head);
    bodyOf(n.body, depth, loc, next);
  }

  /// A loop whose init or step does not fit in a GLSL head, or whose step must not be one. The step comes first in every
  /// iteration but the first, so that `continue` still runs it, and a jump out of the loop does not.
  void longFor(const Loop& n, int depth, Loc loc, std::uint32_t next) {
    begin(depth, loc, "{");
    const std::uint32_t openedAt = writer_.row();
    block(n.init, depth + 1, 0);
    writer_.put(depth + 1, nowhere, "for (bool sk_again = false; ; sk_again = true) {");
    writer_.put(depth + 2, nowhere, "if (sk_again)");
    braces(n.step, depth + 2, 0);
    if (n.cond) writer_.put(depth + 2, nowhere, "if (!" + expr(*n.cond, Precedence::Primary) + ") break;");
    block(n.body, depth + 2, next);
    writer_.close(depth + 1, 0, "}");
    writer_.close(depth, openedAt, "}");
  }

  // ---- switch -----------------------------------------------------------------------------------

  void choice(const Switch& n, int depth, Loc loc) {
    if (n.cases.empty()) return;
    begin(depth, loc, "switch (" + expr(*n.value) + ") {");
    const std::uint32_t openedAt = writer_.row();
    for (const Case& one : n.cases) {
      writer_.put(depth + 1, one.loc, label(one, n.value->type.scalar));
      const bool isScope = !one.body.empty() && std::holds_alternative<Scope>(one.body[0].node);
      block(one.body, isScope ? depth + 1 : depth + 2, 0);
    }
    if (isNothing(n.cases.back().body)) writer_.put(depth + 2, n.cases.back().loc, "break;");
    writer_.close(depth, openedAt, "}");
  }

  /// GLSL needs a statement after the last label, and an empty block does not count.
  static bool isNothing(const Block& body) {
    return std::all_of(body.begin(), body.end(), [](const Stmt& stmt) {
      const auto* n = std::get_if<Scope>(&stmt.node);
      return n != nullptr && isNothing(n->body);
    });
  }

  static std::string label(const Case& one, Scalar scalar) {
    std::vector<std::string> labels;
    for (std::int64_t value : one.values) {
      labels.push_back(fmt::format("case {}{}:", value, scalar == Scalar::Uint ? "u" : ""));
    }
    if (one.isDefault) labels.push_back("default:");
    return join(labels, " ");
  }

  std::string expr(const Expr& e, Precedence around = Precedence::Lowest) const {
    return glslExpr(context_, id_, e, around);
  }

  const GlslContext& context_;
  FunctionId id_;
  LineWriter& writer_;
  bool isTrial_;  ///< only tests whether a block fits on its line
  bool isSplit_ = false;  ///< the current block is too long for its line in the .sk file
};

/// "inout ", "out " or "".
std::string_view direction(const GlslContext& context, FunctionId id, VarId var) {
  if (context.module.functions[id].variables[var].role != VarRole::InOut) return "";
  const bool isOutput = id == context.kernel.entry && context.kernel.params[var].role == ParamRole::Output;
  return isOutput ? "out " : "inout ";
}

}  // namespace

std::string glslHead(const GlslContext& context, FunctionId id) {
  const Function& function = context.module.functions[id];
  std::vector<std::string> parameters;
  for (VarId i = 0; i < function.parameterCount; ++i) {
    const Variable& var = function.variables[i];
    if (var.role == VarRole::Gather || var.role == VarRole::AppendOutput) continue;
    parameters.push_back(
        std::string(isDeclaredPrecise(function, i) ? declarationMark(context, var.type) : "") +
        std::string(direction(context, id, i)) +
        context.types.declaration(var.type, context.names.variable(id, i)));
  }
  return fmt::format("{} {}({})", context.types.glsl(function.result), context.names.function(id),
                     join(parameters, ", "));
}

void writeFunction(const GlslContext& context, FunctionId id, LineWriter& writer) {
  FunctionWriter(context, id, writer).write();
}

}  // namespace skc::emit
