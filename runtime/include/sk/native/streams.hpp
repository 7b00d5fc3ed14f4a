// SPDX-License-Identifier: MIT
//
// The parameters of a kernel in native code. An Index is the domain's, x fastest.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>

#include "sk/native/call.hpp"
#include "sk/native/element.hpp"
#include "sk/native/math.hpp"
#include "sk/native/vector.hpp"

namespace sk::native {

using Index = Vec<Int, 4>;

/// One index into a stream of rank N: Int, or Vec<Int, N>.
template <std::size_t N>
struct IndexOfRank {
  using Type = Vec<Int, N>;
};
template <>
struct IndexOfRank<1> {
  using Type = Int;
};

inline Index toIndex(const Extents& extents) {
  Index index{};
  for (std::size_t d = 0; d < 4; ++d) index.components[d] = Int(extents[d]);
  return index;
}

/// A uniform or spec parameter.
template <class T>
class Uniform {
 public:
  Uniform(const Call& call, std::size_t parameter)
      : value_(load<T>(call.operands[parameter].components.data(), 0)) {}
  const T& get() const { return value_; }

 private:
  T value_;
};

/// An `iter` parameter: begin + (end - begin) * k / n, rounded once where that is exact.
template <class T>
class Iterator {
 public:
  Iterator(const Call& call, std::size_t parameter)
      : domain_(call.domain),
        countsElements_(call.operands[parameter].countsElements),
        begin_(load<T>(call.operands[parameter].components.data(), 0)),
        end_(load<T>(call.operands[parameter].components.data(), 1)) {}

  T at(const Index& index) const {
    T value{};
    for (std::size_t c = 0; c < widthOf<T>; ++c) {
      componentAt(value, c) =
          ramp(componentAt(begin_, c), componentAt(end_, c), position(index, c), steps(c));
    }
    return value;
  }

 private:
  using Scalar = Component<T>;

  std::int64_t steps(std::size_t component) const {
    return countsElements_ ? domain_[0] * domain_[1] * domain_[2] * domain_[3] : domain_[component];
  }
  std::int64_t position(const Index& index, std::size_t component) const {
    if (!countsElements_) return index.components[component].word();
    std::int64_t number = 0;
    for (std::size_t d = 4; d-- > 0;) number = number * domain_[d] + index.components[d].word();
    return number;
  }
  static Scalar ramp(Scalar begin, Scalar end, std::int64_t k, std::int64_t n) {
    if constexpr (isInteger<Scalar>) {
      const std::int64_t first = begin.word();
      return Scalar(first + (std::int64_t{end.word()} - first) / n * k);
    } else {
      using W = Wide<Scalar>;
      return static_cast<Scalar>(W(begin) + (W(end) - W(begin)) * static_cast<W>(k) / static_cast<W>(n));
    }
  }

  Extents domain_;
  bool countsElements_;
  T begin_, end_;
};

/// What all streams have.
class StreamParameter {
 public:
  StreamParameter(const Call& call, std::size_t parameter) : operand_(&call.operands[parameter]) {}
  Index extent() const { return toIndex(operand_->extent); }

 protected:
  bool isGiven() const { return !operand_->components.empty(); }
  /// The number of the element at an index that is inside the region.
  std::int64_t number(const Extents& index) const {
    std::int64_t element = operand_->first;
    for (std::size_t d = 0; d < 4; ++d) element += index[d] * operand_->stride[d];
    return element;
  }
  const Operand& operand() const { return *operand_; }

 private:
  const Operand* operand_;
};

/// `T x<>`. A stream that is left out has zeros, which nobody looks at.
template <class T>
class Input : public StreamParameter {
 public:
  using StreamParameter::StreamParameter;

  T at(const Index& index) const {
    return isGiven() ? load<T>(operand().components.data(), number(own(index))) : T{};
  }
  Index index(const Index& index) const { return toIndex(own(index)); }

 private:
  Extents own(const Index& index) const {
    Extents position;
    for (std::size_t d = 0; d < 4; ++d) {
      position[d] = index.components[d].word() * operand().multiply[d] / operand().divide[d];
    }
    return position;
  }
};

/// `out T r<>`.
template <class T>
class Output : public StreamParameter {
 public:
  using StreamParameter::StreamParameter;

  void store(const Index& index, const T& value) const {
    if (!isGiven()) return;
    Extents position;
    for (std::size_t d = 0; d < 4; ++d) position[d] = index.components[d].word();
    native::store(operand().components.data(), number(position), value);
  }
};

enum class Boundary : std::uint8_t { Clamp, Wrap, Mirror, Border };

/// `T a[]` of rank N.
template <class T, std::size_t N, Boundary boundary>
class Gather : public StreamParameter {
 public:
  using Position = typename IndexOfRank<N>::Type;

  Gather(const Call& call, std::size_t parameter, const T& border = T{})
      : StreamParameter(call, parameter), border_(border) {}

  T at(const Position& position) const {
    Extents index{};
    for (std::size_t d = 0; d < N; ++d) index[d] = componentAt(position, d).word();
    return element(index);
  }
  /// At an offset from the current element.
  T near(const Index& here, const Position& offset) const {
    Extents index{};
    for (std::size_t d = 0; d < N; ++d) {
      index[d] = std::int64_t{here.components[d].word()} + componentAt(offset, d).word();
    }
    return element(index);
  }

  /// Linear interpolation in the carrier of T; a neighbour of no weight is not looked at.
  template <class Carrier, class Place>
  Carrier sample(const Place& place) const {
    using Real = Component<Place>;
    Extents low{};
    Real weights[N];
    for (std::size_t d = 0; d < N; ++d) {
      const Real x = componentAt(place, d);
      const Real whole = Math<Real>::floor(x);
      low[d] = wholeIndex(whole).word();
      weights[d] = Math<Real>::fabs(x) >= Real(16777216) ? Real(0) : x - whole;   // infinity has none
    }
    return weighted<Carrier, Real, N>(low, weights);
  }

 private:
  T element(Extents index) const {
    for (std::size_t d = 0; d < N; ++d) {
      const std::int64_t n = operand().extent[d];
      if constexpr (boundary == Boundary::Border) {
        if (index[d] < 0 || index[d] >= n) return border_;
      } else {
        index[d] = brought(index[d], n);
      }
    }
    return load<T>(operand().components.data(), number(index));
  }

  static std::int64_t brought(std::int64_t i, std::int64_t n) {
    if constexpr (boundary == Boundary::Clamp) return std::clamp<std::int64_t>(i, 0, n - 1);
    const std::int64_t period = boundary == Boundary::Mirror ? 2 * n : n;
    const std::int64_t inside = (i % period + period) % period;
    return inside < n ? inside : period - 1 - inside;
  }

  template <class Carrier, class Real, std::size_t D>
  Carrier weighted(const Extents& at, const Real* weights) const {
    if constexpr (D == 0) {
      return convert<Carrier>(element(at));
    } else {
      Extents next = at;
      ++next[D - 1];
      const Real t = weights[D - 1];
      if (t <= Real(0)) return weighted<Carrier, Real, D - 1>(at, weights);
      if (t >= Real(1)) return weighted<Carrier, Real, D - 1>(next, weights);
      return weighted<Carrier, Real, D - 1>(at, weights) * (Real(1) - t) +
             weighted<Carrier, Real, D - 1>(next, weights) * t;
    }
  }

  T border_;
};

/// `vout T r<>`.
template <class T>
class VariableOutput : public StreamParameter {
 public:
  using StreamParameter::StreamParameter;
  void push(const T& value) const {
    if (operand().pushed != nullptr) append(*operand().pushed, value);
  }
};

/// `out T r[]` of rank N. An index outside does nothing.
template <class T, std::size_t N>
class Scatter : public StreamParameter {
 public:
  using StreamParameter::StreamParameter;
  using Position = typename IndexOfRank<N>::Type;

  void put(const Position& position, const T& value) const {
    combine(position, [&](const T&) { return value; });
  }
  /// The element becomes `operation` of what it holds.
  void combine(const Position& position, auto&& operation) const {
    if (!isGiven()) return;
    Extents index{};
    for (std::size_t d = 0; d < N; ++d) {
      index[d] = componentAt(position, d).word();
      if (index[d] < 0 || index[d] >= operand().extent[d]) return;
    }
    void* const* components = operand().components.data();
    store(components, number(index), operation(load<T>(components, number(index))));
  }
};

}  // namespace sk::native
