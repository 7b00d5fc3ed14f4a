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
#include "support/overloaded.hpp"

namespace skc {

using namespace ir;

namespace {

/// The low bits of an integer, as the scalar represents them.
double wrapped(Scalar scalar, std::int64_t value) {
  switch (scalar) {
    case Scalar::Int: return static_cast<std::int32_t>(value);
    case Scalar::Uint: return static_cast<std::uint32_t>(value);
    case Scalar::Char: return static_cast<std::int8_t>(value);
    case Scalar::Uchar: return static_cast<std::uint8_t>(value);
    case Scalar::Short: return static_cast<std::int16_t>(value);
    case Scalar::Ushort: return static_cast<std::uint16_t>(value);
    default: throw std::logic_error("the evaluator has no such integer");
  }
}

double converted(Scalar to, Scalar from, double value) {
  if (to == Scalar::Bool) return value != 0 ? 1 : 0;
  if (to == Scalar::Float) return static_cast<float>(value);
  if (to == Scalar::Double) return value;
  if (isReal(from) && (to == Scalar::Int || to == Scalar::Uint)) {
    const double least = to == Scalar::Int ? std::numeric_limits<std::int32_t>::min() : 0;
    const double most = to == Scalar::Int ? std::numeric_limits<std::int32_t>::max()
                                          : std::numeric_limits<std::uint32_t>::max();
    return std::isnan(value) ? 0 : std::clamp(std::trunc(value), least, most);
  }
  return wrapped(to, static_cast<std::int64_t>(value));
}

double computedInteger(BinaryOp op, Scalar scalar, double x, double y) {
  const auto a = static_cast<std::int64_t>(x), b = static_cast<std::int64_t>(y);
  const auto count = static_cast<unsigned>(b & 31);
  switch (op) {
    case BinaryOp::Add: return wrapped(scalar, a + b);
    case BinaryOp::Sub: return wrapped(scalar, a - b);
    case BinaryOp::Mul:
      return wrapped(
          scalar, static_cast<std::int64_t>(static_cast<std::uint64_t>(a) * static_cast<std::uint64_t>(b)));
    case BinaryOp::Div: return b == 0 ? x : wrapped(scalar, a / b);
    case BinaryOp::Rem: return b == 0 ? 0 : wrapped(scalar, a % b);
    case BinaryOp::BitAnd: return wrapped(scalar, a & b);
    case BinaryOp::BitOr: return wrapped(scalar, a | b);
    case BinaryOp::BitXor: return wrapped(scalar, a ^ b);
    case BinaryOp::ShiftLeft:
      return wrapped(scalar, static_cast<std::int64_t>(static_cast<std::uint64_t>(a) << count));
    case BinaryOp::ShiftRight: return wrapped(scalar, a >> count);
    default: throw std::logic_error("the evaluator has no such operator of integers");
  }
}

double computed(BinaryOp op, Scalar scalar, double a, double b) {
  switch (op) {
    case BinaryOp::Less: return a < b;
    case BinaryOp::LessEqual: return a <= b;
    case BinaryOp::Greater: return a > b;
    case BinaryOp::GreaterEqual: return a >= b;
    case BinaryOp::Equal: return a == b;
    case BinaryOp::NotEqual: return a != b;
    case BinaryOp::LogicalAnd: return a != 0 && b != 0;
    case BinaryOp::LogicalOr: return a != 0 || b != 0;
    default: break;
  }
  if (scalar == Scalar::Bool) return computedInteger(op, Scalar::Int, a, b);
  if (!isReal(scalar)) return computedInteger(op, scalar, a, b);
  double result = 0;
  switch (op) {
    case BinaryOp::Add: result = a + b; break;
    case BinaryOp::Sub: result = a - b; break;
    case BinaryOp::Mul: result = a * b; break;
    case BinaryOp::Div: result = a / b; break;
    default: throw std::logic_error("the evaluator has no such operator of floats");
  }
  return scalar == Scalar::Float ? static_cast<float>(result) : result;
}

double computed(UnaryOp op, Scalar scalar, double x) {
  if (op == UnaryOp::LogicalNot) return x == 0;
  if (op == UnaryOp::BitNot)
    return scalar == Scalar::Bool ? double(x == 0) : wrapped(scalar, ~static_cast<std::int64_t>(x));
  return isReal(scalar) ? -x : wrapped(scalar, -static_cast<std::int64_t>(x));
}

/// The intrinsics of one component that need no rounding.
double computed(Intrinsic intrinsic, Scalar scalar, double x, double y, double z) {
  switch (intrinsic) {
    case Intrinsic::Abs:
    case Intrinsic::Fabs:
      return isReal(scalar) ? std::fabs(x) : wrapped(scalar, static_cast<std::int64_t>(std::fabs(x)));
    case Intrinsic::Sign: return x > 0 ? 1 : x < 0 ? -1 : 0;
    case Intrinsic::Floor: return std::floor(x);
    case Intrinsic::Ceil: return std::ceil(x);
    case Intrinsic::Trunc: return std::trunc(x);
    case Intrinsic::Round:
    case Intrinsic::RoundEven: return std::nearbyint(x);
    case Intrinsic::Fract:
    case Intrinsic::Frac: return x - std::floor(x);
    case Intrinsic::Min:
    case Intrinsic::Fmin: return std::fmin(x, y);
    case Intrinsic::Max:
    case Intrinsic::Fmax: return std::fmax(x, y);
    case Intrinsic::Clamp: return std::fmin(std::fmax(x, y), z);
    case Intrinsic::LessThan: return x < y;
    case Intrinsic::LessThanEqual: return x <= y;
    case Intrinsic::GreaterThan: return x > y;
    case Intrinsic::GreaterThanEqual: return x >= y;
    case Intrinsic::EqualTo: return x == y;
    case Intrinsic::NotEqualTo: return x != y;
    case Intrinsic::MixBool: return z != 0 ? y : x;
    default: throw std::logic_error("the evaluator has no " + std::string(row(intrinsic).name));
  }
}

std::size_t nearest(double index, std::size_t length) {
  return static_cast<std::size_t>(std::clamp(index, 0.0, static_cast<double>(length) - 1));
}

double component(const LaneEvaluator::Value& value, std::size_t i) {
  return value[value.size() == 1 ? 0 : i];
}

}  // namespace

std::size_t LaneEvaluator::size(Type type) const {
  switch (type.kind) {
    case Type::Kind::Void: return 0;
    case Type::Kind::Scalar:
    case Type::Kind::Vector: return type.width;
    case Type::Kind::Matrix: return std::size_t{type.width} * type.width;
    case Type::Kind::Struct:
      return fieldOffset(type, static_cast<std::uint32_t>(module_.structs[type.index].fields.size()));
    case Type::Kind::Array: break;
  }
  const Array& array = module_.arrays[type.index];
  return array.length * size(array.element);
}

std::size_t LaneEvaluator::fieldOffset(Type type, std::uint32_t field) const {
  std::size_t offset = 0;
  for (std::uint32_t i = 0; i < field; ++i) offset += size(module_.structs[type.index].fields[i].type);
  return offset;
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
              sum[i] = computed(*n.op, n.place->type.scalar, old[lane][i], component(value[lane], i));
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
    const std::size_t first = fieldOffset(n->base->type, n->field);
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
      value[i] = computed(n.op, Scalar::Bool, component(lhs[lane], i), component(rhs[lane], i));
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
    for (std::size_t i = 0; i < value.size(); ++i)
      value[i] = computed(n.intrinsic, scalar, argument(0, i), argument(1, i), argument(2, i));
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
      expr.node,
      [&](const Literal& n) {
        const Scalar kind = arithmeticScalar(scalar);
        double value = n.bits;
        if (kind == Scalar::Int) value = static_cast<std::int32_t>(n.bits);
        if (kind == Scalar::Float) value = std::bit_cast<float>(n.bits);
        if (kind == Scalar::Double) value = std::bit_cast<double>(std::uint64_t{n.high} << 32 | n.bits);
        return Lanes(count_, {value});
      },
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
            value[i] = computed(n.op, n.lhs->type.scalar, component(lhs[lane], i), component(rhs[lane], i));
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
          for (double& x : lane) x = converted(scalar, n.operand->type.scalar, x);
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
        const std::size_t first = fieldOffset(n.base->type, n.field);
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
