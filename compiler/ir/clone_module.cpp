// SPDX-License-Identifier: MIT
#include "ir/clone_module.hpp"

#include "ir/build.hpp"

namespace skc::ir {
namespace {

Constant clone(const Constant& constant) {
  return {
      .name = constant.name, .type = constant.type, .value = ir::clone(constant.value), .loc = constant.loc};
}

Kernel clone(const Kernel& kernel) {
  Kernel copy{.name = kernel.name,
              .scope = kernel.scope,
              .signature = kernel.signature,
              .entry = kernel.entry,
              .params = {},
              .reduction = kernel.reduction,
              .isScan = kernel.isScan,
              .isSynthesized = kernel.isSynthesized,
              .isNativeOnly = kernel.isNativeOnly,
              .parts = kernel.parts,
              .isPart = kernel.isPart,
              .plans = kernel.plans,
              .pass = kernel.pass,
              .variants = kernel.variants,
              .choices = kernel.choices,
              .unrolled = kernel.unrolled,
              .loc = kernel.loc};
  for (const KernelParam& param : kernel.params) copy.params.push_back(ir::clone(param));
  return copy;
}

}  // namespace

Module clone(const Module& module) {
  Module copy{.file = module.file,
              .sources = module.sources,
              .structs = module.structs,
              .arrays = module.arrays,
              .constants = {},
              .functions = {},
              .tables = module.tables,
              .kernels = {},
              .streams = module.streams};
  for (const Constant& constant : module.constants) copy.constants.push_back(clone(constant));
  for (const Function& function : module.functions) copy.functions.push_back(ir::clone(function));
  for (const Kernel& kernel : module.kernels) copy.kernels.push_back(clone(kernel));
  return copy;
}

}  // namespace skc::ir
