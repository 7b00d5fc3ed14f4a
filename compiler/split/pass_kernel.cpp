// SPDX-License-Identifier: MIT
#include "split/pass_kernel.hpp"

#include <algorithm>
#include <limits>
#include <map>
#include <utility>

#include "ir/build.hpp"
#include "ir/call_graph.hpp"
#include "ir/walk.hpp"
#include "split/cost.hpp"
#include "split/slice.hpp"

namespace skc::split {
namespace {

using namespace ir;

constexpr std::uint32_t none = std::numeric_limits<std::uint32_t>::max();

class PassKernelBuilder {
 public:
  PassKernelBuilder(Module& module, KernelId whole, const PlannedSplit& plan, const PlannedPass& pass)
      : module_(module),
        whole_(whole),
        plan_(plan),
        pass_(pass),
        slicer_(module, module.functions[module.kernels[whole].entry]),
        newParams_(module.kernels[whole].params.size(), none),
        newVars_(module.functions[module.kernels[whole].entry].variables.size(), none) {}

  Pass run() {
    const Kernel& whole = module_.kernels[whole_];
    kernel_.name = whole.name;
    kernel_.scope = whole.scope;
    kernel_.signature = whole.signature;
    kernel_.loc = whole.loc;
    entry_.name = source().name;
    entry_.result = source().result;
    entry_.loc = source().loc;
    addReads();
    addWrites();
    entry_.parameterCount = static_cast<std::uint32_t>(entry_.variables.size());
    addLocals();
    for (KernelParam& param : kernel_.params) {
      if (param.neededIf) renumber(*param.neededIf);
    }
    entry_.body = body();
    bind(entry_.body);
    kernel_.entry = static_cast<FunctionId>(module_.functions.size());
    module_.functions.push_back(std::move(entry_));
    module_.kernels.push_back(std::move(kernel_));
    return {static_cast<KernelId>(module_.kernels.size() - 1), std::move(operands_), pass_.cost};
  }

 private:
  const Function& source() const { return module_.functions[module_.kernels[whole_].entry]; }

  // ---- parameters -------------------------------------------------------------------------------

  void addReads() {
    const Kernel& whole = module_.kernels[whole_];
    const VarSet params = Demand(module_, whole).params(pass_.slice);
    for (std::uint32_t i = 0; i < whole.params.size(); ++i) {
      if (!params[i]) continue;
      newParams_[i] = static_cast<std::uint32_t>(kernel_.params.size());
      addParam(clone(whole.params[i]), i, source().variables[i].role);
      operands_.push_back({false, i});
    }
    for (VarId var = 0; var < pass_.slice.loaded.size(); ++var) {
      if (!pass_.slice.loaded[var]) continue;
      addParam(temporaryParam(var, ParamRole::Input), var, VarRole::Element);
      operands_.push_back({true, temporaryOf(var)});
    }
  }

  void addWrites() {
    for (const Target& target : pass_.targets) {
      if (target.isOutput) {
        KernelParam param = clone(module_.kernels[whole_].params[target.var]);
        const bool isWhole = target.planeCount == planesOf(module_, heldType(param)).size();
        param.firstPlane = target.firstPlane;
        param.planeCount = isWhole ? 0 : target.planeCount;
        addParam(std::move(param), target.var, VarRole::InOut);
        operands_.push_back({false, target.var});
      } else {
        addParam(temporaryParam(target.var, ParamRole::Output), target.var, VarRole::InOut);
        operands_.push_back({true, temporaryOf(target.var)});
      }
    }
  }

  void addParam(KernelParam param, VarId from, VarRole role) {
    Variable variable = source().variables[from];
    variable.role = role;
    variable.isConst = variable.isConst && role != VarRole::InOut;
    newVars_[from] = static_cast<VarId>(entry_.variables.size());
    entry_.variables.push_back(std::move(variable));
    kernel_.params.push_back(std::move(param));
  }

  KernelParam temporaryParam(VarId var, ParamRole role) const {
    KernelParam param;
    param.name = source().variables[var].name;
    param.role = role;
    param.type = source().variables[var].type;
    param.loc = source().variables[var].loc;
    return param;
  }

  std::uint32_t temporaryOf(VarId var) const {
    return static_cast<std::uint32_t>(std::ranges::find(plan_.saved, var) - plan_.saved.begin());
  }

  // ---- body -------------------------------------------------------------------------------------

  /// Declares locals for outputs that the pass computes but does not write.
  void addLocals() {
    for (VarId var = 0; var < newVars_.size(); ++var) {
      if (newVars_[var] != none || !pass_.slice.used[var]) continue;
      const bool isOutput = var < source().parameterCount;
      newVars_[var] = static_cast<VarId>(entry_.variables.size());
      Variable variable = source().variables[var];
      variable.role = VarRole::Local;
      entry_.variables.push_back(std::move(variable));
      if (isOutput) declarations_.push_back(declare(var));
    }
  }

  /// The sliced body, still in terms of the whole kernel's variables.
  Block body() {
    Block result = std::move(declarations_);
    for (Stmt& stmt : slicer_.copy(pass_.slice)) {
      auto* n = std::get_if<Declare>(&stmt.node);
      if (n == nullptr || newVars_[n->var] >= entry_.parameterCount) {
        result.push_back(std::move(stmt));
      } else if (n->init) {   // temporaries written by this pass are outputs, declared already
        result.push_back(assign(varRef(source(), n->var, stmt.loc), std::move(n->init), stmt.loc));
      }
    }
    for (Stmt& stmt : result) renumber(stmt);
    return result;
  }

  void renumber(Expr& whole) const {
    walkExprs(whole, [&](Expr& expr) {
      if (auto* n = std::get_if<VarRef>(&expr.node)) n->var = newVars_[n->var];
    });
  }

  void renumber(Stmt& stmt) {
    const auto one = [&](Stmt& inner) {
      if (auto* n = std::get_if<Declare>(&inner.node)) n->var = newVars_[n->var];
      forEachOperand(inner, [&](ExprPtr& operand) { renumber(*operand); });
    };
    one(stmt);
    forEachBlock(stmt, [&](Block& block) { walkStmts(block, one); });
  }

  // ---- functions and streams --------------------------------------------------------------------

  /// Redirects the streams of a block to the pass's parameters, and its calls to copies of the functions.
  void bind(Block& block) {
    walkExprs(block, [&](Expr& expr) {
      StreamRef* stream = streamOf(expr);
      if (stream != nullptr && stream->space == StreamRef::Space::KernelParameter)
        stream->id = newParams_[stream->id];
      if (auto* n = std::get_if<Call>(&expr.node)) n->callee = copyOf(n->callee);
    });
    walkStmts(block, [&](Stmt& stmt) {
      if (auto* n = std::get_if<CallStmt>(&stmt.node)) n->callee = copyOf(n->callee);
    });
  }

  FunctionId copyOf(FunctionId id) {
    const auto known = copies_.find(id);
    if (known != copies_.end()) return known->second;
    Function function = clone(module_.functions[id]);
    bind(function.body);
    const auto copy = static_cast<FunctionId>(module_.functions.size());
    module_.functions.push_back(std::move(function));
    copies_.emplace(id, copy);
    return copy;
  }

  Module& module_;
  const KernelId whole_;
  const PlannedSplit& plan_;
  const PlannedPass& pass_;
  Slicer slicer_;
  Kernel kernel_;
  Function entry_;
  std::vector<PassOperand> operands_;
  std::vector<std::uint32_t> newParams_;   ///< new index of each parameter of the whole kernel
  std::vector<VarId> newVars_;             ///< new id of each variable of its entry
  Block declarations_;
  std::map<FunctionId, FunctionId> copies_;
};

}  // namespace

Pass makePassKernel(Module& module, KernelId whole, const PlannedSplit& plan, const PlannedPass& pass) {
  return PassKernelBuilder(module, whole, plan, pass).run();
}

}  // namespace skc::split
