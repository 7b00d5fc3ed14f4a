// SPDX-License-Identifier: MIT
#include "transforms/interpreter.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <numeric>
#include <stdexcept>
#include <utility>

#include "ir/build.hpp"
#include "ir/scalar_operations.hpp"
#include "support/overloaded.hpp"

namespace skc {
namespace {

using namespace ir;

/// Thrown if a function cannot be tried; it does not leave this file.
struct CannotInterpret {};

/// A number that is large for an int is no fair try, although the language defines what it becomes.
double toScalar(Scalar from, Scalar to, double value) {
  const bool isTruncated =
      isReal(arithmeticScalar(from)) && !isReal(arithmeticScalar(to)) && to != Scalar::Bool;
  if (isTruncated && !(std::fabs(value) < 2147483648.0)) throw CannotInterpret{};
  return converted(from, to, value);
}

/// The bits of a float, if the number is one.
std::uint32_t bitsOfFloat(double value) {
  const auto number = static_cast<float>(value);
  if (double{number} != value) throw CannotInterpret{};
  return std::bit_cast<std::uint32_t>(number);
}

double floatOfBits(double bits) {
  return std::bit_cast<float>(static_cast<std::uint32_t>(static_cast<std::int64_t>(bits)));
}

/// Intrinsics that devices round, each in its own way: here, to the nearest double.
std::optional<double> inDouble(Intrinsic intrinsic, double x, double y, double z) {
  switch (intrinsic) {
    case Intrinsic::Sin: return std::sin(x);
    case Intrinsic::Cos: return std::cos(x);
    case Intrinsic::Tan: return std::tan(x);
    case Intrinsic::Asin: return std::asin(x);
    case Intrinsic::Acos: return std::acos(x);
    case Intrinsic::Atan: return std::atan(x);
    case Intrinsic::Sinh: return std::sinh(x);
    case Intrinsic::Cosh: return std::cosh(x);
    case Intrinsic::Tanh: return std::tanh(x);
    case Intrinsic::Exp: return std::exp(x);
    case Intrinsic::Log: return std::log(x);
    case Intrinsic::Exp2: return std::exp2(x);
    case Intrinsic::Log2: return std::log2(x);
    case Intrinsic::Log10: return std::log10(x);
    case Intrinsic::Sqrt: return std::sqrt(x);
    case Intrinsic::InverseSqrt:
    case Intrinsic::Rsqrt: return 1 / std::sqrt(x);
    case Intrinsic::Radians: return x * (std::numbers::pi / 180);
    case Intrinsic::Degrees: return x * (180 / std::numbers::pi);
    case Intrinsic::Asinh: return std::asinh(x);
    case Intrinsic::Acosh: return std::acosh(x);
    case Intrinsic::Atanh: return std::atanh(x);
    case Intrinsic::FloatBitsToInt:
    case Intrinsic::AsInt: return static_cast<std::int32_t>(bitsOfFloat(x));
    case Intrinsic::FloatBitsToUint:
    case Intrinsic::AsUint: return bitsOfFloat(x);
    case Intrinsic::IntBitsToFloat:
    case Intrinsic::UintBitsToFloat:
    case Intrinsic::AsFloatInt:
    case Intrinsic::AsFloatUint: return floatOfBits(x);
    case Intrinsic::Mix:
    case Intrinsic::Lerp: return x + (y - x) * z;
    case Intrinsic::Ldexp: return std::ldexp(x, static_cast<int>(y));
    case Intrinsic::Pow: return std::pow(x, y);
    case Intrinsic::AtanYX:
    case Intrinsic::Atan2: return std::atan2(x, y);
    case Intrinsic::Mod: return x - y * std::floor(x / y);
    case Intrinsic::Fmod: return std::fmod(x, y);
    case Intrinsic::Hypot: return std::hypot(x, y);
    case Intrinsic::Log1p: return std::log1p(x);
    case Intrinsic::Expm1: return std::expm1(x);
    case Intrinsic::Cbrt: return std::cbrt(x);
    case Intrinsic::Erf: return std::erf(x);
    case Intrinsic::Erfc: return std::erfc(x);
    case Intrinsic::Fma: return x * y + z;
    default: return std::nullopt;
  }
}

/// Values have the numbers of all lanes, one lane after the other.
class Interpreter {
 public:
  Interpreter(const Module& module, const InterpretedStreams& streams, const InterpretedLanes& lanes,
              int& steps)
      : module_(module), streams_(streams), lanes_(lanes), steps_(steps) {}

  std::vector<Numbers> call(FunctionId id, std::vector<Numbers> arguments) {
    Numbers result;
    return call(id, std::move(arguments), result);
  }

  Numbers constant(const Expr& expr) {
    Frame frame{{}, nullptr, {}, {}};
    return of(frame, expr);
  }

 private:
  enum class Flow : std::uint8_t { Next, Break, Continue, Return };
  struct Frame {
    FunctionId id;
    const Function* function;
    std::vector<Numbers> variables;
    Numbers result;
  };

  void tick() {
    if (steps_-- <= 0) throw CannotInterpret{};
  }

  /// The number of scalars that one lane holds of a value of this type.
  std::size_t size(Type type) const {
    const std::uint64_t count = scalarCount(module_, type);
    if (count > 256) throw CannotInterpret{};
    return static_cast<std::size_t>(count);
  }

  /// The value of a variable before its first assignment.
  Numbers unassigned(const Frame& frame, VarId var) const {
    if (lanes_.unassigned) return lanes_.unassigned(frame.id, var);
    return Numbers(lanes_.count * size(frame.function->variables[var].type), 0.0);
  }

  void noteValue(const Frame& frame, VarId var) const {
    if (lanes_.assigned) lanes_.assigned(frame.id, var, frame.variables[var]);
  }

  std::vector<Numbers> call(FunctionId id, std::vector<Numbers> arguments, Numbers& result) {
    if (++depth_ > 32) throw CannotInterpret{};
    Frame frame{id, &module_.functions[id], std::move(arguments), {}};
    for (VarId i = 0; i < frame.variables.size(); ++i) noteValue(frame, i);
    for (auto i = static_cast<VarId>(frame.variables.size()); i < frame.function->variables.size(); ++i)
      frame.variables.push_back(unassigned(frame, i));
    block(frame, frame.function->body);
    --depth_;
    result = std::move(frame.result);
    frame.variables.resize(frame.function->parameterCount);
    return std::move(frame.variables);
  }

  // ---- statements ---------------------------------------------------------------------------------

  Flow block(Frame& frame, const Block& statements) {
    for (const Stmt& stmt : statements) {
      if (const Flow flow = statement(frame, stmt); flow != Flow::Next) return flow;
    }
    return Flow::Next;
  }

  Flow statement(Frame& frame, const Stmt& stmt) {
    tick();
    return match(
        stmt.node,
        [&](const Declare& n) {
          frame.variables[n.var] = n.init ? of(frame, *n.init) : unassigned(frame, n.var);
          if (n.init) noteValue(frame, n.var);
          return Flow::Next;
        },
        [&](const Assign& n) {
          Numbers value = of(frame, *n.value);
          if (n.op) value = binary(*n.op, n.place->type, n.value->type, of(frame, *n.place), value);
          store(frame, slots(frame, *n.place), value);
          return Flow::Next;
        },
        [&](const CallStmt& n) { return callStatement(frame, n); },
        [&](const If& n) { return block(frame, decides(frame, *n.cond) ? n.then : n.otherwise); },
        [&](const Loop& n) { return loop(frame, n); }, [&](const Switch& n) { return choice(frame, n); },
        [](const Break&) { return Flow::Break; }, [](const Continue&) { return Flow::Continue; },
        [&](const Return& n) {
          if (n.value) frame.result = of(frame, *n.value);
          return Flow::Return;
        },
        [&](const Scope& n) { return block(frame, n.body); }, [&](const Push& n) { return push(frame, n); },
        [](const Scatter&) -> Flow { throw CannotInterpret{}; }, [](const Print&) { return Flow::Next; });
  }

  Flow callStatement(Frame& frame, const CallStmt& n) {
    const Function& callee = module_.functions[n.callee];
    std::vector<Numbers> arguments;
    std::vector<std::pair<std::size_t, Slots>> places;  // before the call changes what their indices are
    for (std::size_t i = 0; i < n.args.size(); ++i) {
      arguments.push_back(of(frame, *n.args[i]));
      if (callee.variables[i].role == VarRole::InOut) places.emplace_back(i, slots(frame, *n.args[i]));
    }
    Numbers result;
    const std::vector<Numbers> ends = call(n.callee, std::move(arguments), result);
    for (const auto& [i, place] : places) store(frame, place, ends[i]);
    if (n.result) store(frame, slots(frame, *n.result), result);
    return Flow::Next;
  }

  Flow push(Frame& frame, const Push& n) {
    if (!lanes_.pushed) throw CannotInterpret{};
    const Numbers value = of(frame, *n.value);
    const Numbers mask = n.mask ? of(frame, *n.mask) : Numbers(lanes_.count, 1.0);
    for (std::size_t lane = 0; lane < lanes_.count; ++lane) {
      if (mask.at(lane) != 0) lanes_.pushed(lane, value.at(lane * (value.size() / lanes_.count)));
    }
    return Flow::Next;
  }

  /// The number on which control flow depends: the same in all lanes.
  double uniform(Frame& frame, const Expr& expr) {
    const Numbers value = of(frame, expr);
    if (std::ranges::find_if(value, [&](double v) { return v != value[0]; }) != value.end())
      throw CannotInterpret{};
    return value.at(0);
  }
  bool decides(Frame& frame, const Expr& cond) { return uniform(frame, cond) != 0; }

  Flow loop(Frame& frame, const Loop& n) {
    block(frame, n.init);
    for (bool isFirst = true;; isFirst = false) {
      tick();
      const bool asks = n.cond && (n.kind != LoopKind::DoWhile || !isFirst);
      if (asks && !decides(frame, *n.cond)) return Flow::Next;
      const Flow flow = block(frame, n.body);
      if (flow == Flow::Break) return Flow::Next;
      if (flow == Flow::Return) return flow;
      block(frame, n.step);
    }
  }

  Flow choice(Frame& frame, const Switch& n) {
    const auto value = static_cast<std::int64_t>(uniform(frame, *n.value));
    auto at = std::ranges::find_if(
        n.cases, [&](const Case& c) { return std::ranges::find(c.values, value) != c.values.end(); });
    if (at == n.cases.end()) at = std::ranges::find_if(n.cases, &Case::isDefault);
    for (; at != n.cases.end(); ++at) {
      const Flow flow = block(frame, at->body);
      if (flow == Flow::Break) return Flow::Next;
      if (flow != Flow::Next) return flow;
    }
    return Flow::Next;
  }

  // ---- parts and lvalues --------------------------------------------------------------------------

  /// What a Member, Index or Swizzle names of its base, of which `all` has something for each number. An index outside is
  /// clamped.
  template <class T>
  std::vector<T> part(Frame& frame, const Expr& expr, const std::vector<T>& all) {
    const std::size_t count = size(expr.type), total = all.size() / lanes_.count;
    const auto chosen = [&](auto&& numberOf) {
      std::vector<T> part;
      for (std::size_t lane = 0; lane < lanes_.count; ++lane) {
        for (std::size_t i = 0; i < count; ++i) part.push_back(all.at(lane * total + numberOf(lane, i)));
      }
      return part;
    };
    if (const auto* n = std::get_if<Member>(&expr.node)) {
      const std::size_t first = scalarOffset(module_, n->base->type, n->field);
      return chosen([&](std::size_t, std::size_t i) { return first + i; });
    }
    if (const auto* n = std::get_if<Swizzle>(&expr.node))
      return chosen([&](std::size_t, std::size_t i) { return n->components[i]; });
    const Numbers index = of(frame, *std::get<Index>(expr.node).index);
    const auto last = static_cast<double>(total / count) - 1;
    return chosen([&](std::size_t lane, std::size_t i) {
      return static_cast<std::size_t>(std::clamp(index.at(lane), 0.0, last)) * count + i;
    });
  }

  /// What an expression is a part of, or null.
  static const Expr* baseOf(const Expr& expr) {
    if (const auto* n = std::get_if<Member>(&expr.node)) return n->base.get();
    if (const auto* n = std::get_if<Index>(&expr.node)) return n->base.get();
    const auto* n = std::get_if<Swizzle>(&expr.node);
    return n != nullptr ? n->base.get() : nullptr;
  }

  /// A variable, and the positions of an lvalue's numbers in it.
  struct Slots {
    VarId var;
    std::vector<std::size_t> numbers;
  };

  Slots slots(Frame& frame, const Expr& place) {
    if (const Expr* base = baseOf(place)) {
      Slots whole = slots(frame, *base);
      return {whole.var, part(frame, place, whole.numbers)};
    }
    const auto* n = std::get_if<VarRef>(&place.node);
    if (n == nullptr) throw CannotInterpret{};
    Slots all{n->var, std::vector<std::size_t>(frame.variables[n->var].size())};
    std::iota(all.numbers.begin(), all.numbers.end(), std::size_t{0});
    return all;
  }

  void store(Frame& frame, const Slots& at, const Numbers& value) const {
    const std::size_t count = at.numbers.size() / lanes_.count;
    for (std::size_t i = 0; i < at.numbers.size(); ++i)
      frame.variables[at.var][at.numbers[i]] = component(value, i / count, i % count);
    noteValue(frame, at.var);
  }

  // ---- expressions --------------------------------------------------------------------------------

  /// A number of a value, or its only one.
  double component(const Numbers& value, std::size_t lane, std::size_t i) const {
    const std::size_t count = value.size() / lanes_.count;
    return value.at(count == 1 ? lane : lane * count + i);
  }

  /// A value of `count` numbers in each lane.
  template <class NumberOf>
  Numbers each(std::size_t count, NumberOf&& numberOf) const {
    Numbers value;
    value.reserve(lanes_.count * count);
    for (std::size_t lane = 0; lane < lanes_.count; ++lane) {
      for (std::size_t i = 0; i < count; ++i) value.push_back(numberOf(lane, i));
    }
    return value;
  }

  Numbers of(Frame& frame, const Expr& expr) {
    tick();
    Numbers result = node(frame, expr);
    const auto isKnown = [&](double value) { return isRepresentable(expr.type.scalar, value); };
    if (expr.type.isLong() && !std::ranges::all_of(result, isKnown)) throw CannotInterpret{};
    return result;
  }

  Numbers node(Frame& frame, const Expr& expr) {
    if (const Expr* base = baseOf(expr)) return part(frame, expr, of(frame, *base));
    return match(
        expr.node, [&](const Literal& n) { return Numbers(lanes_.count, valueOf(expr.type.scalar, n)); },
        [&](const VarRef& n) { return frame.variables.at(n.var); },
        [&](const ConstantRef& n) { return constant(*module_.constants[n.constant].value); },
        [&](const Unary& n) {
          Numbers value = of(frame, *n.operand);
          for (double& v : value) v = computed(n.op, n.operand->type.scalar, v);
          return value;
        },
        [&](const Binary& n) { return binaryOf(frame, n); },
        [&](const Select& n) { return select(frame, n, size(expr.type)); },
        [&](const Convert& n) {
          Numbers value = of(frame, *n.operand);
          for (double& v : value) v = toScalar(n.operand->type.scalar, expr.type.scalar, v);
          return value;
        },
        [&](const Construct& n) { return construct(frame, n, size(expr.type)); },
        [](const Swizzle&) -> Numbers { throw CannotInterpret{}; },  // parts
        [](const Member&) -> Numbers { throw CannotInterpret{}; },
        [](const Index&) -> Numbers { throw CannotInterpret{}; },
        [&](const Call& n) {
          std::vector<Numbers> arguments;
          for (const ExprPtr& arg : n.args) arguments.push_back(of(frame, *arg));
          Numbers result;
          call(n.callee, std::move(arguments), result);
          return result;
        },
        [&](const IntrinsicCall& n) { return intrinsic(frame, n, expr.type); },
        [&](const GatherRead& n) { return read(n.stream, of(frame, *n.index), false); },
        [&](const NeighborRead& n) { return read(n.stream, of(frame, *n.offset), true); },
        [&](const Sample& n) { return read(n.stream, of(frame, *n.position), false); },  // any value does
        [&](const IndexOf&) {
          return each(4, [&](std::size_t lane, std::size_t i) { return double(indexOf(lane)[i]); });
        },
        [&](const ExtentOf&) {
          return each(4, [&](std::size_t, std::size_t i) { return double(streams_.extent[i]); });
        });
  }

  InterpretedStreams::Index indexOf(std::size_t lane) const {
    InterpretedStreams::Index index = streams_.index;
    index[0] += static_cast<std::int64_t>(lane);
    return index;
  }

  /// The elements at an index, or at an offset from the lane's own.
  Numbers read(const StreamRef& stream, const Numbers& at, bool isOffset) const {
    if (stream.space != StreamRef::Space::KernelParameter || !streams_.read) throw CannotInterpret{};
    Numbers all;
    const std::size_t rank = at.size() / lanes_.count;
    for (std::size_t lane = 0; lane < lanes_.count; ++lane) {
      InterpretedStreams::Index index = isOffset ? indexOf(lane) : InterpretedStreams::Index{};
      for (std::size_t i = 0; i < rank; ++i) {
        const double number = at[lane * rank + i];
        if (!(std::fabs(number) < 2147483648.0)) throw CannotInterpret{};
        index[i] += static_cast<std::int64_t>(std::floor(number));
      }
      const Numbers element = streams_.read(stream.id, index);
      all.insert(all.end(), element.begin(), element.end());
    }
    return all;
  }

  Numbers binaryOf(Frame& frame, const Binary& n) {
    Numbers a = of(frame, *n.lhs);
    const bool mayDecide = !lanes_.inFull && a.size() == 1;
    if (mayDecide && n.op == BinaryOp::LogicalAnd && a[0] == 0) return {0};
    if (mayDecide && n.op == BinaryOp::LogicalOr && a[0] != 0) return {1};
    return binary(n.op, n.lhs->type, n.rhs->type, a, of(frame, *n.rhs));
  }

  Numbers binary(BinaryOp op, Type left, Type right, const Numbers& a, const Numbers& b) const {
    if (op == BinaryOp::Mul && left.isMatrix() && !right.isScalar()) return product(left.width, a, b);
    return each(std::max(a.size(), b.size()) / lanes_.count, [&](std::size_t lane, std::size_t i) {
      const std::optional<double> result =
          computed(op, left.scalar, component(a, lane, i), component(b, lane, i));
      if (!result || !isRepresentable(left.scalar, *result)) throw CannotInterpret{};
      return *result;
    });
  }

  /// Multiplies a matrix, stored by rows, by a matrix or a column vector.
  Numbers product(std::size_t width, const Numbers& a, const Numbers& b) const {
    const std::size_t columns = b.size() / lanes_.count / width;
    return each(width * columns, [&](std::size_t lane, std::size_t i) {
      double sum = 0;
      for (std::size_t k = 0; k < width; ++k)
        sum += component(a, lane, i / columns * width + k) * component(b, lane, k * columns + i % columns);
      return sum;
    });
  }

  Numbers select(Frame& frame, const Select& n, std::size_t count) {
    const Numbers cond = of(frame, *n.cond);
    if (!lanes_.inFull && cond.size() == 1) return of(frame, cond[0] != 0 ? *n.yes : *n.no);
    const Numbers yes = of(frame, *n.yes), no = of(frame, *n.no);
    return each(count, [&](std::size_t lane, std::size_t i) {
      return component(component(cond, lane, i) != 0 ? yes : no, lane, i);
    });
  }

  Numbers construct(Frame& frame, const Construct& n, std::size_t count) {
    std::vector<Numbers> args;
    std::size_t given = 0;
    for (const ExprPtr& arg : n.args) given += args.emplace_back(of(frame, *arg)).size() / lanes_.count;
    if (given == 1)
      return each(count, [&](std::size_t lane, std::size_t) { return component(args[0], lane, 0); });
    if (given != count) throw CannotInterpret{};
    Numbers value;
    for (std::size_t lane = 0; lane < lanes_.count; ++lane) {
      for (const Numbers& arg : args) {
        const auto size = static_cast<std::ptrdiff_t>(arg.size() / lanes_.count);
        const auto first = arg.begin() + static_cast<std::ptrdiff_t>(lane) * size;
        value.insert(value.end(), first, first + size);
      }
    }
    return value;
  }

  Numbers dot(const Numbers& a, const Numbers& b) const {
    return each(1, [&](std::size_t lane, std::size_t) {
      double sum = 0;
      for (std::size_t i = 0; i < a.size() / lanes_.count; ++i)
        sum += component(a, lane, i) * component(b, lane, i);
      return sum;
    });
  }
  Numbers length(const Numbers& a) const {
    Numbers squares = dot(a, a);
    for (double& v : squares) v = std::sqrt(v);
    return squares;
  }

  /// An intrinsic that does not compute each component by itself.
  std::optional<Numbers> combined(Intrinsic intrinsic, const std::vector<Numbers>& args) const {
    const Numbers &a = args.front(), &b = args.back();
    const std::size_t width = a.size() / lanes_.count;
    const auto isSet = [](double v) { return v != 0; };
    const auto componentsSet = [&](std::size_t lane) {
      const auto first = a.begin() + static_cast<std::ptrdiff_t>(lane * width);
      return static_cast<std::size_t>(
          std::count_if(first, first + static_cast<std::ptrdiff_t>(width), isSet));
    };
    switch (intrinsic) {
      case Intrinsic::AnyLane: return Numbers(lanes_.count, double(std::ranges::any_of(a, isSet)));
      case Intrinsic::Any:
        return each(1, [&](std::size_t lane, std::size_t) { return double(componentsSet(lane) > 0); });
      case Intrinsic::All:
        return each(1, [&](std::size_t lane, std::size_t) { return double(componentsSet(lane) == width); });
      case Intrinsic::Dot: return dot(a, b);
      case Intrinsic::Length: return length(a);
      case Intrinsic::Distance:
        return length(each(width, [&](std::size_t lane, std::size_t i) {
          return component(a, lane, i) - component(b, lane, i);
        }));
      case Intrinsic::Normalize: {
        const Numbers lengths = length(a);
        return each(width, [&](std::size_t lane, std::size_t i) {
          return lengths[lane] == 0 ? 0 : component(a, lane, i) / lengths[lane];
        });
      }
      case Intrinsic::Cross:
        return each(3, [&](std::size_t lane, std::size_t i) {
          const std::size_t j = (i + 1) % 3, k = (i + 2) % 3;
          return component(a, lane, j) * component(b, lane, k) -
                 component(a, lane, k) * component(b, lane, j);
        });
      default: return std::nullopt;
    }
  }

  Numbers intrinsic(Frame& frame, const IntrinsicCall& n, Type type) {
    std::vector<Numbers> args;
    for (const ExprPtr& arg : n.args) args.push_back(of(frame, *arg));
    if (std::optional<Numbers> value = combined(n.intrinsic, args)) return std::move(*value);
    const Scalar scalar = n.args.front()->type.scalar;
    return each(size(type), [&](std::size_t lane, std::size_t i) {
      const auto at = [&](std::size_t arg) {
        return arg < args.size() ? component(args[arg], lane, i) : 0.0;
      };
      std::optional<double> v = computed(n.intrinsic, scalar, at(0), at(1), at(2));
      if (!v) v = inDouble(n.intrinsic, at(0), at(1), at(2));
      if (!v) throw CannotInterpret{};
      return *v;
    });
  }

  const Module& module_;
  const InterpretedStreams& streams_;
  const InterpretedLanes& lanes_;
  int& steps_;
  int depth_ = 0;
};

}  // namespace

namespace {

/// What `run` returns; nullopt if something has no value here.
template <class Run>
auto unlessImpossible(Run&& run) -> std::optional<decltype(run())> {
  try {
    return run();
  } catch (const CannotInterpret&) {
    return std::nullopt;
  } catch (const std::out_of_range&) {
    return std::nullopt;
  }
}

}  // namespace

std::optional<std::vector<Numbers>> interpret(const Module& module, FunctionId id,
                                              std::vector<Numbers> arguments,
                                              const InterpretedStreams& streams, int& steps,
                                              const InterpretedLanes& lanes) {
  return unlessImpossible(
      [&] { return Interpreter(module, streams, lanes, steps).call(id, std::move(arguments)); });
}

std::optional<Numbers> interpretConstant(const Module& module, const Expr& expr) {
  int steps = 20'000;
  return unlessImpossible([&] { return Interpreter(module, {}, {}, steps).constant(expr); });
}

}  // namespace skc
