// SPDX-License-Identifier: MIT
#include "transforms/made_kernel.hpp"

#include <utility>
#include <vector>

#include "ir/build.hpp"

namespace skc {

using namespace ir;

KernelParam makeParam(std::string name, ParamRole role, Type type, Loc loc) {
  KernelParam made;
  made.name = std::move(name);
  made.role = role;
  made.type = type;
  made.loc = loc;
  return made;
}

Kernel madeFor(const Kernel& of) {
  Kernel made;
  made.name = of.name;
  made.scope = of.scope;
  made.loc = of.loc;
  made.isMade = true;
  return made;
}

MadeKernel::MadeKernel(const Kernel& of, std::string_view suffix) : kernel(madeFor(of)) {
  entry.name = of.name;
  entry.name += suffix;
  entry.loc = of.loc;
}

MadeKernel::MadeKernel(const std::string& name) {
  kernel.name = entry.name = name;
  kernel.isMade = true;
}

VarId MadeKernel::add(KernelParam param) {
  const VarRole role = param.role == ParamRole::Input ? VarRole::Element : VarRole::InOut;
  const VarId var = addVariable(entry, param.name, param.type, role, param.loc);
  kernel.params.push_back(std::move(param));
  return var;
}

KernelId MadeKernel::finish(Module& module) {
  kernel.entry = static_cast<FunctionId>(module.functions.size());
  module.functions.push_back(std::move(entry));
  module.kernels.push_back(std::move(kernel));
  return static_cast<KernelId>(module.kernels.size() - 1);
}

KernelId MadeKernel::finishCombination(Module& module) {
  const auto id = static_cast<KernelId>(module.kernels.size());
  kernel.reduction = Reduction{id, std::vector<std::uint32_t>(kernel.params.size()), true, {}};
  return finish(module);
}

}  // namespace skc
