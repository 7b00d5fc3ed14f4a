// SPDX-License-Identifier: MIT
#include "cpp/types.hpp"

#include <algorithm>
#include <utility>

namespace fuzz::cpp {
namespace {

constexpr const char* scalarNames[scalarCount] = {"bool", "char", "uchar", "short", "ushort",
                                                  "int",  "uint", "float", "double"};

}  // namespace

Types::Types() {
  for (int i = 0; i < scalarCount; ++i)
    all_.push_back({.kind = Type::Kind::Scalar, .scalar = static_cast<Scalar>(i), .name = scalarNames[i]});
  for (int first = 1; first < scalarCount; ++first) {
    const auto scalar = static_cast<Scalar>(first);
    for (int width = 2; width <= 4; ++width) {
      all_.push_back({.kind = Type::Kind::Vector,
                      .scalar = scalar,
                      .count = width,
                      .element = of(scalar),
                      .name = scalarNames[of(scalar)] + std::to_string(width)});
    }
  }
  for (int size = 2; size <= 4; ++size) {
    const std::string name = "float" + std::to_string(size) + "x" + std::to_string(size);
    all_.push_back({.kind = Type::Kind::Matrix,
                    .scalar = Scalar::Float,
                    .count = size,
                    .element = vector(Scalar::Float, size),
                    .name = name});
  }
}

TypeId Types::vector(Scalar scalar, int count) { return scalarCount + (of(scalar) - 1) * 3 + count - 2; }

TypeId Types::matrix(int count) const { return scalarCount + 3 * (scalarCount - 1) + count - 2; }

TypeId Types::array(TypeId element, int count) {
  for (int i = 0; i < size(); ++i) {
    const Type& type = (*this)[i];
    if (type.kind == Type::Kind::Array && type.element == element && type.count == count) return i;
  }
  return add({.kind = Type::Kind::Array, .count = count, .element = element});
}

TypeId Types::add(Type type) {
  all_.push_back(std::move(type));
  return size() - 1;
}

bool Types::isOfScalars(TypeId id) const {
  const Type& type = (*this)[id];
  if (type.kind == Type::Kind::Array) return isOfScalars(type.element);
  if (type.kind == Type::Kind::Struct)
    return std::ranges::all_of(type.fields, [&](const Field& field) { return isOfScalars(field.type); });
  return type.kind == Type::Kind::Scalar || type.kind == Type::Kind::Enum;
}

int Types::leaves(TypeId id) const {
  const Type& type = (*this)[id];
  switch (type.kind) {
    case Type::Kind::Scalar:
    case Type::Kind::Enum: return 1;
    case Type::Kind::Vector: return type.count;
    case Type::Kind::Matrix: return type.count * type.count;
    case Type::Kind::Array: return type.count * leaves(type.element);
    case Type::Kind::Struct: break;
  }
  int sum = 0;
  for (const Field& field : type.fields) sum += leaves(field.type);
  return sum;
}

TypeId Types::promoted(TypeId id) const {
  const Type& type = (*this)[id];
  const bool isUint = type.scalar == Scalar::Uint && (type.kind == Type::Kind::Scalar || type.isFixed);
  return of(isUint ? Scalar::Uint : Scalar::Int);
}

TypeId Types::common(TypeId a, TypeId b) const {
  const TypeId isUint = of(Scalar::Uint);
  return promoted(a) == isUint || promoted(b) == isUint ? isUint : of(Scalar::Int);
}

std::string Types::declare(TypeId id, const std::string& name) const {
  std::string suffix;
  while ((*this)[id].kind == Type::Kind::Array) {
    suffix += "[" + std::to_string((*this)[id].count) + "]";
    id = (*this)[id].element;
  }
  return spell(id) + " " + name + suffix;
}

std::string Types::declareReference(TypeId id, const std::string& name) const {
  if ((*this)[id].kind == Type::Kind::Array) return declare(id, "(&" + name + ")");
  return spell(id) + "& " + name;
}

std::string Types::spell(TypeId id) const { return (*this)[id].name; }

std::string Types::simplest(TypeId id) const {
  const Type& type = (*this)[id];
  switch (type.kind) {
    case Type::Kind::Scalar:
      switch (type.scalar) {
        case Scalar::Bool: return "false";
        case Scalar::Int: return "0";
        case Scalar::Uint: return "0u";
        case Scalar::Float: return "0.0f";
        case Scalar::Double: return "double(0)";
        default: return spell(id) + "(0)";
      }
    case Type::Kind::Vector: return spell(id) + "(" + simplest(type.element) + ")";
    case Type::Kind::Matrix: return {};
    case Type::Kind::Struct: return spell(id) + "{}";
    case Type::Kind::Enum: return type.enumerators.front();
    case Type::Kind::Array: return {};
  }
  return {};
}

}  // namespace fuzz::cpp
