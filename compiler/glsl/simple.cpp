// SPDX-License-Identifier: MIT
#include "glsl/simple.hpp"

#include <algorithm>
#include <vector>

#include <fmt/format.h>

#include "ir/print.hpp"
#include "support/overloaded.hpp"
#include "support/text.hpp"

namespace skc::emit {
namespace {

using namespace ir;
using MaybeText = std::optional<std::string>;

class SimplePrinter {
 public:
  SimplePrinter(const GlslContext& context, FunctionId function) : context_(context), id_(function) {}

  MaybeText simple(const Stmt& stmt) const {
    return match(
        stmt.node,
        [&](const Declare& n) -> MaybeText {
          return std::string(declarationMark(context_, typeOf(n))) +
                 context_.types.declaration(typeOf(n), name(n)) + init(n);
        },
        [&](const Assign& n) -> MaybeText { return glslAssignment(context_, id_, *n.place, n.op, *n.value); },
        [&](const CallStmt& n) -> MaybeText {
          std::vector<std::string> args;
          for (const ExprPtr& arg : n.args) args.push_back(expr(arg));
          const std::string call = context_.names.function(n.callee) + "(" + join(args, ", ") + ")";
          return n.result ? expr(n.result) + " = " + call : call;
        },
        [&](const Push& n) -> MaybeText {
          return fmt::format("sk_push_{}({})", context_.names.symbol(n.stream.id), expr(n.value));
        },
        [&](const Scatter& n) -> MaybeText {
          return fmt::format("sk_put_{}({}, {})", context_.names.symbol(n.stream.id), expr(n.index),
                             expr(n.value));
        },
        [](const Print&) -> MaybeText { return std::nullopt; },  // legalize has removed it
        [](const Break&) -> MaybeText { return "break"; },
        [](const Continue&) -> MaybeText { return "continue"; },
        [&](const Return& n) -> MaybeText { return n.value ? "return " + expr(n.value) : "return"; },
        [](const If&) -> MaybeText { return std::nullopt; },
        [](const Loop&) -> MaybeText { return std::nullopt; },
        [](const Switch&) -> MaybeText { return std::nullopt; },
        [](const Scope&) -> MaybeText { return std::nullopt; });
  }

  std::size_t declarators(const Block& block, std::size_t first) const {
    std::size_t end = first;
    for (; end < block.size(); ++end) {
      const auto* n = std::get_if<Declare>(&block[end].node);
      if (n == nullptr || typeOf(*n).kind == Type::Kind::Array) break;
      const Declare& start = std::get<Declare>(block[first].node);
      if (typeOf(*n) != typeOf(start) || block[end].loc.line != block[first].loc.line) break;
    }
    return end - first;
  }

  std::string declaratorList(const Block& block, std::size_t first, std::size_t count) const {
    std::vector<std::string> declarators;
    for (std::size_t i = first; i < first + count; ++i) {
      const Declare& n = std::get<Declare>(block[i].node);
      declarators.push_back(name(n) + init(n));
    }
    const Type type = typeOf(std::get<Declare>(block[first].node));
    return std::string(declarationMark(context_, type)) + context_.types.glsl(type) + " " +
           join(declarators, ", ");
  }

  /// "int i = 0, n = 9" or "i = 0, n = 9".
  MaybeText initText(const Block& block) const {
    if (block.empty() || !std::holds_alternative<Declare>(block[0].node)) return effects(block);
    if (declarators(block, 0) != block.size()) return std::nullopt;
    return declaratorList(block, 0, block.size());
  }

  /// "++i, j -= 2".
  MaybeText effects(const Block& block) const {
    std::vector<std::string> texts;
    for (const Stmt& stmt : block) {
      const bool isAssign = std::holds_alternative<Assign>(stmt.node);
      const bool isOnlyCall = std::holds_alternative<CallStmt>(stmt.node) && block.size() == 1;
      if (!isAssign && !isOnlyCall) return std::nullopt;
      texts.push_back(isAssign ? step(std::get<Assign>(stmt.node), stmt) : *simple(stmt));
    }
    return join(texts, ", ");
  }

 private:
  std::string step(const Assign& n, const Stmt& stmt) const {
    const auto* value = std::get_if<Literal>(&n.value->node);
    const auto* index = std::get_if<Index>(&n.place->node);
    const bool isComponent = index != nullptr && index->base->type.isVector();
    const bool isOne = value != nullptr && value->bits == 1 && n.place->type.isScalar() &&
                       n.place->type.isInteger() && !isComponent;
    if (isOne && n.op == BinaryOp::Add) return "++" + expr(n.place);
    if (isOne && n.op == BinaryOp::Sub) return "--" + expr(n.place);
    return *simple(stmt);
  }

  Type typeOf(const Declare& n) const { return context_.module.functions[id_].variables[n.var].type; }
  std::string name(const Declare& n) const { return context_.names.variable(id_, n.var); }
  std::string init(const Declare& n) const {
    if (!n.init) return "";
    const bool isStored = holdsFloats(context_.module, typeOf(n));
    return " = " + glslExpr(context_, id_, *n.init, Precedence::Lowest, isStored);
  }
  std::string expr(const ExprPtr& e) const { return glslExpr(context_, id_, *e); }

  const GlslContext& context_;
  FunctionId id_;
};

}  // namespace

std::optional<std::string> simpleText(const GlslContext& context, FunctionId function, const Stmt& stmt) {
  return SimplePrinter(context, function).simple(stmt);
}

std::size_t declaratorsFrom(const GlslContext& context, FunctionId function, const Block& block,
                            std::size_t first) {
  return SimplePrinter(context, function).declarators(block, first);
}

std::string declaratorList(const GlslContext& context, FunctionId function, const Block& block,
                           std::size_t first, std::size_t count) {
  return SimplePrinter(context, function).declaratorList(block, first, count);
}

std::optional<std::string> forHead(const GlslContext& context, FunctionId function, const Loop& loop) {
  const SimplePrinter printer(context, function);
  const MaybeText init = printer.initText(loop.init);
  const MaybeText step = printer.effects(loop.step);
  if (!init || !step) return std::nullopt;
  const std::string cond = loop.cond ? " " + glslExpr(context, function, *loop.cond) : "";
  return fmt::format("for ({};{};{})", *init, cond, step->empty() ? "" : " " + *step);
}

}  // namespace skc::emit
