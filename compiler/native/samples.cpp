// SPDX-License-Identifier: MIT
//
// Linear interpolation between the elements of a gather.
#include <llvm/IR/Intrinsics.h>

#include "native/arithmetic.hpp"
#include "native/intrinsic_functions.hpp"
#include "native/streams.hpp"

namespace skc::native {

using namespace ir;

/// Interpolates along `dimensions` dimensions, the last one first. Ignores neighbours with a weight of 0,
/// even NaN.
Parts Streams::weighted(std::uint32_t param, const Parts& low, const Parts& weights, std::size_t dimensions) {
  if (dimensions == 0) {
    const Parts element = gather(param, low);
    Parts parts;
    for (std::size_t c = 0; c < element.size(); ++c) {
      parts.push_back(convert(l, scalars(param)[c], arithmeticScalar(scalars(param)[c]), element[c]));
    }
    return parts;
  }
  const std::size_t d = dimensions - 1;
  Parts high = low;
  high[d] = binary(l, BinaryOp::Add, Scalar::Int, low[d], {l.integer(l.int32(), 1)});
  const Parts a = weighted(param, low, weights, d);
  const Parts c = weighted(param, high, weights, d);
  const Part& t = weights[d];
  const auto number = [&](double value) { return Part{l.number(l.real(), value)}; };
  const auto real = [&](BinaryOp op, const Part& x, const Part& y) {
    return binary(l, op, Scalar::Float, x, y);
  };
  const Part isLow = real(BinaryOp::LessEqual, t, number(0));
  const Part isHigh = real(BinaryOp::GreaterEqual, t, number(1));
  const Part rest = real(BinaryOp::Sub, number(1), t);
  Parts parts;
  for (std::size_t i = 0; i < a.size(); ++i) {
    const Part between = real(BinaryOp::Add, real(BinaryOp::Mul, a[i], rest), real(BinaryOp::Mul, c[i], t));
    parts.push_back(l.select(isLow, a[i], l.select(isHigh, c[i], between)));
  }
  return parts;
}

Parts Streams::sample(std::uint32_t param, const Parts& position) {
  Parts low, weights;
  for (const Part& x : position) {
    const Part whole = floorOf(l, x);
    const Part size = {l.b.CreateUnaryIntrinsic(llvm::Intrinsic::fabs, x.value)};
    const Part isWhole =
        binary(l, BinaryOp::GreaterEqual, Scalar::Float, size, {l.number(l.real(), 16777216)});
    low.push_back(toIndex(l, whole));
    // infinity has no fraction; other numbers of this size have a fraction of 0
    weights.push_back(
        l.select(isWhole, {l.number(l.real(), 0)}, binary(l, BinaryOp::Sub, Scalar::Float, x, whole)));
  }
  return weighted(param, low, weights, position.size());
}

}  // namespace skc::native
