// SPDX-License-Identifier: MIT
#include "native/intrinsic_functions.hpp"

namespace skc::native {

using namespace ir;

namespace {

Parts times(const ScalarBuilder& f, const Parts& a, const Part& factor) {
  Parts result;
  for (const Part& part : a) result.push_back(f.mul(part, factor));
  return result;
}

Part largest(const ScalarBuilder& f, const Parts& a) {
  Part most = f.abs(a[0]);
  for (std::size_t i = 1; i < a.size(); ++i) most = maximum(f, Scalar::Float, most, f.abs(a[i]));
  return most;
}

/// Powers of 2: vectors whose largest component is below `small`, or at least `large` or `huge`, are multiplied by `up`,
/// `down` or `farDown`. Then no square overflows, none that counts underflows, and no component becomes denormal whose part
/// of the length is not: the largest is at least 1 where it was multiplied by less.
struct LengthScales {
  const char *small, *up, *large, *down, *huge, *farDown;
};

LengthScales lengthScales(const Part& part) {
  const llvm::Type* const type = part.value->getType()->getScalarType();
  if (type->isFloatTy()) return {"0x1p-40", "0x1p86", "0x1p62", "0x1p-34", "0x1p95", "0x1p-66"};
  if (type->isDoubleTy()) return {"0x1p-400", "0x1p600", "0x1p500", "0x1p-300", "0x1p750", "0x1p-600"};
  return {"0x1p-8000", "0x1p8500", "0x1p8000", "0x1p-5000", "0x1p12000", "0x1p-9000"};
}

/// The power of 2 by which to multiply a vector with this largest component.
Part lengthScale(const ScalarBuilder& f, const Part& most) {
  const LengthScales scales = lengthScales(most);
  const Part small =
      f.select(f.less(most, f.decimal(most, scales.small)), f.decimal(most, scales.up), f.number(most, 1));
  const auto isAtLeast = [&](const char* number) {
    return binary(f.l, BinaryOp::GreaterEqual, Scalar::Float, most, f.decimal(most, number));
  };
  const Part down =
      f.select(isAtLeast(scales.huge), f.decimal(most, scales.farDown), f.decimal(most, scales.down));
  return f.select(isAtLeast(scales.large), down, small);
}

/// An n by n matrix in row-major order, without one row and one column.
Parts minorOf(const Parts& m, std::size_t n, std::size_t row, std::size_t column) {
  Parts part;
  for (std::size_t i = 0; i < n; ++i) {
    for (std::size_t k = 0; k < n; ++k) {
      if (i != row && k != column) part.push_back(m[i * n + k]);
    }
  }
  return part;
}

Part anyOrAll(const ScalarBuilder& f, bool isAny, const Parts& parts) {
  Part result = parts[0];
  for (std::size_t i = 1; i < parts.size(); ++i) {
    result = isAny ? f.either(result, parts[i]) : f.both(result, parts[i]);
  }
  return result;
}

}  // namespace

Parts minus(const ScalarBuilder& f, const Parts& a, const Parts& c) {
  Parts result;
  for (std::size_t i = 0; i < a.size(); ++i) result.push_back(f.sub(a[i], c[i]));
  return result;
}

Part dot(const ScalarBuilder& f, const Parts& a, const Parts& c) {
  Part sum = f.mul(a[0], c[0]);
  for (std::size_t i = 1; i < a.size(); ++i) sum = f.add(sum, f.mul(a[i], c[i]));
  return sum;
}

Part length(const ScalarBuilder& f, const Parts& a) {
  const Part most = largest(f, a);
  const Part scale = lengthScale(f, most);
  const Parts scaled = times(f, a, scale);
  return f.select(f.isInfinite(most), most, f.div(f.sqrt(dot(f, scaled, scaled)), scale));
}

Parts normalize(const ScalarBuilder& f, const Parts& a) {
  const Parts scaled = times(f, a, lengthScale(f, largest(f, a)));
  const Part square = dot(f, scaled, scaled);
  const Part isZero = f.equal(square, f.number(square, 0));
  const Part root = f.sqrt(square);
  Parts result;
  for (std::size_t i = 0; i < a.size(); ++i) result.push_back(f.select(isZero, a[i], f.div(scaled[i], root)));
  return result;
}

Parts cross(const ScalarBuilder& f, const Parts& a, const Parts& c) {
  const auto minor = [&](std::size_t i, std::size_t k) {
    return f.sub(f.mul(a[i], c[k]), f.mul(c[i], a[k]));
  };
  return {minor(1, 2), minor(2, 0), minor(0, 1)};
}

Parts faceforward(const ScalarBuilder& f, const Parts& n, const Parts& i, const Parts& reference) {
  const Part product = dot(f, reference, i);
  const Part isAgainst = f.less(product, f.number(product, 0));
  Parts result;
  for (const Part& part : n) result.push_back(f.select(isAgainst, part, f.negate(part)));
  return result;
}

Parts reflect(const ScalarBuilder& f, const Parts& i, const Parts& n) {
  const Part product = dot(f, n, i);
  return minus(f, i, times(f, n, f.mul(f.number(product, 2), product)));
}

Parts refract(const ScalarBuilder& f, const Parts& i, const Parts& n, const Part& eta) {
  const Part d = dot(f, n, i);
  const Part one = f.number(d, 1);
  const Part k = f.sub(one, f.mul(f.mul(eta, eta), f.sub(one, f.mul(d, d))));
  const Part isTotal = f.less(k, f.number(d, 0));
  const Parts all = minus(f, times(f, i, eta), times(f, n, f.add(f.mul(eta, d), f.sqrt(k))));
  Parts result;
  for (const Part& part : all) result.push_back(f.select(isTotal, f.number(d, 0), part));
  return result;
}

Parts transpose(const Parts& m, std::size_t n) {
  Parts result;
  for (std::size_t i = 0; i < n; ++i) {
    for (std::size_t k = 0; k < n; ++k) result.push_back(m[k * n + i]);
  }
  return result;
}

Part determinant(const ScalarBuilder& f, const Parts& m, std::size_t n) {
  if (n == 1) return m[0];
  if (n == 2) return f.sub(f.mul(m[0], m[3]), f.mul(m[1], m[2]));
  Part sum = f.number(m[0], 0);
  for (std::size_t k = 0; k < n; ++k) {
    const Part term = f.mul(m[k], determinant(f, minorOf(m, n, 0, k), n - 1));
    sum = k % 2 == 0 ? f.add(sum, term) : f.sub(sum, term);
  }
  return sum;
}

Parts inverse(const ScalarBuilder& f, const Parts& m, std::size_t n) {
  const Part d = determinant(f, m, n);
  Parts result(m.size());
  for (std::size_t i = 0; i < n; ++i) {
    for (std::size_t k = 0; k < n; ++k) {
      const Part cofactor = determinant(f, minorOf(m, n, i, k), n - 1);
      result[k * n + i] = f.div((i + k) % 2 == 0 ? cofactor : f.negate(cofactor), d);
    }
  }
  return result;
}

Part anyOf(const ScalarBuilder& f, const Parts& parts) { return anyOrAll(f, true, parts); }
Part allOf(const ScalarBuilder& f, const Parts& parts) { return anyOrAll(f, false, parts); }

}  // namespace skc::native
