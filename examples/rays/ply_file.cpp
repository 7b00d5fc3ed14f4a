// SPDX-License-Identifier: MIT
//
// PLY files (G. Turk, "The PLY polygon file format", 1994), as text and binary in both orders of bytes. Elements other than
// vertices and faces, and properties that nobody needs, are passed over; polygons become fans.
#include "mesh.hpp"

#include <algorithm>
#include <bit>
#include <cstring>
#include <limits>
#include <map>

#include "support/text_cursor.hpp"

namespace rays {

using examples::TextCursor;

namespace {

enum class Encoding : std::uint8_t { Text, Little, Big };
enum class Number : std::uint8_t { Int8, UInt8, Int16, UInt16, Int32, UInt32, Float, Double };

struct Property {
  std::string name;
  Number type = Number::Float;
  bool isList = false;
  Number countType = Number::UInt8;
};

struct Element {
  std::string name;
  std::int64_t count = 0;
  std::vector<Property> properties{};
};

struct Header {
  Encoding encoding = Encoding::Text;
  std::vector<Element> elements;
};

Number numberType(const TextCursor& cursor, std::string_view word) {
  static const std::map<std::string_view, Number> types = {
      {"char", Number::Int8},     {"int8", Number::Int8},     {"uchar", Number::UInt8},
      {"uint8", Number::UInt8},   {"short", Number::Int16},   {"int16", Number::Int16},
      {"ushort", Number::UInt16}, {"uint16", Number::UInt16}, {"int", Number::Int32},
      {"int32", Number::Int32},   {"uint", Number::UInt32},   {"uint32", Number::UInt32},
      {"float", Number::Float},   {"float32", Number::Float}, {"double", Number::Double},
      {"float64", Number::Double}};
  const auto found = types.find(word);
  if (found == types.end()) cursor.fail(fmt::format("'{}' is no type of PLY", word));
  return found->second;
}

Encoding encodingOf(const TextCursor& cursor, std::string_view word) {
  if (word == "ascii") return Encoding::Text;
  if (word == "binary_little_endian") return Encoding::Little;
  if (word == "binary_big_endian") return Encoding::Big;
  cursor.fail(fmt::format(
      "'{}' is no format of PLY; there are ascii, binary_little_endian, binary_big_endian", word));
}

Property propertyOf(TextCursor& cursor) {
  Property property;
  std::string_view type = cursor.word();
  property.isList = type == "list";
  if (property.isList) {
    property.countType = numberType(cursor, cursor.word());
    type = cursor.word();
  }
  property.type = numberType(cursor, type);
  property.name = cursor.word();
  if (property.name.empty()) cursor.fail("a property needs a name");
  return property;
}

/// Leaves the cursor at the line `end_header`.
Header readHeader(TextCursor& cursor) {
  if (!cursor.nextLine() || cursor.word() != "ply")
    cursor.fail("this is no PLY file, whose first line is 'ply'");
  Header header;
  bool hasFormat = false;
  while (cursor.nextLine()) {
    const std::string_view key = cursor.word();
    if (key == "format") {
      header.encoding = encodingOf(cursor, cursor.word());
      hasFormat = true;
    } else if (key == "element") {
      Element element{.name = std::string(cursor.word())};
      element.count = cursor.integerOf(cursor.word());
      if (element.count < 0) cursor.fail("an element cannot be there less than 0 times");
      header.elements.push_back(element);
    } else if (key == "property") {
      if (header.elements.empty()) cursor.fail("a property comes after its element");
      header.elements.back().properties.push_back(propertyOf(cursor));
    } else if (key == "end_header") {
      if (!hasFormat) cursor.fail("the header has no line 'format'");
      return header;
    } else if (key != "comment" && key != "obj_info" && !key.empty()) {
      cursor.fail(fmt::format("'{}' is no word of a PLY header", key));
    }
  }
  cursor.fail("the header has no end; 'end_header' is missing");
}

/// Numbers of the body, whatever the encoding; errors tell the place.
class Body {
 public:
  Body(const std::string& name, std::string_view bytes, TextCursor& cursor, Encoding encoding)
      : name_(name), bytes_(bytes), cursor_(cursor), encoding_(encoding), at_(cursor.nextLineAt()) {}

  double read(Number type) {
    if (encoding_ == Encoding::Text) return readText(type);
    switch (type) {
      case Number::Int8: return readBinary<std::int8_t>();
      case Number::UInt8: return readBinary<std::uint8_t>();
      case Number::Int16: return readBinary<std::int16_t>();
      case Number::UInt16: return readBinary<std::uint16_t>();
      case Number::Int32: return readBinary<std::int32_t>();
      case Number::UInt32: return readBinary<std::uint32_t>();
      case Number::Float: return readBinary<float>();
      case Number::Double: return readBinary<double>();
    }
    return 0.0;
  }
  [[noreturn]] void fail(std::string_view message) const {
    if (encoding_ == Encoding::Text) cursor_.fail(message);
    throw std::runtime_error(fmt::format("{}: byte {}: {}", name_, at_, message));
  }

 private:
  /// The words of text files may stand on any lines.
  double readText(Number type) {
    std::string_view word = cursor_.word();
    while (word.empty()) {
      if (!cursor_.nextLine()) cursor_.fail("the file ends too early");
      word = cursor_.word();
    }
    return type >= Number::Float ? cursor_.numberOf(word) : static_cast<double>(cursor_.integerOf(word));
  }
  template <class T>
  double readBinary() {
    if (bytes_.size() - at_ < sizeof(T)) fail("the file ends too early");
    char raw[sizeof(T)];
    std::memcpy(raw, bytes_.data() + at_, sizeof(T));
    const bool isForeign = (encoding_ == Encoding::Big) == (std::endian::native == std::endian::little);
    if (isForeign) std::reverse(raw, raw + sizeof(T));
    T value;
    std::memcpy(&value, raw, sizeof(T));
    at_ += sizeof(T);
    return static_cast<double>(value);
  }

  const std::string& name_;
  std::string_view bytes_;
  TextCursor& cursor_;
  Encoding encoding_;
  std::size_t at_;
};

std::int64_t readCount(Body& body, const Property& list) {
  const double count = body.read(list.countType);
  if (!(count >= 0 && count <= 1e9)) body.fail(fmt::format("a list cannot have {} elements", count));
  return static_cast<std::int64_t>(count);
}

void skip(Body& body, const Property& property) {
  const std::int64_t count = property.isList ? readCount(body, property) : 1;
  for (std::int64_t i = 0; i < count; ++i) body.read(property.type);
}

/// What a mesh needs of each vertex.
struct VertexData {
  std::vector<sk::float3> normals;
  std::vector<sk::float2> texture;
};

void readVertices(Body& body, const Element& element, Mesh& mesh, VertexData& data) {
  const auto has = [&](std::string_view name) {
    return std::ranges::any_of(element.properties,
                               [&](const Property& p) { return !p.isList && p.name == name; });
  };
  for (const std::string_view name : {"x", "y", "z"}) {
    if (!has(name)) body.fail(fmt::format("vertices have no property '{}'", name));
  }
  const bool hasNormals = has("nx") && has("ny") && has("nz");
  const bool hasTexture = (has("s") && has("t")) || (has("u") && has("v"));
  for (std::int64_t i = 0; i < element.count; ++i) {
    Vector p;
    sk::float3 n{};
    sk::float2 t{};
    for (const Property& property : element.properties) {
      if (property.isList) {
        skip(body, property);
        continue;
      }
      const double value = body.read(property.type);
      if (property.name == "x") p.x = value;
      if (property.name == "y") p.y = value;
      if (property.name == "z") p.z = value;
      if (property.name == "nx") n.x = static_cast<float>(value);
      if (property.name == "ny") n.y = static_cast<float>(value);
      if (property.name == "nz") n.z = static_cast<float>(value);
      if (property.name == "s" || property.name == "u") t.x = static_cast<float>(value);
      if (property.name == "t" || property.name == "v") t.y = static_cast<float>(value);
    }
    mesh.points.push_back(p);
    if (hasNormals) data.normals.push_back(n);
    if (hasTexture) data.texture.push_back(t);
  }
}

void readFace(Body& body, const Property& list, Mesh& mesh) {
  const std::int64_t corners = readCount(body, list);
  if (corners < 3) body.fail(fmt::format("a face has three corners at least, and this one has {}", corners));
  std::array<std::uint32_t, 3> points{};
  for (std::int64_t i = 0; i < corners; ++i) {
    const double index = body.read(list.type);
    if (!(index >= 0 && index < static_cast<double>(mesh.points.size())) || index != std::floor(index))
      body.fail(fmt::format("there is no vertex {}; they count from 0, and there are {}", index,
                            mesh.points.size()));
    if (i >= 2) points[1] = points[2];
    points[static_cast<std::size_t>(std::min<std::int64_t>(i, 2))] = static_cast<std::uint32_t>(index);
    if (i >= 2) mesh.faces.push_back({points, -1});
    if (i == 1) points[2] = points[1];
  }
}

void readFaces(Body& body, const Element& element, Mesh& mesh) {
  for (std::int64_t i = 0; i < element.count; ++i) {
    for (const Property& property : element.properties) {
      if (property.isList && (property.name == "vertex_indices" || property.name == "vertex_index"))
        readFace(body, property, mesh);
      else
        skip(body, property);
    }
  }
}

}  // namespace

Mesh parsePly(const std::string& name, std::string_view bytes) {
  TextCursor cursor(name, bytes);
  const Header header = readHeader(cursor);
  Body body(name, bytes, cursor, header.encoding);
  Mesh mesh;
  VertexData data;
  for (const Element& element : header.elements) {
    if (element.name == "vertex") {
      readVertices(body, element, mesh, data);
    } else if (element.name == "face") {
      readFaces(body, element, mesh);
    } else {
      for (std::int64_t i = 0; i < element.count && !element.properties.empty(); ++i)
        for (const Property& property : element.properties) skip(body, property);
    }
  }
  if (data.normals.empty() && data.texture.empty()) return mesh;
  for (const Face& face : mesh.faces) {
    Corners corners;
    for (std::size_t i = 0; i < 3; ++i) {
      if (!data.normals.empty()) corners.normals[i] = data.normals[face.points[i]];
      if (!data.texture.empty()) corners.texture[i] = data.texture[face.points[i]];
    }
    mesh.corners.push_back(corners);
  }
  return mesh;
}

}  // namespace rays
