// SPDX-License-Identifier: MIT
#include "native/components.hpp"

#include <algorithm>
#include <cstring>
#include <limits>

#include "native/convert_floats.hpp"
#include "native/scalars.hpp"
#include "sk/narrow.hpp"
#include "sk/native/parallel.hpp"
#include "sk/native/quad_type.hpp"
#include "sk/scalar_bytes.hpp"
#include "support/checked_size.hpp"
#include "support/convert_elements.hpp"

namespace sk {

namespace {

/// Copies `count` values of Bytes bytes from one stride to another.
template <std::size_t Bytes>
void copyStrided(const std::byte* from, std::size_t fromStride, std::byte* to, std::size_t toStride,
                 std::int64_t count) {
  for (std::int64_t i = 0; i < count; ++i, from += fromStride, to += toStride) {
    std::memcpy(to, from, Bytes);
  }
}

template <class From, class To>
void convertStrided(const std::byte* from, std::size_t fromStride, std::byte* to, std::size_t toStride,
                    std::int64_t count) {
  for (std::int64_t i = 0; i < count; ++i, from += fromStride, to += toStride) {
    From value;
    std::memcpy(&value, from, sizeof value);
    const To converted = static_cast<To>(value);
    std::memcpy(to, &converted, sizeof converted);
  }
}

/// Likewise to floats that are rounded to half afterwards.
template <class From>
void convertToOdd(const std::byte* from, std::size_t fromStride, std::byte* to, std::size_t toStride,
                  std::int64_t count) {
  for (std::int64_t i = 0; i < count; ++i, from += fromStride, to += toStride) {
    From value;
    std::memcpy(&value, from, sizeof value);
    const float converted = roundedToOdd(static_cast<double>(value));
    std::memcpy(to, &converted, sizeof converted);
  }
}

template <class From>
void convertFrom(const std::byte* from, std::size_t fromStride, std::byte* to, std::size_t toStride,
                 std::size_t toBytes, std::int64_t count) {
  switch (toBytes) {
    case sizeof(float): return convertStrided<From, float>(from, fromStride, to, toStride, count);
    case sizeof(double): return convertStrided<From, double>(from, fromStride, to, toStride, count);
    default: return convertStrided<From, native::Quad>(from, fromStride, to, toStride, count);
  }
}

/// Copies values; converts real ones if their sizes differ. `areRoundedAgain`: floats are rounded to half afterwards.
void move(const Values<const std::byte>& from, const Values<std::byte>& to, std::int64_t count,
          bool areRoundedAgain = false) {
  if (from.bytes == to.bytes) {
    if (from.stride == from.bytes && to.stride == to.bytes) {
      if (count > 0) std::memcpy(to.first, from.first, static_cast<std::size_t>(count) * from.bytes);
      return;
    }
    switch (from.bytes) {
      case 1: return copyStrided<1>(from.first, from.stride, to.first, to.stride, count);
      case 2: return copyStrided<2>(from.first, from.stride, to.first, to.stride, count);
      case 4: return copyStrided<4>(from.first, from.stride, to.first, to.stride, count);
      case 8: return copyStrided<8>(from.first, from.stride, to.first, to.stride, count);
      default: return copyStrided<16>(from.first, from.stride, to.first, to.stride, count);
    }
  }
  const bool areDense = from.stride == from.bytes && to.stride == to.bytes;
  if (areDense && from.bytes == sizeof(float) && to.bytes == sizeof(double))
    return widenFloats(reinterpret_cast<const float*>(from.first), count,
                       reinterpret_cast<double*>(to.first));
  if (areDense && from.bytes == sizeof(double) && to.bytes == sizeof(float) && !areRoundedAgain)
    return narrowDoubles(reinterpret_cast<const double*>(from.first), count,
                         reinterpret_cast<float*>(to.first));
  if (areRoundedAgain && from.bytes == sizeof(double) && to.bytes == sizeof(float))
    return convertToOdd<double>(from.first, from.stride, to.first, to.stride, count);
  switch (from.bytes) {
    case sizeof(float):
      return convertFrom<float>(from.first, from.stride, to.first, to.stride, to.bytes, count);
    case sizeof(double):
      return convertFrom<double>(from.first, from.stride, to.first, to.stride, to.bytes, count);
    default: return convertFrom<native::Quad>(from.first, from.stride, to.first, to.stride, to.bytes, count);
  }
}

}  // namespace

std::size_t storedBytes(program::Scalar scalar, RealType real) {
  const bool isReal =
      scalar == program::Scalar::Float || (scalar == program::Scalar::Double && real == RealType::Quad);
  if (!isReal) return program::hostBytes(scalar);
  return real == RealType::Float    ? sizeof(float)
         : real == RealType::Double ? sizeof(double)
                                    : sizeof(native::Quad);
}

std::vector<ComponentType> componentsOf(const program::Element& element, RealType real) {
  std::vector<ComponentType> components;
  for (const program::Field& field : element.fields) {
    const std::size_t bytes = program::hostBytes(field.scalar);
    for (std::size_t c = 0; c < field.width; ++c) {
      components.push_back({field.offset + c * bytes, bytes, storedBytes(field.scalar, real), field.scalar});
    }
  }
  return components;
}

Components::Components(const program::Element& element, RealType real, std::int64_t count)
    : real_(real), types_(componentsOf(element, real)) {
  allocate(count);
}

Components::Components(const program::Element& element, RealType real, std::vector<ArrayMemory> arrays)
    : real_(real), types_(componentsOf(element, real)), arrays_(std::move(arrays)) {
  for (const ArrayMemory& array : arrays_) pointers_.push_back(array.get());
}

void Components::allocate(std::int64_t count) {
  for (const ComponentType& type : types_) {
    arrays_.push_back(allocated(bytesOf(count, type.storedBytes)));
    pointers_.push_back(arrays_.back().get());
  }
}

Components Components::clone(std::int64_t count, RealType real) const {
  Components copy;
  copy.real_ = real;
  copy.types_ = types_;
  for (ComponentType& type : copy.types_) type.storedBytes = storedBytes(type.scalar, real);
  copy.allocate(count);
  copy.assign(*this, count);
  return copy;
}

void Components::assign(const Components& from, std::int64_t count) { copy(from, 0, 0, count); }

void Components::copy(const Components& others, std::int64_t from, std::int64_t first, std::int64_t count) {
  copy(others, Run{from, count}, Run{first, count});
}

void Components::copy(const Components& others, const Run& from, const Run& to) {
  for (std::size_t c = 0; c < types_.size(); ++c) {
    native::inParallel(to.count, 1, native::Deal::Evenly, [&](native::Range part) {
      move(others.valuesOf(c, from.part(part.begin, part.end)), valuesOf(c, to.part(part.begin, part.end)),
           part.end - part.begin, holdsHalves_);
    });
  }
}

void Components::fill(const Run& run, const std::byte* element) {
  native::inParallel(run.count, 1, native::Deal::Evenly,
                     [&](native::Range part) { write(run.part(part.begin, part.end), element, 0); });
}

Values<std::byte> Components::valuesOf(std::size_t component, const Run& run) {
  const std::size_t bytes = types_[component].storedBytes;
  return {arrays_[component].get() + static_cast<std::size_t>(run.first) * bytes,
          static_cast<std::size_t>(run.step) * bytes, bytes};
}

Values<const std::byte> Components::valuesOf(std::size_t component, const Run& run) const {
  const std::size_t bytes = types_[component].storedBytes;
  return {arrays_[component].get() + static_cast<std::size_t>(run.first) * bytes,
          static_cast<std::size_t>(run.step) * bytes, bytes};
}

void Components::write(const Run& run, const std::byte* elements, std::size_t elementBytes) {
  for (std::size_t c = 0; c < types_.size(); ++c) {
    const Values<std::byte> held = valuesOf(c, run);
    move({elements + types_[c].offset, elementBytes, types_[c].hostBytes}, held, run.count);
    if (types_[c].scalar != program::Scalar::Bool) continue;
    for (std::int64_t i = 0; i < run.count; ++i) {  // any byte that is not 0 is true
      std::byte& value = held.first[static_cast<std::size_t>(i) * held.stride];
      value = std::byte{value != std::byte{0}};
    }
  }
}

void Components::read(const Run& run, std::byte* elements, std::size_t elementBytes) const {
  for (std::size_t c = 0; c < types_.size(); ++c) {
    move(valuesOf(c, run), {elements + types_[c].offset, elementBytes, types_[c].hostBytes}, run.count);
  }
}

void Components::readReals(const Run& run, double* values) const {
  for (std::size_t c = 0; c < types_.size(); ++c) {
    move(valuesOf(c, run),
         {reinterpret_cast<std::byte*>(values + c), types_.size() * sizeof(double), sizeof(double)},
         run.count);
  }
}

void Components::writeReals(const Run& run, const double* values) {
  for (std::size_t c = 0; c < types_.size(); ++c) {
    move({reinterpret_cast<const std::byte*>(values + c), types_.size() * sizeof(double), sizeof(double)},
         valuesOf(c, run), run.count, holdsHalves_);
  }
}

void Components::writeScalars(std::size_t component, const Run& run, const std::byte* values) {
  const std::size_t bytes = types_[component].storedBytes;
  move({values, bytes, bytes}, valuesOf(component, run), run.count);
}

void Components::roundToHalf(const Run& run) {
  for (std::size_t c = 0; c < types_.size(); ++c) {
    if (types_[c].scalar != program::Scalar::Float) continue;
    auto* const floats = reinterpret_cast<float*>(arrays_[c].get()) + run.first;
    for (std::int64_t i = 0; i < run.count; ++i) floats[i * run.step] = float{half(floats[i * run.step])};
  }
}

namespace {

using program::Role;

bool isEmpty(const native::Operand& operand) {
  return operand.components.empty() || std::ranges::count(operand.extent, 0) > 0;
}

bool fits32(std::int64_t number) {
  return number >= std::numeric_limits<std::int32_t>::min() &&
         number <= std::numeric_limits<std::int32_t>::max();
}

/// Sets isSmall and start. Code adds multiples of the strides in 32 bits, and that sum to `start` in 64. In a large whole,
/// sums are large though the elements that are held lie close together.
void setSmall(native::Argument& argument, const native::Operand& operand, const native::HeldIndices& held) {
  argument.start = operand.first;
  std::int64_t least = 0, most = 0;
  bool areSmall = true;
  for (std::size_t d = 0; d < 4; ++d) {
    if (held.low[d] == 0 && held.high[d] == 1) continue;
    least += held.low[d] * operand.stride[d];
    most += (held.high[d] - 1) * operand.stride[d];
    areSmall = areSmall && fits32(operand.stride[d]) && fits32(least) && fits32(most);
  }
  if (areSmall && fits32(operand.held ? most : operand.first + most)) {
    argument.isSmall = 1;
    return;
  }
  constexpr int bits = 32;
  const std::int64_t turns = (least + (std::int64_t{1} << (bits - 1))) >> bits;
  const std::int64_t turned = turns * (std::int64_t{1} << bits);
  if (!operand.held || !fits32(least - turned) || !fits32(most - turned)) return;
  argument.isSmall = 2;
  argument.start += turned;
}

native::Argument argumentOf(const native::Operand& operand) {
  native::Argument argument{};
  argument.components = operand.components.empty() ? nullptr : operand.components.data();
  argument.first = operand.first;
  std::ranges::copy(operand.extent, argument.extent);
  std::ranges::copy(operand.stride, argument.stride);
  std::ranges::copy(operand.multiply, argument.multiply);
  std::ranges::copy(operand.divide, argument.divide);
  argument.countsElements = operand.countsElements ? 1 : 0;
  const native::HeldIndices held = operand.held.value_or(native::HeldIndices{{}, operand.extent});
  setSmall(argument, operand, held);
  std::ranges::copy(held.low, argument.low);
  std::ranges::copy(held.high, argument.high);
  return argument;
}

}  // namespace

CodeFrame::CodeFrame(const program::Kernel& kernel, const native::Call& call,
                     std::pmr::memory_resource* memory)
    : arguments_(memory),
      zeroArrays_(memory),
      frame_{.arguments = nullptr,
             .domain = {call.domain[0], call.domain[1], call.domain[2], call.domain[3]},
             .tables = call.tables.empty() ? nullptr : call.tables.data(),
             .isSilent = call.isSilent ? 1 : 0} {
  arguments_.reserve(call.operands.size());
  for (std::size_t i = 0; i < call.operands.size(); ++i) {
    const program::Parameter& parameter = kernel.parameters[i];
    // object code applies the boundary mode to the indices of a gather and then reads, even if its stream is
    // omitted
    if (parameter.role == Role::Gather && isEmpty(call.operands[i])) {
      native::Argument& zero = arguments_.emplace_back(argumentOf({}));
      zero.stride[0] = 1;
      zero.components = zeroArrays(kernel);
    } else {
      arguments_.push_back(argumentOf(call.operands[i]));
    }
  }
  frame_.arguments = arguments_.data();
}

CodeFrame::CodeFrame(const CodeFrame& other, std::pmr::memory_resource* memory)
    : arguments_(other.arguments_, memory), zeroArrays_(memory), frame_(other.frame_) {
  frame_.arguments = arguments_.data();
}

void CodeFrame::redirect(std::size_t parameter, const native::Operand& operand) {
  arguments_[parameter] = argumentOf(operand);
}

/// One element of zeros, for any gather of the kernel.
void* const* CodeFrame::zeroArrays(const program::Kernel& kernel) {
  alignas(mostScalarBytes) static constexpr std::byte zero[mostScalarBytes] = {};
  if (zeroArrays_.empty()) {
    std::size_t most = 0;
    for (const program::Parameter& parameter : kernel.parameters) {
      most = std::max(most, scalarsOf(*parameter.element));
    }
    zeroArrays_.resize(most, const_cast<std::byte*>(zero));
  }
  return zeroArrays_.data();
}

}  // namespace sk
