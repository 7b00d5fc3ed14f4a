// SPDX-License-Identifier: MIT
#include "transforms/tabulate.hpp"

#include <map>
#include <utility>

#include "ir/build.hpp"
#include "ir/reach.hpp"
#include "transforms/copy_functions.hpp"

namespace skc {
namespace {

using namespace ir;

/// A function that each table stands for, of some kernel.
std::map<TableId, FunctionId> functionsWithTables(const Module& module) {
  std::map<TableId, FunctionId> found;
  for (const Kernel& kernel : module.kernels) {
    for (const FunctionId id : functionsOf(module, kernel)) {
      if (const std::optional<TableId> table = module.functions[id].table) found.emplace(*table, id);
    }
  }
  return found;
}

/// value = f(x), with functions of its own, none of which is looked up.
KernelId makeKernel(Module& module, TableId table, FunctionId function) {
  FunctionCopies copies;
  const FunctionId computed = copyFunction(module, function, copies);
  dropTables(module, copies);
  Kernel made;
  Function entry;
  made.name = module.tables[table].name;   // what messages call it
  made.scope = module.tables[table].scope;
  made.isMade = true;
  made.loc = entry.loc = module.functions[function].loc;
  entry.name = made.name + "_values";
  const auto addParam = [&](std::string name, ParamRole role, VarRole varRole) {
    KernelParam param;
    param.name = name;
    param.role = role;
    param.type = Type::of(Scalar::Float);
    param.loc = made.loc;
    made.params.push_back(std::move(param));
    return addVariable(entry, std::move(name), Type::of(Scalar::Float), varRole, made.loc);
  };
  const VarId x = addParam("x", ParamRole::Input, VarRole::Element);
  const VarId value = addParam("value", ParamRole::Output, VarRole::InOut);
  entry.body.push_back(assign(varRef(entry, value), call(module, computed, exprs(varRef(entry, x)))));
  made.entry = static_cast<FunctionId>(module.functions.size());
  module.functions.push_back(std::move(entry));
  module.kernels.push_back(std::move(made));
  return static_cast<KernelId>(module.kernels.size() - 1);
}

}  // namespace

void tabulate(Module& module, Diagnostics&) {
  for (const auto& [table, function] : functionsWithTables(module)) {
    const KernelId kernel = makeKernel(module, table, function);
    module.tables[table].kernel = kernel;
  }
}

}  // namespace skc
