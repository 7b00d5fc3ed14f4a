// SPDX-License-Identifier: MIT
#include "native/records.hpp"

#include <algorithm>
#include <map>

#include "ir/op_weight.hpp"
#include "ir/walk.hpp"

namespace skc::native {

using namespace ir;

namespace {

/// Counts how often a group of lanes may append records for one parameter, up to `many`.
class RecordCounter {
 public:
  static constexpr std::uint32_t many = 2;

  RecordCounter(const Module& module, std::uint32_t param) : module_(module), param_(param) {}

  std::uint32_t function(FunctionId id) {
    const auto known = functions_.find(id);
    if (known != functions_.end()) return known->second;
    return functions_[id] = block(module_.functions[id].body);
  }

 private:
  /// Adds up all branches of a statement, because lanes may take different ones.
  std::uint32_t block(const Block& statements) {
    std::uint32_t sum = 0;
    for (const Stmt& stmt : statements) {
      std::uint32_t count = own(stmt);
      forEachBlock(stmt, [&](const Block& inner) { count += block(inner); });
      const bool repeats = count > 0 && std::holds_alternative<Loop>(stmt.node);
      sum = std::min(many, sum + (repeats ? many : count));
    }
    return sum;
  }
  std::uint32_t own(const Stmt& stmt) {
    if (const auto* n = std::get_if<Push>(&stmt.node)) return n->stream.id == param_ ? 1 : 0;
    if (const auto* n = std::get_if<Scatter>(&stmt.node)) return n->stream.id == param_ ? 1 : 0;
    if (const auto* n = std::get_if<CallStmt>(&stmt.node)) return function(n->callee);
    return 0;
  }

  const Module& module_;
  std::uint32_t param_;
  std::map<FunctionId, std::uint32_t> functions_;
};

}  // namespace

bool isReordered(const Module& module, const Kernel& kernel) {
  for (std::uint32_t i = 0; i < kernel.params.size(); ++i) {
    const ParamRole role = kernel.params[i].role;
    if (role != ParamRole::VariableOutput && role != ParamRole::Scatter) continue;
    if (RecordCounter(module, i).function(kernel.entry) >= RecordCounter::many) return true;
  }
  return false;
}

bool isLight(const Module& module, const Kernel& kernel) {
  // large, because elements are computed several at a time, and records are moved one by one
  constexpr std::uint32_t limit = 192;
  constexpr OpWeights weights = {
      .operation = 1, .intrinsic = 8, .gather = 4, .sample = 16, .countsCalls = false};
  return weigh(module, module.functions[kernel.entry].body, weights, limit) < limit;
}

}  // namespace skc::native
