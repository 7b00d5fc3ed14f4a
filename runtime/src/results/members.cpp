// SPDX-License-Identifier: MIT
#include "results/members.hpp"

#include <cstdint>
#include <cstring>
#include <string>
#include <type_traits>

#include "sk/scalar_bytes.hpp"
#include "support/scalar_types.hpp"

namespace sk::results {

namespace {

Values::Kind kindOf(program::Scalar scalar) {
  return withScalarType(scalar, []<class T>(T) {
    return std::is_integral_v<T>       ? Values::Kind::Integer
           : std::is_same_v<T, double> ? Values::Kind::Double
                                       : Values::Kind::Single;
  });
}

template <class T>
void append(std::string& bytes, T value) {
  bytes.append(reinterpret_cast<const char*>(&value), sizeof value);
}

/// Appends a component as Values holds it.
void appendComponent(std::string& bytes, program::Scalar scalar, const std::byte* place) {
  withScalarType(scalar, [&]<class T>(T) {
    const T value = componentAt<T>(place);
    if constexpr (std::is_same_v<T, double>) {
      append(bytes, value);
    } else if constexpr (std::is_integral_v<T>) {
      append(bytes, static_cast<std::int64_t>(value));
    } else {
      append(bytes, static_cast<float>(value));
    }
  });
}

std::size_t componentsOf(std::span<const program::Field> fields) {
  std::size_t count = 0;
  for (const program::Field& field : fields) count += field.width;
  return count;
}

}  // namespace

std::vector<Member> membersOf(const program::Element& element) {
  std::vector<Member> members;
  std::size_t components = 0;
  for (std::size_t i = 0; i < element.fields.size(); ++i) {
    const program::Field& field = element.fields[i];
    if (!members.empty() && members.back().path == field.path) {
      members.back().fields = {members.back().fields.data(), members.back().fields.size() + 1};
    } else {
      members.push_back({field.path, element.fields.subspan(i, 1), components});
    }
    components += field.width;
  }
  return members;
}

Values valuesOf(const Member& member, const program::Element& element, const std::byte* elements,
                std::size_t count) {
  const program::Field& only = member.fields.front();
  Values values{.kind = kindOf(only.scalar), .bytes = {}};
  if (only.scalar == program::Scalar::Float && only.width * sizeof(float) == element.size) {  // as it is
    values.bytes.assign(reinterpret_cast<const char*>(elements), count * element.size);
    return values;
  }
  for (std::size_t i = 0; i < count; ++i) {
    for (const program::Field& field : member.fields) {
      const std::byte* const first = elements + i * element.size + field.offset;
      for (std::size_t k = 0; k < field.width; ++k)
        appendComponent(values.bytes, field.scalar, first + k * program::hostBytes(field.scalar));
    }
  }
  return values;
}

Values valuesOf(const Member& member, const program::Element& element, std::span<const double> components,
                Values::Kind kind) {
  const std::size_t width = componentsOf(element.fields), own = componentsOf(member.fields);
  Values values{.kind = kind, .bytes = {}};
  for (std::size_t i = member.firstComponent; i < components.size(); i += width) {
    for (const double component : components.subspan(i, own)) {
      kind == Values::Kind::Single ? append(values.bytes, static_cast<float>(component))
                                   : append(values.bytes, component);
    }
  }
  return values;
}

}  // namespace sk::results
