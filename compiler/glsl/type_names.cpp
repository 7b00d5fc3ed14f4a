// SPDX-License-Identifier: MIT
#include "glsl/type_names.hpp"

#include <array>
#include <string_view>

#include "glsl/constants.hpp"
#include "glsl/words.hpp"

namespace skc::emit {
namespace {

using namespace ir;

/// Different names for several things.
class TakenNames {
 public:
  explicit TakenNames(std::set<std::string>& taken) : taken_(taken) {}
  bool isTaken(const std::string& name) const { return taken_.contains(name); }
  std::string take(const std::string& wanted) {
    std::string name = unique_.find(wanted, [&](const std::string& n) { return isTaken(n); });
    taken_.insert(name);
    return name;
  }

 private:
  std::set<std::string>& taken_;
  UniqueNames unique_;
};

/// The struct's own name, with its namespaces if another struct has that name already.
std::string nameOf(const Struct& type, TakenNames& names) {
  const std::string name = glslSafe(type.name) + (isGlslFunction(type.name) ? "_" : "");
  if (!names.isTaken(name)) return names.take(name);
  std::string qualified;
  for (const std::string& part : type.scope) qualified += part + "_";
  return names.take(glslSafe(qualified + type.name));
}

/// Renames `length`: glslang takes `.length` for the beginning of an array's `.length()` everywhere.
std::string nameOf(const StructField& field, TakenNames& names) {
  return names.take(glslSafe(field.name) + (field.name == "length" ? "_" : ""));
}

}  // namespace

TypeNames::TypeNames(const Module& module) : module_(&module) {
  TakenNames structs(structNames_);
  for (const Struct& type : module.structs) {
    structs_.push_back(nameOf(type, structs));
    std::set<std::string> taken;
    TakenNames members(taken);
    std::vector<std::string> fields;
    for (const StructField& field : type.fields) fields.push_back(nameOf(field, members));
    fields_.push_back(std::move(fields));
  }
  UniqueNames constants;
  const std::vector<bool> isFunction = functionConstants(module);
  for (ConstantId id = 0; id < module.constants.size(); ++id) {
    const std::string name =
        constants.find(glslSafeGlobal(module.constants[id].name),
                       [&](const std::string& n) { return isStructName(n) || isConstantName(n); });
    constants_.push_back(name);
    constantNames_.insert(name);
    constantUses_.push_back(name + (isFunction[id] ? "()" : ""));
  }
}

std::string glslSpelling(Scalar scalar, int width) {
  constexpr std::array<std::string_view, 7> scalars = {"bool",      "int",     "uint",    "float",
                                                       "sk_double", "sk_long", "sk_ulong"};
  constexpr std::array<std::string_view, 7> vectors = {"bvec",      "ivec",    "uvec",    "vec",
                                                       "sk_double", "sk_long", "sk_ulong"};
  const auto row = static_cast<std::size_t>(arithmeticScalar(scalar));
  return width == 1 ? std::string(scalars[row]) : std::string(vectors[row]) + std::to_string(width);
}

std::string glslSpelling(Type type) { return glslSpelling(type.scalar, type.width); }

std::string TypeNames::glsl(Type type) const {
  switch (type.kind) {
    case Type::Kind::Void: return "void";
    case Type::Kind::Scalar:
    case Type::Kind::Vector: return glslSpelling(type.scalar, type.width);
    case Type::Kind::Matrix: return "mat" + std::to_string(type.width);
    case Type::Kind::Struct: return structs_[type.index];
    case Type::Kind::Array: break;
  }
  const Array& array = module_->arrays[type.index];
  return glsl(array.element) + "[" + std::to_string(array.length) + "]";
}

std::string TypeNames::declaration(Type type, const std::string& name) const {
  if (type.kind != Type::Kind::Array) return glsl(type) + " " + name;
  const Array& array = module_->arrays[type.index];
  return glsl(array.element) + " " + name + "[" + std::to_string(array.length) + "]";
}

}  // namespace skc::emit
