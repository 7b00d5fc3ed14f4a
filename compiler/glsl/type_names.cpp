// SPDX-License-Identifier: MIT
#include "glsl/type_names.hpp"

#include <algorithm>
#include <array>
#include <string_view>

#include "glsl/words.hpp"

namespace skc::emit {
namespace {

using namespace ir;

bool contains(const std::vector<std::string>& names, const std::string& name) {
  return std::find(names.begin(), names.end(), name) != names.end();
}

/// The struct's own name, with its namespaces if another struct has that name already.
std::string nameOf(const Struct& type, const std::vector<std::string>& taken) {
  const auto isTaken = [&](const std::string& name) { return contains(taken, name); };
  const std::string name = glslSafe(type.name) + (isGlslFunction(type.name) ? "_" : "");
  if (!isTaken(name)) return name;
  std::string qualified;
  for (const std::string& part : type.scope) qualified += part + "_";
  return uniqueName(glslSafe(qualified + type.name), isTaken);
}

/// Renames `length`: glslang takes `.length` for the beginning of an array's `.length()` everywhere.
std::string nameOf(const StructField& field, const std::vector<std::string>& taken) {
  const std::string name = glslSafe(field.name) + (field.name == "length" ? "_" : "");
  return uniqueName(name, [&](const std::string& n) { return contains(taken, n); });
}

}  // namespace

TypeNames::TypeNames(const Module& module) : module_(&module) {
  for (const Struct& type : module.structs) {
    structs_.push_back(nameOf(type, structs_));
    std::vector<std::string> fields;
    for (const StructField& field : type.fields) fields.push_back(nameOf(field, fields));
    fields_.push_back(std::move(fields));
  }
}

std::string glslSpelling(Scalar scalar, int width) {
  constexpr std::array<std::string_view, 5> scalars = {"bool", "int", "uint", "float", "sk_double"};
  constexpr std::array<std::string_view, 5> vectors = {"bvec", "ivec", "uvec", "vec", "sk_double"};
  const auto row = static_cast<std::size_t>(arithmeticScalar(scalar));
  return width == 1 ? std::string(scalars[row]) : std::string(vectors[row]) + std::to_string(width);
}

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
