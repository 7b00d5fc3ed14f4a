// SPDX-License-Identifier: MIT
#include "transforms/synthesized_kernel.hpp"

#include <utility>
#include <vector>

#include "ir/build.hpp"
#include "ir/walk.hpp"

namespace skc {

using namespace ir;

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
