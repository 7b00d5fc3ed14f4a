// SPDX-License-Identifier: MIT
#include "transforms/passes.hpp"

#include <algorithm>
#include <map>
#include <optional>

#include "ir/call_graph.hpp"
#include "ir/counted_loop.hpp"
#include "ir/print.hpp"
#include "ir/walk.hpp"
#include "support/overloaded.hpp"

namespace skc {
namespace {

using namespace ir;

/// How many statements run; nullopt if unknown.
using Bound = std::optional<std::int64_t>;

/// Larger bounds are useless, and count as unknown.
constexpr std::int64_t largestBound = 1 << 20;

Bound limited(std::int64_t count) { return count <= largestBound ? Bound(count) : std::nullopt; }
Bound sum(Bound a, Bound b) { return a && b ? limited(*a + *b) : std::nullopt; }
Bound larger(Bound a, Bound b) { return a && b ? Bound(std::max(*a, *b)) : std::nullopt; }
Bound product(Bound a, Bound b) {
  if (a == 0 || b == 0) return 0;
  return a && b ? limited(*a * *b) : std::nullopt;
}

/// Counts executions of the statements that write one parameter of a kernel.
class PushCounter {
 public:
  PushCounter(const Module& module, std::uint32_t param) : module_(module), param_(param) {}

  Bound function(FunctionId id) {
    const auto known = functions_.find(id);
    if (known != functions_.end()) return known->second;
    return functions_[id] = block(module_.functions[id].body);
  }

 private:
  Bound block(const Block& statements) {
    Bound total = 0;
    for (const Stmt& stmt : statements)
      total = sum(total, match(stmt.node, [&](const auto& n) { return count(n); }));
    return total;
  }

  Bound count(const Push& n) const { return n.stream.id == param_ ? 1 : 0; }
  Bound count(const Scatter& n) const { return n.stream.id == param_ ? 1 : 0; }
  Bound count(const Print&) const { return 0; }
  Bound count(const CallStmt& n) { return function(n.callee); }
  Bound count(const If& n) { return larger(block(n.then), block(n.otherwise)); }
  Bound count(const Loop& n) {
    return sum(block(n.init), product(tripCount(module_, n), sum(block(n.body), block(n.step))));
  }
  /// All cases may run, by falling through.
  Bound count(const Switch& n) {
    Bound total = 0;
    for (const Case& one : n.cases) total = sum(total, block(one.body));
    return total;
  }
  Bound count(const Scope& n) { return block(n.body); }
  static Bound count(const Declare&) { return 0; }
  static Bound count(const Assign&) { return 0; }
  static Bound count(const Break&) { return 0; }
  static Bound count(const Continue&) { return 0; }
  static Bound count(const Return&) { return 0; }

  const Module& module_;
  std::uint32_t param_;
  std::map<FunctionId, Bound> functions_;
};

/// Sets each scatter output's operation from its first statement, and reports statements that differ.
void unifyOperations(const Module& module, Kernel& kernel, Diagnostics& diagnostics) {
  std::vector<bool> isKnown(kernel.params.size(), false);
  for (const FunctionId id : functionsOf(module, kernel)) {
    walkStmts(module.functions[id].body, [&](const Stmt& stmt) {
      const auto* n = std::get_if<Scatter>(&stmt.node);
      if (n == nullptr) return;
      KernelParam& param = kernel.params[n->stream.id];
      if (isKnown[n->stream.id] && param.scatter != n->op) {
        diagnostics.report(Diag::ScatterMixed, stmt.loc,
                           {param.name, spelling(param.scatter), spelling(n->op)});
      }
      param.scatter = n->op;
      isKnown[n->stream.id] = true;
    });
  }
}

}  // namespace

void boundPushes(Module& module, Diagnostics& diagnostics) {
  for (Kernel& kernel : module.kernels) {
    unifyOperations(module, kernel, diagnostics);
    for (std::uint32_t i = 0; i < kernel.params.size(); ++i) {
      KernelParam& param = kernel.params[i];
      if (param.role != ParamRole::VariableOutput && param.role != ParamRole::Scatter) continue;
      param.pushes = static_cast<std::int32_t>(PushCounter(module, i).function(kernel.entry).value_or(-1));
    }
  }
}

}  // namespace skc
