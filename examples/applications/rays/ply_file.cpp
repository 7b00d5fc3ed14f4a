// SPDX-License-Identifier: MIT
//
// PLY files (G. Turk, "The PLY polygon file format", 1994), as text and binary in both orders of bytes. Elements come in any order; those
// other than vertices and faces, and properties that nobody needs, are passed over; polygons are cut.
#include "mesh.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <map>
#include <span>
#include <stdexcept>
#include <utility>

#include <fmt/format.h>

#include "support/text_cursor.hpp"
#include "support/triangulation.hpp"

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

  bool has(std::string_view property, bool isList = false) const {
    return std::ranges::any_of(properties,
                               [&](const Property& p) { return p.isList == isList && p.name == property; });
  }
};

struct Header {
  Encoding encoding = Encoding::Text;
  std::vector<Element> elements;

  const Element* find(std::string_view name) const {
    const auto found = std::ranges::find(elements, name, &Element::name);
    return found == elements.end() ? nullptr : &*found;
  }
};

/// The names of the list that a face has of its corners.
constexpr std::array<std::string_view, 2> cornerLists = {"vertex_indices", "vertex_index"};

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

Element elementOf(TextCursor& cursor, const Header& header) {
  Element element{.name = std::string(cursor.word())};
  if (header.find(element.name))
    cursor.fail(fmt::format("there is another element '{}' above", element.name));
  element.count = cursor.needInteger("the number of elements");
  if (element.count < 0) cursor.fail("an element cannot be there less than 0 times");
  return element;
}

/// Whether the mesh has what it needs, at the line that ends the header.
void checkHeader(const TextCursor& cursor, const Header& header) {
  if (const Element* vertex = header.find("vertex"); vertex && vertex->count > 0) {
    for (const std::string_view name : {"x", "y", "z"}) {
      if (!vertex->has(name)) cursor.fail(fmt::format("vertices have no property '{}'", name));
    }
  }
  const Element* face = header.find("face");
  if (face && face->count > 0 && !face->has(cornerLists[0], true) && !face->has(cornerLists[1], true))
    cursor.fail("faces have no list 'vertex_indices'");
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
      header.elements.push_back(elementOf(cursor, header));
    } else if (key == "property") {
      if (header.elements.empty()) cursor.fail("a property comes after its element");
      header.elements.back().properties.push_back(propertyOf(cursor));
    } else if (key == "end_header") {
      if (!hasFormat) cursor.fail("the header has no line 'format'");
      checkHeader(cursor, header);
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
      : name_(name), bytes_(bytes), cursor_(cursor), encoding_(encoding), at_(cursor.bytesBehind()) {}

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
  /// Text has nothing behind the last element.
  void end() {
    if (encoding_ == Encoding::Text && !cursor_.wordOnAnyLine().empty())
      fail("the file goes on after its last element; the header has fewer");
  }
  [[noreturn]] void fail(std::string_view message) const {
    if (encoding_ == Encoding::Text) cursor_.fail(message);
    throw std::runtime_error(fmt::format("{}: byte {}: {}", name_, at_, message));
  }

 private:
  /// The words of text files may stand on any lines.
  double readText(Number type) {
    const std::string_view word = cursor_.wordOnAnyLine();
    if (word.empty()) cursor_.fail("the file ends too early");
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
  if (!(count >= 0 && count <= 1e9 && count == std::floor(count)))
    body.fail(fmt::format("a list cannot have {} elements", count));
  return static_cast<std::int64_t>(count);
}

void skip(Body& body, const Property& property) {
  const std::int64_t count = property.isList ? readCount(body, property) : 1;
  for (std::int64_t i = 0; i < count; ++i) body.read(property.type);
}

/// What the body says: vertices, and the corners of all faces one behind the other.
struct Polygons {
  std::vector<Vector> points;
  std::vector<sk::float3> normals;  ///< of each vertex, or none at all
  std::vector<sk::float2> textures;  ///< of each vertex, or none at all
  std::vector<std::uint32_t> corners;
  std::vector<std::size_t> ends;  ///< of each face, in corners
};

void readVertex(Body& body, const Element& element, Polygons& polygons) {
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
  polygons.points.push_back(p);
  polygons.normals.push_back(n);
  polygons.textures.push_back(t);
}

/// `vertices` is how many the header promises, as they may follow the faces.
void readFace(Body& body, const Element& element, std::int64_t vertices, Polygons& polygons) {
  for (const Property& property : element.properties) {
    if (!property.isList || std::ranges::find(cornerLists, property.name) == cornerLists.end()) {
      skip(body, property);
      continue;
    }
    const std::int64_t corners = readCount(body, property);
    if (corners < 3)
      body.fail(fmt::format("a face has three corners at least, and this one has {}", corners));
    for (std::int64_t i = 0; i < corners; ++i) {
      const double index = body.read(property.type);
      if (!(index >= 0 && index < static_cast<double>(vertices) && index <= UINT32_MAX) ||
          index != std::floor(index))
        body.fail(fmt::format("there is no vertex {}; they count from 0, and there are {}", index, vertices));
      polygons.corners.push_back(static_cast<std::uint32_t>(index));
    }
    polygons.ends.push_back(polygons.corners.size());
  }
}

Polygons readBody(Body& body, const Header& header) {
  const Element* const vertex = header.find("vertex");
  const Element* const face = header.find("face");
  Polygons polygons;
  for (const Element& element : header.elements) {
    if (element.properties.empty()) continue;  // however many there are, they take no bytes
    for (std::int64_t i = 0; i < element.count; ++i) {
      if (&element == vertex) {
        readVertex(body, element, polygons);
      } else if (&element == face) {
        readFace(body, element, vertex ? vertex->count : 0, polygons);
      } else {
        for (const Property& property : element.properties) skip(body, property);
      }
    }
  }
  body.end();
  const auto has = [&](std::string_view name) { return vertex && vertex->has(name); };
  if (!(has("nx") && has("ny") && has("nz"))) polygons.normals.clear();
  if (!(has("s") && has("t")) && !(has("u") && has("v"))) polygons.textures.clear();
  return polygons;
}

Corners cornersOf(const Polygons& polygons, const Face& face) {
  Corners corners;
  for (std::size_t i = 0; i < 3; ++i) {
    if (!polygons.normals.empty()) corners.normals[i] = polygons.normals[face.points[i]];
    if (!polygons.textures.empty()) corners.texture[i] = polygons.textures[face.points[i]];
  }
  return corners;
}

}  // namespace

Mesh parsePly(const std::string& name, std::string_view bytes) {
  TextCursor cursor(name, bytes);
  const Header header = readHeader(cursor);
  Body body(name, bytes, cursor, header.encoding);
  Polygons polygons = readBody(body, header);
  Mesh mesh;
  std::vector<Vector> positions;
  std::vector<std::array<std::uint32_t, 3>> triangles;
  std::size_t first = 0;
  for (const std::size_t end : polygons.ends) {
    const std::span face = std::span(polygons.corners).subspan(first, end - first);
    positions.clear();
    for (const std::uint32_t corner : face) positions.push_back(polygons.points[corner]);
    examples::triangulate(positions, triangles);
    for (const auto& [a, b, c] : triangles) {
      mesh.faces.push_back({{face[a], face[b], face[c]}, -1});
      if (!polygons.normals.empty() || !polygons.textures.empty())
        mesh.corners.push_back(cornersOf(polygons, mesh.faces.back()));
    }
    first = end;
  }
  mesh.points = std::move(polygons.points);
  return mesh;
}

}  // namespace rays
