// SPDX-License-Identifier: MIT
//
// Elements as native code wants them: an array for each scalar component. Floats are held in the device's real
// type, all else as in host memory.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "native/memory.hpp"
#include "sk/program.hpp"

namespace sk {

/// What native code computes with where a kernel says float. Quad stands for double, too (native/quad_type.hpp).
enum class RealType : std::uint8_t { Float, Double, Quad };

/// A scalar component of an element.
struct ComponentType {
  std::size_t offset;  ///< in the element, in host memory
  std::size_t hostBytes;
  std::size_t storedBytes;
  program::Scalar scalar;
};
/// What a scalar takes in an array.
std::size_t storedBytes(program::Scalar scalar, RealType real);
std::vector<ComponentType> componentsOf(const program::Element& element, RealType real);

/// Where values of some bytes lie, one each stride.
template <class Byte>
struct Values {
  Byte* first;
  std::size_t stride;
  std::size_t bytes;
};

/// Arrays of `count` elements, uninitialised. Throws NoMemory (support/checked_size.hpp).
class Components {
 public:
  Components() = default;
  Components(const program::Element& element, RealType real, std::int64_t count);
  /// Takes arrays that hold floats as `real`.
  Components(const program::Element& element, RealType real, std::vector<ArrayMemory> arrays);

  RealType real() const { return real_; }
  std::span<const ComponentType> types() const { return types_; }

  /// A copy that holds floats as `real`.
  Components clone(std::int64_t count, RealType real) const;
  /// Takes the elements of others, which are of as many components.
  void assign(const Components& from, std::int64_t count);
  std::span<void* const> arrays() const { return pointers_; }

  /// Copies `count` elements of others, which are of as many components, from `from` on to those from `first` on.
  void copy(const Components& others, std::int64_t from, std::int64_t first, std::int64_t count);
  /// Gives `count` elements from `first` on the value of one in host memory.
  void fill(std::int64_t first, std::int64_t count, const std::byte* element);
  /// `count` elements from `first` on, from and to host memory.
  void write(std::int64_t first, std::int64_t count, const std::byte* elements, std::size_t elementBytes);
  void read(std::int64_t first, std::int64_t count, std::byte* elements, std::size_t elementBytes) const;
  /// Of floats: one element after the other.
  void readReals(std::int64_t first, std::int64_t count, double* values) const;
  void writeReals(std::int64_t first, std::int64_t count, const double* values);
  /// One scalar of `count` elements from `first` on: values as the arrays hold them.
  void writeScalars(std::size_t component, std::int64_t first, std::int64_t count, const std::byte* values);
  /// Floats to the nearest halves.
  void roundToHalf(std::int64_t count);

 private:
  void allocate(std::int64_t count);
  Values<std::byte> valuesFrom(std::size_t component, std::int64_t first);
  Values<const std::byte> valuesFrom(std::size_t component, std::int64_t first) const;

  RealType real_ = RealType::Float;
  std::vector<ComponentType> types_;
  std::vector<ArrayMemory> arrays_;
  std::vector<void*> pointers_;
};

}  // namespace sk
