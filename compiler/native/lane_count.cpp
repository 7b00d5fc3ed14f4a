// SPDX-License-Identifier: MIT
#include "native/lane_count.hpp"

#include <algorithm>
#include <bit>
#include <optional>

#include "analysis/stream_uses.hpp"
#include "analysis/uniformity.hpp"
#include "ir/build.hpp"
#include "ir/call_graph.hpp"
#include "ir/lvalue.hpp"
#include "ir/walk.hpp"
#include "native/leaves.hpp"

namespace skc::native {

using namespace ir;
using analysis::Shape;
using analysis::Uniformity;

namespace {

/// Most operations per gather for which gathers dominate the time of a loop.
constexpr std::size_t fewOperations = 4;

/// The variable that a `for` loop's step changes by a constant, if the body does not assign it.
std::optional<VarId> counterOf(const Module& module, const Loop& loop) {
  if (loop.kind != LoopKind::For || loop.step.size() != 1) return std::nullopt;
  const auto* step = std::get_if<Assign>(&loop.step.front().node);
  if (step == nullptr || !step->op || !std::holds_alternative<Literal>(step->value->node))
    return std::nullopt;
  const VarId counter = rootOf(*step->place);
  return assigns(module, loop.body, counter) ? std::nullopt : std::optional(counter);
}

/// True if the loop's body assigns a variable in the expression.
bool dependsOnEarlier(const Module& module, const Expr& expr, const Loop& loop) {
  bool depends = false;
  walkExprs(expr, [&](const Expr& inner) {
    const auto* n = std::get_if<VarRef>(&inner.node);
    depends = depends || (n != nullptr && assigns(module, loop.body, n->var));
  });
  return depends;
}

/// True if lanes have different trip counts and the loop does little but gather elements whose indices follow
/// from its counter. One element at a time, its gathers overlap just as well, and none is for a lane that has
/// left the loop.
bool gathersAlone(const Module& module, const Uniformity& uniformity, FunctionId function, const Stmt& stmt) {
  const auto* loop = std::get_if<Loop>(&stmt.node);
  if (loop == nullptr || !uniformity.diverges(function, stmt)) return false;
  const std::optional<VarId> counter = counterOf(module, *loop);
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
      isSimple = isSimple && !dependsOnEarlier(module, *n->index, *loop);
    }
    isSimple = isSimple && !std::holds_alternative<Call>(expr.node);
    const bool isOperation =
        std::holds_alternative<Binary>(expr.node) || std::holds_alternative<Unary>(expr.node) ||
        std::holds_alternative<Select>(expr.node) || std::holds_alternative<IntrinsicCall>(expr.node);
    operations += isOperation ? 1 : 0;
  });
  return isSimple && gathers > 0 && operations <= fewOperations * gathers;
}

/// True if the kernel has such loops and no others.
bool onlyGathers(const Module& module, const Kernel& kernel) {
  const Uniformity uniformity(module, kernel);
  bool some = false, all = true;
  for (const FunctionId id : functionsOf(module, kernel)) {
    walkStmts(module.functions[id].body, [&](const Stmt& stmt) {
      if (!std::holds_alternative<Loop>(stmt.node)) return;
      const bool is = gathersAlone(module, uniformity, id, stmt);
      some = some || is;
      all = all && is;
    });
  }
  return some && all;
}

/// True if a loop of the kernel reads streams at indices or offsets of its own.
bool readsInLoops(const Module& module, const Kernel& kernel) {
  bool found = false;
  for (const FunctionId id : functionsOf(module, kernel)) {
    walkStmts(module.functions[id].body, [&](const Stmt& stmt) {
      const auto* loop = std::get_if<Loop>(&stmt.node);
      if (loop == nullptr) return;
      walkExprs(loop->body, [&](const Expr& expr) {
        found = found || std::holds_alternative<GatherRead>(expr.node) ||
                std::holds_alternative<NeighborRead>(expr.node) ||
                std::holds_alternative<Sample>(expr.node) || std::holds_alternative<Call>(expr.node);
      });
      walkStmts(loop->body,
                [&](const Stmt& inner) { found = found || std::holds_alternative<CallStmt>(inner.node); });
    });
  }
  return found;
}

/// The number of vectors in which a kernel with data-dependent loops computes elements. The operations of an iteration
/// wait for each other: a second vector, and where nothing is read in loops a third and a fourth, fill the time, as
/// long as what differs between lanes leaves half of the registers for intermediate results.
std::uint32_t vectorsOfLoops(const Module& module, const Kernel& kernel, std::size_t scalars,
                             std::uint32_t registers) {
  constexpr std::size_t few = 16;
  if (scalars > few) return 1;
  if (readsInLoops(module, kernel)) return 2;
  const Uniformity uniformity(module, kernel);
  std::size_t varying = 0;
  for (const FunctionId id : functionsOf(module, kernel)) {
    const auto count = static_cast<VarId>(module.functions[id].variables.size());
    for (VarId variable = 0; variable < count; ++variable)
      varying += static_cast<std::size_t>(std::ranges::count(uniformity.of(id, variable), Shape::Varying));
  }
  return 4 * varying <= registers / 2 ? 4 : 2;
}

/// The number of vectors, of `bytes` each, in which accumulators are folded side by side. Several vectors
/// read memory in order and do not wait for each other's additions. The runtime has 256 bytes of columns per
/// scalar: one scalar uses them all, so that a leaf is read sequentially; several use half of them, because
/// their code would take long to compile.
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

/// The lanes of a fold that stores outputs, too. Memory decides its time, so that it goes through all columns of the
/// runtime (256 bytes of accumulators, 16 to 64 columns) at once, in the order of the elements, unless their
/// accumulators take more than half of the registers.
std::uint32_t lanesBesideOutputs(const Module& module, const Kernel& kernel, std::uint32_t one,
                                 std::uint32_t floatBytes, const CpuLevel& level) {
  std::uint32_t bytes = 0;  // of a column
  for (const KernelParam& param : kernel.params) {
    if (param.role != ParamRole::Accumulator) continue;
    for (const Scalar scalar : scalarsOf(module, param.type)) bytes += is64Bit(scalar) ? 8 : floatBytes;
  }
  const std::uint32_t columns = std::bit_floor(std::clamp(256 / bytes, 16U, 64U));
  const auto registers = [&](std::uint32_t lanes) { return lanes * bytes * 8 / level.vectorBits; };
  std::uint32_t lanes = std::min(one, columns);
  while (2 * lanes <= columns && registers(2 * lanes) <= level.vectorRegisters / 2) lanes *= 2;
  return lanes;
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
  if (analysis::streamUses(module, kernel).loops)
    return one * vectorsOfLoops(module, kernel, scalars, level.vectorRegisters);
  const bool foldsInAnyOrder =
      kind == sk::native::EntryKind::Fold && kernel.reduction && kernel.reduction->commutative;
  if (foldsInAnyOrder && foldsBesideOutputs(kernel))
    return lanesBesideOutputs(module, kernel, one, bits / 8, level);
  return foldsInAnyOrder ? one * vectorsOfFold(module, kernel, scalars, bits / 8 * one, level.vectorRegisters)
                         : one;
}

}  // namespace skc::native
