// SPDX-License-Identifier: MIT
#include "split/plan_passes.hpp"

#include <algorithm>
#include <cassert>
#include <cstdint>
#include <limits>
#include <map>
#include <optional>
#include <ranges>
#include <utility>
#include <vector>

#include "ir/build.hpp"
#include "ir/call_graph.hpp"
#include "ir/ir.hpp"
#include "ir/walk.hpp"
#include "split/cost.hpp"
#include "split/slice.hpp"

namespace skc::split {

using namespace ir;

namespace {

// If a pass reads more planes than there are texture units, planes of one texel format are copied to the
// layers of one array texture, which takes one unit. This works for any control flow around the reads; no
// division of the kernel into passes does.

struct PassReads {
  VarSet params;                ///< parameters of the kernel that the pass reads
  std::uint32_t temporaries;    ///< planes of temporaries that it reads as well
};

/// A vector of three takes a texel of four. (No plane is a vector of doubles.)
Type texelType(Type plane) { return plane.width == 3 ? Type::of(plane.scalar, 4) : plane; }

struct ReadPlane {
  ArgumentPlane plane;
  Type type;
};

class Chooser {
 public:
  Chooser(const Module& module, const Kernel& kernel) : module_(module), kernel_(kernel) {}

  std::vector<Stack> run(const std::vector<PassReads>& passes, std::uint32_t units) {
    for (const PassReads& pass : passes) {
      while (unitsOf(pass) > units) stackOne(pass);
    }
    return std::move(stacks_);
  }

 private:
  std::vector<ReadPlane> planesRead(const PassReads& pass) const {
    std::vector<ReadPlane> planes;
    for (std::uint32_t i = 0; i < kernel_.params.size(); ++i) {
      if (!pass.params[i] || !isRead(kernel_.params[i])) continue;
      const std::vector<Type> types = planesOf(module_, heldType(kernel_.params[i]));
      for (std::uint32_t plane = 0; plane < types.size(); ++plane) {
        planes.push_back({{i, plane}, texelType(types[plane])});
      }
    }
    return planes;
  }

  Stack* stackOf(const ArgumentPlane& plane) {
    const auto holds = [&](const Stack& stack) {
      return std::ranges::find(stack.layers, plane) != stack.layers.end();
    };
    const auto found = std::ranges::find_if(stacks_, holds);
    return found == stacks_.end() ? nullptr : &*found;
  }

  std::uint32_t unitsOf(const PassReads& pass) {
    std::uint32_t units = pass.temporaries;
    std::vector<const Stack*> counted;
    for (const ReadPlane& plane : planesRead(pass)) {
      const Stack* stack = stackOf(plane.plane);
      if (stack != nullptr && std::ranges::find(counted, stack) != counted.end()) continue;
      if (stack != nullptr) counted.push_back(stack);
      ++units;
    }
    return units;
  }

  /// Adds one more plane of the pass to a stack: to an existing one, since that frees a unit, or else to a
  /// new one in the format that most planes have.
  void stackOne(const PassReads& pass) {
    std::vector<ReadPlane> free = planesRead(pass);
    std::erase_if(free, [&](const ReadPlane& plane) { return stackOf(plane.plane) != nullptr; });
    assert(!free.empty() && "there are fewer formats than texture units");
    for (const ReadPlane& plane : free) {
      const auto stack = std::ranges::find(stacks_, plane.type, &Stack::type);
      if (stack == stacks_.end()) continue;
      stack->layers.push_back(plane.plane);
      return;
    }
    const auto countOf = [&](const ReadPlane& one) {
      return std::ranges::count(free, one.type, &ReadPlane::type);
    };
    const ReadPlane most = *std::ranges::max_element(free, {}, countOf);
    stacks_.push_back({most.type, {most.plane}});
  }

  const Module& module_;
  const Kernel& kernel_;
  std::vector<Stack> stacks_;
};

/// Chooses stacks that bring every pass within `units`, with as few planes in them as possible. Every pass
/// reads a stacked plane from its stack.
std::vector<Stack> chooseStacks(const Module& module, const Kernel& kernel,
                                const std::vector<PassReads>& passes, std::uint32_t units) {
  return Chooser(module, kernel).run(passes, units);
}

/// Number of values considered for saving: the most expensive ones.
constexpr std::size_t mostCandidates = 24;
/// Number of targets considered for a place in a pass: those that are final next.
constexpr std::size_t mostMembers = 32;
/// Number of statements in the bodies of all passes that are considered. After that, no more values are saved, and a pass is
/// only offered as many targets as it has draw buffers, so that the time for a large kernel does not grow with the cube of its size.
constexpr std::size_t mostStatements = 200'000;

class Planner {
 public:
  Planner(const Module& module, const Kernel& kernel, const Limits& limits)
      : module_(module),
        kernel_(kernel),
        entry_(module.functions[kernel.entry]),
        limits_(limits),
        slicer_(module, entry_),
        costs_(module, kernel),
        demand_(module, kernel) {
    walkStmts(entry_.body, [&](const Stmt&) { ++bodySize_; });
    addOutputs();
    addCandidates();
  }

  PlannedSplit run() {
    Targets saved;
    Passes best = passesFor(saved);
    const double costWithoutTemporaries = costOf(best);
    while (const auto next = bestAddition(saved, costOf(best))) {
      Targets more = saved;
      more.push_back(*next);
      Passes passes = passesFor(more);
      if (costOf(passes) >= costOf(best)) break;  // fewer targets were offered than when it was chosen
      saved = std::move(more);
      best = std::move(passes);
    }
    return finish(std::move(saved), std::move(best), costWithoutTemporaries);
  }

 private:
  using TargetId = std::size_t;  ///< index into targets_
  using Targets = std::vector<TargetId>;
  /// A pass whose slice is not kept, since most of those considered are not taken.
  struct Considered {
    Targets group;
    VarSet offered;
    VarSet loaded;  ///< Slice::loaded
    double cost = 0;
  };
  using Passes = std::vector<const Considered*>;  ///< point into known_

  // ---- targets ------------------------------------------------------------------------------------

  /// Each output is a target; an output with more planes than a pass can write is several.
  void addOutputs() {
    for (VarId var = 0; var < kernel_.params.size(); ++var) {
      if (kernel_.params[var].role != ParamRole::Output) continue;
      const auto planes = static_cast<std::uint32_t>(planesOf(module_, heldType(kernel_.params[var])).size());
      for (std::uint32_t first = 0; first < planes; first += limits_.drawBuffers) {
        outputs_.push_back(targets_.size());
        targets_.push_back({var, true, first, std::min(planes - first, limits_.drawBuffers)});
      }
    }
  }

  /// Adds the scalars and vectors that the body itself declares and that cost more to compute than to load.
  void addCandidates() {
    std::vector<std::pair<double, VarId>> found;
    for (const Stmt& stmt : entry_.body) {
      const auto* declare = std::get_if<Declare>(&stmt.node);
      if (declare == nullptr || !entry_.variables[declare->var].type.isArithmetic()) continue;
      const double cost = computeCost(declare->var);
      if (cost > elementCost(module_, entry_.variables[declare->var].type)) {
        found.emplace_back(cost, declare->var);
      }
    }
    std::ranges::stable_sort(found, std::greater(), [](const auto& one) { return one.first; });
    found.resize(std::min(found.size(), mostCandidates));
    for (const auto& [cost, var] : found) {
      candidates_.push_back(targets_.size());
      targets_.push_back({var, false, 0, 1});
    }
  }

  double computeCost(VarId var) const {
    VarSet wanted(entry_.variables.size(), false);
    wanted[var] = true;
    const Slice slice = slicer_.slice(wanted, VarSet(wanted.size(), false));
    return costs_.run(entry_.body, slice) + inputCost(slice);
  }

  // ---- saving or recomputing ----------------------------------------------------------------------

  /// The value that makes the plan cheapest if saved; nullopt if no plan costs less than `limit`.
  std::optional<TargetId> bestAddition(const Targets& saved, double limit) {
    std::optional<TargetId> best;
    for (TargetId candidate : candidates_) {
      if (statements_ > mostStatements) break;
      if (std::ranges::find(saved, candidate) != saved.end()) continue;
      Targets more = saved;
      more.push_back(candidate);
      const double cost = costOf(passesFor(more));
      if (cost >= limit) continue;
      limit = cost;
      best = candidate;
    }
    return best;
  }

  static double costOf(const Passes& passes) {
    double cost = 0;
    for (const Considered* pass : passes) cost += pass->cost;
    return cost;
  }

  // ---- grouping targets into passes ---------------------------------------------------------------

  /// Takes targets in the order in which they are final, so that a pass loads only what was computed before
  /// it. Each pass begins with the first target left and adds those with which it saves most.
  Passes passesFor(const Targets& saved) {
    Targets open = outputs_;
    open.insert(open.end(), saved.begin(), saved.end());
    std::ranges::stable_sort(open, {}, [&](TargetId id) { return slicer_.lastWrite(targets_[id].var); });
    VarSet offered(entry_.variables.size(), false);
    for (TargetId id : saved) offered[targets_[id].var] = true;
    VarSet computed(entry_.variables.size(), false);
    Passes passes;
    while (!open.empty()) {
      Targets group = {open.front()};
      open.erase(open.begin());
      while (const auto next = bestMember(group, open, offered, computed)) {
        group.push_back(*next);
        std::erase(open, *next);
      }
      passes.push_back(&passOf(group, offered));
      for (TargetId id : group) computed[targets_[id].var] = true;
    }
    return passes;
  }

  std::optional<TargetId> bestMember(const Targets& group, const Targets& open, const VarSet& offered,
                                     const VarSet& computed) {
    std::optional<TargetId> best;
    double gain = 0;
    const std::size_t offeredTargets = statements_ > mostStatements ? limits_.drawBuffers : mostMembers;
    for (TargetId candidate : open | std::views::take(offeredTargets)) {
      Targets more = group;
      more.push_back(candidate);
      if (planesOfAll(more) > limits_.drawBuffers) continue;
      const Considered& joined = passOf(more, offered);
      if (!isSubset(joined.loaded, computed)) continue;
      const double apart = passOf(group, offered).cost + passOf({candidate}, offered).cost;
      if (apart - joined.cost <= gain) continue;
      gain = apart - joined.cost;
      best = candidate;
    }
    return best;
  }

  std::uint32_t planesOfAll(const Targets& group) const {
    std::uint32_t planes = 0;
    for (TargetId id : group) planes += targets_[id].planeCount;
    return planes;
  }

  static bool isSubset(const VarSet& inner, const VarSet& outer) {
    for (std::size_t i = 0; i < inner.size(); ++i) {
      if (inner[i] && !outer[i]) return false;
    }
    return true;
  }

  /// The pass that writes these targets, from a cache.
  const Considered& passOf(Targets group, VarSet offered) {
    std::ranges::sort(group);
    for (TargetId id : group) offered[targets_[id].var] = false;  // the pass computes it
    const auto [entry, isNew] = known_.try_emplace({group, offered});
    if (isNew) {
      PlannedPass pass = makePass(group, offered);
      entry->second = {std::move(group), std::move(offered), std::move(pass.slice.loaded), pass.cost};
      statements_ += bodySize_;
    }
    return entry->second;
  }

  PlannedPass makePass(const Targets& group, const VarSet& offered) const {
    VarSet wanted(entry_.variables.size(), false);
    PlannedPass pass;
    for (TargetId id : group) {
      wanted[targets_[id].var] = true;
      pass.targets.push_back(targets_[id]);
    }
    pass.slice = slicer_.slice(wanted, offered);
    pass.cost = passCost + costs_.run(entry_.body, pass.slice) + inputCost(pass.slice) +
                targetCost(pass.targets) + unitCost(pass.slice);
    return pass;
  }

  // ---- costs ------------------------------------------------------------------------------------

  /// Cost of reading the elements of inputs and the temporaries, each once.
  double inputCost(const Slice& slice) const {
    double cost = 0;
    const VarSet params = demand_.params(slice);
    for (std::size_t i = 0; i < params.size(); ++i) {
      if (params[i] && kernel_.params[i].role == ParamRole::Input) {
        cost += elementCost(module_, kernel_.params[i].type);
      }
    }
    for (VarId var = 0; var < slice.loaded.size(); ++var) {
      if (slice.loaded[var]) cost += elementCost(module_, entry_.variables[var].type);
    }
    return cost;
  }

  double targetCost(const std::vector<Target>& targets) const {
    double cost = 0;
    for (const Target& target : targets) {
      const std::vector<Type> planes =
          planesOf(module_, target.isOutput ? heldType(kernel_.params[target.var])
                                            : entry_.variables[target.var].type);
      for (std::uint32_t i = 0; i < target.planeCount; ++i) {
        cost += planeCost(planes[target.firstPlane + i]);
      }
    }
    return cost;
  }

  /// Cost of copying planes to stacks if a pass reads more planes than it has texture units; infinite if the
  /// temporaries that the pass loads take more than half of the units.
  double unitCost(const Slice& slice) const {
    const auto temporaries = static_cast<std::uint32_t>(std::ranges::count(slice.loaded, true));
    const VarSet params = demand_.params(slice);
    std::uint32_t planes = temporaries;
    for (std::size_t i = 0; i < params.size(); ++i) {
      if (!params[i] || !isRead(kernel_.params[i])) continue;
      planes += static_cast<std::uint32_t>(planesOf(module_, heldType(kernel_.params[i])).size());
    }
    if (planes <= limits_.textureUnits) return 0;
    if (temporaries > limits_.textureUnits / 2) return std::numeric_limits<double>::infinity();
    constexpr double copyCost = 2 * 4 * componentCost;
    return copyCost * (planes - limits_.textureUnits + 1);
  }

  // ---- the result -------------------------------------------------------------------------------

  PlannedSplit finish(Targets saved, Passes passes, double costWithoutTemporaries) {
    std::ranges::sort(saved, {}, [&](TargetId id) { return slicer_.lastWrite(targets_[id].var); });
    PlannedSplit plan;
    for (TargetId id : saved) {
      plan.saved.push_back(targets_[id].var);
      plan.computeCosts.push_back(computeCost(targets_[id].var));
    }
    for (const Considered* pass : passes) plan.passes.push_back(makePass(pass->group, pass->offered));
    std::vector<PassReads> reads;
    for (const PlannedPass& pass : plan.passes) {
      reads.push_back({demand_.params(pass.slice),
                       static_cast<std::uint32_t>(std::ranges::count(pass.slice.loaded, true))});
    }
    plan.stacks = chooseStacks(module_, kernel_, reads, limits_.textureUnits);
    plan.cost = costOf(passes);
    plan.costWithoutTemporaries = costWithoutTemporaries;
    return plan;
  }

  const Module& module_;
  const Kernel& kernel_;
  const Function& entry_;
  const Limits limits_;
  Slicer slicer_;
  CostModel costs_;
  Demand demand_;
  std::vector<Target> targets_;
  Targets outputs_, candidates_;
  std::map<std::pair<Targets, VarSet>, Considered> known_;
  std::size_t bodySize_ = 0;  ///< statements of the kernel's body
  std::size_t statements_ = 0;  ///< statements that considered passes went through
};

}  // namespace

PlannedSplit planPasses(const Module& module, const Kernel& kernel, const Limits& limits) {
  return Planner(module, kernel, limits).run();
}

namespace {

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
      } else if (n->init) {  // temporaries written by this pass are outputs, declared already
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
  std::vector<std::uint32_t> newParams_;  ///< new index of each parameter of the whole kernel
  std::vector<VarId> newVars_;  ///< new id of each variable of its entry
  Block declarations_;
  std::map<FunctionId, FunctionId> copies_;
};

}  // namespace

Pass makePassKernel(Module& module, KernelId whole, const PlannedSplit& plan, const PlannedPass& pass) {
  return PassKernelBuilder(module, whole, plan, pass).run();
}

}  // namespace skc::split
