// SPDX-License-Identifier: MIT
#include "native/contraction.hpp"

#include "ir/call_graph.hpp"
#include "ir/walk.hpp"

namespace skc::native {

using namespace ir;

namespace {

bool isSum(BinaryOp op) { return op == BinaryOp::Add || op == BinaryOp::Sub; }

bool isProduct(const Expr& expr) {
  const auto* n = std::get_if<Binary>(&expr.node);
  return n != nullptr && n->op == BinaryOp::Mul && isReal(expr.type.scalar);
}

/// Counts the operations of a kernel that contraction may fuse.
class Operations {
 public:
  bool hasPair() const { return !isExact_ && sums_ > 0 && products_ > 0; }

  void add(const Block& body) {
    walkStmts(body, [&](const Stmt& stmt) {
      const auto* n = std::get_if<Assign>(&stmt.node);
      if (n == nullptr || !n->op || !isReal(n->place->type.scalar)) return;
      if (isSum(*n->op)) ++sums_;
      if (*n->op == BinaryOp::Mul) ++products_;
    });
    walkExprs(body, [&](const Expr& expr) { add(expr); });
  }

 private:
  void add(const Expr& expr) {
    if (const auto* n = std::get_if<IntrinsicCall>(&expr.node)) return add(n->intrinsic, expr.type);
    if (const auto* n = std::get_if<Convert>(&expr.node)) {
      // a product that is rounded to half, as are all in half precision, feeds no sum
      if (expr.type.scalar == Scalar::Half && isProduct(*n->operand)) --products_;
    }
    if (isProduct(expr)) ++products_;
    const auto* n = std::get_if<Binary>(&expr.node);
    if (n == nullptr || !isReal(expr.type.scalar)) return;
    if (isSum(n->op)) ++sums_;
    if (isProduct(expr) && n->lhs->type.isMatrix() && !n->rhs->type.isScalar()) ++sums_;
  }

  void add(Intrinsic intrinsic, const Type& type) {
    const bool isExactSum = intrinsic >= Intrinsic::RoundedSum && intrinsic <= Intrinsic::ExactRounded;
    isExact_ = isExact_ || isExactSum;
    if (!isReal(type.scalar) || (intrinsic != Intrinsic::Fma && intrinsic != Intrinsic::Dot)) return;
    ++products_;
    ++sums_;
  }

  int products_ = 0, sums_ = 0;
  bool isExact_ = false;
};

}  // namespace

bool canContract(const Module& module, const Kernel& kernel) {
  Operations operations;
  for (const FunctionId id : functionsOf(module, kernel)) operations.add(module.functions[id].body);
  return operations.hasPair();
}

}  // namespace skc::native
