// SPDX-License-Identifier: MIT
#include "native/lane_count.hpp"

#include <optional>

#include "analysis/stream_uses.hpp"
#include "analysis/uniformity.hpp"
#include "ir/assigned.hpp"
#include "ir/build.hpp"
#include "ir/reach.hpp"
#include "ir/walk.hpp"
#include "native/leaves.hpp"

namespace skc::native {

using namespace ir;
using analysis::Shape;
using analysis::Uniformity;

namespace {

/// Operations for each gather, up to which a loop takes its time for gathers.
constexpr std::size_t fewOperations = 4;

/// The variable that a `for` loop's step adds a constant to, if the body leaves it alone.
std::optional<VarId> counterOf(const Loop& loop) {
  if (loop.kind != LoopKind::For || loop.step.size() != 1) return std::nullopt;
  const auto* step = std::get_if<Assign>(&loop.step.front().node);
  if (step == nullptr || !step->op || !std::holds_alternative<Literal>(step->value->node))
    return std::nullopt;
  const VarId counter = rootOf(*step->place);
  return assigns(loop.body, counter) ? std::nullopt : std::optional(counter);
}

/// True if a variable in the expression carries a value from one iteration to the next.
bool dependsOnEarlier(const Expr& expr, const Loop& loop) {
  bool depends = false;
  walkExprs(expr, [&](const Expr& inner) {
    const auto* n = std::get_if<VarRef>(&inner.node);
    depends = depends || (n != nullptr && assigns(loop.body, n->var));
  });
  return depends;
}

/// True of a loop with a trip count of each lane's own that does little but gather elements at indices which follow from its
/// counter. One element after the other, its gathers overlap as well, and none is for a lane that has left the loop.
bool gathersAlone(const Uniformity& uniformity, FunctionId function, const Stmt& stmt) {
  const auto* loop = std::get_if<Loop>(&stmt.node);
  if (loop == nullptr || !uniformity.diverges(function, stmt)) return false;
  const std::optional<VarId> counter = counterOf(*loop);
  if (!counter || uniformity.of(function, *std::get<Assign>(loop->step.front().node).place) != Shape::Varying)
    return false;
  std::size_t gathers = 0, operations = 0;
  bool isSimple = true;
  walkStmts(loop->body, [&](const Stmt& inner) {
    isSimple = isSimple &&
               (std::holds_alternative<Declare>(inner.node) || std::holds_alternative<Assign>(inner.node));
  });
  walkExprs(loop->body, [&](const Expr& expr) {
    if (const auto* n = std::get_if<GatherRead>(&expr.node)) {
      const bool isScattered = uniformity.of(function, *n->index) == Shape::Varying;
      gathers += isScattered ? 1 : 0;
      isSimple = isSimple && !dependsOnEarlier(*n->index, *loop);
    }
    isSimple = isSimple && !std::holds_alternative<Call>(expr.node);
    const bool isOperation =
        std::holds_alternative<Binary>(expr.node) || std::holds_alternative<Unary>(expr.node) ||
        std::holds_alternative<Select>(expr.node) || std::holds_alternative<IntrinsicCall>(expr.node);
    operations += isOperation ? 1 : 0;
  });
  return isSimple && gathers > 0 && operations <= fewOperations * gathers;
}

/// True if some loop of the kernel only gathers, and no other loop has work for lanes.
bool onlyGathers(const Module& module, const Kernel& kernel) {
  const Uniformity uniformity(module, kernel);
  bool some = false, all = true;
  for (const FunctionId id : functionsOf(module, kernel)) {
    walkStmts(module.functions[id].body, [&](const Stmt& stmt) {
      if (!std::holds_alternative<Loop>(stmt.node)) return;
      const bool is = gathersAlone(uniformity, id, stmt);
      some = some || is;
      all = all && is;
    });
  }
  return some && all;
}

/// The number of vectors, of `bytes` each, in which accumulators are folded side by side. Several read memory in order and do not wait
/// for each other's additions. The runtime has 256 bytes of columns for a scalar. With all of them a leaf is read from end to end;
/// half are enough where there are several scalars, whose code would take long to compile.
std::uint32_t vectorsOfFold(const Module& module, const Kernel& kernel, std::size_t scalars,
                            std::uint32_t bytes, std::uint32_t registers) {
  std::size_t accumulators = 0;
  for (const KernelParam& param : kernel.params)
    accumulators += param.role == ParamRole::Accumulator ? componentCount(module, param.type) : 0;
  const std::uint32_t columnBytes = accumulators == 1 ? 256 : 128;
  std::uint32_t vectors = 1;
  while (2 * vectors * bytes * accumulators <= columnBytes && 2 * vectors * scalars <= registers)
    vectors *= 2;
  return vectors;
}

}  // namespace

std::uint32_t laneCount(const Module& module, const Kernel& kernel, sk::native::EntryKind kind,
                        sk::native::Real real, const CpuLevel& level) {
  if (onlyGathers(module, kernel)) return 1;
  const std::uint32_t bits = real == sk::native::Real::Float ? 32 : 64;
  const std::uint32_t one = level.vectorBits / bits;
  std::size_t scalars = 0;
  for (const FunctionId id : functionsOf(module, kernel)) {
    for (const Variable& variable : module.functions[id].variables)
      scalars += componentCount(module, variable.type);
  }
  // a chain of dependent operations leaves units idle; a second vector fills them
  constexpr std::size_t few = 16;
  const bool waits = analysis::streamUses(module, kernel).loops;
  if (waits) return scalars <= few ? 2 * one : one;
  const bool foldsInAnyOrder =
      kind == sk::native::EntryKind::Fold && kernel.reduction && kernel.reduction->commutative;
  return foldsInAnyOrder ? one * vectorsOfFold(module, kernel, scalars, bits / 8 * one, level.vectorRegisters)
                         : one;
}

}  // namespace skc::native
