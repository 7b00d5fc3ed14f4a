// SPDX-License-Identifier: MIT
//
// Kernels for tests with hand-written object code: functions that comply with sk/native/code.hpp and, as it
// permits, access whole groups of lanes.
#pragma once

#include <cstdint>
#include <deque>
#include <vector>

#include "native/call.hpp"
#include "native/slot_arrays.hpp"
#include "sk/native/code.hpp"
#include "sk/program.hpp"

namespace sk::test {

inline constexpr std::uint8_t testLanes = 8;

inline constexpr program::Field floatField[] = {{"", program::Scalar::Float, 1, 0}};
inline constexpr program::Element floatElement{"float", "float", 4, floatField};
inline constexpr program::Field intField[] = {{"", program::Scalar::Int, 1, 0}};
inline constexpr program::Element intElement{"int", "int", 4, intField};

/// `count`, rounded up to whole groups of lanes.
inline std::int64_t inGroups(std::int64_t count) { return roundUp(count, testLanes); }

template <class T>
T* arrayOf(const native::Chunk* chunk, std::size_t slot) {
  return static_cast<T*>(chunk->arrays[slot]);
}
template <class T>
T valueOf(const native::Frame* frame, std::size_t parameter) {
  return *static_cast<const T*>(frame->arguments[parameter].components[0]);
}

template <class Function>
native::Entry entry(native::EntryKind kind, Function* function, native::Real real = native::Real::Float) {
  return {.function = reinterpret_cast<void (*)()>(function),
          .kind = kind,
          .real = real,
          .level = native::Level::Base,
          .isContracted = 0,
          .lanes = testLanes,
          .rows = 1};
}

/// A kernel and its code. Its address must not change.
struct TestKernel {
  std::vector<program::Parameter> parameters;
  std::vector<native::Slot> slots;
  std::vector<native::Entry> entries;
  native::Code code{};
  program::Kernel kernel{};

  TestKernel() = default;
  TestKernel(const TestKernel&) = delete;
  TestKernel& operator=(const TestKernel&) = delete;

  program::Parameter& add(program::Role role, const program::Element& element = floatElement) {
    program::Parameter parameter{};
    parameter.name = parameter.symbol = "p";
    parameter.role = role;
    parameter.element = &element;
    return parameters.emplace_back(parameter);
  }
  void slot(std::uint8_t parameter, std::uint8_t reach = 0, std::int8_t y = 0, std::int8_t z = 0) {
    const bool isOutput = parameters[parameter].role == program::Role::Output;
    slots.push_back({parameter, {y, z, 0}, reach, static_cast<std::uint8_t>(isOutput ? 1 : 0)});
  }
  const program::Kernel& finish() {
    code.version = native::Code::currentVersion;
    code.entries = entries.data();
    code.entryCount = static_cast<std::uint32_t>(entries.size());
    code.slots = slots.data();
    code.slotCount = static_cast<std::uint32_t>(slots.size());
    kernel.name = "f";
    kernel.parameters = parameters;
    kernel.code = &code;
    return kernel;
  }
};

/// The operands of a call, and the pointers in them.
class TestOperands {
 public:
  /// Adds a whole array with these extents.
  template <class T>
  native::Operand& add(std::vector<T>& array, const native::Extents& extent) {
    native::Operand& operand = list_.emplace_back();
    operand.components = {&pointers_.emplace_back(array.data()), 1};
    operand.extent = extent;
    operand.stride = {1, extent[0], extent[0] * extent[1], extent[0] * extent[1] * extent[2]};
    return operand;
  }
  /// Adds an omitted stream.
  native::Operand& addNone() { return list_.emplace_back(); }
  native::Call call(const native::Extents& domain) const { return {list_, domain, {}}; }

 private:
  std::deque<void*> pointers_;
  std::vector<native::Operand> list_;
};

/// Whole numbers; sums and products of a few of them are exact in floats.
inline std::vector<float> someFloats(std::int64_t count, int seed = 1) {
  std::vector<float> values(static_cast<std::size_t>(count));
  std::uint32_t state = static_cast<std::uint32_t>(seed) * 2654435761U;
  for (float& value : values) {
    state = state * 1664525U + 1013904223U;
    value = static_cast<float>(state >> 24) - 100.0F;
  }
  return values;
}

}  // namespace sk::test
