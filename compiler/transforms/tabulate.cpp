// SPDX-License-Identifier: MIT
#include "transforms/tabulate.hpp"

#include <map>
#include <utility>

#include "ir/build.hpp"
#include "ir/reach.hpp"
#include "transforms/copy_functions.hpp"
#include "transforms/made_kernel.hpp"

namespace skc {
namespace {

using namespace ir;

/// For each table, a function of some kernel that it may replace.
std::map<TableId, FunctionId> functionsWithTables(const Module& module) {
  std::map<TableId, FunctionId> found;
  for (const Kernel& kernel : module.kernels) {
    for (const FunctionId id : functionsOf(module, kernel)) {
      if (const std::optional<TableId> table = module.functions[id].table) found.emplace(*table, id);
    }
  }
  return found;
}

/// value = f(x), with functions of its own, none of which a table replaces.
KernelId makeKernel(Module& module, TableId table, FunctionId function) {
  FunctionCopies copies;
  const FunctionId computed = copyFunction(module, function, copies);
  dropTables(module, copies);
  MadeKernel made(module.tables[table].name);   // the name in messages
  made.kernel.scope = module.tables[table].scope;
  made.kernel.loc = made.entry.loc = module.functions[function].loc;
  made.entry.name = made.kernel.name + "_values";
  const Type type = Type::of(Scalar::Float);
  const VarId x = made.add(makeParam("x", ParamRole::Input, type, made.kernel.loc));
  const VarId value = made.add(makeParam("value", ParamRole::Output, type, made.kernel.loc));
  made.entry.body.push_back(
      assign(varRef(made.entry, value), call(module, computed, exprs(varRef(made.entry, x)))));
  return made.finish(module);
}

}  // namespace

void tabulate(Module& module, Diagnostics&) {
  for (const auto& [table, function] : functionsWithTables(module)) {
    const KernelId kernel = makeKernel(module, table, function);
    module.tables[table].kernel = kernel;
  }
}

}  // namespace skc
