// SPDX-License-Identifier: MIT
#include "transforms/passes.hpp"

#include <cstdlib>
#include <optional>
#include <utility>
#include <vector>

#include "ir/build.hpp"
#include "ir/call_graph.hpp"
#include "ir/evaluate.hpp"
#include "ir/lvalue.hpp"
#include "ir/walk.hpp"

namespace skc {
namespace {

using namespace ir;

/// Adding a larger offset to an index might overflow an int.
constexpr std::int64_t farthest = 1 << 20;

/// An integer that is a constant, or component `dimension` of the domain's index plus a constant.
struct AffineIndex {
  std::optional<std::uint8_t> dimension;
  std::int64_t offset = 0;
};

class Finder {
 public:
  Finder(const Module& module, const Kernel& kernel, Function& function)
      : module_(module), kernel_(kernel), function_(function), values_(function.variables.size()) {
    const std::vector<bool> assigned = assignedVariables(module, function);
    walkStmts(function.body, [&](const Stmt& stmt) {
      const auto* n = std::get_if<Declare>(&stmt.node);
      if (n == nullptr || !n->init || assigned[n->var]) return;
      if (n->init->type.isInteger()) values_[n->var] = clone(n->init);
    });
  }

  void run() {
    rewriteExprs(function_.body, [&](ExprPtr& slot) {
      const auto* read = std::get_if<GatherRead>(&slot->node);
      ExprPtr offset = read == nullptr ? nullptr : offsetOf(*read->index);
      if (offset) slot = neighborRead(slot->type, read->stream, std::move(offset), slot->loc);
    });
  }

 private:
  /// The offset of an index from the domain's; null if it is not constant.
  ExprPtr offsetOf(const Expr& index) const {
    std::vector<ExprPtr> offsets;
    for (std::uint8_t d = 0; d < index.type.width; ++d) {
      const std::optional<AffineIndex> affine = affineIndex(*componentOf(index, d));
      if (!affine || affine->dimension != d || std::abs(affine->offset) > farthest) return nullptr;
      offsets.push_back(literal(static_cast<std::int32_t>(affine->offset), index.loc));
    }
    if (offsets.size() == 1) return std::move(offsets.front());
    return construct(index.type, std::move(offsets), index.loc);
  }

  std::optional<AffineIndex> affineIndex(const Expr& scalar) const {
    if (const auto bits = evaluate(module_, scalar, Constants::LookThrough)) {
      return AffineIndex{{}, static_cast<std::int32_t>(*bits)};
    }
    if (const auto* n = std::get_if<Binary>(&scalar.node)) return affineSum(*n);
    if (const auto* n = std::get_if<VarRef>(&scalar.node)) {
      return values_[n->var] ? affineIndex(*values_[n->var]) : std::nullopt;
    }
    const auto* n = std::get_if<Swizzle>(&scalar.node);
    return n == nullptr ? std::nullopt : affineComponent(*n->base, n->components.front());
  }

  std::optional<AffineIndex> affineSum(const Binary& n) const {
    if ((n.op != BinaryOp::Add && n.op != BinaryOp::Sub) || n.lhs->type.scalar != Scalar::Int)
      return std::nullopt;
    const std::optional<AffineIndex> lhs = affineIndex(*n.lhs), rhs = affineIndex(*n.rhs);
    if (!lhs || !rhs || (rhs->dimension && (lhs->dimension || n.op == BinaryOp::Sub))) return std::nullopt;
    const std::int64_t offset = n.op == BinaryOp::Add ? lhs->offset + rhs->offset : lhs->offset - rhs->offset;
    return AffineIndex{lhs->dimension ? lhs->dimension : rhs->dimension, offset};
  }

  /// For a vector that componentOf() cannot decompose.
  std::optional<AffineIndex> affineComponent(const Expr& vector, std::uint8_t component) const {
    if (const auto* n = std::get_if<IndexOf>(&vector.node)) {
      return isDomain(n->stream) ? std::optional(AffineIndex{component}) : std::nullopt;
    }
    const auto* n = std::get_if<VarRef>(&vector.node);
    return n != nullptr && values_[n->var] ? affineIndex(*componentOf(*values_[n->var], component))
                                           : std::nullopt;
  }

  /// True for the domain and outputs; an input may have another shape, and its element another index.
  bool isDomain(StreamRef stream) const {
    return stream.space == StreamRef::Space::Domain || (stream.space == StreamRef::Space::KernelParameter &&
                                                        kernel_.params[stream.id].role == ParamRole::Output);
  }

  const Module& module_;
  const Kernel& kernel_;
  Function& function_;
  std::vector<ExprPtr> values_;  ///< initial values of locals that are never assigned
};

}  // namespace

void findNeighbors(Module& module, Diagnostics&) {
  for (const Kernel& kernel : module.kernels) {
    if (kernel.reduction && !foldsBesideOutputs(kernel)) continue;
    for (const FunctionId id : functionsOf(module, kernel)) {
      Finder(module, kernel, module.functions[id]).run();
    }
  }
}

}  // namespace skc
