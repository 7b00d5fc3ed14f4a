// SPDX-License-Identifier: MIT
#include "analysis/stream_uses.hpp"

#include <algorithm>
#include <cstdlib>

#include "ir/call_graph.hpp"
#include "ir/counted_loop.hpp"
#include "ir/evaluate.hpp"
#include "ir/walk.hpp"

namespace skc::analysis {
namespace {

using namespace ir;

class Collector {
 public:
  Collector(const Module& module, const Kernel& kernel) : module_(module), kernel_(kernel) {
    uses_.params.resize(kernel.params.size());
    allConstant_.assign(kernel.params.size(), true);
  }

  StreamUses run() {
    for (FunctionId id : functionsOf(module_, kernel_)) {
      const Block& body = module_.functions[id].body;
      walkExprs(body, [&](const Expr& expr) { collect(expr); });
      walkStmts(body, [&](const Stmt& stmt) {
        const auto* loop = std::get_if<Loop>(&stmt.node);
        uses_.loops = uses_.loops || (loop != nullptr && !isCounted(module_, *loop));
      });
    }
    for (std::size_t i = 0; i < allConstant_.size(); ++i) {
      if (!allConstant_[i]) uses_.params[i].reach = -1;
    }
    return std::move(uses_);
  }

 private:
  void collect(const Expr& expr) {
    if (const auto* n = std::get_if<GatherRead>(&expr.node)) uses_.params[n->stream.id].at = true;
    if (const auto* n = std::get_if<NeighborRead>(&expr.node)) collectNear(*n);
    if (const auto* n = std::get_if<Sample>(&expr.node)) uses_.params[n->stream.id].sample = true;
    if (const auto* n = std::get_if<ExtentOf>(&expr.node)) {
      const bool isDomain = n->stream.space == StreamRef::Space::Domain;
      const std::uint32_t param = isDomain ? domainParam(kernel_) : n->stream.id;
      (param < uses_.params.size() ? uses_.params[param].extent : uses_.domainExtent) = true;
    }
    if (const auto* n = std::get_if<IndexOf>(&expr.node)) {
      const bool isInput = n->stream.space == StreamRef::Space::KernelParameter &&
                           kernel_.params[n->stream.id].role == ParamRole::Input;
      (isInput ? uses_.params[n->stream.id].index : uses_.domainIndex) = true;
    }
  }

  void collectNear(const NeighborRead& n) {
    StreamUse& use = uses_.params[n.stream.id];
    use.near = true;
    const std::optional<std::int32_t> reach = reachOf(module_, *n.offset);
    if (reach) {
      use.reach = std::max(use.reach, *reach);
    } else {
      allConstant_[n.stream.id] = false;
    }
  }

  const Module& module_;
  const Kernel& kernel_;
  StreamUses uses_;
  std::vector<bool> allConstant_;
};

}  // namespace

std::optional<std::int32_t> reachOf(const Module& module, const Expr& offset) {
  if (const auto* n = std::get_if<Construct>(&offset.node)) {
    std::int32_t largest = 0;
    for (const ExprPtr& arg : n->args) {
      const std::optional<std::int32_t> one = reachOf(module, *arg);
      if (!one) return std::nullopt;
      largest = std::max(largest, *one);
    }
    return largest;
  }
  const std::optional<std::uint32_t> bits = evaluate(module, offset, Constants::LookThrough);
  if (!bits) return std::nullopt;
  const auto value = static_cast<std::int32_t>(*bits);
  return value == INT32_MIN ? std::nullopt : std::optional(std::abs(value));
}

StreamUses streamUses(const Module& module, const Kernel& kernel) { return Collector(module, kernel).run(); }

std::uint32_t domainParam(const Kernel& kernel) {
  const auto found = std::find_if(kernel.params.begin(), kernel.params.end(),
                                  [](const KernelParam& param) { return param.role == ParamRole::Output; });
  return static_cast<std::uint32_t>(found - kernel.params.begin());
}

}  // namespace skc::analysis
