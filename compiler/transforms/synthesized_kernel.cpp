// SPDX-License-Identifier: MIT
#include "transforms/synthesized_kernel.hpp"

#include <utility>
#include <vector>

#include "ir/build.hpp"

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

}  // namespace skc
