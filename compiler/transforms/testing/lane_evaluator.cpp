// SPDX-License-Identifier: MIT
#include "transforms/testing/lane_evaluator.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <numeric>
#include <utility>

#include "analysis/shapes.hpp"
#include "ir/build.hpp"
#include "ir/print.hpp"
#include "ir/scalar_operations.hpp"
#include "support/overloaded.hpp"

namespace skc {

using namespace ir;

namespace {

double rounded(Scalar scalar, double value) {
  return scalar == Scalar::Float ? static_cast<float>(value) : value;
}

/// The result of an operator on two values of this type.
double computedHere(BinaryOp op, Scalar scalar, double a, double b) {
  const std::optional<double> result = computed(op, scalar, a, b);
  if (!result) throw std::logic_error("the evaluator has no such operator");
  return rounded(scalar, *result);
}

std::size_t nearest(double index, std::size_t length) {
  return static_cast<std::size_t>(std::clamp(index, 0.0, static_cast<double>(length) - 1));
}

double component(const LaneEvaluator::Value& value, std::size_t i) {
  return value[value.size() == 1 ? 0 : i];
}

}  // namespace

std::size_t LaneEvaluator::size(Type type) const {
  return static_cast<std::size_t>(scalarCount(module_, type));
}

/// For each scalar of a value, its leaf in the analysis.
void LaneEvaluator::addLeaves(Type type, std::size_t first, Offsets& leaves) const {
  if (type.kind == Type::Kind::Struct) {
    const std::vector<StructField>& fields = module_.structs[type.index].fields;
    for (std::uint32_t i = 0; i < fields.size(); ++i)
      addLeaves(fields[i].type, first + analysis::firstLeaf(module_, type, i), leaves);
  } else if (type.kind == Type::Kind::Array) {
    const Array& array = module_.arrays[type.index];
    for (std::uint32_t i = 0; i < array.length; ++i) addLeaves(array.element, first, leaves);
  } else {
    for (std::size_t i = 0; i < size(type); ++i) leaves.push_back(first + i);
  }
}

std::vector<LaneEvaluator::Lanes> LaneEvaluator::call(FunctionId id, std::vector<Lanes> arguments,
                                                      Lanes& result) {
  const Function& function = module_.functions[id];
  Frame frame{id, function, std::move(arguments), {}};
  for (VarId var = function.parameterCount; var < function.variables.size(); ++var) {
    frame.variables.push_back(unassigned(id, var));
  }
  for (VarId var = 0; var < function.parameterCount; ++var) check(frame, var);
  frame.result = each([&](std::size_t) { return Value(size(function.result), 1); });
  block(frame, function.body);
  result = std::move(frame.result);
  frame.variables.resize(function.parameterCount);
  return std::move(frame.variables);
}

/// A variable's value before its first assignment: different in each lane, if the analysis allows that.
LaneEvaluator::Lanes LaneEvaluator::unassigned(FunctionId id, VarId var) const {
  const Type type = module_.functions[id].variables[var].type;
  Offsets leaves;
  if (shapes_ != nullptr) addLeaves(type, 0, leaves);
  return each([&](std::size_t lane) {
    Value value(size(type), type.isBool() ? 1 : 77);
    for (std::size_t i = 0; i < leaves.size(); ++i) {
      const bool varies = shapes_->of(id, var)[leaves[i]] == analysis::Shape::Varying;
      if (varies) value[i] = type.isBool() ? static_cast<double>(lane % 2) : 100 + static_cast<double>(lane);
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
      double wanted = frame.variables[var][0][i];
      if (leaves[i] == analysis::Shape::Consecutive)
        wanted = wrapped(type.scalar, static_cast<std::int64_t>(wanted) + static_cast<std::int64_t>(lane));
      const double got = frame.variables[var][lane][i];
      if (got != wanted && !(std::isnan(got) && std::isnan(wanted)))
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
            Value sum(old[lane].size());
            for (std::size_t i = 0; i < sum.size(); ++i)
              sum[i] = computedHere(*n.op, n.place->type.scalar, old[lane][i], component(value[lane], i));
            value[lane] = std::move(sum);
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
    return std::ranges::find(one.values, static_cast<std::int64_t>(value.front().front())) !=
           one.values.end();
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

std::vector<LaneEvaluator::Offsets> LaneEvaluator::offsets(Frame& frame, const Expr& place) {
  const auto part = [&](std::vector<Offsets> lanes, auto&& firstOf) {
    const std::size_t length = size(place.type);
    for (std::size_t lane = 0; lane < count_; ++lane) {
      const auto begin = lanes[lane].begin() + static_cast<std::ptrdiff_t>(firstOf(lane, lanes[lane].size()));
      lanes[lane] = Offsets(begin, begin + static_cast<std::ptrdiff_t>(length));
    }
    return lanes;
  };
  if (const auto* n = std::get_if<Index>(&place.node)) {
    const Lanes index = of(frame, *n->index);
    const std::size_t element = size(place.type);
    return part(offsets(frame, *n->base), [&](std::size_t lane, std::size_t all) {
      return element * nearest(index[lane].front(), all / element);
    });
  }
  if (const auto* n = std::get_if<Member>(&place.node)) {
    const std::size_t first = scalarOffset(module_, n->base->type, n->field);
    return part(offsets(frame, *n->base), [&](std::size_t, std::size_t) { return first; });
  }
  if (const auto* n = std::get_if<Swizzle>(&place.node)) {
    std::vector<Offsets> lanes = offsets(frame, *n->base);
    for (Offsets& lane : lanes) {
      Offsets chosen;
      for (const std::uint8_t i : n->components) chosen.push_back(lane[i]);
      lane = std::move(chosen);
    }
    return lanes;
  }
  Offsets all(size(place.type));
  std::iota(all.begin(), all.end(), std::size_t{0});
  return std::vector<Offsets>(count_, all);
}

void LaneEvaluator::assign(Frame& frame, const Expr& place, const Lanes& value) {
  const std::vector<Offsets> chosen = offsets(frame, place);
  const VarId root = rootOf(place);
  for (std::size_t lane = 0; lane < count_; ++lane) {
    for (std::size_t i = 0; i < chosen[lane].size(); ++i)
      frame.variables[root][lane][chosen[lane][i]] = value[lane][i];
  }
  check(frame, root);
}

// ---- expressions --------------------------------------------------------------------------------

LaneEvaluator::Lanes LaneEvaluator::logical(Frame& frame, const Binary& n, std::size_t size) {
  const Lanes lhs = of(frame, *n.lhs);
  const bool decides = (lhs.front().front() != 0) == (n.op == BinaryOp::LogicalOr);
  if (!inFull_ && size == 1 && decides) return lhs;
  const Lanes rhs = of(frame, *n.rhs);
  return each([&](std::size_t lane) {
    Value value(size);
    for (std::size_t i = 0; i < size; ++i)
      value[i] = computedHere(n.op, Scalar::Bool, component(lhs[lane], i), component(rhs[lane], i));
    return value;
  });
}

LaneEvaluator::Lanes LaneEvaluator::intrinsic(Frame& frame, const IntrinsicCall& n, Type type) {
  std::vector<Lanes> arguments;
  for (const ExprPtr& argument : n.args) arguments.push_back(of(frame, *argument));
  const Lanes& first = arguments.front();
  const auto isSet = [](const Value& lane) { return lane.front() != 0; };
  const auto isNonzero = [](double x) { return x != 0; };
  switch (n.intrinsic) {
    case Intrinsic::AnyLane: return Lanes(count_, {double(std::ranges::any_of(first, isSet))});
    case Intrinsic::Any:
      return each(
          [&](std::size_t lane) { return Value{double(std::ranges::any_of(first[lane], isNonzero))}; });
    case Intrinsic::All:
      return each(
          [&](std::size_t lane) { return Value{double(std::ranges::all_of(first[lane], isNonzero))}; });
    default: break;
  }
  const Scalar scalar = n.args.front()->type.scalar;
  return each([&](std::size_t lane) {
    Value value(size(type));
    const auto argument = [&](std::size_t i, std::size_t c) {
      return i < arguments.size() ? component(arguments[i][lane], c) : 0;
    };
    for (std::size_t i = 0; i < value.size(); ++i) {
      const auto result = computed(n.intrinsic, scalar, argument(0, i), argument(1, i), argument(2, i));
      if (!result) throw std::logic_error("the evaluator has no " + std::string(row(n.intrinsic).name));
      value[i] = *result;
    }
    return value;
  });
}

LaneEvaluator::Lanes LaneEvaluator::of(Frame& frame, const Expr& expr) {
  const Scalar scalar = expr.type.scalar;
  const auto part = [&](const Lanes& base, auto&& firstOf) {
    const auto length = static_cast<std::ptrdiff_t>(size(expr.type));
    return each([&](std::size_t lane) {
      const auto begin = base[lane].begin() + static_cast<std::ptrdiff_t>(firstOf(lane));
      return Value(begin, begin + length);
    });
  };
  return match(
      expr.node, [&](const Literal& n) { return Lanes(count_, {valueOf(scalar, n)}); },
      [&](const VarRef& n) { return frame.variables[n.var]; },
      [&](const ConstantRef& n) { return of(frame, *module_.constants[n.constant].value); },
      [&](const Unary& n) {
        Lanes value = of(frame, *n.operand);
        for (Value& lane : value) {
          for (double& x : lane) x = computed(n.op, scalar, x);
        }
        return value;
      },
      [&](const Binary& n) {
        if (n.op == BinaryOp::LogicalAnd || n.op == BinaryOp::LogicalOr)
          return logical(frame, n, size(expr.type));
        if (n.lhs->type.isMatrix() || n.rhs->type.isMatrix())
          throw std::logic_error("the evaluator has no operators of matrices");
        const Lanes lhs = of(frame, *n.lhs), rhs = of(frame, *n.rhs);
        return each([&](std::size_t lane) {
          Value value(size(expr.type));
          for (std::size_t i = 0; i < value.size(); ++i)
            value[i] =
                computedHere(n.op, n.lhs->type.scalar, component(lhs[lane], i), component(rhs[lane], i));
          return value;
        });
      },
      [&](const Select& n) {
        const Lanes cond = of(frame, *n.cond);
        if (n.cond->type.isVector()) {
          const Lanes yes = of(frame, *n.yes), no = of(frame, *n.no);
          return each([&](std::size_t lane) {
            Value value(size(expr.type));
            for (std::size_t i = 0; i < value.size(); ++i)
              value[i] = component(cond[lane][i] != 0 ? yes[lane] : no[lane], i);
            return value;
          });
        }
        if (!inFull_) return of(frame, cond.front().front() != 0 ? *n.yes : *n.no);
        const Lanes yes = of(frame, *n.yes), no = of(frame, *n.no);
        return each([&](std::size_t lane) { return cond[lane].front() != 0 ? yes[lane] : no[lane]; });
      },
      [&](const Convert& n) {
        Lanes value = of(frame, *n.operand);
        for (Value& lane : value) {
          for (double& x : lane) x = rounded(scalar, converted(n.operand->type.scalar, scalar, x));
        }
        return value;
      },
      [&](const Construct& n) {
        Lanes value(count_);
        for (const ExprPtr& arg : n.args) {
          const Lanes arguments = of(frame, *arg);
          for (std::size_t lane = 0; lane < count_; ++lane)
            value[lane].insert(value[lane].end(), arguments[lane].begin(), arguments[lane].end());
        }
        for (Value& lane : value) {
          if (lane.size() == 1) lane.resize(size(expr.type), lane.front());
        }
        return value;
      },
      [&](const Swizzle& n) {
        const Lanes base = of(frame, *n.base);
        return each([&](std::size_t lane) {
          Value value;
          for (const std::uint8_t i : n.components) value.push_back(component(base[lane], i));
          return value;
        });
      },
      [&](const Member& n) {
        const std::size_t first = scalarOffset(module_, n.base->type, n.field);
        return part(of(frame, *n.base), [&](std::size_t) { return first; });
      },
      [&](const Index& n) {
        const Lanes base = of(frame, *n.base), index = of(frame, *n.index);
        const std::size_t element = size(expr.type);
        return part(base, [&](std::size_t lane) {
          return element * nearest(index[lane].front(), base[lane].size() / element);
        });
      },
      [&](const Call& n) {
        std::vector<Lanes> arguments;
        for (const ExprPtr& arg : n.args) arguments.push_back(of(frame, *arg));
        Lanes result;
        call(n.callee, std::move(arguments), result);
        return result;
      },
      [&](const IntrinsicCall& n) { return intrinsic(frame, n, expr.type); },
      [&](const IndexOf&) {
        return each([&](std::size_t lane) { return Value{firstIndex + static_cast<double>(lane), 3, 0, 0}; });
      },
      [](const auto&) -> Lanes { throw std::logic_error("the evaluator has no such expression"); });
}

}  // namespace skc
