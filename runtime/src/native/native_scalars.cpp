// SPDX-License-Identifier: MIT
//
// Operations with scalars on a native device: on the calling thread, with the arithmetic of native code.
#include <array>
#include <cmath>
#include <concepts>
#include <cstring>
#include <limits>
#include <type_traits>
#include <utility>
#include <vector>

#include "native/native_device.hpp"
#include "native/native_stream.hpp"
#include "sk/native/quad_type.hpp"

namespace sk {

namespace {

using detail::ScalarOp;

template <class F>
F squareRoot(F x) {
  return std::sqrt(x);
}
/// Newton's iteration from the root in doubles.
template <>
native::Quad squareRoot(native::Quad x) {
  const double start = std::sqrt(static_cast<double>(x));
  if (!(start > 0) || std::isinf(start)) return start;
  native::Quad root = start;
  for (int i = 0; i < 2; ++i) root = (root + x / root) / 2;
  return root;
}

template <class F>
bool isNegative(F x) {
  return x < 0 || (x == 0 && 1 / x < 0);
}

/// Computes an operation on floats or doubles.
template <class T>
T computeReal(ScalarOp op, T a, T b) {
  switch (op) {
    case ScalarOp::Copy: return a;
    case ScalarOp::Negate: return -a;
    case ScalarOp::Absolute: return isNegative(a) ? -a : a;
    case ScalarOp::SquareRoot: return squareRoot(a);
    case ScalarOp::Add: return a + b;
    case ScalarOp::Subtract: return a - b;
    case ScalarOp::Multiply: return a * b;
    case ScalarOp::Divide: return a / b;
    case ScalarOp::Minimum:
      if (a != a || b != b) return a != a ? b : a;
      return a < b || (a == b && isNegative(a)) ? a : b;
    case ScalarOp::Maximum:
      if (a != a || b != b) return a != a ? b : a;
      return a > b || (a == b && !isNegative(a)) ? a : b;
    default: return a;
  }
}

/// Wraps.
template <std::unsigned_integral T>
T computeUnsigned(ScalarOp op, T a, T b) {
  switch (op) {
    case ScalarOp::Negate: return 0 - a;
    case ScalarOp::Add: return a + b;
    case ScalarOp::Subtract: return a - b;
    case ScalarOp::Multiply: return a * b;
    case ScalarOp::Divide: return b == 0 ? a : a / b;
    case ScalarOp::Minimum: return a < b ? a : b;
    case ScalarOp::Maximum: return a > b ? a : b;
    default: return a;
  }
}

/// Wraps.
template <std::signed_integral T>
T computeSigned(ScalarOp op, T a, T b) {
  using Unsigned = std::make_unsigned_t<T>;
  switch (op) {
    case ScalarOp::Absolute: return a < 0 ? static_cast<T>(0 - static_cast<Unsigned>(a)) : a;
    case ScalarOp::Minimum: return a < b ? a : b;
    case ScalarOp::Maximum: return a > b ? a : b;
    case ScalarOp::Divide: return b == 0 || (b == -1 && a == std::numeric_limits<T>::min()) ? a : a / b;
    default: return static_cast<T>(computeUnsigned(op, static_cast<Unsigned>(a), static_cast<Unsigned>(b)));
  }
}

bool computeBool(ScalarOp op, bool a, bool b) {
  switch (op) {
    case ScalarOp::Not: return !a;
    case ScalarOp::And: return a && b;
    case ScalarOp::Or: return a || b;
    default: return a;
  }
}

/// Operations with scalars; comparisons are compare().
template <class T>
T compute(ScalarOp op, T a, T b) {
  if constexpr (std::same_as<T, bool>) {
    return computeBool(op, a, b);
  } else if constexpr (std::unsigned_integral<T>) {
    return computeUnsigned(op, a, b);
  } else if constexpr (std::signed_integral<T>) {
    return computeSigned(op, a, b);
  } else {
    return computeReal(op, a, b);
  }
}

template <class T>
bool compare(ScalarOp op, T a, T b) {
  return op == ScalarOp::Less ? a < b : op == ScalarOp::LessEqual ? a <= b : a == b;
}

/// A value of one of the types, as it is in an array of a stream.
struct ScalarValue {
  alignas(16) std::array<std::byte, 16> bytes{};

  template <class T>
  T as() const {
    T value;
    std::memcpy(&value, bytes.data(), sizeof value);
    return value;
  }
  template <class T>
  static ScalarValue of(T value) {
    ScalarValue made;
    std::memcpy(made.bytes.data(), &value, sizeof value);
    return made;
  }
};

/// The values of a pass, whose memory is kept between its runs.
struct ScalarValues {
  std::vector<ScalarValue> reads, steps;
};

/// `Float` and `Double` stand for a kernel's float and double.
template <class Float, class Double>
class Evaluation {
 public:
  Evaluation(const ScalarPass& pass, ScalarValues& values)
      : pass_(pass), reads_(values.reads), steps_(values.steps) {}

  void run() {
    reads_.clear();
    steps_.clear();
    for (const StreamRegion& read : pass_.reads) reads_.push_back(stored(read.stream));
    for (const ScalarStep& step : pass_.steps) steps_.push_back(valueOf(step));
    for (const ScalarPass::Output& output : pass_.outputs) {
      auto& stream = nativeStream({output.stream, {}, {}});
      std::memcpy(stream.components.arrays()[0], steps_[output.step].bytes.data(),
                  stream.components.types()[0].storedBytes);
      stream.setWritten();
    }
  }

 private:
  ScalarValue stored(StreamState* state) const {
    NativeStream& stream = nativeStream({state, {}, {}});
    ScalarValue value;
    std::memcpy(value.bytes.data(), stream.components.arrays()[0], stream.components.types()[0].storedBytes);
    return value;
  }

  ScalarValue operand(const ScalarRef& ref) const {
    switch (ref.kind) {
      case ScalarRef::Kind::Read: return reads_[ref.index];
      case ScalarRef::Kind::Step: return steps_[ref.index];
      case ScalarRef::Kind::Number: break;
    }
    const ScalarPass::Number& number = pass_.numbers[ref.index];
    ScalarValue host;
    std::memcpy(host.bytes.data(), number.value.data(), number.value.size());
    switch (number.element->fields.front().scalar) {
      case program::Scalar::Float: return ScalarValue::of(static_cast<Float>(host.as<float>()));
      case program::Scalar::Double: return ScalarValue::of(static_cast<Double>(host.as<double>()));
      default: return host;
    }
  }

  ScalarValue valueOf(const ScalarStep& step) const {
    if (step.op == ScalarOp::Select)
      return operand(step.operands[operand(step.operands[0]).template as<bool>() ? 1 : 2]);
    switch (step.type) {
      case program::Scalar::Float: return valueOf<Float>(step);
      case program::Scalar::Double: return valueOf<Double>(step);
      case program::Scalar::Int: return valueOf<std::int32_t>(step);
      case program::Scalar::Uint: return valueOf<std::uint32_t>(step);
      case program::Scalar::Long: return valueOf<std::int64_t>(step);
      case program::Scalar::Ulong: return valueOf<std::uint64_t>(step);
      default: return valueOf<bool>(step);
    }
  }

  template <class T>
  ScalarValue valueOf(const ScalarStep& step) const {
    const T a = operand(step.operands[0]).template as<T>(),
            b = isBinary(step.op) ? operand(step.operands[1]).template as<T>() : a;
    switch (step.op) {
      case ScalarOp::Less:
      case ScalarOp::LessEqual:
      case ScalarOp::Equal: return ScalarValue::of(compare(step.op, a, b));
      default: return ScalarValue::of(compute(step.op, a, b));
    }
  }

  static bool isBinary(ScalarOp op) { return op >= ScalarOp::Add; }

  const ScalarPass& pass_;
  std::vector<ScalarValue>& reads_;
  std::vector<ScalarValue>& steps_;
};

class NativeScalars final : public RecordedCall {
 public:
  std::string_view name() const override { return operationsName; }
  NativeScalars(ScalarPass pass, RealType real) : pass_(std::move(pass)), real_(real) {}

  void run() override {
    switch (real_) {
      case RealType::Float: Evaluation<float, double>(pass_, values_).run(); return;
      case RealType::Double: Evaluation<double, double>(pass_, values_).run(); return;
      case RealType::Quad: Evaluation<native::Quad, native::Quad>(pass_, values_).run(); return;
    }
  }

 private:
  const ScalarPass pass_;
  const RealType real_;
  ScalarValues values_;
};

}  // namespace

std::unique_ptr<RecordedCall> NativeDevice::prepareScalars(ScalarPass pass) {
  return std::make_unique<NativeScalars>(std::move(pass), real_);
}

}  // namespace sk
