// SPDX-License-Identifier: MIT
#include "transforms/wide_types.hpp"

#include <algorithm>
#include <utility>
#include <vector>

#include "ir/build.hpp"

namespace skc {

using namespace ir;

bool WideTypes::holdsFloat(Type type) const {
  if (type.kind == Type::Kind::Array) return holdsFloat(module_.arrays[type.index].element);
  if (type.kind != Type::Kind::Struct) return type.isFloat();
  return std::ranges::any_of(module_.structs[type.index].fields,
                             [&](const StructField& field) { return holdsFloat(field.type); });
}

Type WideTypes::of(Type type) {
  if (!holdsFloat(type)) return type;
  if (type.kind == Type::Kind::Array) {
    const Array array = module_.arrays[type.index];
    return arrayOf(module_, of(array.element), array.length);
  }
  if (type.kind != Type::Kind::Struct) return type.withScalar(Scalar::Double);
  if (const auto known = structs_.find(type.index); known != structs_.end()) {
    return Type::structType(known->second);
  }
  Struct wide = module_.structs[type.index];
  wide.name += "_wide";
  wide.isSynthesized = true;
  for (StructField& field : wide.fields) field.type = of(field.type);
  module_.structs.push_back(std::move(wide));
  const auto index = static_cast<std::uint32_t>(module_.structs.size() - 1);
  structs_[type.index] = index;
  return Type::structType(index);
}

ExprPtr WideTypes::widened(ExprPtr value) {
  const Type to = of(value->type);
  return converted(std::move(value), to);
}

ExprPtr WideTypes::narrowed(ExprPtr value, Type to) { return converted(std::move(value), to); }

/// The value is evaluated once per part, since expressions have no side effects.
ExprPtr WideTypes::converted(ExprPtr value, Type to) {
  if (value->type == to) return value;
  const Loc loc = value->loc;
  if (to.isArithmetic()) return convert(to.scalar, std::move(value), loc);
  std::vector<ExprPtr> parts;
  if (to.kind == Type::Kind::Array) {
    const Array array = module_.arrays[to.index];
    for (std::uint32_t i = 0; i < array.length; ++i) {
      parts.push_back(
          converted(index(module_, clone(value), literal(static_cast<std::int32_t>(i)), loc), array.element));
    }
  } else {
    for (std::uint32_t i = 0; i < module_.structs[to.index].fields.size(); ++i) {
      parts.push_back(
          converted(member(module_, clone(value), i, loc), module_.structs[to.index].fields[i].type));
    }
  }
  return construct(to, std::move(parts), loc);
}

}  // namespace skc
