// SPDX-License-Identifier: MIT
#include "transforms/passes.hpp"

#include <map>
#include <utility>

#include "ir/build.hpp"
#include "ir/call_graph.hpp"
#include "transforms/fold_copy.hpp"

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
  SynthesizedKernel synthesized(module.tables[table].name);   // the name in messages
  synthesized.kernel.scope = module.tables[table].scope;
  synthesized.kernel.loc = synthesized.entry.loc = module.functions[function].loc;
  synthesized.entry.name = synthesized.kernel.name + "_values";
  const Type type = Type::of(Scalar::Float);
  const VarId x = synthesized.add(makeParam("x", ParamRole::Input, type, synthesized.kernel.loc));
  const VarId value = synthesized.add(makeParam("value", ParamRole::Output, type, synthesized.kernel.loc));
  synthesized.entry.body.push_back(
      assign(varRef(synthesized.entry, value), call(module, computed, exprs(varRef(synthesized.entry, x)))));
  return synthesized.finish(module);
}

}  // namespace

void tabulate(Module& module, Diagnostics&) {
  for (const auto& [table, function] : functionsWithTables(module)) {
    const KernelId kernel = makeKernel(module, table, function);
    module.tables[table].kernel = kernel;
  }
}

}  // namespace skc
