// SPDX-License-Identifier: MIT
//
// Intrinsics as operations: those of single numbers, and those of vectors and matrices as native code computes them.
#include <fmt/format.h>

#include "bounds/executor.hpp"
#include "ir/scalar_operations.hpp"

namespace skc::bounds {

using namespace ir;

Numbers Executor::intrinsic(Frame& frame, const Path& path, const IntrinsicCall& n, Type type) {
  std::vector<Numbers> args;
  for (const ExprPtr& arg : n.args) args.push_back(of(frame, path, *arg));
  const Scalar scalar = n.args.front()->type.scalar;
  if (std::optional<Numbers> value = combined(n.intrinsic, scalar, args)) return std::move(*value);
  Numbers value;
  for (std::size_t i = 0; i < size(type); ++i) {
    const auto at = [&](std::size_t k) {
      if (k >= args.size()) return noNode;
      return args[k].size() == 1 ? args[k][0] : args[k].at(i);
    };
    value.push_back(component(n.intrinsic, scalar, at(0), at(1), at(2)));
  }
  return value;
}

// ---- vectors and matrices -------------------------------------------------------------------------

NodeId Executor::dot(Scalar type, const Numbers& a, const Numbers& b) {
  NodeId sum = arithmetic_.multiply(type, a[0], b[0]);
  for (std::size_t i = 1; i < a.size(); ++i)
    sum = arithmetic_.add(type, sum, arithmetic_.multiply(type, a[i], b[i]));
  return sum;
}

NodeId Executor::determinant(Scalar type, const Numbers& m, std::size_t n) {
  if (n == 1) return m[0];
  Arithmetic& f = arithmetic_;
  if (n == 2) return f.subtract(type, f.multiply(type, m[0], m[3]), f.multiply(type, m[1], m[2]));
  NodeId sum = f.number(0);
  for (std::size_t k = 0; k < n; ++k) {
    Numbers minor;
    for (std::size_t i = 1; i < n; ++i) {
      for (std::size_t c = 0; c < n; ++c) {
        if (c != k) minor.push_back(m[i * n + c]);
      }
    }
    const NodeId term = f.multiply(type, m[k], determinant(type, minor, n - 1));
    sum = k % 2 == 0 ? f.add(type, sum, term) : f.subtract(type, sum, term);
  }
  return sum;
}

Numbers Executor::inverse(Scalar type, const Numbers& m, std::size_t n) {
  const NodeId whole = determinant(type, m, n);
  Numbers result(m.size());
  for (std::size_t i = 0; i < n; ++i) {
    for (std::size_t k = 0; k < n; ++k) {
      Numbers minor;
      for (std::size_t r = 0; r < n; ++r) {
        for (std::size_t c = 0; c < n; ++c) {
          if (r != i && c != k) minor.push_back(m[r * n + c]);
        }
      }
      const NodeId cofactor = determinant(type, minor, n - 1);
      const NodeId signedOne = (i + k) % 2 == 0 ? cofactor : arithmetic_.negate(type, cofactor);
      result[k * n + i] = arithmetic_.divide(type, signedOne, whole);
    }
  }
  return result;
}

/// An intrinsic that does not compute each component by itself.
std::optional<Numbers> Executor::combined(Intrinsic intrinsic, Scalar type,
                                          const std::vector<Numbers>& args) {
  Arithmetic& f = arithmetic_;
  const Numbers& a = args.front();
  const Numbers& b = args.size() > 1 ? args[1] : a;
  const auto minus = [&](const Numbers& x, const Numbers& y) {
    Numbers result;
    for (std::size_t i = 0; i < x.size(); ++i) result.push_back(f.subtract(type, x[i], y[i]));
    return result;
  };
  const auto times = [&](const Numbers& x, NodeId factor) {
    Numbers result;
    for (const NodeId number : x) result.push_back(f.multiply(type, number, factor));
    return result;
  };
  const auto length = [&](const Numbers& x) { return f.call(type, UnaryFunction::Sqrt, dot(type, x, x)); };
  const auto side = [](std::size_t count) -> std::size_t { return count == 4 ? 2 : count == 9 ? 3 : 4; };
  switch (intrinsic) {
    case Intrinsic::Dot: return Numbers{dot(type, a, b)};
    case Intrinsic::Length: return Numbers{length(a)};
    case Intrinsic::Distance: return Numbers{length(minus(a, b))};
    case Intrinsic::Normalize: {
      const NodeId root = length(a);
      Numbers result;
      for (const NodeId number : a) result.push_back(f.divide(type, number, root));
      return result;
    }
    case Intrinsic::Cross: {
      const auto minor = [&](std::size_t i, std::size_t k) {
        return f.subtract(type, f.multiply(type, a[i], b[k]), f.multiply(type, b[i], a[k]));
      };
      return Numbers{minor(1, 2), minor(2, 0), minor(0, 1)};
    }
    case Intrinsic::Faceforward: {
      const NodeId isAgainst = f.less(dot(type, args[2], b), f.number(0));
      Numbers result;
      for (const NodeId number : a) result.push_back(f.select(isAgainst, number, f.negate(type, number)));
      return result;
    }
    case Intrinsic::Reflect: {
      const NodeId product = dot(type, b, a);
      return minus(a, times(b, f.multiply(type, f.number(2), product)));
    }
    case Intrinsic::Refract: {
      const NodeId eta = args[2][0], d = dot(type, b, a), one = f.number(1);
      const NodeId rest = f.subtract(type, one, f.multiply(type, d, d));
      const NodeId k = f.subtract(type, one, f.multiply(type, f.multiply(type, eta, eta), rest));
      const NodeId factor = f.add(type, f.multiply(type, eta, d), f.call(type, UnaryFunction::Sqrt, k));
      Numbers result = minus(times(a, eta), times(b, factor));
      for (NodeId& number : result) number = f.select(f.less(k, f.number(0)), f.number(0), number);
      return result;
    }
    case Intrinsic::Transpose: {
      const std::size_t n = side(a.size());
      Numbers result;
      for (std::size_t i = 0; i < a.size(); ++i) result.push_back(a[i % n * n + i / n]);
      return result;
    }
    case Intrinsic::Determinant: return Numbers{determinant(type, a, side(a.size()))};
    case Intrinsic::Inverse: return inverse(type, a, side(a.size()));
    case Intrinsic::Any:
    case Intrinsic::All: {
      const bool isAny = intrinsic == Intrinsic::Any;
      NodeId result = graph_.truth(!isAny);
      for (const NodeId number : a) {
        const NodeId one = graph_.condition(number);
        result = isAny ? graph_.disjunction(result, one) : graph_.conjunction(result, one);
      }
      return Numbers{result};
    }
    case Intrinsic::AnyLane: return a;
    default: return std::nullopt;
  }
}

// ---- single numbers -------------------------------------------------------------------------------

namespace {

std::optional<UnaryFunction> functionOf(Intrinsic intrinsic) {
  switch (intrinsic) {
    case Intrinsic::Radians: return UnaryFunction::Radians;
    case Intrinsic::Degrees: return UnaryFunction::Degrees;
    case Intrinsic::Sin: return UnaryFunction::Sin;
    case Intrinsic::Cos: return UnaryFunction::Cos;
    case Intrinsic::Tan: return UnaryFunction::Tan;
    case Intrinsic::Asin: return UnaryFunction::Asin;
    case Intrinsic::Acos: return UnaryFunction::Acos;
    case Intrinsic::Atan: return UnaryFunction::Atan;
    case Intrinsic::Sinh: return UnaryFunction::Sinh;
    case Intrinsic::Cosh: return UnaryFunction::Cosh;
    case Intrinsic::Tanh: return UnaryFunction::Tanh;
    case Intrinsic::Asinh: return UnaryFunction::Asinh;
    case Intrinsic::Acosh: return UnaryFunction::Acosh;
    case Intrinsic::Atanh: return UnaryFunction::Atanh;
    case Intrinsic::Exp: return UnaryFunction::Exp;
    case Intrinsic::Exp2: return UnaryFunction::Exp2;
    case Intrinsic::Expm1: return UnaryFunction::Expm1;
    case Intrinsic::Log: return UnaryFunction::Log;
    case Intrinsic::Log2: return UnaryFunction::Log2;
    case Intrinsic::Log10: return UnaryFunction::Log10;
    case Intrinsic::Log1p: return UnaryFunction::Log1p;
    case Intrinsic::Cbrt: return UnaryFunction::Cbrt;
    case Intrinsic::Erf: return UnaryFunction::Erf;
    case Intrinsic::Erfc: return UnaryFunction::Erfc;
    case Intrinsic::Sqrt: return UnaryFunction::Sqrt;
    case Intrinsic::InverseSqrt:
    case Intrinsic::Rsqrt: return UnaryFunction::InverseSqrt;
    default: return std::nullopt;
  }
}

}  // namespace

NodeId Executor::component(Intrinsic intrinsic, Scalar type, NodeId x, NodeId y, NodeId z) {
  Arithmetic& f = arithmetic_;
  const auto isKnown = [&](NodeId id) { return id == noNode || graph_.isExact(id); };
  if (isKnown(x) && isKnown(y) && isKnown(z)) {
    const auto value = [&](NodeId id) { return id == noNode ? 0 : graph_[id].value; };
    const std::optional<double> known = computed(intrinsic, type, value(x), value(y), value(z));
    if (known && std::isfinite(*known)) return f.number(type, *known);
  }
  if (const std::optional<UnaryFunction> function = functionOf(intrinsic)) return f.call(type, *function, x);
  const NodeId one = f.number(type, 1), zero = f.number(type, 0);
  const auto clamped = [&](NodeId number, NodeId low, NodeId high) {
    return f.minimum(type, f.maximum(type, number, low), high);
  };
  switch (intrinsic) {
    case Intrinsic::AtanYX:
    case Intrinsic::Atan2: return f.call(type, BinaryFunction::Atan2, x, y);
    case Intrinsic::Pow: return f.call(type, BinaryFunction::Pow, x, y);
    case Intrinsic::Hypot: return f.call(type, BinaryFunction::Hypot, x, y);
    case Intrinsic::Abs:
    case Intrinsic::Fabs: return f.absolute(type, x);
    case Intrinsic::Sign: {
      const NodeId below = f.select(f.less(x, zero), f.number(type, -1), zero);
      return f.select(f.less(zero, x), one, below);
    }
    case Intrinsic::Floor: return f.step(Op::Floor, type, x);
    case Intrinsic::Trunc: return f.step(Op::Truncate, type, x);
    case Intrinsic::Round:
    case Intrinsic::RoundEven: return f.step(Op::RoundEven, type, x);
    case Intrinsic::Ceil: return f.step(Op::Ceil, type, x);
    case Intrinsic::Fract:
    case Intrinsic::Frac: return f.fraction(type, x);
    case Intrinsic::Mod: return f.remainder(type, x, y, Op::Floor);
    case Intrinsic::Fmod: return f.remainder(type, x, y, Op::Truncate);
    case Intrinsic::Min:
    case Intrinsic::Fmin: return f.minimum(type, x, y);
    case Intrinsic::Max:
    case Intrinsic::Fmax: return f.maximum(type, x, y);
    case Intrinsic::Clamp: return clamped(x, y, z);
    case Intrinsic::Saturate: return clamped(x, zero, one);
    case Intrinsic::Mix:
    case Intrinsic::Lerp: {
      // The ends are exact, as they are here: their products are with 0 and 1.
      const NodeId rest = f.subtract(type, one, z);
      return f.add(type, f.multiply(type, x, rest), f.multiply(type, y, z));
    }
    case Intrinsic::MixBool: return f.select(z, y, x);
    case Intrinsic::Step: return f.select(f.less(y, x), zero, one);
    case Intrinsic::Smoothstep: {
      const NodeId t = clamped(f.divide(type, f.subtract(type, z, x), f.subtract(type, y, x)), zero, one);
      const NodeId rest = f.subtract(type, f.number(3), f.multiply(type, f.number(2), t));
      return f.multiply(type, f.multiply(type, t, t), rest);
    }
    case Intrinsic::Fma: return f.multiplyAdd(type, x, y, z);
    case Intrinsic::LessThan: return f.less(x, y);
    case Intrinsic::LessThanEqual: return f.lessEqual(x, y);
    case Intrinsic::GreaterThan: return f.less(y, x);
    case Intrinsic::GreaterThanEqual: return f.lessEqual(y, x);
    case Intrinsic::EqualTo: return binary(BinaryOp::Equal, type, x, y);
    case Intrinsic::NotEqualTo: return binary(BinaryOp::NotEqual, type, x, y);
    // Values are finite where there is a bound.
    case Intrinsic::Isnan:
    case Intrinsic::Isinf: return graph_.truth(false);
    case Intrinsic::Isfinite: return graph_.truth(true);
    case Intrinsic::ModfFraction: return f.subtract(type, x, f.step(Op::Truncate, type, x));
    case Intrinsic::Ldexp:
      if (graph_.isExact(y) && std::fabs(graph_[y].value) < 1000)
        return f.multiply(type, x, f.number(std::ldexp(1, static_cast<int>(graph_[y].value))));
      break;
    default: break;
  }
  throw NotBounded(fmt::format("the function {}", row(intrinsic).spelling.empty() ? row(intrinsic).name
                                                                                  : row(intrinsic).spelling),
                   f.loc());
}

}  // namespace skc::bounds
