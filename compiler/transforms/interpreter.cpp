// SPDX-License-Identifier: MIT
#include "transforms/interpreter.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <numbers>
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
    case Intrinsic::Fma: return x * y + z;
    default: return std::nullopt;
  }
}

class Interpreter {
 public:
  Interpreter(const Module& module, const InterpretedStreams& streams, int& steps)
      : module_(module), streams_(streams), steps_(steps) {}

  std::vector<Numbers> call(FunctionId id, std::vector<Numbers> arguments) {
    Numbers result;
    return call(id, std::move(arguments), result);
  }

  Numbers constant(const Expr& expr) {
    Frame frame{nullptr, {}, {}};
    return of(frame, expr);
  }

 private:
  enum class Flow : std::uint8_t { Next, Break, Continue, Return };
  struct Frame {
    const Function* function;
    std::vector<Numbers> variables;
    Numbers result;
  };

  void tick() {
    if (steps_-- <= 0) throw CannotInterpret{};
  }

  std::size_t size(Type type) const {
    const std::uint64_t count = scalarCount(module_, type);
    if (count > 256) throw CannotInterpret{};
    return static_cast<std::size_t>(count);
  }

  std::vector<Numbers> call(FunctionId id, std::vector<Numbers> arguments, Numbers& result) {
    if (++depth_ > 32) throw CannotInterpret{};
    Frame frame{&module_.functions[id], std::move(arguments), {}};
    for (std::size_t i = frame.variables.size(); i < frame.function->variables.size(); ++i) {
      frame.variables.emplace_back(size(frame.function->variables[i].type), 0.0);
    }
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
          const std::size_t count = size(frame.function->variables[n.var].type);
          frame.variables[n.var] = n.init ? of(frame, *n.init) : Numbers(count, 0.0);
          return Flow::Next;
        },
        [&](const Assign& n) {
          Numbers value = of(frame, *n.value);
          if (n.op) value = binary(*n.op, n.place->type, n.value->type, of(frame, *n.place), value);
          store(frame, *n.place, value);
          return Flow::Next;
        },
        [&](const CallStmt& n) { return callStatement(frame, n); },
        [&](const If& n) { return block(frame, of(frame, *n.cond)[0] != 0 ? n.then : n.otherwise); },
        [&](const Loop& n) { return loop(frame, n); }, [&](const Switch& n) { return choice(frame, n); },
        [](const Break&) { return Flow::Break; }, [](const Continue&) { return Flow::Continue; },
        [&](const Return& n) {
          if (n.value) frame.result = of(frame, *n.value);
          return Flow::Return;
        },
        [&](const Scope& n) { return block(frame, n.body); },
        [](const Push&) -> Flow { throw CannotInterpret{}; },
        [](const Scatter&) -> Flow { throw CannotInterpret{}; });
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
    if (n.result) store(frame, *n.result, result);
    return Flow::Next;
  }

  Flow loop(Frame& frame, const Loop& n) {
    block(frame, n.init);
    const auto holds = [&] { return !n.cond || of(frame, *n.cond)[0] != 0; };
    for (bool isFirst = true;; isFirst = false) {
      tick();
      const bool asks = n.kind != LoopKind::DoWhile || !isFirst;
      if (asks && !holds()) return Flow::Next;
      const Flow flow = block(frame, n.body);
      if (flow == Flow::Break) return Flow::Next;
      if (flow == Flow::Return) return flow;
      block(frame, n.step);
    }
  }

  Flow choice(Frame& frame, const Switch& n) {
    const auto value = static_cast<std::int64_t>(of(frame, *n.value)[0]);
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

  // ---- lvalues ------------------------------------------------------------------------------------

  /// A variable, and the positions of an lvalue's numbers in it.
  struct Slots {
    VarId var;
    std::vector<std::size_t> numbers;
  };

  static std::vector<std::size_t> some(const std::vector<std::size_t>& all, std::size_t from,
                                       std::size_t count) {
    return {all.begin() + static_cast<std::ptrdiff_t>(from),
            all.begin() + static_cast<std::ptrdiff_t>(from + count)};
  }

  Slots slots(Frame& frame, const Expr& place) {
    if (const auto* n = std::get_if<VarRef>(&place.node)) {
      Slots all{n->var, {}};
      for (std::size_t i = 0; i < frame.variables[n->var].size(); ++i) all.numbers.push_back(i);
      return all;
    }
    if (const auto* n = std::get_if<Member>(&place.node)) {
      Slots base = slots(frame, *n->base);
      base.numbers = some(base.numbers, scalarOffset(module_, n->base->type, n->field), size(place.type));
      return base;
    }
    if (const auto* n = std::get_if<Index>(&place.node)) {
      Slots base = slots(frame, *n->base);
      const std::size_t count = size(place.type);
      base.numbers = some(base.numbers, indexed(frame, *n, base.numbers.size()), count);
      return base;
    }
    if (const auto* n = std::get_if<Swizzle>(&place.node)) {
      Slots base = slots(frame, *n->base);
      std::vector<std::size_t> chosen;
      for (const std::uint8_t component : n->components) chosen.push_back(base.numbers[component]);
      base.numbers = std::move(chosen);
      return base;
    }
    throw CannotInterpret{};
  }

  /// Where the indexed part begins; an index outside is clamped.
  std::size_t indexed(Frame& frame, const Index& n, std::size_t total) {
    const std::size_t count =
        size(n.base->type.kind == Type::Kind::Array ? module_.arrays[n.base->type.index].element
                                                    : n.base->type.indexed());
    const auto last = static_cast<double>(total / count) - 1;
    return static_cast<std::size_t>(std::clamp(of(frame, *n.index)[0], 0.0, last)) * count;
  }

  void store(Frame& frame, const Expr& place, const Numbers& value) {
    store(frame, slots(frame, place), value);
  }
  static void store(Frame& frame, const Slots& at, const Numbers& value) {
    for (std::size_t i = 0; i < at.numbers.size(); ++i) {
      frame.variables[at.var][at.numbers[i]] = value.size() == 1 ? value[0] : value.at(i);
    }
  }

  // ---- expressions --------------------------------------------------------------------------------

  Numbers of(Frame& frame, const Expr& expr) {
    tick();
    return match(
        expr.node, [&](const Literal& n) { return Numbers{valueOf(expr.type.scalar, n)}; },
        [&](const VarRef& n) { return frame.variables.at(n.var); },
        [&](const ConstantRef& n) { return constant(*module_.constants[n.constant].value); },
        [&](const Unary& n) { return unary(n, of(frame, *n.operand)); },
        [&](const Binary& n) { return binaryOf(frame, n); },
        [&](const Select& n) { return select(frame, n); },
        [&](const Convert& n) {
          Numbers value = of(frame, *n.operand);
          for (double& v : value) v = toScalar(n.operand->type.scalar, expr.type.scalar, v);
          return value;
        },
        [&](const Construct& n) { return construct(frame, n, expr.type); },
        [&](const Swizzle& n) {
          const Numbers base = of(frame, *n.base);
          Numbers value;
          for (const std::uint8_t component : n.components) value.push_back(base[component]);
          return value;
        },
        [&](const Member& n) {
          return part(of(frame, *n.base), scalarOffset(module_, n.base->type, n.field), expr.type);
        },
        [&](const Index& n) {
          const Numbers base = of(frame, *n.base);
          return part(base, indexed(frame, n, base.size()), expr.type);
        },
        [&](const Call& n) {
          std::vector<Numbers> arguments;
          for (const ExprPtr& arg : n.args) arguments.push_back(of(frame, *arg));
          Numbers result;
          call(n.callee, std::move(arguments), result);
          return result;
        },
        [&](const IntrinsicCall& n) { return intrinsic(frame, n, expr.type); },
        [&](const GatherRead& n) { return read(n.stream, of(frame, *n.index), {}); },
        [&](const NeighborRead& n) { return read(n.stream, of(frame, *n.offset), streams_.index); },
        [&](const Sample& n) { return read(n.stream, of(frame, *n.position), {}); },  // any value does
        [&](const IndexOf&) { return Numbers(streams_.index.begin(), streams_.index.end()); },
        [&](const ExtentOf&) { return Numbers(streams_.extent.begin(), streams_.extent.end()); });
  }

  /// The element at an index, from an origin.
  Numbers read(const StreamRef& stream, const Numbers& at, InterpretedStreams::Index index) const {
    if (stream.space != StreamRef::Space::KernelParameter || !streams_.read) throw CannotInterpret{};
    for (std::size_t i = 0; i < at.size(); ++i) {
      if (!(std::fabs(at[i]) < 2147483648.0)) throw CannotInterpret{};
      index[i] += static_cast<std::int64_t>(std::floor(at[i]));
    }
    return streams_.read(stream.id, index);
  }

  Numbers part(const Numbers& all, std::size_t from, Type type) const {
    const auto begin = all.begin() + static_cast<std::ptrdiff_t>(from);
    return {begin, begin + static_cast<std::ptrdiff_t>(size(type))};
  }

  static Numbers unary(const Unary& n, Numbers value) {
    for (double& v : value) v = computed(n.op, n.operand->type.scalar, v);
    return value;
  }

  Numbers binaryOf(Frame& frame, const Binary& n) {
    Numbers a = of(frame, *n.lhs);
    if (n.op == BinaryOp::LogicalAnd && a.size() == 1 && a[0] == 0) return {0};
    if (n.op == BinaryOp::LogicalOr && a.size() == 1 && a[0] != 0) return {1};
    return binary(n.op, n.lhs->type, n.rhs->type, a, of(frame, *n.rhs));
  }

  static Numbers binary(BinaryOp op, Type left, Type right, const Numbers& a, const Numbers& b) {
    if (op == BinaryOp::Mul && left.isMatrix() && !right.isScalar()) return product(left.width, a, b);
    Numbers value(std::max(a.size(), b.size()));
    for (std::size_t i = 0; i < value.size(); ++i) {
      const double x = a.size() == 1 ? a[0] : a.at(i), y = b.size() == 1 ? b[0] : b.at(i);
      const std::optional<double> result = computed(op, left.scalar, x, y);
      if (!result) throw CannotInterpret{};
      value[i] = *result;
    }
    return value;
  }

  /// Multiplies a matrix, stored by rows, by a matrix or a column vector.
  static Numbers product(std::size_t width, const Numbers& a, const Numbers& b) {
    const std::size_t columns = b.size() / width;
    Numbers value(width * columns, 0.0);
    for (std::size_t row = 0; row < width; ++row) {
      for (std::size_t column = 0; column < columns; ++column) {
        for (std::size_t k = 0; k < width; ++k)
          value[row * columns + column] += a[row * width + k] * b[k * columns + column];
      }
    }
    return value;
  }

  Numbers select(Frame& frame, const Select& n) {
    const Numbers cond = of(frame, *n.cond);
    if (cond.size() == 1) return of(frame, cond[0] != 0 ? *n.yes : *n.no);
    const Numbers yes = of(frame, *n.yes);
    Numbers value = of(frame, *n.no);
    for (std::size_t i = 0; i < value.size(); ++i) value[i] = cond.at(i) != 0 ? yes.at(i) : value[i];
    return value;
  }

  Numbers construct(Frame& frame, const Construct& n, Type type) {
    Numbers value;
    for (const ExprPtr& arg : n.args) {
      const Numbers numbers = of(frame, *arg);
      value.insert(value.end(), numbers.begin(), numbers.end());
    }
    if (value.size() == 1) value.resize(size(type), value[0]);
    if (value.size() != size(type)) throw CannotInterpret{};
    return value;
  }

  Numbers intrinsic(Frame& frame, const IntrinsicCall& n, Type type) {
    std::vector<Numbers> args;
    for (const ExprPtr& arg : n.args) args.push_back(of(frame, *arg));
    const auto dot = [](const Numbers& a, const Numbers& b) {
      double sum = 0;
      for (std::size_t i = 0; i < a.size(); ++i) sum += a[i] * b[i];
      return sum;
    };
    if (n.intrinsic == Intrinsic::Dot) return {dot(args[0], args[1])};
    if (n.intrinsic == Intrinsic::Length) return {std::sqrt(dot(args[0], args[0]))};
    if (n.intrinsic == Intrinsic::Distance) {
      for (std::size_t i = 0; i < args[0].size(); ++i) args[0][i] -= args[1].at(i);
      return {std::sqrt(dot(args[0], args[0]))};
    }
    if (n.intrinsic == Intrinsic::Normalize) {
      const double length = std::sqrt(dot(args[0], args[0]));
      for (double& v : args[0]) v = length == 0 ? 0 : v / length;
      return args[0];
    }
    if (n.intrinsic == Intrinsic::Cross) {
      const Numbers &a = args[0], &b = args[1];
      return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
    }
    if (n.intrinsic == Intrinsic::Any)
      return {std::ranges::any_of(args[0], [](double v) { return v != 0; }) ? 1.0 : 0.0};
    if (n.intrinsic == Intrinsic::All)
      return {std::ranges::all_of(args[0], [](double v) { return v != 0; }) ? 1.0 : 0.0};
    Numbers value(size(type));
    for (std::size_t i = 0; i < value.size(); ++i) {
      const auto at = [&](std::size_t arg) {
        if (arg >= args.size()) return 0.0;
        return args[arg].size() == 1 ? args[arg][0] : args[arg].at(i);
      };
      const Scalar scalar = n.args.front()->type.scalar;
      std::optional<double> v = computed(n.intrinsic, scalar, at(0), at(1), at(2));
      if (!v) v = inDouble(n.intrinsic, at(0), at(1), at(2));
      if (!v) throw CannotInterpret{};
      value[i] = *v;
    }
    return value;
  }

  const Module& module_;
  const InterpretedStreams& streams_;
  int& steps_;
  int depth_ = 0;
};

}  // namespace

std::optional<std::vector<Numbers>> interpret(const Module& module, FunctionId id,
                                              std::vector<Numbers> arguments,
                                              const InterpretedStreams& streams, int& steps) {
  try {
    return Interpreter(module, streams, steps).call(id, std::move(arguments));
  } catch (const CannotInterpret&) {
    return std::nullopt;
  } catch (const std::out_of_range&) {
    return std::nullopt;
  }
}

std::optional<Numbers> interpretConstant(const Module& module, const Expr& expr) {
  try {
    int steps = 20'000;
    return Interpreter(module, {}, steps).constant(expr);
  } catch (const CannotInterpret&) {
    return std::nullopt;
  } catch (const std::out_of_range&) {
    return std::nullopt;
  }
}

}  // namespace skc
