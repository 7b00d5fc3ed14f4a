// SPDX-License-Identifier: MIT
#include "cpp/types.hpp"

#include <algorithm>
#include <utility>

namespace fuzz::cpp {
namespace {

const std::vector<std::string> ints = {"0",
                                       "1",
                                       "2",
                                       "3",
                                       "5",
                                       "7",
                                       "8",
                                       "10",
                                       "31",
                                       "100",
                                       "127",
                                       "128",
                                       "255",
                                       "256",
                                       "0x7fff",
                                       "65535",
                                       "123456789",
                                       "2147483647",
                                       "(-2147483647 - 1)",
                                       "(-1)",
                                       "(-2)",
                                       "(-7)",
                                       "(-100)",
                                       "0x55aa"};
const std::vector<std::string> uints = {"0u",     "1u",          "2u",          "3u",         "7u",
                                        "9u",     "16u",         "255u",        "256u",       "1000u",
                                        "65535u", "0x80000000u", "4294967295u", "4294967290u"};
const std::vector<std::string> longs = {"long(0)",
                                        "long(1)",
                                        "long(-1)",
                                        "long(7)",
                                        "long(-100)",
                                        "long(63)",
                                        "(long(1) << 31)",
                                        "(long(1) << 32)",
                                        "(-(long(1) << 32))",
                                        "(long(1) << 63)",
                                        "(~(long(1) << 63))",
                                        "((long(1) << 63) + 1)",
                                        "(long(0x01234567) << 32)",
                                        "long(0xffffffffu)"};
const std::vector<std::string> ulongs = {
    "ulong(0u)",         "ulong(1u)",    "ulong(9u)",    "ulong(255u)",        "(ulong(1u) << 32)",
    "(ulong(1u) << 63)", "(~ulong(0u))", "(~ulong(5u))", "ulong(0xffffffffu)", "(ulong(0x89abcdefu) << 32)"};

/// One row for each Scalar.
const ScalarFacts scalars[scalarCount] = {
    {"bool", 1, false, "false", {"false", "true"}},
    {"char", 8, true, "char(0)", ints},
    {"uchar", 8, false, "uchar(0)", ints},
    {"short", 16, true, "short(0)", ints},
    {"ushort", 16, false, "ushort(0)", ints},
    {"int", 32, true, "0", ints},
    {"uint", 32, false, "0u", uints},
    {"long", 64, true, "long(0)", longs},
    {"ulong", 64, false, "ulong(0u)", ulongs},
    {"float", 32, true, "0.0f"},
    {"double", 64, true, "double(0)"},
};

}  // namespace

const ScalarFacts& factsOf(Scalar scalar) { return scalars[static_cast<std::size_t>(scalar)]; }

Types::Types() {
  for (int i = 0; i < scalarCount; ++i)
    all_.push_back({.kind = Type::Kind::Scalar, .scalar = static_cast<Scalar>(i), .name = scalars[i].name});
  for (int first = 1; first < scalarCount; ++first) {
    const auto scalar = static_cast<Scalar>(first);
    for (int width = 2; width <= 4; ++width) {
      all_.push_back({.kind = Type::Kind::Vector,
                      .scalar = scalar,
                      .count = width,
                      .element = of(scalar),
                      .name = factsOf(scalar).name + std::to_string(width)});
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
  all_.push_back({.kind = Type::Kind::Index, .count = anyRank, .name = "index<N>"});
}

TypeId Types::vector(Scalar scalar, int count) { return scalarCount + (of(scalar) - 1) * 3 + count - 2; }

TypeId Types::matrix(int count) const { return scalarCount + 3 * (scalarCount - 1) + count - 2; }

TypeId Types::indexOfAnyRank() { return scalarCount + 3 * (scalarCount - 1) + 3; }

TypeId Types::array(TypeId element, int count) {
  for (int i = 0; i < size(); ++i) {
    const Type& type = (*this)[i];
    if (type.kind == Type::Kind::Array && type.element == element && type.count == count) return i;
  }
  return add({.kind = Type::Kind::Array, .count = count, .element = element});
}

TypeId Types::gather(TypeId element, int rank) {
  for (int i = 0; i < size(); ++i) {
    const Type& type = (*this)[i];
    if (type.kind == Type::Kind::Gather && type.element == element && type.count == rank) return i;
  }
  const std::string name =
      "gather<" + spell(element) + ", " + (rank == anyRank ? "N" : std::to_string(rank)) + ">";
  return add({.kind = Type::Kind::Gather, .count = rank, .element = element, .name = name});
}

TypeId Types::atRank(TypeId id, int rank) {
  const Type type = (*this)[id];
  if (!isOfAnyRank(id) || rank == anyRank) return id;
  if (type.kind == Type::Kind::Gather) return gather(type.element, rank);
  if (type.kind == Type::Kind::Index) return rank == 1 ? of(Scalar::Int) : vector(Scalar::Int, rank);
  for (TypeId other = 0; other < size(); ++other) {
    if ((*this)[other].family == id && (*this)[other].count == rank) return other;
  }
  Type instance = type;
  instance.count = rank;
  instance.name.replace(instance.name.rfind("<N>"), 3, "<" + std::to_string(rank) + ">");
  for (Field& field : instance.fields) field.type = atRank(field.type, rank);
  return add(std::move(instance));
}

bool Types::isOfAnyRank(TypeId id) const {
  const Type& type = (*this)[id];
  if (type.kind == Type::Kind::Bundle) return type.family >= 0 && type.count == anyRank;
  return (type.kind == Type::Kind::Gather || type.kind == Type::Kind::Index) && type.count == anyRank;
}

bool Types::isUniform(TypeId id, bool mayHaveArrays) const {
  const Type& type = (*this)[id];
  switch (type.kind) {
    case Type::Kind::Scalar:
    case Type::Kind::Vector: return !isWideInteger(id);
    case Type::Kind::Enum:
      return type.isFixed && !type.isWide;  // others do not hold all values of their bits
    case Type::Kind::Array: return mayHaveArrays && isUniform(type.element, true);
    case Type::Kind::Struct:
      return std::ranges::all_of(type.fields,
                                 [&](const Field& field) { return isUniform(field.type, mayHaveArrays); });
    default: return false;
  }
}

int Types::planes(TypeId id) const {
  const Type& type = (*this)[id];
  int sum = 0;
  switch (type.kind) {
    case Type::Kind::Gather: {
      const Type& element = (*this)[type.element];
      if (element.kind != Type::Kind::Struct)
        return element.scalar == Scalar::Double && element.count > 2 ? 2 : 1;
      for (const Field& field : element.fields) sum += leaves(field.type);
      return sum;
    }
    case Type::Kind::Bundle:
      for (const Field& field : type.fields) sum += planes(field.type);
      return sum;
    default: return 0;
  }
}

int Types::specs(TypeId id) const {
  const Type& type = (*this)[id];
  int sum = 0;
  if (type.kind != Type::Kind::Bundle) return 0;
  for (const Field& field : type.fields) sum += field.isSpec ? 1 : specs(field.type);
  return sum;
}

TypeId Types::add(Type type) {
  all_.push_back(std::move(type));
  return size() - 1;
}

bool Types::isWideInteger(TypeId id) const {
  const Type& type = (*this)[id];
  return (type.kind == Type::Kind::Scalar || type.kind == Type::Kind::Vector) &&
         type.scalar < Scalar::Float && factsOf(type.scalar).bits == 64;
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
    case Type::Kind::Index: return 4;
    case Type::Kind::Gather: return 0;
    case Type::Kind::Struct:
    case Type::Kind::Bundle: break;
  }
  int sum = 0;
  for (const Field& field : type.fields) sum += leaves(field.type);
  return sum;
}

TypeId Types::promoted(TypeId id) const {
  const Type& type = (*this)[id];
  if (isWideInteger(id)) return of(type.scalar);
  const bool isUint = type.scalar == Scalar::Uint && (type.kind == Type::Kind::Scalar || type.isFixed);
  return of(isUint ? Scalar::Uint : Scalar::Int);
}

TypeId Types::common(TypeId a, TypeId b) const {
  const TypeId isUint = of(Scalar::Uint);
  for (const Scalar wide : {Scalar::Ulong, Scalar::Long}) {
    if (promoted(a) == of(wide) || promoted(b) == of(wide)) return of(wide);
  }
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
    case Type::Kind::Scalar: return factsOf(type.scalar).zero;
    case Type::Kind::Vector: return spell(id) + "(" + simplest(type.element) + ")";
    case Type::Kind::Matrix: return {};
    case Type::Kind::Struct: return spell(id) + "{}";
    case Type::Kind::Enum: return type.enumerators.front();
    case Type::Kind::Index: return "index<N>(0)";
    case Type::Kind::Array:
    case Type::Kind::Gather:
    case Type::Kind::Bundle: return {};
  }
  return {};
}

}  // namespace fuzz::cpp
