// SPDX-License-Identifier: MIT
#include "support/npy_header.hpp"

#include <algorithm>
#include <charconv>

#include <fmt/format.h>

#include "sk/error.hpp"
#include "sk/scalar_bytes.hpp"

namespace sk::npy {

namespace {

using program::Element;
using program::Field;
using program::Scalar;

constexpr std::string_view magic = "\x93NUMPY";

/// NumPy's letter and size. Normalized integers are stored as integers.
std::string typeOf(Scalar scalar) {
  const auto typed = [&](char kind) {
    const std::size_t bytes = program::hostBytes(scalar);
    return fmt::format("'{}{}{}'", bytes == 1 ? '|' : '<', kind, bytes);
  };
  switch (scalar) {
    case Scalar::Bool: return typed('b');
    case Scalar::Int:
    case Scalar::Long:
    case Scalar::Char:
    case Scalar::Short:
    case Scalar::Snorm8:
    case Scalar::Snorm16: return typed('i');
    case Scalar::Uint:
    case Scalar::Ulong:
    case Scalar::Uchar:
    case Scalar::Ushort:
    case Scalar::Unorm8:
    case Scalar::Unorm16: return typed('u');
    case Scalar::Float:
    case Scalar::Double:
    case Scalar::Half: break;
  }
  return typed('f');
}

bool isStruct(const Element& element) { return !element.fields.front().path.empty(); }

std::size_t componentCount(const Element& element) {
  std::size_t components = 0;
  for (const Field& field : element.fields) components += field.width;
  return components;
}

/// A structured type with bytes that no member uses as members without a name.
std::string structType(const Element& element) {
  std::vector<const Field*> fields;
  for (const Field& field : element.fields) fields.push_back(&field);
  std::ranges::sort(fields, {}, &Field::offset);
  std::string type;
  std::size_t end = 0;
  const auto fillTo = [&](std::size_t offset) {
    if (offset > end) type += fmt::format("('','|V{}'),", offset - end);
  };
  for (const Field* field : fields) {
    fillTo(field->offset);
    std::string name(field->path);
    if (field->part >= 0) name += fmt::format("[{}]", field->part);
    const std::string width = field->width > 1 ? fmt::format(",({},)", field->width) : "";
    type += fmt::format("('{}',{}{}),", name, typeOf(field->scalar), width);
    end = field->offset + field->width * program::hostBytes(field->scalar);
  }
  fillTo(element.size);
  type.pop_back();
  return fmt::format("[{}]", type);
}

/// The text behind 'key': up to the comma that ends it, without spaces; "" if there is none.
std::string valueOf(std::string_view dictionary, std::string_view key) {
  const std::size_t at = dictionary.find(fmt::format("'{}':", key));
  if (at == std::string_view::npos) return {};
  std::string value;
  int depth = 0;
  for (const char c : dictionary.substr(at + key.size() + 3)) {
    if (c == '(' || c == '[') ++depth;
    if (c == ')' || c == ']') --depth;
    if (depth < 0 || (depth == 0 && (c == ',' || c == '}'))) break;
    if (c != ' ') value += c;
  }
  return value;
}

}  // namespace

NpyArray npyArray(const Element& element, const Shape& shape, bool asDoubles) {
  NpyArray array;
  for (int d = 0; d < shape.rank(); ++d) array.extents.push_back(shape[d]);
  if (isStruct(element)) {
    if (asDoubles) {
      throw Error(fmt::format(
          "elements '{}' stored in doubles cannot be written to a file; store them with Storage::Single",
          element.name));
    }
    array.type = structType(element);
    return array;
  }
  const Field& field = element.fields.front();
  const auto components = static_cast<std::int64_t>(componentCount(element));
  if (components > 1 && field.part >= 0 && !program::is64Bit(field.scalar)) {
    array.extents.push_back(static_cast<std::int64_t>(element.fields.size()));  // rows of a matrix
    array.extents.push_back(field.width);
  } else if (components > 1) {
    array.extents.push_back(components);
  }
  array.type = asDoubles ? "'<f8'" : typeOf(field.scalar);
  return array;
}

std::size_t elementBytes(const Element& element, bool asDoubles) {
  return asDoubles ? componentCount(element) * sizeof(double) : element.size;
}

std::string npyShape(const std::vector<std::int64_t>& extents) {
  if (extents.size() == 1) return fmt::format("({},)", extents.front());
  return fmt::format("({})", fmt::join(extents, ", "));
}

std::string npyHeader(const NpyArray& array) {
  std::string text = fmt::format("{{'descr': {}, 'fortran_order': False, 'shape': {}, }}", array.type,
                                 npyShape(array.extents));
  constexpr std::size_t alignment = 64;  // of the elements
  // Version 1.0, whose length has 16 bits, suffices for all but structs with thousands of members.
  const bool isLong = text.size() > 0xff00;
  const std::size_t length = (isLong ? npyPrefix : npyPrefix - 2) + text.size() + 1;
  text.append((alignment - length % alignment) % alignment, ' ');
  text += '\n';
  std::string header(magic);
  header += isLong ? '\x02' : '\x01';
  header += '\0';
  for (int k = 0; k < (isLong ? 4 : 2); ++k) header += static_cast<char>(text.size() >> (8 * k) & 0xff);
  return header + text;
}

std::size_t npyHeaderLength(std::string_view prefix) {
  if (prefix.size() < npyPrefix || !prefix.starts_with(magic)) return 0;
  const auto byte = [&](std::size_t k) {
    return static_cast<std::size_t>(static_cast<unsigned char>(prefix[k]));
  };
  if (byte(6) == 1) return 10 + byte(8) + (byte(9) << 8);
  if (byte(6) > 3) return 0;
  return npyPrefix + byte(8) + (byte(9) << 8) + (byte(10) << 16) + (byte(11) << 24);
}

std::string parseNpyHeader(std::string_view header, NpyArray& array) {
  const std::string_view text =
      header.substr(std::min<std::size_t>(header.size(), header[6] == 1 ? 10 : npyPrefix));
  array.type = valueOf(text, "descr");
  const std::string order = valueOf(text, "fortran_order"), shape = valueOf(text, "shape");
  if (array.type.empty() || order.empty() || !shape.starts_with('('))
    return "its header has no type or no shape";
  if (order != "False") return "its elements are in Fortran's order; save numpy.ascontiguousarray of them";
  array.extents.clear();
  const char* at = shape.data() + 1;
  const char* const end = shape.data() + shape.size();
  while (at < end && *at != ')') {
    std::int64_t extent = 0;
    const auto [next, error] = std::from_chars(at, end, extent);
    if (error != std::errc{} || extent < 0) return "its header has no shape";
    array.extents.push_back(extent);
    at = next < end && *next == ',' ? next + 1 : next;
  }
  return {};
}

}  // namespace sk::npy
