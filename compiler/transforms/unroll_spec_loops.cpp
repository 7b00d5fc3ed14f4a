// SPDX-License-Identifier: MIT
#include "transforms/passes.hpp"

#include <algorithm>
#include <optional>
#include <utility>

#include "ir/build.hpp"
#include "ir/lvalue.hpp"
#include "ir/op_weight.hpp"
#include "ir/walk.hpp"
#include "ir/walk_module.hpp"
#include "transforms/synthesized_kernel.hpp"

namespace skc {
namespace {

using namespace ir;

/// Whether an expression or a block reads a variable.
template <class Node>
bool mentions(const Node& node, VarId var) {
  bool found = false;
  walkExprs(node, [&](const Expr& expr) {
    const auto* ref = std::get_if<VarRef>(&expr.node);
    found = found || (ref != nullptr && ref->var == var);
  });
  return found;
}

/// The first integer Spec parameter that occurs in the head of a loop, and that nothing changes.
std::optional<VarId> boundOfLoops(const Module& module, const Kernel& kernel) {
  const Function& entry = module.functions[kernel.entry];
  for (VarId p = 0; p < kernel.params.size(); ++p) {
    const KernelParam& param = kernel.params[p];
    if (param.role != ParamRole::Spec || !param.type.isScalar() || !param.type.isInteger()) continue;
    if (assigns(entry.body, p)) continue;
    bool bounds = false;
    walkStmts(entry.body, [&](const Stmt& stmt) {
      const auto* loop = std::get_if<Loop>(&stmt.node);
      bounds = bounds || (loop != nullptr && (mentions(loop->init, p) || mentions(loop->step, p) ||
                                              (loop->cond && mentions(*loop->cond, p))));
    });
    if (bounds) return p;
  }
  return std::nullopt;
}

/// Adds the variant for one value of a parameter to the module.
KernelId addVariant(Module& module, KernelId id, VarId spec, std::uint32_t value) {
  FunctionCopies copies;
  Kernel variant = variantOf(module, id, copies);
  Function& entry = module.functions[variant.entry];
  const Type type = entry.variables[spec].type;
  rewriteExprs(entry.body, [&](ExprPtr& slot) {
    const auto* ref = std::get_if<VarRef>(&slot->node);
    if (ref != nullptr && ref->var == spec) slot = makeExpr(type, Literal{value}, slot->loc);
  });
  unrollLoops(module, variant);
  variant.loops.clear();
  module.kernels.push_back(std::move(variant));
  return static_cast<KernelId>(module.kernels.size() - 1);
}

void addVariants(Module& module, KernelId id, VarId spec) {
  std::uint32_t expressions = 0;
  for (std::uint32_t value = 1; value <= mostUnrolledValue; ++value) {
    const std::size_t functions = module.functions.size();
    const KernelId variant = addVariant(module, id, spec, value);
    // a variant with a loop weighs as much as the limit
    expressions += weigh(module, module.functions[module.kernels[variant].entry].body,
                         {.node = 1, .countsCalls = false}, mostUnrolledExpressions + 1);
    if (expressions > mostUnrolledExpressions) {
      module.kernels.pop_back();
      module.functions.resize(functions);
      return;
    }
    module.kernels[id].unrolled.push_back({spec, value, variant});
  }
}

}  // namespace

void unrollSpecLoops(Module& module, Diagnostics&) {
  forEachDeclaredKernel(module, [&](KernelId id) {
    const Kernel& kernel = module.kernels[id];
    if (kernel.isSynthesized || kernel.reduction) return;
    if (const std::optional<VarId> spec = boundOfLoops(module, kernel)) addVariants(module, id, *spec);
  });
}

}  // namespace skc
