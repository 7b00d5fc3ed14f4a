// SPDX-License-Identifier: MIT
#include "native/block_gathers.hpp"

#include <algorithm>
#include <map>
#include <optional>

#include "ir/build.hpp"
#include "ir/counted_loop.hpp"
#include "ir/lvalue.hpp"
#include "ir/op_weight.hpp"
#include "ir/walk.hpp"
#include "native/leaves.hpp"
#include "native/streams.hpp"

namespace skc::native {

using namespace ir;
using analysis::Shape;
using analysis::Uniformity;

namespace {

/// The largest body that is emitted twice.
constexpr std::uint32_t mostExpressions = 100;
constexpr std::size_t mostComponents = 4;

class LoopGathers {
 public:
  LoopGathers(const Module& module, const Kernel& kernel, const Uniformity& uniformity, FunctionId function,
              const Loop& loop)
      : module_(module), kernel_(kernel), uniformity_(uniformity), function_(function), loop_(loop) {}

  std::vector<BlockGather> find() {
    const std::optional<VarId> counter = findCounter();
    if (!counter) return {};
    counter_ = *counter;
    walkStmts(loop_.body, [&](const Stmt& stmt) {
      if (const auto* n = std::get_if<Declare>(&stmt.node)) declared_[n->var] = n->init.get();
    });
    std::vector<BlockGather> found;
    std::size_t components = 0;
    walkExprs(loop_.body, [&](const Expr& expr) {
      const auto* read = std::get_if<GatherRead>(&expr.node);
      if (read == nullptr || !holdsWords(*read) || !isScattered(*read->index)) return;
      ExprPtr index = beforeBody(*read->index);
      if (!advances(*index)) return;
      components += componentCount(module_, expr.type);
      found.push_back({&expr, std::move(index)});
    });
    if (components > mostComponents) return {};
    return found;
  }

 private:
  /// The uniform variable that the loop's step increments by one, if the body does not assign it.
  std::optional<VarId> findCounter() const {
    if (loop_.kind != LoopKind::For || loop_.step.size() != 1) return std::nullopt;
    const auto* step = std::get_if<Assign>(&loop_.step.front().node);
    if (step == nullptr || step->op != BinaryOp::Add) return std::nullopt;
    const auto* stepped = std::get_if<VarRef>(&step->place->node);
    const auto* by = std::get_if<Literal>(&step->value->node);
    if (stepped == nullptr || by == nullptr || by->bits != 1) return std::nullopt;
    const Type type = step->place->type;
    const bool isUniform = uniformity_.of(function_, *step->place) == Shape::Uniform;
    if (!type.isScalar() || !type.isInteger() || !isUniform || assigns(loop_.body, stepped->var))
      return std::nullopt;
    return stepped->var;
  }

  /// True if all components of an element take 32 bits.
  bool holdsWords(const GatherRead& read) const {
    const std::vector<Scalar> scalars = scalarsOf(module_, kernel_.params[read.stream.id].type);
    return std::ranges::all_of(scalars, [](Scalar scalar) {
      return scalar == Scalar::Float || scalar == Scalar::Int || scalar == Scalar::Uint;
    });
  }

  /// True if lanes read neither the same element nor consecutive ones.
  bool isScattered(const Expr& index) const {
    const std::vector<Shape> shapes = uniformity_.leavesOf(function_, index);
    const bool isRow =
        std::all_of(shapes.begin() + 1, shapes.end(), [](Shape shape) { return shape == Shape::Uniform; });
    return shapes[0] == Shape::Varying || !isRow;
  }

  /// Replaces variables that the body declares and never reassigns by their initial values.
  ExprPtr beforeBody(const Expr& expr) {
    ExprPtr result = clone(expr);
    rewriteExprs(result, [&](ExprPtr& slot) {
      const auto* n = std::get_if<VarRef>(&slot->node);
      if (n == nullptr) return;
      const auto declared = declared_.find(n->var);
      if (declared == declared_.end() || declared->second == nullptr || assigns(loop_.body, n->var)) return;
      if (replaced_++ < mostExpressions) slot = beforeBody(*declared->second);
    });
    return result;
  }

  bool isInvariant(const Expr& expr) const {
    bool is = true;
    walkExprs(expr, [&](const Expr& inner) {
      const auto* n = std::get_if<VarRef>(&inner.node);
      if (n == nullptr) return;
      is = is && n->var != counter_ && !declared_.contains(n->var) && !assigns(loop_.body, n->var);
    });
    return is;
  }

  /// True if an integer grows by one in each iteration: it is the counter, plus or minus invariant values.
  bool growsByOne(const Expr& expr) const {
    if (!expr.type.isScalar() || !expr.type.isInteger()) return false;
    if (const auto* n = std::get_if<VarRef>(&expr.node)) return n->var == counter_;
    if (const auto* n = std::get_if<Convert>(&expr.node)) return growsByOne(*n->operand);
    const auto* n = std::get_if<Binary>(&expr.node);
    if (n == nullptr) return false;
    if (n->op == BinaryOp::Sub) return growsByOne(*n->lhs) && isInvariant(*n->rhs);
    if (n->op != BinaryOp::Add) return false;
    return (growsByOne(*n->lhs) && isInvariant(*n->rhs)) || (isInvariant(*n->lhs) && growsByOne(*n->rhs));
  }

  /// True if x grows by one in each iteration and the other indices are invariant.
  bool advances(const Expr& index) const {
    if (index.type.isScalar()) return growsByOne(index);
    const auto* n = std::get_if<Construct>(&index.node);
    if (n == nullptr || n->args.size() < 2 || !growsByOne(*n->args.front())) return false;
    return std::all_of(n->args.begin() + 1, n->args.end(),
                       [&](const ExprPtr& arg) { return isInvariant(*arg); });
  }

  const Module& module_;
  const Kernel& kernel_;
  const Uniformity& uniformity_;
  FunctionId function_;
  const Loop& loop_;
  VarId counter_ = 0;
  std::map<VarId, const Expr*> declared_;  ///< variables of the body; initial values or null
  std::size_t replaced_ = 0;
};

}  // namespace

std::vector<BlockGather> blockGathers(const Module& module, const Kernel& kernel,
                                      const Uniformity& uniformity, FunctionId function, const Loop& loop) {
  const std::optional<std::int64_t> iterations = tripCount(module, loop);
  if (iterations && *iterations < Streams::blockLength) return {};
  std::vector<BlockGather> found = LoopGathers(module, kernel, uniformity, function, loop).find();
  // a body with a loop weighs as much as the limit
  if (weigh(module, loop.body, {.node = 1}, mostExpressions + 1) > mostExpressions) found.clear();
  return found;
}

}  // namespace skc::native
