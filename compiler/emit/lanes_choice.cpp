// SPDX-License-Identifier: MIT
#include "emit/lanes_choice.hpp"

#include <algorithm>
#include <map>
#include <set>

#include "ir/counted_loop.hpp"
#include "ir/reach.hpp"
#include "ir/walk.hpp"
#include "support/overloaded.hpp"

namespace skc::emit {

using namespace ir;

namespace {

bool isNumber(Type type) { return type.isArithmetic() && type.scalar <= Scalar::Float; }

class LanesCheck {
 public:
  LanesCheck(const Module& module, const Divergence& divergence, FunctionId id)
      : module_(module), divergence_(divergence), id_(id) {}

  bool passes() const {
    const Function& function = module_.functions[id_];
    bool passed = true;
    for (VarId i = 0; i < function.variables.size(); ++i) {
      passed = passed && (!divergence_.differs(id_, i) || isNumber(function.variables[i].type));
    }
    walkStmts(function.body, [&](const Stmt& stmt) { passed = passed && passes(stmt); });
    walkExprs(function.body, [&](const Expr& expr) { passed = passed && passes(expr); });
    return passed;
  }

 private:
  bool differs(const Expr& expr) const { return divergence_.differs(id_, expr); }

  bool passes(const Stmt& stmt) const {
    if (const auto* n = std::get_if<Assign>(&stmt.node)) return isPlace(*n->place);
    if (const auto* n = std::get_if<CallStmt>(&stmt.node)) {
      bool arePlaces = !n->result || isPlace(*n->result);
      for (std::size_t i = 0; i < n->args.size(); ++i) {
        const bool isInOut = module_.functions[n->callee].variables[i].role == VarRole::InOut;
        arePlaces = arePlaces && (!isInOut || isPlace(*n->args[i]));
      }
      return arePlaces;
    }
    return !std::holds_alternative<Switch>(stmt.node) && !std::holds_alternative<Push>(stmt.node) &&
           !std::holds_alternative<Scatter>(stmt.node);
  }
  /// Whether no lane has a place of its own.
  bool isPlace(const Expr& place) const {
    bool is = true;
    walkExprs(place, [&](const Expr& expr) {
      const auto* n = std::get_if<Index>(&expr.node);
      is = is && (n == nullptr || !differs(*n->index));
    });
    return is;
  }

  bool passes(const Expr& expr) const {
    if (!differs(expr)) return true;
    if (!isNumber(expr.type)) return false;
    if (const auto* n = std::get_if<NeighborRead>(&expr.node)) return !differs(*n->offset);
    if (const auto* n = std::get_if<Unary>(&expr.node))
      return n->op != UnaryOp::LogicalNot || expr.type.isScalar();
    if (const auto* n = std::get_if<Binary>(&expr.node)) {
      const bool isLogical = n->op == BinaryOp::LogicalAnd || n->op == BinaryOp::LogicalOr;
      return isNumber(n->lhs->type) && isNumber(n->rhs->type) && (!isLogical || expr.type.isScalar());
    }
    if (std::holds_alternative<Index>(expr.node)) return true;  // of what is the same for all, any type
    bool areNumbers = true;
    forEachOperand(expr, [&](const ExprPtr& operand) { areNumbers = areNumbers && isNumber(operand->type); });
    return areNumbers;
  }

  const Module& module_;
  const Divergence& divergence_;
  FunctionId id_;
};

}  // namespace

bool hasLanesForm(const Module& module, const Kernel& kernel, const Divergence& divergence) {
  const auto isOrdered = [](const KernelParam& param) {
    return param.role == ParamRole::VariableOutput || param.role == ParamRole::Scatter;
  };
  if (kernel.reduction || std::ranges::any_of(kernel.params, isOrdered)) return false;
  return std::ranges::all_of(functionsOf(module, kernel), [&](FunctionId id) {
    return (id != kernel.entry && !divergence.of(id).differs()) ||
           LanesCheck(module, divergence, id).passes();
  });
}

namespace {

/// What a function gains by lanes: operations that are done for several elements at a time, less reads that are not.
class Gain {
 public:
  Gain(const Module& module, const Divergence& divergence, FunctionId id)
      : divergence_(divergence), id_(id), function_(module.functions[id]) {
    walkStmts(function_.body, [&](const Stmt& stmt) {
      if (const auto* n = std::get_if<Declare>(&stmt.node); n != nullptr && n->init)
        inits_[n->var] = n->init.get();
    });
    walkStmts(function_.body, [&](const Stmt& stmt) {
      const auto* n = std::get_if<Assign>(&stmt.node);
      if (n == nullptr) return;
      walkExprs(static_cast<const Expr&>(*n->place), [&](const Expr& expr) {
        if (const auto* var = std::get_if<VarRef>(&expr.node)) assigned_.insert(var->var);
      });
    });
  }

  double total() {
    block(function_.body, 1);
    return total_;
  }

 private:
  /// In a loop that some lanes leave before others, half of them work.
  void block(const Block& statements, double share) {
    for (const Stmt& stmt : statements) {
      const bool isLoop = std::holds_alternative<Loop>(stmt.node);
      const double inside = isLoop && divergence_.isApart(stmt) ? share / 2 : share;
      forEachOperand(stmt, [&](const ExprPtr& operand) {
        walkExprs(static_cast<const Expr&>(*operand), [&](const Expr& expr) { add(expr, inside); });
      });
      forEachBlock(stmt, [&](const Block& inner) { block(inner, inside); });
    }
  }

  void add(const Expr& expr, double share) {
    const double width = expr.type.width;
    if (const auto* n = std::get_if<GatherRead>(&expr.node)) {
      if (!differs(expr)) {
        total_ += share;
      } else {
        total_ += isNear(*n->index) ? 3 * share * width : -3 * width;
      }
    } else if (!differs(expr)) {
      return;
    } else if (std::holds_alternative<Binary>(expr.node) || std::holds_alternative<Select>(expr.node)) {
      total_ += share * width;
    } else if (std::holds_alternative<IntrinsicCall>(expr.node)) {
      total_ += 4 * share * width;
    }
  }

  /// Whether neighbours ask for neighbours, or all for one, as far as the text tells. Of an index of several dimensions, x comes
  /// first.
  bool isNear(const Expr& expr) const {
    if (!differs(expr) || std::holds_alternative<IndexOf>(expr.node)) return true;
    if (const auto* n = std::get_if<VarRef>(&expr.node)) {
      const auto init = inits_.find(n->var);
      if (init == inits_.end()) return n->var < function_.parameterCount;
      return !assigned_.contains(n->var) && isNear(*init->second);
    }
    if (const auto* n = std::get_if<Construct>(&expr.node)) {
      return isNear(*n->args[0]) && std::all_of(n->args.begin() + 1, n->args.end(),
                                                [&](const ExprPtr& arg) { return !differs(*arg); });
    }
    if (const auto* n = std::get_if<Swizzle>(&expr.node)) {
      return (n->components[0] == 0 || !expr.type.isVector()) && isNear(*n->base);
    }
    if (const auto* n = std::get_if<Index>(&expr.node)) return n->base->type.isVector() && isNear(*n->base);
    if (const auto* n = std::get_if<Select>(&expr.node)) return isNear(*n->yes) && isNear(*n->no);
    const auto* n = std::get_if<Binary>(&expr.node);
    if (n == nullptr) return false;
    const bool keeps = n->op == BinaryOp::Add || n->op == BinaryOp::Sub || n->op == BinaryOp::BitXor;
    return keeps && isNear(*n->lhs) && isNear(*n->rhs);
  }

  bool differs(const Expr& expr) const { return divergence_.differs(id_, expr); }

  const Divergence& divergence_;
  FunctionId id_;
  const Function& function_;
  std::map<VarId, const Expr*> inits_;
  std::set<VarId> assigned_;
  double total_ = 0;
};

}  // namespace

bool gainsByLanes(const Module& module, const Kernel& kernel, const Divergence& divergence) {
  bool isMissed = false;  // by compilers
  double total = 0;
  for (const FunctionId id : functionsOf(module, kernel)) {
    const Block& body = module.functions[id].body;
    walkStmts(body, [&](const Stmt& stmt) {
      const auto* loop = std::get_if<Loop>(&stmt.node);
      isMissed = isMissed || (loop != nullptr && !isCounted(module, *loop));
    });
    walkExprs(body, [&](const Expr& expr) {
      isMissed = isMissed || (std::holds_alternative<GatherRead>(expr.node) && divergence.differs(id, expr));
    });
    total += Gain(module, divergence, id).total();
  }
  return isMissed && total > 0;
}

}  // namespace skc::emit
