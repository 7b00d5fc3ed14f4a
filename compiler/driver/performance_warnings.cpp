// SPDX-License-Identifier: MIT
#include "driver/performance_warnings.hpp"

#include <algorithm>
#include <iterator>
#include <set>
#include <utility>

#include "analysis/stream_uses.hpp"
#include "assemble/assemble.hpp"
#include "ir/call_graph.hpp"
#include "ir/counted_loop.hpp"
#include "ir/walk.hpp"
#include "program/descriptors.hpp"

namespace skc::driver {
namespace {

using namespace ir;

/// True for functions of doubles that are not a single instruction.
bool isLibraryFunction(Intrinsic intrinsic) {
  using enum Intrinsic;
  constexpr Intrinsic all[] = {Sin,  Cos,   Tan,   Asin,  Acos, Atan, Atan2, Sinh, Cosh,
                               Tanh, Asinh, Acosh, Atanh, Exp,  Exp2, Log,   Log2, Log10,
                               Pow,  Hypot, Log1p, Expm1, Cbrt, Erf,  Erfc};
  return std::ranges::find(all, intrinsic) != std::end(all);
}

class Advisor {
 public:
  Advisor(const Module& module, Diagnostics& diagnostics) : module_(module), diagnostics_(diagnostics) {}

  void kernel(const Kernel& kernel, const sk::program::Kernel& program) {
    kernel_ = &kernel;
    reads_.assign(kernel.params.size(), false);
    for (const FunctionId id : functionsOf(module_, kernel)) block(module_.functions[id].body);
    if (!kernel.reduction) outputs(program);
    appendOutputs();
    if (kernel.reduction && !kernel.reduction->commutative) report(Diag::SlowFold, kernel.loc, {kernel.name});
  }

 private:
  // ---- bodies -------------------------------------------------------------------------------------

  void block(const Block& statements) {
    for (const Stmt& stmt : statements) {
      forEachOperand(stmt, [&](const ExprPtr& operand) {
        walkExprs(std::as_const(*operand), [&](const Expr& expr) { expression(expr); });
      });
      const bool isLoop = std::holds_alternative<Loop>(stmt.node);
      if (isLoop) loops_.push_back(stmt.loc);
      forEachBlock(stmt, [&](const Block& inner) { block(inner); });
      if (isLoop) loops_.pop_back();
    }
  }

  void expression(const Expr& expr) {
    if (const auto* n = std::get_if<NeighborRead>(&expr.node)) neighbor(*n, expr.loc);
    if (const auto* n = std::get_if<GatherRead>(&expr.node)) gather(*n, expr.loc);
    if (const auto* n = std::get_if<IntrinsicCall>(&expr.node)) call(*n, expr.loc);
  }

  void neighbor(const NeighborRead& n, Loc loc) {
    if (analysis::reachOf(module_, *n.offset)) return;
    const std::string& name = kernel_->params[n.stream.id].name;
    const std::string whyNot = whyNotUnrolled();
    if (whyNot.empty()) {
      report(Diag::SlowOffset, loc, {name});
    } else {
      report(Diag::SlowOffsetInLoop, loc, {name, whyNot});
    }
  }

  /// Why unroll-loops could not unroll the innermost candidate loop; "" if there is none.
  std::string whyNotUnrolled() const {
    for (auto loop = loops_.rbegin(); loop != loops_.rend(); ++loop) {
      const auto note = std::ranges::find_if(
          kernel_->loops, [&](const LoopNote& one) { return one.loc.token == loop->token; });
      if (note != kernel_->loops.end() && !note->whyNot.empty()) return note->whyNot;
    }
    return {};
  }

  /// Reports the first of each gather, except in reduces and at indices that are the same for all elements.
  void gather(const GatherRead& n, Loc loc) {
    if (kernel_->reduction || reads_[n.stream.id] || isSame(*n.index)) return;
    reads_[n.stream.id] = true;
    report(Diag::SlowIndex, loc, {kernel_->params[n.stream.id].name});
  }

  /// True if an index consists of literals, constants and uniforms.
  bool isSame(const Expr& index) const {
    bool is = true;
    walkExprs(index, [&](const Expr& expr) {
      const auto* ref = std::get_if<VarRef>(&expr.node);
      const bool isUniform = ref != nullptr && ref->var < kernel_->params.size() &&
                             (kernel_->params[ref->var].role == ParamRole::Uniform ||
                              kernel_->params[ref->var].role == ParamRole::Spec);
      is = is && (isUniform || std::holds_alternative<Literal>(expr.node) ||
                  std::holds_alternative<ConstantRef>(expr.node) ||
                  std::holds_alternative<Construct>(expr.node) || std::holds_alternative<Binary>(expr.node));
    });
    return is;
  }

  void call(const IntrinsicCall& n, Loc loc) {
    const bool takesDouble =
        std::ranges::any_of(n.args, [](const ExprPtr& arg) { return arg->type.isDouble(); });
    if (takesDouble && isLibraryFunction(n.intrinsic))
      report(Diag::SlowDouble, loc, {row(n.intrinsic).spelling});
  }

  // ---- outputs ----------------------------------------------------------------------------------

  /// Reports why outputs that could be packed are not.
  void outputs(const sk::program::Kernel& program) {
    const auto mayPack = [](const sk::program::Parameter& parameter) {
      return parameter.role == sk::program::Role::Output && sk::assemble::mayPack(*parameter.element);
    };
    if (std::ranges::none_of(program.parameters, mayPack) || sk::assemble::mayWritePacked(program)) return;
    if (program.usesLoops) return loops();
    if (program.weight > sk::assemble::greatestPackedWeight)
      report(Diag::SlowLength, kernel_->loc,
             {kernel_->name, std::to_string(program.weight),
              std::to_string(sk::assemble::greatestPackedWeight)});
  }

  void loops() {
    for (const FunctionId id : functionsOf(module_, *kernel_)) {
      walkStmts(module_.functions[id].body, [&](const Stmt& stmt) {
        const auto* loop = std::get_if<Loop>(&stmt.node);
        if (loop != nullptr && !isCounted(module_, *loop)) report(Diag::SlowLoop, stmt.loc, {kernel_->name});
      });
    }
  }

  /// Reports outputs whose result depends on the order of the elements, which the device therefore keeps.
  void appendOutputs() {
    if (kernel_->choices.order == static_cast<std::uint8_t>(sk::Order::Any)) return;
    for (const KernelParam& param : kernel_->params) {
      if (param.role == ParamRole::VariableOutput) {
        const std::string instead =
            "where every element writes one value, an output 'out T " + param.name + "<>' is faster";
        report(Diag::SlowOrder, param.loc, {param.name, instead});
      }
      if (param.role == ParamRole::Scatter && dependsOnOrder(param))
        report(Diag::SlowOrder, param.loc,
               {param.name, "[[order(any)]] in front of the kernel gives the order up"});
    }
  }

  /// False for minima, maxima and sums of integers.
  static bool dependsOnOrder(const KernelParam& param) {
    if (param.scatter == ScatterOp::Store) return true;
    return param.scatter == ScatterOp::Add && !param.type.isInteger();
  }

  /// Reports once per location, which instances of a template and helpers of several kernels share.
  void report(Diag diag, Loc loc, std::initializer_list<std::string_view> arguments) {
    if (reported_.emplace(diag, loc.token).second) diagnostics_.report(diag, loc, arguments);
  }

  const Module& module_;
  Diagnostics& diagnostics_;
  const Kernel* kernel_ = nullptr;
  std::vector<bool> reads_;  ///< gathers whose computed index has been reported
  std::vector<Loc> loops_;  ///< the loops around the current statement, outer ones first
  std::set<std::pair<Diag, std::uint32_t>> reported_;
};

}  // namespace

bool wantsPerformanceWarnings(const std::vector<std::string>& warnings) {
  bool wants = false;
  for (const std::string& warning : warnings) {
    if (warning == "performance") wants = true;
    if (warning == "no-performance") wants = false;
  }
  return wants;
}

void warnOfPerformance(const Module& module, Diagnostics& diagnostics) {
  Advisor advisor(module, diagnostics);
  const emit::Program program(module);
  for (const emit::Unit& unit : program.units()) {
    const Kernel& kernel = module.kernels[unit.id];
    if (kernel.isSynthesized || kernel.pass) continue;
    if (kernel.unrolled.empty()) {
      advisor.kernel(kernel, unit.kernel);
    } else {  // of a variant for a value, which is the one to be fast
      advisor.kernel(module.kernels[kernel.unrolled.back().kernel], *unit.kernel.unrolled.back().kernel);
    }
  }
}

}  // namespace skc::driver
