// SPDX-License-Identifier: MIT
#include "transforms/fold_copy.hpp"

#include <algorithm>
#include <limits>
#include <utility>
#include <vector>

#include "ir/build.hpp"
#include "ir/walk.hpp"
#include "transforms/fold_pattern.hpp"

namespace skc {

using namespace ir;

namespace {

constexpr std::uint32_t gone = std::numeric_limits<std::uint32_t>::max();

}  // namespace

FoldCopy::FoldCopy(Module& module, KernelId of, std::string_view suffix)
    : module_(module), before_(module.kernels[of].params.size()) {
  const Kernel& original = module.kernels[of];
  kernel_ = synthesizedFor(original);
  operands_ = original.reduction->operands;
  for (const KernelParam& param : original.params) kernel_.params.push_back(clone(param));
  kernel_.entry = copyFunction(module, original.entry, copies_);
  entry_ = std::move(module.functions[kernel_.entry]);
  entry_.name += suffix;
  module.functions[kernel_.entry].body.clear();
}

VarId FoldCopy::add(std::string name, ParamRole role, Type type, ExprPtr identity) {
  KernelParam param = makeParam(std::move(name), role, type, kernel_.loc);
  param.identity = std::move(identity);
  added_.push_back(addVariable(entry_, param.name, param.type));
  kernel_.params.push_back(std::move(param));
  return added_.back();
}

/// Whether an original parameter stays one.
bool FoldCopy::keeps(VarId param) const {
  return std::ranges::find(dropped_, kernel_.params[param].role) == dropped_.end();
}

/// Moves parameters to the front of the variables, and renumbers the streams by parameter.
void FoldCopy::renumber() {
  std::vector<VarId> order;   // old ids in new order
  for (VarId i = 0; i < before_; ++i) {
    if (keeps(i)) order.push_back(i);
  }
  order.insert(order.end(), added_.begin(), added_.end());
  const std::size_t parameters = order.size();
  Block declared;
  for (VarId i = 0; i < before_; ++i) {
    if (keeps(i) || kernel_.params[i].role != ParamRole::Output) continue;
    order.push_back(i);
    entry_.variables[i].role = VarRole::Local;
    declared.push_back(declare(i));
  }
  prepend(entry_.body, std::move(declared));
  for (VarId i = static_cast<VarId>(before_); i < entry_.variables.size(); ++i) {
    if (std::ranges::find(added_, i) == added_.end()) order.push_back(i);
  }
  std::vector<std::uint32_t> numbers(entry_.variables.size(), gone);
  std::vector<Variable> variables;
  for (const VarId old : order) {
    numbers[old] = static_cast<VarId>(variables.size());
    variables.push_back(std::move(entry_.variables[old]));
  }
  entry_.variables = std::move(variables);
  entry_.parameterCount = static_cast<std::uint32_t>(parameters);
  std::vector<KernelParam> params;
  for (std::size_t i = 0; i < kernel_.params.size(); ++i) {
    if (i >= before_ || keeps(static_cast<VarId>(i))) params.push_back(std::move(kernel_.params[i]));
  }
  kernel_.params = std::move(params);
  for (const VarId var : added_) {
    const bool isInput = kernel_.params[numbers[var]].role == ParamRole::Input;
    entry_.variables[numbers[var]].role = isInput ? VarRole::Element : VarRole::InOut;
  }

  const auto variable = [&](Expr& expr) {
    if (auto* n = std::get_if<VarRef>(&expr.node)) n->var = numbers[n->var];
  };
  const auto stream = [&](Expr& expr) {
    StreamRef* ref = streamOf(expr);
    if (ref != nullptr && ref->space == StreamRef::Space::KernelParameter) ref->id = numbers[ref->id];
  };
  walkExprs(entry_.body, variable);
  walkExprs(entry_.body, stream);
  walkStmts(entry_.body, [&](Stmt& stmt) {
    if (auto* n = std::get_if<Declare>(&stmt.node)) n->var = numbers[n->var];
  });
  for (KernelParam& param : kernel_.params) {
    if (param.neededIf) walkExprs(*param.neededIf, variable);
  }
  for (const auto& [old, copy] : copies_) walkExprs(module_.functions[copy].body, stream);
}

KernelId FoldCopy::addToModule() {
  renumber();
  module_.functions[kernel_.entry] = std::move(entry_);
  module_.kernels.push_back(std::move(kernel_));
  return static_cast<KernelId>(module_.kernels.size() - 1);
}

KernelId FoldCopy::finish(KernelId combine, std::size_t operands, bool seeded) {
  operands_.resize(operands);
  kernel_.reduction = Reduction{combine, std::move(operands_), seeded};
  return addToModule();
}

KernelId FoldCopy::finish(KernelId combine) {
  return finish(combine, module_.kernels[combine].params.size(), false);
}

KernelId FoldCopy::finishCombination() {
  for (KernelParam& param : kernel_.params) param.identity = nullptr;
  return finish(static_cast<KernelId>(module_.kernels.size()), kernel_.params.size(), true);
}

KernelId FoldCopy::finishFold(bool seeded) {
  const auto id = static_cast<KernelId>(module_.kernels.size());
  operands_.clear();
  const KernelId added = finish(id, 0, seeded);
  std::vector<std::uint32_t>& own = module_.kernels[added].reduction->operands;
  for (std::uint32_t i = 0; i < module_.kernels[added].params.size(); ++i) own.push_back(i);
  return added;
}

KernelId FoldCopy::finishNativeKernel() {
  kernel_.isNativeOnly = true;
  return addToModule();
}

void rewriteFolds(const Kernel& kernel, Block& block, RewriteFold rewrite) {
  Block rewritten;
  for (Stmt& stmt : block) {
    forEachBlock(stmt, [&](Block& inner) { rewriteFolds(kernel, inner, rewrite); });
    const std::optional<FoldTarget> target = foldedBy(kernel, stmt);
    if (!target || !rewrite(stmt, *target, rewritten)) rewritten.push_back(std::move(stmt));
  }
  block = std::move(rewritten);
}

KernelId makeSumVariant(Module& module, KernelId of, const std::vector<FloatSum>& sums,
                        std::string_view suffix, SumRepresentation& representation) {
  const auto copyOf = [&](KernelId plain, std::string_view name, bool ofParts) {
    FoldCopy copy(module, plain, name);
    std::vector<FloatSum> held = sums;
    for (std::size_t k = 0; k < held.size(); ++k) {
      held[k].accumulator = counterpartOf(module.kernels[of], held[k].accumulator, module.kernels[plain],
                                          ParamRole::Accumulator);
      representation.hold(copy, held[k], k, ofParts);
    }
    rewriteFolds(module.kernels[plain], copy.entry().body,
                 [&](const Stmt& fold, const FoldTarget& target, Block& to) {
                   const auto sum =
                       std::ranges::find_if(held, [&](const FloatSum& one) { return one.overlaps(target); });
                   if (sum == held.end()) return false;
                   const auto k = static_cast<std::size_t>(sum - held.begin());
                   representation.add(copy.entry(), fold, k, ofParts, to);
                   return true;
                 });
    return copy;
  };
  const KernelId plain = *module.kernels[of].reduction->combine;
  const KernelId combine = copyOf(plain, plain == of ? "_combine" : suffix, true).finishCombination();
  const KernelId fold = copyOf(of, suffix, false).finish(combine);
  module.kernels[fold].reduction->commutative = module.kernels[of].reduction->commutative;
  return fold;
}

KernelParam makeParam(std::string name, ParamRole role, Type type, Loc loc) {
  KernelParam param;
  param.name = std::move(name);
  param.role = role;
  param.type = type;
  param.loc = loc;
  return param;
}

std::vector<VarId> paramsOf(const Kernel& kernel, ParamRole role) {
  std::vector<VarId> params;
  for (VarId i = 0; i < kernel.params.size(); ++i) {
    if (kernel.params[i].role == role) params.push_back(i);
  }
  return params;
}

Kernel synthesizedFor(const Kernel& of) {
  Kernel kernel;
  kernel.name = of.name;
  kernel.scope = of.scope;
  kernel.loc = of.loc;
  kernel.isSynthesized = true;
  return kernel;
}

SynthesizedKernel::SynthesizedKernel(const Kernel& of, std::string_view suffix) : kernel(synthesizedFor(of)) {
  entry.name = of.name;
  entry.name += suffix;
  entry.loc = of.loc;
}

SynthesizedKernel::SynthesizedKernel(const std::string& name) {
  kernel.name = entry.name = name;
  kernel.isSynthesized = true;
}

VarId SynthesizedKernel::add(KernelParam param) {
  const VarRole role = param.role == ParamRole::Input ? VarRole::Element : VarRole::InOut;
  const VarId var = addVariable(entry, param.name, param.type, role, param.loc);
  kernel.params.push_back(std::move(param));
  return var;
}

std::vector<VarId> SynthesizedKernel::addEach(const Kernel& of, const std::vector<VarId>& params,
                                              ParamRole role, std::string_view prefix,
                                              std::string_view suffix,
                                              const std::function<Type(VarId)>& typeOf) {
  std::vector<VarId> added;
  for (const VarId i : params) {
    const KernelParam& param = of.params[i];
    added.push_back(add(makeParam(std::string(prefix) + param.name + std::string(suffix), role,
                                  typeOf ? typeOf(i) : param.type, param.loc)));
  }
  return added;
}

KernelId SynthesizedKernel::finish(Module& module) {
  kernel.entry = static_cast<FunctionId>(module.functions.size());
  module.functions.push_back(std::move(entry));
  module.kernels.push_back(std::move(kernel));
  return static_cast<KernelId>(module.kernels.size() - 1);
}

KernelId SynthesizedKernel::finishCombination(Module& module) {
  const auto id = static_cast<KernelId>(module.kernels.size());
  kernel.reduction = Reduction{id, std::vector<std::uint32_t>(kernel.params.size()), true, {}};
  return finish(module);
}

FunctionId copyFunction(Module& module, FunctionId id, FunctionCopies& copies) {
  if (const auto known = copies.find(id); known != copies.end()) return known->second;
  Function copy = clone(module.functions[id]);
  walkStmts(copy.body, [&](Stmt& stmt) {
    if (auto* n = std::get_if<CallStmt>(&stmt.node)) n->callee = copyFunction(module, n->callee, copies);
  });
  walkExprs(copy.body, [&](Expr& expr) {
    if (auto* n = std::get_if<Call>(&expr.node)) n->callee = copyFunction(module, n->callee, copies);
  });
  module.functions.push_back(std::move(copy));
  return copies[id] = static_cast<FunctionId>(module.functions.size() - 1);
}

void dropTables(Module& module, const FunctionCopies& copies) {
  for (const auto& [from, to] : copies) module.functions[to].table.reset();
}

Kernel variantOf(Module& module, KernelId of, FunctionCopies& copies) {
  const FunctionId entry = copyFunction(module, module.kernels[of].entry, copies);
  const Kernel& plain = module.kernels[of];
  Kernel variant = synthesizedFor(plain);
  variant.signature = plain.signature;
  variant.entry = entry;
  for (const KernelParam& param : plain.params) variant.params.push_back(clone(param));
  if (plain.reduction) variant.reduction = Reduction{{}, plain.reduction->operands, plain.reduction->seeded};
  return variant;
}

ConstantId copyConstant(Module& module, ConstantId id, ConstantCopies& copies, std::string_view suffix,
                        FunctionRef<void(Constant&)> convert) {
  const Constant& plain = module.constants[id];
  if (!holds(module, plain.type, Scalar::Float)) return id;
  if (const auto known = copies.find(id); known != copies.end()) return known->second;
  Constant copy{plain.name + std::string(suffix), plain.type, clone(plain.value), plain.loc};
  convert(copy);  // may copy constants in its value
  module.constants.push_back(std::move(copy));
  return copies[id] = static_cast<ConstantId>(module.constants.size() - 1);
}

}  // namespace skc
