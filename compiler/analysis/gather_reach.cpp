// SPDX-License-Identifier: MIT
#include "analysis/gather_reach.hpp"

#include <map>
#include <optional>
#include <utility>

#include "analysis/index_expressions.hpp"
#include "analysis/shapes.hpp"
#include "ir/counted_loop.hpp"
#include "support/overloaded.hpp"

namespace skc::analysis {
namespace {

using namespace ir;

/// Statements that the analysis of a kernel visits before it gives up: more than any kernel of our examples needs by a
/// factor of ten.
constexpr int mostVisits = 100'000;

/// What a call leaves: its result, and its parameters.
struct Outcome {
  IndexValues result;
  std::vector<IndexValues> parameters;
};

/// A call that has been analysed.
struct KnownCall {
  std::vector<IndexValues> arguments;
  ElementBounds element;
  Outcome outcome;
  ReachRecords records;  ///< its reads
};

/// The kernel's analysis: what all its calls share.
struct Analysis {
  const Module& module;
  const Kernel& kernel;
  ReachRecords records;
  std::map<FunctionId, std::vector<KnownCall>> calls = {};
  int visits = 0;

  Outcome call(FunctionId id, const std::vector<IndexValues>& arguments, const ElementBounds& element);
};

/// One call of a function.
class FunctionWalk {
 public:
  FunctionWalk(Analysis& all, const Function& function, const ElementBounds& element)
      : all_(all), function_(function) {
    state_.element = element;
    for (const Variable& variable : function.variables)
      state_.variables.emplace_back(hasLeaves(variable) ? leafCount(all.module, variable.type) : 0);
    returned_.isReachable = false;
  }

  Outcome run(const std::vector<IndexValues>& arguments) {
    for (std::size_t p = 0; p < arguments.size(); ++p) {
      if (hasLeaves(function_.variables[p])) state_.variables[p] = arguments[p];
    }
    const IndexState start = state_;
    block(function_.body);
    leave();
    Outcome outcome{std::move(result_), {}};
    if (!returned_.isReachable) returned_ = start;  // it never returns
    for (std::uint32_t p = 0; p < function_.parameterCount; ++p)
      outcome.parameters.push_back(returned_.variables[p]);
    return outcome;
  }

 private:
  /// Streams have no value.
  static bool hasLeaves(const Variable& variable) {
    return variable.role == VarRole::Local || variable.role == VarRole::In || variable.role == VarRole::InOut;
  }

  IndexExpressions expressions() { return {all_.module, all_.kernel, state_, all_.records, callRule_}; }
  IndexValues of(const Expr& expr) { return expressions().of(expr); }

  /// Ends this path.
  void leave() {
    join(returned_, state_);
    state_.isReachable = false;
  }

  /// What visiting a statement counts: more if that copies what is known of all variables.
  int costOf(const Stmt& stmt) const {
    constexpr std::size_t variablesPerVisit = 8;
    const bool isSimple = std::holds_alternative<Declare>(stmt.node) ||
                          std::holds_alternative<Assign>(stmt.node) ||
                          std::holds_alternative<CallStmt>(stmt.node);
    return isSimple ? 1 : 1 + static_cast<int>(state_.variables.size() / variablesPerVisit);
  }

  void block(const Block& statements) {
    for (const Stmt& stmt : statements) {
      if (!state_.isReachable || (all_.visits += costOf(stmt)) > mostVisits) return;
      match(stmt.node, [&](const auto& n) { visit(n); });
    }
  }

  void visit(const Declare& n) {
    IndexValues& values = state_.variables[n.var];
    if (n.init) {
      values = of(*n.init);
    } else {
      values.assign(values.size(), IndexValue());
    }
  }
  void visit(const Assign& n) {
    IndexExpressions in = expressions();
    IndexValues value = in.of(*n.value);
    if (n.op) value = in.binary(*n.op, n.place->type, in.of(*n.place), value);
    in.assign(*n.place, std::move(value));
  }
  void visit(const CallStmt& n) {
    std::vector<IndexValues> arguments;
    for (const ExprPtr& arg : n.args) arguments.push_back(of(*arg));
    const Outcome outcome = all_.call(n.callee, arguments, state_.element);
    const Function& callee = all_.module.functions[n.callee];
    for (std::size_t p = 0; p < n.args.size(); ++p) {
      if (callee.variables[p].role == VarRole::InOut) expressions().assign(*n.args[p], outcome.parameters[p]);
    }
    if (n.result) expressions().assign(*n.result, outcome.result);
  }
  void visit(const If& n) {
    of(*n.cond);
    IndexState otherwise = state_;
    expressions().learn(*n.cond, true);
    block(n.then);
    std::swap(state_, otherwise);
    expressions().learn(*n.cond, false);
    block(n.otherwise);
    join(state_, otherwise);
  }
  void visit(const Loop& n) { loop(n); }

  void visit(const Switch& n) {
    of(*n.value);
    const IndexState entry = state_;
    IndexState end = unreachable();
    state_ = unreachable();
    bool hasDefault = false;
    breaks_.push_back(&end);
    for (const Case& one : n.cases) {
      join(state_, entry);
      hasDefault = hasDefault || one.isDefault;
      block(one.body);
    }
    breaks_.pop_back();
    join(state_, end);
    if (!hasDefault) join(state_, entry);
  }
  void visit(const Break&) { jump(*breaks_.back()); }
  void visit(const Continue&) { jump(*continues_.back()); }
  void visit(const Return& n) {
    if (n.value) {
      const IndexValues value = of(*n.value);
      if (result_.empty()) result_.resize(value.size());
      for (std::size_t i = 0; i < value.size(); ++i)
        result_[i] = joined(resultElement_, result_[i], state_.element, value[i]);
      join(returned_, state_);
      resultElement_ = returned_.element;
    }
    leave();
  }
  void visit(const Scope& n) { block(n.body); }
  void visit(const Push& n) { of(*n.value); }
  void visit(const Scatter& n) {
    of(*n.index);
    of(*n.value);
  }
  void visit(const Print& n) {
    for (const ExprPtr& value : n.values) of(*value);
  }

  static IndexState unreachable() {
    IndexState state;
    state.isReachable = false;
    return state;
  }
  void jump(IndexState& target) {
    join(target, state_);
    state_.isReachable = false;
  }

  // ---- loops ------------------------------------------------------------------------------------

  /// Repeats the body until it adds nothing to what is known at its start.
  void loop(const Loop& n) {
    block(n.init);
    const std::optional<CountedLoop> counted = countedLoop(all_.module, n);
    const auto setCounter = [&](IndexState& state) {
      if (!counted || counted->count == 0) return;
      const std::int64_t last = counted->first + (counted->count - 1) * counted->step;
      IndexValue value{true};
      value.range = rangeOf(between(std::min(counted->first, last), std::max(counted->first, last)));
      state.variables[counted->counter] = {value};
    };
    setCounter(state_);
    const IndexState entry = state_;
    const ReachRecords before = all_.records;
    IndexState end;
    // What is known at the start of the next iteration, or the first one.
    const auto after = [&](const IndexState& head) {
      all_.records = before;  // the last round reads all that earlier ones did
      state_ = head;
      end = unreachable();
      iterate(n, end);
      join(state_, entry);
      setCounter(state_);
      return state_;
    };
    IndexState head = entry;
    for (int round = 0; ++all_.visits <= mostVisits; ++round) {
      IndexState next = after(head);
      if (round > 0) widen(head, next);
      if (next == head) break;
      head = std::move(next);
    }
    // One round more regains bounds that widening has dropped but the loop's condition gives.
    if (const IndexState next = state_; next != head) after(next);
    state_ = end;
  }

  /// One iteration; what leaves the loop is joined to `end`.
  void iterate(const Loop& n, IndexState& end) {
    IndexState next = unreachable();
    if (n.kind != LoopKind::DoWhile) test(n, end);
    breaks_.push_back(&end);
    continues_.push_back(&next);
    block(n.body);
    breaks_.pop_back();
    continues_.pop_back();
    join(state_, next);
    block(n.step);
    if (n.kind == LoopKind::DoWhile && state_.isReachable) test(n, end);
  }

  void test(const Loop& n, IndexState& end) {
    if (!n.cond) return;
    of(*n.cond);
    IndexState leaving = state_;
    IndexExpressions(all_.module, all_.kernel, leaving, all_.records, callRule_).learn(*n.cond, false);
    join(end, leaving);
    expressions().learn(*n.cond, true);
  }

  Analysis& all_;
  const Function& function_;
  IndexState state_, returned_;
  IndexValues result_;
  ElementBounds resultElement_;
  std::vector<IndexState*> breaks_, continues_;
  struct Caller {
    FunctionWalk& walk;
    IndexValues operator()(FunctionId id, const std::vector<IndexValues>& arguments) const {
      return walk.all_.call(id, arguments, walk.state_.element).result;
    }
  } caller_{*this};
  CallRule callRule_{caller_};
};

Outcome Analysis::call(FunctionId id, const std::vector<IndexValues>& arguments,
                       const ElementBounds& element) {
  for (const KnownCall& known : calls[id]) {
    if (known.arguments != arguments || known.element != element) continue;
    records.merge(known.records);
    return known.outcome;
  }
  ReachRecords before = std::exchange(records, ReachRecords(kernel));
  Outcome outcome = FunctionWalk(*this, module.functions[id], element).run(arguments);
  if (outcome.result.empty())
    outcome.result.assign(leafCount(module, module.functions[id].result), IndexValue{true, OnData});
  calls[id].push_back({arguments, element, outcome, records});
  before.merge(records);
  records = std::move(before);
  return outcome;
}

/// What a kernel's parameter is at its start.
IndexValues initialValues(const Module& module, const Kernel& kernel, std::uint32_t number) {
  const KernelParam& param = kernel.params[number];
  IndexValues values(leafCount(module, param.type), IndexValue{true});
  for (IndexValue& value : values) {
    const bool isSame = param.role == ParamRole::Uniform || param.role == ParamRole::Spec;
    value.depends = isSame ? OnNothing : param.role == ParamRole::Iterator ? OnElement : OnData;
  }
  if (param.role == ParamRole::Spec && param.type.isInteger()) {
    const auto spec = std::count_if(kernel.params.begin(), kernel.params.begin() + number,
                                    [](const KernelParam& one) { return one.role == ParamRole::Spec; });
    Distance high, negatedLow;
    high.perSpec[static_cast<std::size_t>(spec)] = 1;
    negatedLow.perSpec[static_cast<std::size_t>(spec)] = -1;
    values.front().range = rangeOf({high, negatedLow});
  }
  return values;
}

}  // namespace

std::vector<GatherReach> gatherReach(const Module& module, const Kernel& kernel) {
  Analysis analysis{module, kernel, ReachRecords(kernel)};
  std::vector<IndexValues> arguments;
  for (std::uint32_t p = 0; p < kernel.params.size(); ++p)
    arguments.push_back(initialValues(module, kernel, p));
  ElementBounds element;
  element.fill(atLeast(0));
  analysis.call(kernel.entry, arguments, element);
  if (analysis.visits > mostVisits) analysis.records.giveUp();
  return analysis.records.take();
}

}  // namespace skc::analysis
