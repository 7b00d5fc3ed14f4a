// SPDX-License-Identifier: MIT
#include "transforms/check_sizes.hpp"

#include <algorithm>
#include <cstdint>
#include <string>
#include <unordered_map>

#include "ir/reach.hpp"
#include "ir/walk.hpp"

namespace skc {
namespace {

using namespace ir;

/// Operations of one kernel. Native code of a kernel with as many takes some ten seconds to compile; kernels written by hand have
/// fewer than a hundredth.
constexpr std::uint64_t mostOperations = 100'000;
/// Counts stop here, far above the limit and far below an overflow.
constexpr std::uint64_t largestCount = std::uint64_t{1} << 40;

/// Counts the expressions and statements of functions, with those of the functions that they call.
class InlinedSizes {
 public:
  explicit InlinedSizes(const Module& module) : module_(module) {}

  std::uint64_t of(const Kernel& kernel) {
    for (const FunctionId id : functionsOf(module_, kernel)) {  // callees first
      if (!known_.contains(id)) known_[id] = count(module_.functions[id].body);
    }
    return known_.at(kernel.entry);
  }

 private:
  std::uint64_t count(const Block& body) const {
    std::uint64_t count = 0;
    const auto add = [&](std::uint64_t more) { count = std::min(count + more, largestCount); };
    walkStmts(body, [&](const Stmt& stmt) {
      const auto* n = std::get_if<CallStmt>(&stmt.node);
      add(n == nullptr ? 1 : 1 + known_.at(n->callee));
    });
    walkExprs(body, [&](const Expr& expr) {
      const auto* n = std::get_if<Call>(&expr.node);
      add(n == nullptr ? 1 : 1 + known_.at(n->callee));
    });
    return count;
  }

  const Module& module_;
  std::unordered_map<FunctionId, std::uint64_t> known_;
};

}  // namespace

void checkSizes(const Module& module, Diagnostics& diagnostics) {
  InlinedSizes sizes(module);
  for (const Kernel& kernel : module.kernels) {
    const std::uint64_t size = sizes.of(kernel);
    if (size <= mostOperations) continue;
    const std::string text = size == largestCount ? "more than 10^12" : std::to_string(size);
    diagnostics.report(Diag::KernelSize, kernel.loc, {kernel.name, text, std::to_string(mostOperations)});
  }
}

}  // namespace skc
