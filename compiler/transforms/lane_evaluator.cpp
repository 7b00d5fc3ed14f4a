// SPDX-License-Identifier: MIT
#include "transforms/lane_evaluator.hpp"

#include <algorithm>
#include <utility>

#include "ir/build.hpp"
#include "ir/print.hpp"
#include "support/overloaded.hpp"

namespace skc {

using namespace ir;

namespace {

std::int32_t computed(BinaryOp op, std::int32_t a, std::int32_t b) {
  const auto ua = static_cast<std::uint32_t>(a), ub = static_cast<std::uint32_t>(b);
  switch (op) {
    case BinaryOp::Add: return static_cast<std::int32_t>(ua + ub);
    case BinaryOp::Sub: return static_cast<std::int32_t>(ua - ub);
    case BinaryOp::Mul: return static_cast<std::int32_t>(ua * ub);
    case BinaryOp::BitAnd: return a & b;
    case BinaryOp::BitOr: return a | b;
    case BinaryOp::BitXor: return a ^ b;
    case BinaryOp::Less: return a < b;
    case BinaryOp::LessEqual: return a <= b;
    case BinaryOp::Greater: return a > b;
    case BinaryOp::GreaterEqual: return a >= b;
    case BinaryOp::Equal: return a == b;
    case BinaryOp::NotEqual: return a != b;
    case BinaryOp::LogicalAnd: return a != 0 && b != 0;
    case BinaryOp::LogicalOr: return a != 0 || b != 0;
    case BinaryOp::Div:
    case BinaryOp::Rem:
    case BinaryOp::ShiftLeft:
    case BinaryOp::ShiftRight: break;
  }
  throw std::logic_error("the evaluator has no such operator");
}

std::size_t nearest(std::int32_t index, std::size_t length) {
  return static_cast<std::size_t>(std::clamp(index, 0, static_cast<std::int32_t>(length) - 1));
}

}  // namespace

std::size_t LaneEvaluator::size(Type type) const {
  if (type.kind != Type::Kind::Array) return type.isVoid() ? 0 : type.width;
  const Array& array = module_.arrays[type.index];
  return array.length * size(array.element);
}

std::vector<LaneEvaluator::Lanes> LaneEvaluator::call(FunctionId id, std::vector<Lanes> arguments,
                                                      Lanes& result) {
  const Function& function = module_.functions[id];
  Frame frame{id, function, std::move(arguments), {}};
  for (VarId var = function.parameterCount; var < function.variables.size(); ++var) {
    frame.variables.push_back(unassigned(id, var));
  }
  for (VarId var = 0; var < function.parameterCount; ++var) check(frame, var);
  frame.result = each([&](std::size_t) { return Value(size(function.result), 55); });
  block(frame, function.body);
  result = std::move(frame.result);
  frame.variables.resize(function.parameterCount);
  return std::move(frame.variables);
}

/// A variable's value before its first assignment: different in each lane, if the analysis allows that.
LaneEvaluator::Lanes LaneEvaluator::unassigned(FunctionId id, VarId var) const {
  const Type type = module_.functions[id].variables[var].type;
  return each([&](std::size_t lane) {
    Value value(size(type));
    for (std::size_t i = 0; i < value.size(); ++i) {
      const bool varies =
          shapes_ != nullptr && shapes_->of(id, var)[type.isArithmetic() ? i : 0] == analysis::Shape::Varying;
      value[i] = varies ? 1000 + static_cast<int>(lane) : 77;
    }
    return value;
  });
}

/// Checks that the lanes' values relate as the analysis says; arrays may contain unassigned elements.
void LaneEvaluator::check(const Frame& frame, VarId var) const {
  const VarRole role = frame.function.variables[var].role;
  const Type type = frame.function.variables[var].type;
  if (shapes_ == nullptr || role == VarRole::AppendOutput || !type.isArithmetic()) return;
  const auto leaves = shapes_->of(frame.id, var);
  for (std::size_t i = 0; i < leaves.size(); ++i) {
    for (std::size_t lane = 0; lane < count_ && leaves[i] != analysis::Shape::Varying; ++lane) {
      const auto step = leaves[i] == analysis::Shape::Consecutive ? static_cast<std::int32_t>(lane) : 0;
      if (frame.variables[var][lane][i] != frame.variables[var][0][i] + step)
        throw std::runtime_error("'" + frame.function.variables[var].name + "' has another shape");
    }
  }
}

bool LaneEvaluator::uniform(Frame& frame, const Expr& expr) {
  const Lanes value = of(frame, expr);
  for (const Value& lane : value) {
    if (lane != value.front())
      throw std::runtime_error("control flow diverges at " + print(module_, frame.function, expr));
  }
  return value.front().front() != 0;
}

// ---- statements ---------------------------------------------------------------------------------

LaneEvaluator::Flow LaneEvaluator::block(Frame& frame, const Block& statements) {
  for (const Stmt& stmt : statements) {
    const Flow flow = statement(frame, stmt);
    if (flow != Flow::Next) return flow;
  }
  return Flow::Next;
}

LaneEvaluator::Flow LaneEvaluator::statement(Frame& frame, const Stmt& stmt) {
  tick();
  return match(
      stmt.node,
      [&](const Declare& n) {
        if (n.init) frame.variables[n.var] = of(frame, *n.init);
        if (n.init) check(frame, n.var);
        return Flow::Next;
      },
      [&](const Assign& n) {
        Lanes value = of(frame, *n.value);
        if (n.op) {
          const Lanes old = of(frame, *n.place);
          for (std::size_t lane = 0; lane < count_; ++lane) {
            for (std::size_t i = 0; i < old[lane].size(); ++i)
              value[lane][i] = computed(*n.op, old[lane][i], value[lane][i]);
          }
        }
        assign(frame, *n.place, value);
        return Flow::Next;
      },
      [&](const CallStmt& n) {
        std::vector<Lanes> arguments;
        for (const ExprPtr& arg : n.args) arguments.push_back(of(frame, *arg));
        Lanes result;
        const std::vector<Lanes> after = call(n.callee, std::move(arguments), result);
        for (std::size_t i = 0; i < after.size(); ++i) {
          if (module_.functions[n.callee].variables[i].role == VarRole::InOut)
            assign(frame, *n.args[i], after[i]);
        }
        if (n.result) assign(frame, *n.result, result);
        return Flow::Next;
      },
      [&](const If& n) { return block(frame, uniform(frame, *n.cond) ? n.then : n.otherwise); },
      [&](const Loop& n) { return loop(frame, n); }, [&](const Switch& n) { return choice(frame, n); },
      [](const Break&) { return Flow::Break; }, [](const Continue&) { return Flow::Continue; },
      [&](const Return& n) {
        if (n.value) frame.result = of(frame, *n.value);
        return Flow::Return;
      },
      [&](const Scope& n) { return block(frame, n.body); },
      [&](const Push& n) {
        const Lanes value = of(frame, *n.value);
        const Lanes mask = n.mask ? of(frame, *n.mask) : each([](std::size_t) { return Value{1}; });
        for (std::size_t lane = 0; lane < count_; ++lane) {
          if (mask[lane].front() != 0) pushed[lane].push_back(value[lane].front());
        }
        return Flow::Next;
      },
      [](const Scatter&) -> Flow { throw std::logic_error("the evaluator has no scatter"); });
}

LaneEvaluator::Flow LaneEvaluator::loop(Frame& frame, const Loop& n) {
  block(frame, n.init);
  for (bool isFirst = true;; isFirst = false) {
    tick();
    const bool isTested = n.cond && !(isFirst && n.kind == LoopKind::DoWhile);
    if (isTested && !uniform(frame, *n.cond)) return Flow::Next;
    const Flow flow = block(frame, n.body);
    if (flow == Flow::Return) return flow;
    if (flow == Flow::Break) return Flow::Next;
    block(frame, n.step);
  }
}

LaneEvaluator::Flow LaneEvaluator::choice(Frame& frame, const Switch& n) {
  const Lanes value = of(frame, *n.value);
  for (const Value& lane : value) {
    if (lane != value.front()) throw std::runtime_error("a switch diverges");
  }
  const auto holds = [&](const Case& one) {
    return std::ranges::find(one.values, value.front().front()) != one.values.end();
  };
  auto entered = std::ranges::find_if(n.cases, holds);
  if (entered == n.cases.end()) entered = std::ranges::find_if(n.cases, &Case::isDefault);
  for (; entered != n.cases.end(); ++entered) {
    const Flow flow = block(frame, entered->body);
    if (flow == Flow::Break) return Flow::Next;
    if (flow != Flow::Next) return flow;
  }
  return Flow::Next;
}

/// The first scalar of an lvalue's storage, and the offsets from there of the lvalue's scalars.
std::int32_t* LaneEvaluator::scalars(Frame& frame, const Expr& place, std::size_t lane,
                                     std::vector<std::size_t>& swizzle) {
  if (const auto* n = std::get_if<Index>(&place.node)) {
    const std::int32_t index = of(frame, *n->index)[lane].front();
    std::int32_t* base = scalars(frame, *n->base, lane, swizzle);
    const std::size_t element = size(place.type);
    swizzle.clear();
    for (std::size_t i = 0; i < element; ++i) swizzle.push_back(i);
    return base + element * nearest(index, size(n->base->type) / element);
  }
  if (const auto* n = std::get_if<Swizzle>(&place.node)) {
    std::int32_t* base = scalars(frame, *n->base, lane, swizzle);
    std::vector<std::size_t> chosen;
    for (const std::uint8_t component : n->components) chosen.push_back(swizzle[component]);
    swizzle = chosen;
    return base;
  }
  Value& whole = frame.variables[std::get<VarRef>(place.node).var][lane];
  for (std::size_t i = 0; i < whole.size(); ++i) swizzle.push_back(i);
  return whole.data();
}

void LaneEvaluator::assign(Frame& frame, const Expr& place, const Lanes& value) {
  for (std::size_t lane = 0; lane < count_; ++lane) {
    std::vector<std::size_t> chosen;
    std::int32_t* first = scalars(frame, place, lane, chosen);
    for (std::size_t i = 0; i < chosen.size(); ++i) first[chosen[i]] = value[lane][i];
  }
  check(frame, rootOf(place));
}

// ---- expressions --------------------------------------------------------------------------------

LaneEvaluator::Lanes LaneEvaluator::logical(Frame& frame, const Binary& n) {
  const Lanes lhs = of(frame, *n.lhs);
  const bool decides = (lhs.front().front() != 0) == (n.op == BinaryOp::LogicalOr);
  if (!inFull_ && decides) return lhs;
  const Lanes rhs = of(frame, *n.rhs);
  return each([&](std::size_t lane) { return Value{computed(n.op, lhs[lane].front(), rhs[lane].front())}; });
}

LaneEvaluator::Lanes LaneEvaluator::of(Frame& frame, const Expr& expr) {
  const auto all = [&](std::int32_t value) { return each([&](std::size_t) { return Value{value}; }); };
  const auto component = [](const Value& value, std::size_t i) { return value[value.size() == 1 ? 0 : i]; };
  if (const auto* n = std::get_if<Literal>(&expr.node)) return all(static_cast<std::int32_t>(n->bits));
  if (const auto* n = std::get_if<VarRef>(&expr.node)) return frame.variables[n->var];
  if (const auto* n = std::get_if<Unary>(&expr.node)) {
    Lanes value = of(frame, *n->operand);
    for (Value& lane : value) {
      for (std::int32_t& x : lane) x = n->op == UnaryOp::LogicalNot ? x == 0 : -x;
    }
    return value;
  }
  if (const auto* n = std::get_if<Binary>(&expr.node)) {
    if (n->op == BinaryOp::LogicalAnd || n->op == BinaryOp::LogicalOr) return logical(frame, *n);
    const Lanes lhs = of(frame, *n->lhs), rhs = of(frame, *n->rhs);
    return each([&](std::size_t lane) {
      Value value;
      for (std::size_t i = 0; i < size(expr.type); ++i)
        value.push_back(computed(n->op, component(lhs[lane], i), component(rhs[lane], i)));
      return value;
    });
  }
  if (const auto* n = std::get_if<Select>(&expr.node)) {
    const Lanes cond = of(frame, *n->cond);
    if (!inFull_) return of(frame, cond.front().front() != 0 ? *n->yes : *n->no);
    const Lanes yes = of(frame, *n->yes), no = of(frame, *n->no);
    return each([&](std::size_t lane) { return cond[lane].front() != 0 ? yes[lane] : no[lane]; });
  }
  if (const auto* n = std::get_if<Construct>(&expr.node)) {
    Lanes value = each([](std::size_t) { return Value{}; });
    for (const ExprPtr& arg : n->args) {
      const Lanes part = of(frame, *arg);
      for (std::size_t lane = 0; lane < count_; ++lane)
        value[lane].insert(value[lane].end(), part[lane].begin(), part[lane].end());
    }
    return value;
  }
  if (const auto* n = std::get_if<Swizzle>(&expr.node)) {
    const Lanes base = of(frame, *n->base);
    return each([&](std::size_t lane) {
      Value value;
      for (const std::uint8_t i : n->components) value.push_back(base[lane][i]);
      return value;
    });
  }
  if (const auto* n = std::get_if<Index>(&expr.node)) {
    const Lanes base = of(frame, *n->base), index = of(frame, *n->index);
    return each(
        [&](std::size_t lane) { return Value{base[lane][nearest(index[lane].front(), base[lane].size())]}; });
  }
  if (const auto* n = std::get_if<Call>(&expr.node)) {
    std::vector<Lanes> arguments;
    for (const ExprPtr& arg : n->args) arguments.push_back(of(frame, *arg));
    Lanes result;
    call(n->callee, std::move(arguments), result);
    return result;
  }
  if (const auto* n = std::get_if<IntrinsicCall>(&expr.node);
      n != nullptr && n->intrinsic == Intrinsic::AnyLane) {
    const Lanes value = of(frame, *n->args.front());
    return all(std::ranges::any_of(value, [](const Value& lane) { return lane.front() != 0; }) ? 1 : 0);
  }
  if (std::holds_alternative<IndexOf>(expr.node)) {
    return each(
        [&](std::size_t lane) { return Value{firstIndex + static_cast<std::int32_t>(lane), 3, 0, 0}; });
  }
  throw std::logic_error("the evaluator has no such expression");
}

}  // namespace skc
