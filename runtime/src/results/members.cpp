// SPDX-License-Identifier: MIT
#include "results/members.hpp"

#include <cstdint>
#include <cstring>
#include <string>

#include "sk/narrow.hpp"

namespace sk::results {

namespace {

std::size_t hostBytesOf(program::Scalar scalar) {
  using enum program::Scalar;
  switch (scalar) {
    case Bool:
    case Char:
    case Uchar:
    case Unorm8:
    case Snorm8: return 1;
    case Half:
    case Short:
    case Ushort:
    case Unorm16:
    case Snorm16: return 2;
    case Int:
    case Uint:
    case Float: return 4;
    case Double:
    case Long:
    case Ulong: return 8;
  }
  return 0;
}

Values::Kind kindOf(program::Scalar scalar) {
  using enum program::Scalar;
  switch (scalar) {
    case Float:
    case Half:
    case Unorm8:
    case Snorm8:
    case Unorm16:
    case Snorm16: return Values::Kind::Single;
    case Double: return Values::Kind::Double;
    case Bool:
    case Int:
    case Uint:
    case Long:
    case Ulong:
    case Char:
    case Uchar:
    case Short:
    case Ushort: return Values::Kind::Integer;
  }
  return Values::Kind::Integer;
}

template <class T>
T valueAt(const std::byte* place) {
  T value;
  std::memcpy(&value, place, sizeof value);
  return value;
}

template <class T>
void append(std::string& bytes, T value) {
  bytes.append(reinterpret_cast<const char*>(&value), sizeof value);
}

/// Appends a component as Values holds it.
void appendComponent(std::string& bytes, program::Scalar scalar, const std::byte* place) {
  using enum program::Scalar;
  switch (scalar) {
    case Float: return append(bytes, valueAt<float>(place));
    case Half: return append(bytes, static_cast<float>(valueAt<half>(place)));
    case Unorm8: return append(bytes, static_cast<float>(valueAt<unorm8>(place)));
    case Snorm8: return append(bytes, static_cast<float>(valueAt<snorm8>(place)));
    case Unorm16: return append(bytes, static_cast<float>(valueAt<unorm16>(place)));
    case Snorm16: return append(bytes, static_cast<float>(valueAt<snorm16>(place)));
    case Double: return append(bytes, valueAt<double>(place));
    case Bool:
    case Uchar: return append(bytes, std::int64_t{valueAt<std::uint8_t>(place)});
    case Char: return append(bytes, std::int64_t{valueAt<std::int8_t>(place)});
    case Short: return append(bytes, std::int64_t{valueAt<std::int16_t>(place)});
    case Ushort: return append(bytes, std::int64_t{valueAt<std::uint16_t>(place)});
    case Int: return append(bytes, std::int64_t{valueAt<std::int32_t>(place)});
    case Uint: return append(bytes, std::int64_t{valueAt<std::uint32_t>(place)});
    case Long:
    case Ulong: return append(bytes, valueAt<std::int64_t>(place));
  }
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
        appendComponent(values.bytes, field.scalar, first + k * hostBytesOf(field.scalar));
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
