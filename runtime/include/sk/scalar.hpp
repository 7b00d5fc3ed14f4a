// SPDX-License-Identifier: MIT
//
// Values that live on a device. A reduction or a folded output writes one wherever it takes a stream of one element,
// a kernel reads one wherever it takes a uniform, and arithmetic with them makes others, without the host waiting for
// the device.
#pragma once

#include <concepts>
#include <cstdint>
#include <span>
#include <type_traits>
#include <utility>

#include "sk/call.hpp"
#include "sk/owner.hpp"
#include "sk/stream.hpp"

namespace sk {

/// The types that scalars compute with.
template <class T>
concept ScalarNumber = std::same_as<T, int> || std::same_as<T, unsigned> || std::same_as<T, std::int64_t> ||
                       std::same_as<T, std::uint64_t> || std::same_as<T, float> || std::same_as<T, double>;

template <ElementType T>
class Scalar;

namespace detail {

enum class ScalarOp : std::uint8_t {
  Copy,
  Negate,
  Absolute,
  SquareRoot,
  Not,
  Add,
  Subtract,
  Multiply,
  Divide,
  Minimum,
  Maximum,
  Less,
  LessEqual,
  Equal,
  And,
  Or,
  Select,  ///< the first operand is the condition
};

struct PendingScalar;  // the runtime's own
struct PendingScalarDeleter {
  void operator()(PendingScalar* pending) const noexcept;
};

class ScalarHandle;

/// An operand: a scalar, or a number of its type in host memory.
struct ScalarTerm {
  const ScalarHandle* scalar = nullptr;
  const void* number = nullptr;
  const program::Element* element = nullptr;
};

/// A Scalar without its type: a stream of one element, an operation that has yet to be carried out, or both: then the
/// result goes to the stream. Operations are carried out, many in one pass, before a region is asked for.
class ScalarHandle {
 public:
  ScalarHandle() = default;
  explicit ScalarHandle(StreamOwner stream) : stream_(std::move(stream)) {}
  /// At least one operand is a scalar.
  ScalarHandle(ScalarOp op, const program::Element& result, std::span<const ScalarTerm> operands);
  ScalarHandle(ScalarHandle&& other) noexcept
      : stream_(std::move(other.stream_)), pending_(std::move(other.pending_)) {
    if (pending_) hold();
  }
  ScalarHandle& operator=(ScalarHandle&& other);
  ~ScalarHandle() { end(); }

  void assign(const ScalarHandle& value, const program::Element& element);
  StreamRegion region() const;
  bool exists() const noexcept { return stream_ || pending_; }
  /// Takes the stream of an operation that has been carried out. Returns false if that has failed.
  bool takeStream() const noexcept;

 private:
  void takeResult() const;
  /// Tells the operation that this handle has it.
  void hold() noexcept;
  /// Carries out operations that read the stream, which is about to end.
  void end() noexcept;

  mutable StreamOwner stream_;
  mutable Owner<PendingScalar, PendingScalarDeleter> pending_;
};

/// An operand of an operation with scalars: a scalar, or a number that converts to its type.
template <class T>
class ScalarOperand {
 public:
  ScalarOperand(const Scalar<T>& scalar) : scalar_(&scalar.handle()) {}
  ScalarOperand(T number) : number_(number) {}
  ScalarTerm term() const { return {scalar_, &number_, &ElementTraits<T>::element()}; }

 private:
  const ScalarHandle* scalar_ = nullptr;
  T number_{};
};

template <class R, class... Operands>
Scalar<R> computed(ScalarOp op, const Operands&... operands) {
  const ScalarTerm terms[] = {operands.term()...};
  return Scalar<R>(ScalarHandle(op, ElementTraits<R>::element(), terms));
}

}  // namespace detail

/// A value of type T on a device. Device::scalar creates one; arithmetic with scalars and numbers makes others, of the
/// values that its operands have at that time. Move-only. A scalar that was default-constructed or moved from, or whose
/// device has been destroyed, can only be destroyed or moved to; everything else throws sk::Error.
template <ElementType T>
class Scalar {
 public:
  using value_type = T;

  /// Holds no value: assign the result of Device::scalar or of arithmetic to it.
  Scalar() = default;
  /// Copies a value on the device; the scalar stays in the same place, so that a loop can repeat it. Moving the result of
  /// arithmetic to a scalar that has a place does the same.
  void assign(const Scalar& value) {
    if constexpr (ScalarNumber<T> || std::same_as<T, bool>) {
      handle_.assign(value.handle_, ElementTraits<T>::element());
    } else {
      detail::copy(value.region(), region());
    }
  }
  void assign(const T& value) { detail::fill(region(), &value); }
  /// Like assign(): `a = 3.0f`.
  template <class V>
    requires(std::is_arithmetic_v<V> && std::is_arithmetic_v<T>)
  Scalar& operator=(V value) {
    assign(static_cast<T>(value));
    return *this;
  }

  /// Returns the value. Waits for the device.
  T read() const {
    T value{};
    detail::read(region(), &value, 1);
    return value;
  }

  /// The stream of one element that holds the value. Carries out what has been computed with scalars before.
  StreamRegion region() const { return handle_.region(); }
  const detail::ScalarHandle& handle() const { return handle_; }

  /// Like `a = a + b`: the scalar keeps its place.
  Scalar& operator+=(const detail::ScalarOperand<T>& b)
    requires ScalarNumber<T>
  {
    return *this = *this + b;
  }
  Scalar& operator-=(const detail::ScalarOperand<T>& b)
    requires ScalarNumber<T>
  {
    return *this = *this - b;
  }
  Scalar& operator*=(const detail::ScalarOperand<T>& b)
    requires ScalarNumber<T>
  {
    return *this = *this * b;
  }
  Scalar& operator/=(const detail::ScalarOperand<T>& b)
    requires ScalarNumber<T>
  {
    return *this = *this / b;
  }

  friend Scalar operator-(const Scalar& a)
    requires ScalarNumber<T>
  {
    return detail::computed<T>(detail::ScalarOp::Negate, Operand(a));
  }
  friend Scalar operator+(const detail::ScalarOperand<T>& a, const detail::ScalarOperand<T>& b)
    requires ScalarNumber<T>
  {
    return detail::computed<T>(detail::ScalarOp::Add, a, b);
  }
  friend Scalar operator-(const detail::ScalarOperand<T>& a, const detail::ScalarOperand<T>& b)
    requires ScalarNumber<T>
  {
    return detail::computed<T>(detail::ScalarOp::Subtract, a, b);
  }
  friend Scalar operator*(const detail::ScalarOperand<T>& a, const detail::ScalarOperand<T>& b)
    requires ScalarNumber<T>
  {
    return detail::computed<T>(detail::ScalarOp::Multiply, a, b);
  }
  /// Of integers: the value that kernels give, also for 0 as divisor (docs/language.md).
  friend Scalar operator/(const detail::ScalarOperand<T>& a, const detail::ScalarOperand<T>& b)
    requires ScalarNumber<T>
  {
    return detail::computed<T>(detail::ScalarOp::Divide, a, b);
  }
  friend Scalar<bool> operator<(const detail::ScalarOperand<T>& a, const detail::ScalarOperand<T>& b)
    requires ScalarNumber<T>
  {
    return detail::computed<bool>(detail::ScalarOp::Less, a, b);
  }
  friend Scalar<bool> operator<=(const detail::ScalarOperand<T>& a, const detail::ScalarOperand<T>& b)
    requires ScalarNumber<T>
  {
    return detail::computed<bool>(detail::ScalarOp::LessEqual, a, b);
  }
  friend Scalar<bool> operator>(const detail::ScalarOperand<T>& a, const detail::ScalarOperand<T>& b)
    requires ScalarNumber<T>
  {
    return detail::computed<bool>(detail::ScalarOp::Less, b, a);
  }
  friend Scalar<bool> operator>=(const detail::ScalarOperand<T>& a, const detail::ScalarOperand<T>& b)
    requires ScalarNumber<T>
  {
    return detail::computed<bool>(detail::ScalarOp::LessEqual, b, a);
  }
  friend Scalar<bool> operator==(const detail::ScalarOperand<T>& a, const detail::ScalarOperand<T>& b)
    requires(ScalarNumber<T> || std::same_as<T, bool>)
  {
    return detail::computed<bool>(detail::ScalarOp::Equal, a, b);
  }
  friend Scalar<bool> operator!=(const detail::ScalarOperand<T>& a, const detail::ScalarOperand<T>& b)
    requires(ScalarNumber<T> || std::same_as<T, bool>)
  {
    return !detail::computed<bool>(detail::ScalarOp::Equal, a, b);
  }
  friend Scalar operator!(const Scalar& a)
    requires std::same_as<T, bool>
  {
    return detail::computed<bool>(detail::ScalarOp::Not, Operand(a));
  }
  /// Computes both operands.
  friend Scalar operator&&(const detail::ScalarOperand<T>& a, const detail::ScalarOperand<T>& b)
    requires std::same_as<T, bool>
  {
    return detail::computed<bool>(detail::ScalarOp::And, a, b);
  }
  friend Scalar operator||(const detail::ScalarOperand<T>& a, const detail::ScalarOperand<T>& b)
    requires std::same_as<T, bool>
  {
    return detail::computed<bool>(detail::ScalarOp::Or, a, b);
  }

 private:
  using Operand = detail::ScalarOperand<T>;
  friend class Device;
  template <class R, class... Operands>
  friend Scalar<R> detail::computed(detail::ScalarOp op, const Operands&... operands);
  explicit Scalar(detail::ScalarHandle handle) : handle_(std::move(handle)) {}

  detail::ScalarHandle handle_;
};

template <ScalarNumber T>
Scalar<T> sqrt(const Scalar<T>& a)
  requires std::floating_point<T>
{
  return detail::computed<T>(detail::ScalarOp::SquareRoot, detail::ScalarOperand<T>(a));
}
template <ScalarNumber T>
Scalar<T> abs(const Scalar<T>& a)
  requires(!std::same_as<T, unsigned>)
{
  return detail::computed<T>(detail::ScalarOp::Absolute, detail::ScalarOperand<T>(a));
}

/// The smaller or the greater of two; of a number and NaN, the number.
template <ScalarNumber T>
Scalar<T> min(const Scalar<T>& a, const detail::ScalarOperand<std::type_identity_t<T>>& b) {
  return detail::computed<T>(detail::ScalarOp::Minimum, detail::ScalarOperand<T>(a), b);
}
template <ScalarNumber T>
Scalar<T> min(std::type_identity_t<T> a, const Scalar<T>& b) {
  return detail::computed<T>(detail::ScalarOp::Minimum, detail::ScalarOperand<T>(a),
                             detail::ScalarOperand<T>(b));
}
template <ScalarNumber T>
Scalar<T> max(const Scalar<T>& a, const detail::ScalarOperand<std::type_identity_t<T>>& b) {
  return detail::computed<T>(detail::ScalarOp::Maximum, detail::ScalarOperand<T>(a), b);
}
template <ScalarNumber T>
Scalar<T> max(std::type_identity_t<T> a, const Scalar<T>& b) {
  return detail::computed<T>(detail::ScalarOp::Maximum, detail::ScalarOperand<T>(a),
                             detail::ScalarOperand<T>(b));
}

/// `a` where the condition is true, else `b`.
template <ScalarNumber T>
Scalar<T> select(const Scalar<bool>& condition, const Scalar<T>& a,
                 const detail::ScalarOperand<std::type_identity_t<T>>& b) {
  return detail::computed<T>(detail::ScalarOp::Select, detail::ScalarOperand<bool>(condition),
                             detail::ScalarOperand<T>(a), b);
}
template <ScalarNumber T>
Scalar<T> select(const Scalar<bool>& condition, std::type_identity_t<T> a, const Scalar<T>& b) {
  return detail::computed<T>(detail::ScalarOp::Select, detail::ScalarOperand<bool>(condition),
                             detail::ScalarOperand<T>(a), detail::ScalarOperand<T>(b));
}
template <ScalarNumber T>
Scalar<T> select(const Scalar<bool>& condition, T a, std::type_identity_t<T> b) {
  return detail::computed<T>(detail::ScalarOp::Select, detail::ScalarOperand<bool>(condition),
                             detail::ScalarOperand<T>(a), detail::ScalarOperand<T>(b));
}

template <ElementType T>
StreamRegion regionOf(const Scalar<T>& scalar) {
  return scalar.region();
}
template <class T>
inline constexpr bool isWritable<Scalar<T>> = true;

}  // namespace sk
