// SPDX-License-Identifier: MIT
//
// The parameters of a kernel in native code (gather.hpp has those that are read anywhere). An Index is the domain's, x fastest.
// What the loops of run.hpp go through is placed at a chunk; its elements there have numbers from 0 on.
#pragma once

#include <cstddef>
#include <cstdint>

#include "sk/native/call.hpp"
#include "sk/native/chunk.hpp"
#include "sk/native/element.hpp"
#include "sk/native/hot.hpp"
#include "sk/native/lanes_memory.hpp"
#include "sk/native/vector.hpp"

namespace sk::native {

/// One index into a stream of rank N: Int, or Vec<Int, N>.
template <std::size_t N>
struct IndexOfRank {
  using Type = Vec<Int, N>;
};
template <>
struct IndexOfRank<1> {
  using Type = Int;
};

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

  bool isDirect() const { return true; }
  void place(const Chunk& chunk) {
    for (std::size_t c = 0; c < widthOf<T>; ++c) {
      first_[c] = countsElements_ ? number(chunk.first) : chunk.first[c];
      if constexpr (isInteger<Scalar>) {
        const Scalar begin = componentAt(begin_, c);
        componentAt(step_, c) = Scalar((std::int64_t{componentAt(end_, c).word()} - begin.word()) / steps(c));
        componentAt(start_, c) = begin + componentAt(step_, c) * Scalar(first_[c]);
      }
    }
  }

  T at(int i) const {
    T value{};
    for (std::size_t c = 0; c < widthOf<T>; ++c) componentAt(value, c) = componentOf(c, c == 0 ? i : 0);
    if (countsElements_) {
      for (std::size_t c = 1; c < widthOf<T>; ++c) componentAt(value, c) = componentOf(c, i);
    }
    return value;
  }
  /// Of element i and those that follow it.
  LanesOf<T> lanesAt(int i) const {
    return laneByLane([&](Int lane) { return at(i + lane.word()); }, laneNumbers());
  }

 private:
  using Scalar = Component<T>;

  std::int64_t steps(std::size_t component) const {
    return countsElements_ ? domain_[0] * domain_[1] * domain_[2] * domain_[3] : domain_[component];
  }
  std::int64_t number(const Extents& index) const {
    std::int64_t number = 0;
    for (std::size_t d = 4; d-- > 0;) number = number * domain_[d] + index[d];
    return number;
  }
  Scalar componentOf(std::size_t c, int i) const {
    if constexpr (isInteger<Scalar>) {
      return componentAt(start_, c) + componentAt(step_, c) * Scalar(i);
    } else {
      using W = Wide<Scalar>;
      const W begin = componentAt(begin_, c);
      const W k = static_cast<W>(first_[c]) + static_cast<W>(i);  // exact
      return static_cast<Scalar>(begin + (W(componentAt(end_, c)) - begin) * k / static_cast<W>(steps(c)));
    }
  }

  Extents domain_;
  bool countsElements_;
  T begin_, end_;
  T start_{}, step_{};  ///< of integers: at the chunk's first element, and from one to the next
  std::int64_t first_[4]{};
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

/// The arrays of an element's components, from the chunk's first element on. They may hold floats where T has another real type.
template <class T, bool holdFloats = false>
class ComponentArrays {
 public:
  T load(int i) const {
    if constexpr (holdFloats) {
      return loadFloats<T>(arrays_, i);
    } else {
      return native::load<T>(arrays_, i);
    }
  }
  void store(int i, const T& value) const { native::store(arrays_, i, value); }
  LanesOf<T> loadLanes(int i) const { return loadNeighbours<T>(arrays_, i); }
  void storeLanes(int i, const LanesOf<T>& value) const { storeNeighbours<T>(arrays_, i, value); }

  void place(void* const* arrays, std::int64_t first) {
    each([&]<class Held>(std::size_t c, Held*) { arrays_[c] = static_cast<Held*>(arrays[c]) + first; });
  }
  /// In memory of its own, uninitialised.
  void place(Scratch& scratch, int count) {
    each([&]<class Held>(std::size_t c, Held*) {
      arrays_[c] = scratch.take(static_cast<std::size_t>(count) * sizeof(Held));
    });
  }
  template <class Held>
  const Held* first() const {
    return static_cast<const Held*>(arrays_[0]);
  }

 private:
  void each(auto&& component) const {
    T value{};
    std::size_t c = 0;
    visit(value, [&]<class S>(S&) { component(c++, static_cast<HeldAs<S, holdFloats>*>(nullptr)); });
  }

  void* arrays_[footprintOf<T>().scalars]{};
};

/// `T x<>`. A stream that is left out has zeros, which nobody looks at. One of floats for doubles serves where it is direct.
template <class T, bool isOfFloats = false>
class Input : public StreamParameter {
 public:
  using StreamParameter::StreamParameter;

  /// Whether its elements lie as the domain's do along x.
  bool isDirect() const { return isGiven() && isDense() && holdsItsReals(); }
  void place(const Chunk& chunk) {
    for (std::size_t d = 0; d < 4; ++d)
      own_[d] = chunk.first[d] * operand().multiply[d] / operand().divide[d];
    if (isDirect() || (chunk.count == 1 && isGiven() && holdsItsReals())) {
      arrays_.place(operand().components.data(), number(own_));
    } else if constexpr (!isOfFloats) {
      layOut(chunk);
    }
  }

  T at(int i) const { return arrays_.load(i); }
  /// Where element i and those that follow it are, which are floats.
  const float* floats(int i) const
    requires(isOfFloats || std::is_same_v<T, float>)
  {
    return arrays_.template first<float>() + i;
  }
  /// Element i and those that follow it.
  LanesOf<T> lanesAt(int i) const { return arrays_.loadLanes(i); }
  /// Of the element of the domain that has this index.
  Index index(const Index& index) const {
    Index own = toIndex(own_);
    const bool isSame = operand().multiply[0] == 1 && operand().divide[0] == 1;
    own.components[0] =
        isSame ? index.components[0]
               : Int(std::int64_t{index.components[0].word()} * operand().multiply[0] / operand().divide[0]);
    return own;
  }
  /// Of the element of the domain that has this index, and of those that follow it.
  Vec<Lanes<Int>, 4> lanesIndex(const Index& first) const {
    return laneByLane(
        [&](Int lane) {
          Index next = first;
          next.components[0] = next.components[0] + lane;
          return index(next);
        },
        laneNumbers());
  }

 private:
  bool holdsItsReals() const { return operand().holdsFloats == isOfFloats; }
  bool isDense() const {
    return operand().multiply[0] == 1 && operand().divide[0] == 1 && operand().stride[0] == 1;
  }
  T elementAt(std::int64_t number) const {
    void* const* arrays = operand().components.data();
    return operand().holdsFloats ? loadFloats<T>(arrays, number) : load<T>(arrays, number);
  }

  void layOut(const Chunk& chunk) {
    arrays_.place(chunk.scratch, chunk.count);
    std::int64_t element = number(own_);
    if (!isGiven()) {
      for (int i = 0; i < chunk.count; ++i) arrays_.store(i, T{});
    } else if (isDense()) {
      SK_NATIVE_INDEPENDENT
      for (int i = 0; i < chunk.count; ++i) arrays_.store(i, elementAt(element + i));
    } else {
      const std::int64_t step = operand().multiply[0] * operand().stride[0];
      const std::int64_t repeats = operand().divide[0];
      std::int64_t repeated = chunk.first[0] % repeats;
      for (int i = 0; i < chunk.count; ++i) {
        arrays_.store(i, elementAt(element));
        if (++repeated < repeats) continue;
        repeated = 0;
        element += step;
      }
    }
  }

  Extents own_{};  ///< where the chunk begins here
  ComponentArrays<T, isOfFloats> arrays_;
};

/// `out T r<>`. What is stored to one that is left out is lost.
template <class T>
class Output : public StreamParameter {
 public:
  using StreamParameter::StreamParameter;

  bool isDirect() const { return isGiven(); }
  void place(const Chunk& chunk) {
    if (isGiven()) {
      arrays_.place(operand().components.data(), number(chunk.first));
    } else {
      arrays_.place(chunk.scratch, chunk.count);
    }
  }
  void store(int i, const T& value) const { arrays_.store(i, value); }
  /// Element i and those that follow it.
  void storeLanes(int i, const LanesOf<T>& value) const { arrays_.storeLanes(i, value); }

  /// At any index, whatever the chunk.
  void store(const Index& index, const T& value) const {
    if (!isGiven()) return;
    Extents position;
    for (std::size_t d = 0; d < 4; ++d) position[d] = index.components[d].word();
    native::store(operand().components.data(), number(position), value);
  }

 private:
  ComponentArrays<T> arrays_;
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
