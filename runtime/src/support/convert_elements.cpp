// SPDX-License-Identifier: MIT
#include "support/convert_elements.hpp"

#include <cstring>
#include <vector>

#include "sk/narrow.hpp"
#include "sk/scalar_bytes.hpp"

namespace sk {

namespace {

using program::Element;

struct Component {
  std::size_t offset;
  program::Scalar scalar;
};

std::vector<Component> componentsOf(const Element& element) {
  std::vector<Component> components;
  for (const program::Field& field : element.fields) {
    for (std::size_t c = 0; c < field.width; ++c) {
      components.push_back({field.offset + c * program::hostBytes(field.scalar), field.scalar});
    }
  }
  return components;
}

template <class T>
T load(const std::byte* place) {
  T value;
  std::memcpy(&value, place, sizeof value);
  return value;
}

template <class T>
void keep(std::byte* place, T value) {
  std::memcpy(place, &value, sizeof value);
}

double loadReal(program::Scalar scalar, const std::byte* place) {
  if (scalar == program::Scalar::Double) return load<double>(place);
  return scalar == program::Scalar::Half ? float{load<half>(place)} : load<float>(place);
}

void keepReal(program::Scalar scalar, std::byte* place, double value) {
  if (scalar == program::Scalar::Double) return keep(place, value);
  if (scalar == program::Scalar::Half) return keep(place, half(roundedToOdd(value)));
  keep(place, static_cast<float>(value));
}

}  // namespace

void convertElements(const Element& from, const std::byte* source, const Element& to, std::byte* target,
                     std::size_t count) {
  const std::vector<Component> sources = componentsOf(from);
  const std::vector<Component> targets = componentsOf(to);
  for (std::size_t i = 0; i < count; ++i, source += from.size, target += to.size) {
    for (std::size_t c = 0; c < sources.size(); ++c) {
      const std::byte* given = source + sources[c].offset;
      std::byte* taken = target + targets[c].offset;
      if (sources[c].scalar == targets[c].scalar) {
        std::memcpy(taken, given, program::hostBytes(sources[c].scalar));
      } else {
        keepReal(targets[c].scalar, taken, loadReal(sources[c].scalar, given));
      }
    }
  }
}

void readComponents(const Element& element, const std::byte* elements, std::size_t count, double* values) {
  const std::vector<Component> components = componentsOf(element);
  for (std::size_t i = 0; i < count; ++i, elements += element.size) {
    for (const Component& component : components)
      *values++ = loadReal(component.scalar, elements + component.offset);
  }
}

void writeComponents(const Element& element, std::byte* elements, std::size_t count, const double* values) {
  const std::vector<Component> components = componentsOf(element);
  for (std::size_t i = 0; i < count; ++i, elements += element.size) {
    for (const Component& component : components)
      keepReal(component.scalar, elements + component.offset, *values++);
  }
}

}  // namespace sk
