// SPDX-License-Identifier: MIT
#include "program/elements.hpp"

#include <algorithm>
#include <cassert>

#include "sk/scalar_bytes.hpp"

namespace skc::emit {
namespace {

using namespace ir;

std::uint32_t alignUp(std::uint32_t offset, std::uint32_t alignment) {
  return (offset + alignment - 1) / alignment * alignment;
}

std::uint32_t bytesOf(Scalar scalar) {
  return static_cast<std::uint32_t>(sk::program::hostBytes(static_cast<sk::program::Scalar>(scalar)));
}

ElementLayout matrixLayout(Type type) {
  const std::uint32_t row = 4U * type.width;
  ElementLayout layout{{}, row * type.width, 4};
  for (std::uint32_t i = 0; i < type.width; ++i) {
    layout.planes.push_back(
        {"", "rows[" + std::to_string(i) + "]", type.indexed(), i * row, static_cast<int>(i)});
  }
  return layout;
}

/// Two wide scalars fill the four channels of a texel.
ElementLayout wideVectorLayout(Type type) {
  ElementLayout layout{{}, 8U * type.width, 8};
  for (const Type plane : widePlanes(type)) {
    const auto number = static_cast<std::uint32_t>(layout.planes.size());
    layout.planes.push_back({"", number == 0 ? "x" : "z", plane, 16 * number, static_cast<int>(number)});
  }
  return layout;
}

std::string joinPath(const std::string& outer, const std::string& inner) {
  return inner.empty() || inner.front() == '[' ? outer + inner : outer + "." + inner;
}

ElementLayout arrayLayout(const Module& module, const TypeNames& types, const Array& array) {
  const ElementLayout inner = elementLayout(module, types, array.element);
  ElementLayout layout{{}, inner.size * array.length, inner.alignment};
  for (std::uint32_t i = 0; i < array.length; ++i) {
    const std::string place = "[" + std::to_string(i) + "]";
    for (const Plane& plane : inner.planes) {
      layout.planes.push_back({joinPath(place, plane.path), joinPath(place, plane.member), plane.type,
                               i * inner.size + plane.offset, plane.part});
    }
  }
  return layout;
}

}  // namespace

ElementLayout elementLayout(const Module& module, const TypeNames& types, Type type) {
  if (type.isMatrix()) return matrixLayout(type);
  if (type.is64Bit() && type.width > 2) return wideVectorLayout(type);
  if (type.isArithmetic()) {
    const std::uint32_t component = bytesOf(type.scalar);
    return {{{"", "", type, 0}}, component * type.width, component};
  }
  if (type.kind == Type::Kind::Array) return arrayLayout(module, types, module.arrays[type.index]);
  assert(type.kind == Type::Kind::Struct && "the frontend lets no other type be an element");
  ElementLayout layout;
  const std::vector<StructField>& fields = module.structs[type.index].fields;
  for (std::uint32_t i = 0; i < fields.size(); ++i) {
    const ElementLayout inner = elementLayout(module, types, fields[i].type);
    layout.size = alignUp(layout.size, inner.alignment);
    for (const Plane& plane : inner.planes) {
      layout.planes.push_back({joinPath(types.fieldName(type.index, i), plane.path),
                               joinPath(fields[i].name, plane.member), plane.type, layout.size + plane.offset,
                               plane.part});
    }
    layout.size += inner.size;
    layout.alignment = std::max(layout.alignment, inner.alignment);
  }
  layout.size = alignUp(layout.size, layout.alignment);
  return layout;
}

std::uint32_t offsetOf(const Module& module, const TypeNames& types, Type type,
                       std::span<const std::uint32_t> members) {
  const ElementLayout layout = elementLayout(module, types, type);
  std::string path;
  for (const std::uint32_t member : members) {
    const StructField& field = module.structs[type.index].fields[member];
    path = path.empty() ? field.name : joinPath(path, field.name);
    type = field.type;
  }
  return std::ranges::find(layout.planes, path, &Plane::member)->offset;
}

}  // namespace skc::emit
