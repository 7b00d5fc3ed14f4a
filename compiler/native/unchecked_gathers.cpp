// SPDX-License-Identifier: MIT
#include "native/unchecked_gathers.hpp"

#include <algorithm>
#include <cstddef>
#include <optional>
#include <utility>

#include "ir/build.hpp"
#include "ir/walk.hpp"
#include "native/loop_indices.hpp"
#include "native/streams.hpp"

namespace skc::native {

using namespace ir;
using analysis::Shape;
using analysis::Uniformity;
using sk::native::Argument;

namespace {

/// Sets counter and limit from `counter < limit` or `counter <= limit`; returns false for any other condition.
bool readCondition(const LoopIndices& indices, const Loop& loop, UncheckedLoop& found) {
  const auto* test = loop.cond ? std::get_if<Binary>(&loop.cond->node) : nullptr;
  if (test == nullptr || (test->op != BinaryOp::Less && test->op != BinaryOp::LessEqual)) return false;
  const auto* counter = std::get_if<VarRef>(&test->lhs->node);
  if (counter == nullptr || counter->var != indices.counter() || test->lhs->type != test->rhs->type ||
      !indices.isInvariant(*test->rhs))
    return false;
  found.counter = test->lhs.get();
  found.limit = test->rhs.get();
  found.includesLimit = test->op == BinaryOp::LessEqual;
  return true;
}

/// True if lanes read the same element, or consecutive ones of a row.
bool isUniformOrConsecutive(const std::vector<Shape>& shapes) {
  return shapes[0] != Shape::Varying &&
         std::all_of(shapes.begin() + 1, shapes.end(), [](Shape shape) { return shape == Shape::Uniform; });
}

/// Which dimensions of an index grow; nullopt if one changes in another way.
std::optional<std::vector<bool>> growthOf(const LoopIndices& indices, const Expr& index) {
  std::vector<bool> grows;
  for (std::uint8_t d = 0; d < index.type.width; ++d) {
    const ExprPtr component = componentOf(index, d);
    grows.push_back(indices.growsByOne(*component));
    if (!grows.back() && !indices.isInvariant(*component)) return std::nullopt;
  }
  return grows;
}

}  // namespace

UncheckedLoop uncheckedGathers(const Module& module, const Uniformity& uniformity, FunctionId function,
                               const Loop& loop) {
  UncheckedLoop found;
  std::optional<LoopIndices> indices = LoopIndices::of(module, uniformity, function, loop);
  if (!indices || !readCondition(*indices, loop, found) || !isBodySmall(module, loop)) return found;
  walkExprs(loop.body, [&](const Expr& expr) {
    const auto* read = std::get_if<GatherRead>(&expr.node);
    if (read == nullptr || !isUniformOrConsecutive(uniformity.leavesOf(function, *read->index))) return;
    ExprPtr index = indices->beforeBody(*read->index);
    std::optional<std::vector<bool>> grows = growthOf(*indices, *index);
    if (grows) found.gathers.push_back({&expr, std::move(index), std::move(*grows)});
  });
  return found;
}

llvm::Value* Streams::isWalkInside(std::uint32_t param, const Parts& index, const std::vector<bool>& grows,
                                   llvm::Value* iterations) {
  llvm::Value* isInside = l.b.getTrue();
  for (std::size_t d = 0; d < index.size(); ++d) {
    llvm::Value* const i = l.b.CreateSExt(index[d].value, l.int64());
    llvm::Value* end = l.b.CreateAdd(i, l.integer(l.int64(), index[d].isConsecutive ? l.count() - 1 : 0));
    end = l.b.CreateAdd(end, grows[d] ? iterations : l.integer(l.int64(), 1));
    isInside = l.b.CreateAnd(isInside, l.b.CreateICmpSGE(i, low(param, d)));
    isInside = l.b.CreateAnd(isInside, l.b.CreateICmpSLE(end, high(param, d)));
  }
  return isInside;
}

Streams::Walk Streams::walk(std::uint32_t param, const Parts& index, const std::vector<bool>& grows) {
  llvm::Value* number = argumentField(param, offsetof(Argument, first), l.int64());
  Walk walk{param, {}, l.integer(l.int64(), 0), index[0].isConsecutive};
  for (std::size_t d = 0; d < index.size(); ++d) {
    llvm::Value* const i = l.b.CreateSExt(index[d].value, l.int64());
    llvm::Value* const stride =
        d == 0 ? l.integer(l.int64(), 1) : argumentExtent(param, d, offsetof(Argument, stride));
    number = l.b.CreateAdd(number, l.b.CreateMul(i, stride));
    if (grows[d]) walk.step = l.b.CreateAdd(walk.step, stride);
  }
  for (std::size_t c = 0; c < scalars(param).size(); ++c)
    walk.components.push_back(l.at(l.stored(scalars(param)[c]), component(param, c), number));
  return walk;
}

Parts Streams::elementOf(const Walk& walk, llvm::Value* iteration) {
  llvm::Value* const number = l.b.CreateMul(iteration, walk.step);
  Parts element;
  for (std::size_t c = 0; c < walk.components.size(); ++c) {
    const Scalar scalar = scalars(walk.param)[c];
    llvm::Value* const address = l.at(l.stored(scalar), walk.components[c], number);
    element.push_back(walk.isConsecutive ? l.loadNeighbors(scalar, address) : l.loadOne(scalar, address));
  }
  return element;
}

}  // namespace skc::native
