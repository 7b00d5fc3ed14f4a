// SPDX-License-Identifier: MIT
#include "cpp/stream_types.hpp"

#include <functional>
#include <optional>

#include "cpp/body.hpp"

namespace fuzz::cpp {
namespace {

/// What bundles and kernels of a program may have together: fewer textures than every device has, and all spec parameters.
constexpr int mostPlanesOfBundle = 5;

std::string constant(Unit& unit, TypeId type) {
  Body body(unit, -1, 100, 100);
  body.stayConstant();
  const bool isVector = unit.types[type].kind == Type::Kind::Vector;
  std::string text = print(*(isVector ? body.value(type, 0) : body.literal(type)).node);
  text.pop_back();  // the end of the line
  return text;
}

TypeId pickUniform(Unit& unit) {
  for (int i = 0; i < 30; ++i) {
    const auto id = static_cast<TypeId>(unit.random.below(static_cast<std::size_t>(unit.types.size())));
    if (unit.types.leaves(id) > 12 || !unit.types.isUniform(id, true)) continue;
    if (unit.types[id].kind != Type::Kind::Array ? unit.mayHave(id) : unit.has("arrays")) return id;
  }
  return Types::of(Scalar::Int);
}

TypeId pickSpec(Unit& unit) {
  const std::vector<Scalar> scalars = {Scalar::Bool, Scalar::Int, Scalar::Uint, Scalar::Float};
  std::vector<TypeId> all;
  for (const Scalar scalar : scalars) all.push_back(Types::of(scalar));
  for (TypeId id = 0; id < unit.types.size(); ++id) {
    if (unit.types[id].kind == Type::Kind::Enum && unit.types.isUniform(id, false)) all.push_back(id);
  }
  return unit.random.pick(all);
}

/// Calls visit with the path of each scalar or vector in a uniform or an element.
void leaves(const Types& types, TypeId id, const std::string& path,
            const std::function<void(const std::string&)>& visit) {
  const Type& type = types[id];
  if (type.kind == Type::Kind::Struct) {
    for (const Field& field : type.fields) leaves(types, field.type, path + "." + field.name, visit);
  } else if (type.kind == Type::Kind::Array) {
    for (int i = 0; i < type.count; ++i)
      leaves(types, type.element, path + "[" + std::to_string(i) + "]", visit);
  } else {
    visit(path);
  }
}

void appendBindings(std::string& text, const Types& types, const std::string& object, const std::string& path,
                    const Field& field) {
  const Type& type = types[field.type];
  const std::string begin = "(" + object + ", " + path;
  if (type.kind == Type::Kind::Gather) {
    text += "SK_GATHER" + begin + ", " + field.mode + ")\n";
    leaves(types, type.element, "",
           [&](const std::string& leaf) { text += "SK_LEAF" + begin + ", " + leaf + ")\n"; });
    if (!field.border.empty()) text += "SK_BORDER" + begin + ", " + field.border + ")\n";
  } else if (type.kind == Type::Kind::Bundle) {
    for (const Field& member : type.fields)
      appendBindings(text, types, object, path + "." + member.name, member);
  } else {
    leaves(types, field.type, path,
           [&](const std::string& leaf) { text += "SK_VALUE(" + object + ", " + leaf + ")\n"; });
  }
}

}  // namespace

void addElement(Unit& unit, StreamTypes& streams) {
  for (int i = 0; i < 10; ++i) {
    const auto id = static_cast<TypeId>(unit.random.below(static_cast<std::size_t>(unit.types.size())));
    const int gather = unit.types.gather(id, 1);
    if (!unit.types.isUniform(id, false) || unit.types.planes(gather) > 3 || !unit.mayHave(id)) continue;
    streams.elements.push_back(id);
    return;
  }
}

TypeId pickStream(Unit& unit, const StreamTypes& streams, bool isOfAnyRank) {
  const int rank = isOfAnyRank ? anyRank : unit.random.chance(1, 8) ? 4 : unit.random.between(1, 3);
  if (isOfAnyRank && unit.random.chance(1, 3)) return Types::indexOfAnyRank();
  std::vector<TypeId> bundles;
  for (const TypeId id : streams.bundles) {
    const TypeId bundle = unit.types.atRank(id, rank);
    if (!isOfAnyRank || unit.types.isOfAnyRank(bundle)) bundles.push_back(bundle);
  }
  if (!bundles.empty() && unit.random.chance(1, 2)) return unit.random.pick(bundles);
  return unit.types.gather(unit.random.pick(streams.elements), rank);
}

void pickMode(Unit& unit, Field& field) {
  static const std::vector<std::string> modes = {"Clamp", "Wrap", "Mirror", "Border"};
  field.mode = unit.random.pick(modes);
  const TypeId element = unit.types[field.type].element;
  if (field.mode == "Border" && unit.types[element].kind == Type::Kind::Struct) field.mode = "Wrap";
  if (field.mode == "Border") field.border = constant(unit, element);
}

std::optional<Field> pickMember(Unit& unit, const StreamTypes& streams, Member kind, bool isOfAnyRank) {
  Field field;
  switch (kind) {
    case Member::Gather: {
      const bool isRanked = isOfAnyRank && unit.random.chance(2, 3);
      field.type = unit.types.gather(unit.random.pick(streams.elements),
                                     isRanked ? anyRank : unit.random.between(1, 3));
      pickMode(unit, field);
      return field;
    }
    case Member::Uniform: field.type = pickUniform(unit); return field;
    case Member::Spec:
      field.type = pickSpec(unit);
      field.isSpec = true;
      return field;
    case Member::Bundle: break;
  }
  if (streams.bundles.empty()) return std::nullopt;
  field.type = unit.random.pick(streams.bundles);
  if (!isOfAnyRank) field.type = unit.types.atRank(field.type, unit.random.between(1, 3));
  if (unit.types.planes(field.type) >= mostPlanesOfBundle || unit.types.specs(field.type) > 2)
    return std::nullopt;
  return field;
}

std::string declared(Unit& unit, const Field& field, bool mayHaveBrackets) {
  const Type& type = unit.types[field.type];
  if (type.kind != Type::Kind::Gather)
    return (field.isSpec ? "spec " : "") + unit.types.declare(field.type, field.name);
  std::string text;
  if (field.mode == "Border") text = "[[border(" + field.border + ")]] ";
  if (field.mode == "Wrap") text = "[[wrap]] ";
  if (field.mode == "Mirror") text = "[[mirror]] ";
  if (field.mode == "Clamp" && unit.random.chance(1, 2)) text = "[[clamp]] ";
  if (type.count == anyRank || !mayHaveBrackets || unit.random.chance(1, 2))
    return text + unit.types.declare(field.type, field.name);
  text += unit.types.spell(type.element) + " " + field.name;
  for (int d = 0; d < type.count; ++d) text += "[]";
  return text;
}

std::string bindings(const Types& types, const Field& parameter) {
  std::string text;
  appendBindings(text, types, parameter.name, "", parameter);
  return text;
}

}  // namespace fuzz::cpp
