// SPDX-License-Identifier: MIT
#include "native/components.hpp"

#include <algorithm>
#include <cstring>

#include "sk/narrow.hpp"
#include "sk/scalar_bytes.hpp"

namespace sk {

namespace {

using program::Scalar;

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

void copySame(std::size_t bytes, const std::byte* from, std::size_t fromStride, std::byte* to,
              std::size_t toStride, std::int64_t count) {
  switch (bytes) {
    case 1: return copyStrided<1>(from, fromStride, to, toStride, count);
    case 2: return copyStrided<2>(from, fromStride, to, toStride, count);
    case 4: return copyStrided<4>(from, fromStride, to, toStride, count);
    default: return copyStrided<8>(from, fromStride, to, toStride, count);
  }
}

}  // namespace

std::vector<ComponentType> componentsOf(const program::Element& element, RealType real) {
  std::vector<ComponentType> components;
  for (const program::Field& field : element.fields) {
    const std::size_t bytes = program::hostBytes(field.scalar);
    const bool isReal = field.scalar == Scalar::Float;
    const std::size_t stored = isReal && real == RealType::Double ? sizeof(double) : bytes;
    for (std::size_t c = 0; c < field.width; ++c) {
      components.push_back({field.offset + c * bytes, bytes, stored, isReal});
    }
  }
  return components;
}

Components::Components(const program::Element& element, RealType real, std::int64_t count)
    : real_(real), types_(componentsOf(element, real)) {
  allocate(count);
}

Components::Components(const program::Element& element, RealType real,
                       std::span<const std::vector<std::byte>> arrays)
    : real_(real), types_(componentsOf(element, real)) {
  allocate(static_cast<std::int64_t>(arrays[0].size() / types_[0].storedBytes));
  for (std::size_t c = 0; c < types_.size(); ++c) {
    if (!arrays[c].empty()) std::memcpy(arrays_[c].get(), arrays[c].data(), arrays[c].size());
  }
}

void Components::allocate(std::int64_t count) {
  for (const ComponentType& type : types_) {
    arrays_.push_back(
        std::make_unique_for_overwrite<std::byte[]>(static_cast<std::size_t>(count) * type.storedBytes));
    pointers_.push_back(arrays_.back().get());
  }
}

Components Components::clone(std::int64_t count, RealType real) const {
  Components copy;
  copy.real_ = real;
  copy.types_ = types_;
  for (ComponentType& type : copy.types_) {
    if (type.isReal) type.storedBytes = real == RealType::Double ? sizeof(double) : sizeof(float);
  }
  copy.allocate(count);
  copy.assign(*this, count);
  return copy;
}

void Components::assign(const Components& from, std::int64_t count) {
  for (std::size_t c = 0; c < types_.size(); ++c) {
    const std::byte* source = from.arrays_[c].get();
    std::byte* target = arrays_[c].get();
    const std::size_t given = from.types_[c].storedBytes;
    const std::size_t taken = types_[c].storedBytes;
    if (given == taken) {
      if (count > 0) std::memcpy(target, source, static_cast<std::size_t>(count) * taken);
    } else if (given < taken) {
      convertStrided<float, double>(source, given, target, taken, count);
    } else {
      convertStrided<double, float>(source, given, target, taken, count);
    }
  }
}

void Components::write(std::int64_t first, std::int64_t count, const std::byte* elements,
                       std::size_t elementBytes) {
  for (std::size_t c = 0; c < types_.size(); ++c) {
    const ComponentType& type = types_[c];
    std::byte* to = arrays_[c].get() + static_cast<std::size_t>(first) * type.storedBytes;
    const std::byte* from = elements + type.offset;
    if (type.storedBytes == type.hostBytes) {
      copySame(type.hostBytes, from, elementBytes, to, type.storedBytes, count);
    } else {
      convertStrided<float, double>(from, elementBytes, to, type.storedBytes, count);
    }
  }
}

void Components::read(std::int64_t first, std::int64_t count, std::byte* elements,
                      std::size_t elementBytes) const {
  for (std::size_t c = 0; c < types_.size(); ++c) {
    const ComponentType& type = types_[c];
    const std::byte* from = arrays_[c].get() + static_cast<std::size_t>(first) * type.storedBytes;
    std::byte* to = elements + type.offset;
    if (type.storedBytes == type.hostBytes) {
      copySame(type.hostBytes, from, type.storedBytes, to, elementBytes, count);
    } else {
      convertStrided<double, float>(from, type.storedBytes, to, elementBytes, count);
    }
  }
}

void Components::readReals(std::int64_t first, std::int64_t count, double* values) const {
  const std::size_t stride = types_.size() * sizeof(double);
  for (std::size_t c = 0; c < types_.size(); ++c) {
    const std::size_t bytes = types_[c].storedBytes;
    const std::byte* from = arrays_[c].get() + static_cast<std::size_t>(first) * bytes;
    auto* to = reinterpret_cast<std::byte*>(values + c);
    if (bytes == sizeof(double)) {
      copyStrided<sizeof(double)>(from, bytes, to, stride, count);
    } else {
      convertStrided<float, double>(from, bytes, to, stride, count);
    }
  }
}

void Components::writeReals(std::int64_t first, std::int64_t count, const double* values) {
  const std::size_t stride = types_.size() * sizeof(double);
  for (std::size_t c = 0; c < types_.size(); ++c) {
    const std::size_t bytes = types_[c].storedBytes;
    std::byte* to = arrays_[c].get() + static_cast<std::size_t>(first) * bytes;
    const auto* from = reinterpret_cast<const std::byte*>(values + c);
    if (bytes == sizeof(double)) {
      copyStrided<sizeof(double)>(from, stride, to, bytes, count);
    } else {
      convertStrided<double, float>(from, stride, to, bytes, count);
    }
  }
}

void Components::roundToHalf(std::int64_t count) {
  for (std::size_t c = 0; c < types_.size(); ++c) {
    if (!types_[c].isReal) continue;
    auto* floats = reinterpret_cast<float*>(arrays_[c].get());
    std::transform(floats, floats + count, floats, [](float x) { return float{half(x)}; });
  }
}

}  // namespace sk
