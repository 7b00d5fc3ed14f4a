// SPDX-License-Identifier: MIT
//
// Elements in the form that native code takes: one array per scalar component. Floats are held in the
// device's real type, all else as in host memory.
//
// The operands of a call in the form that object code takes (sk/native/code.hpp).
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory_resource>
#include <span>
#include <utility>
#include <vector>

#include "native/call.hpp"
#include "native/memory.hpp"
#include "sk/native/code.hpp"
#include "sk/program.hpp"

namespace sk {

/// The type that represents the language's float in native code. Quad also represents double
/// (sk/native/quad_type.hpp).
enum class RealType : std::uint8_t { Float, Double, Quad };

/// A scalar component of an element.
struct ComponentType {
  std::size_t offset;  ///< in the element in host memory
  std::size_t hostBytes;
  std::size_t storedBytes;
  program::Scalar scalar;
};
/// The size of a scalar in an array.
std::size_t storedBytes(program::Scalar scalar, RealType real);
std::vector<ComponentType> componentsOf(const program::Element& element, RealType real);

/// Strided values; the size of a value and the stride between values are in bytes.
template <class Byte>
struct Values {
  Byte* first;
  std::size_t stride;
  std::size_t bytes;
};

/// Elements `step` apart.
struct Run {
  std::int64_t first, count;
  std::int64_t step = 1;

  Run part(std::int64_t begin, std::int64_t end) const { return {first + begin * step, end - begin, step}; }
};

/// The arrays of `count` elements, at first uninitialised. Throws NoMemory (support/checked_size.hpp).
class Components {
 public:
  Components() = default;
  Components(const program::Element& element, RealType real, std::int64_t count);
  /// Takes arrays that hold floats as `real`.
  Components(const program::Element& element, RealType real, std::vector<ArrayMemory> arrays);

  RealType real() const { return real_; }
  std::span<const ComponentType> types() const { return types_; }
  /// The bytes of an element in all arrays.
  std::int64_t bytesOfElement() const {
    std::int64_t bytes = 0;
    for (const ComponentType& type : types_) bytes += static_cast<std::int64_t>(type.storedBytes);
    return bytes;
  }

  /// A copy that holds floats as `real`.
  Components clone(std::int64_t count, RealType real) const;
  /// Copies the first `count` elements of `from`, which has as many components.
  void assign(const Components& from, std::int64_t count);
  std::span<void* const> arrays() const { return pointers_; }
  /// Gives the arrays away.
  std::vector<ArrayMemory> release() {
    pointers_.clear();
    return std::exchange(arrays_, {});
  }

  /// Copies `count` elements of `others`, which has as many components, from number `from` on to number
  /// `first` on.
  void copy(const Components& others, std::int64_t from, std::int64_t first, std::int64_t count);
  void copy(const Components& others, const Run& from, const Run& to);
  /// Sets elements to one in host memory.
  void fill(const Run& run, const std::byte* element);
  /// Copies elements from or to host memory.
  void write(const Run& run, const std::byte* elements, std::size_t elementBytes);
  void write(std::int64_t first, std::int64_t count, const std::byte* elements, std::size_t elementBytes) {
    write(Run{first, count}, elements, elementBytes);
  }
  void read(const Run& run, std::byte* elements, std::size_t elementBytes) const;
  void read(std::int64_t first, std::int64_t count, std::byte* elements, std::size_t elementBytes) const {
    read(Run{first, count}, elements, elementBytes);
  }
  /// Likewise for elements of floats: `values` has all components of one element, then the next.
  void readReals(const Run& run, double* values) const;
  void writeReals(const Run& run, const double* values);
  /// Sets one scalar of elements; `values` have the type of the arrays.
  void writeScalars(std::size_t component, const Run& run, const std::byte* values);
  /// From now on, doubles are converted to floats that roundToHalf() rounds as if they were the doubles.
  void holdHalves() { holdsHalves_ = true; }
  /// Rounds floats to half precision.
  void roundToHalf(const Run& run);

 private:
  void allocate(std::int64_t count);
  Values<std::byte> valuesOf(std::size_t component, const Run& run);
  Values<const std::byte> valuesOf(std::size_t component, const Run& run) const;

  RealType real_ = RealType::Float;
  bool holdsHalves_ = false;
  std::vector<ComponentType> types_;
  std::vector<ArrayMemory> arrays_;
  std::vector<void*> pointers_;
};

/// A Frame with its Arguments, one per parameter of the kernel. What the operands point to must outlive it.
class CodeFrame {
 public:
  CodeFrame(const program::Kernel& kernel, const native::Call& call,
            std::pmr::memory_resource* memory = std::pmr::get_default_resource());
  /// A copy, whose parameters can be redirected on their own. The other frame must outlive it.
  CodeFrame(const CodeFrame& other, std::pmr::memory_resource* memory);
  CodeFrame(const CodeFrame&) = delete;
  CodeFrame& operator=(const CodeFrame&) = delete;

  const native::Frame* get() const { return &frame_; }
  /// Lets a parameter read another stream.
  void redirect(std::size_t parameter, const native::Operand& operand);
  std::span<const native::Argument> arguments() const { return arguments_; }

 private:
  void* const* zeroArrays(const program::Kernel& kernel);

  std::pmr::vector<native::Argument> arguments_;
  std::pmr::vector<void*> zeroArrays_;
  native::Frame frame_;
};

}  // namespace sk
