// SPDX-License-Identifier: MIT
#include "native/leaves.hpp"

#include <functional>
#include <numeric>

#include "analysis/shapes.hpp"
#include "ir/build.hpp"

namespace skc::native {

using namespace ir;

namespace {

void addLeaves(const Module& module, Type type, std::vector<std::uint32_t>& dimensions,
               std::vector<Leaf>& leaves) {
  switch (type.kind) {
    case Type::Kind::Void: return;
    case Type::Kind::Scalar:
    case Type::Kind::Vector:
    case Type::Kind::Matrix: {
      const int count = type.isMatrix() ? type.width * type.width : type.width;
      leaves.insert(leaves.end(), static_cast<std::size_t>(count), {type.scalar, dimensions});
      return;
    }
    case Type::Kind::Struct:
      for (const StructField& field : module.structs[type.index].fields) {
        addLeaves(module, field.type, dimensions, leaves);
      }
      return;
    case Type::Kind::Array:
      dimensions.push_back(module.arrays[type.index].length);
      addLeaves(module, module.arrays[type.index].element, dimensions, leaves);
      dimensions.pop_back();
      return;
  }
}

/// Adds the components of a type whose leaves are numbered from `leaf` on.
void addComponents(const Module& module, Type type, std::uint32_t leaf, std::vector<Component>& components) {
  switch (type.kind) {
    case Type::Kind::Void: return;
    case Type::Kind::Scalar:
    case Type::Kind::Vector:
    case Type::Kind::Matrix: {
      const auto count = static_cast<std::uint32_t>(type.isMatrix() ? type.width * type.width : type.width);
      for (std::uint32_t i = 0; i < count; ++i) components.push_back({leaf + i, 0});
      return;
    }
    case Type::Kind::Struct:
      for (const StructField& field : module.structs[type.index].fields) {
        addComponents(module, field.type, leaf, components);
        leaf += static_cast<std::uint32_t>(analysis::leafCount(module, field.type));
      }
      return;
    case Type::Kind::Array: {
      const Array& array = module.arrays[type.index];
      const std::vector<Leaf> inner = leavesOf(module, array.element);
      for (std::uint32_t i = 0; i < array.length; ++i) {
        const std::size_t first = components.size();
        addComponents(module, array.element, leaf, components);
        for (std::size_t c = first; c < components.size(); ++c) {
          components[c].offset += i * inner[components[c].leaf - leaf].count();
        }
      }
      return;
    }
  }
}

}  // namespace

std::uint32_t Leaf::count() const {
  return std::accumulate(dimensions.begin(), dimensions.end(), std::uint32_t{1}, std::multiplies<>());
}

std::vector<Leaf> leavesOf(const Module& module, Type type) {
  std::vector<std::uint32_t> dimensions;
  std::vector<Leaf> leaves;
  addLeaves(module, type, dimensions, leaves);
  return leaves;
}

std::vector<Component> componentsOf(const Module& module, Type type) {
  std::vector<Component> components;
  addComponents(module, type, 0, components);
  return components;
}

std::vector<Scalar> scalarsOf(const Module& module, Type type) {
  const std::vector<Leaf> leaves = leavesOf(module, type);
  std::vector<Scalar> scalars;
  for (const Component& component : componentsOf(module, type))
    scalars.push_back(leaves[component.leaf].scalar);
  return scalars;
}

std::uint32_t componentCount(const Module& module, Type type) {
  return static_cast<std::uint32_t>(scalarCount(module, type));
}

std::uint32_t leavesBefore(const Module& module, Type type, std::uint32_t field) {
  std::uint32_t count = 0;
  for (std::uint32_t i = 0; i < field; ++i) {
    count +=
        static_cast<std::uint32_t>(analysis::leafCount(module, module.structs[type.index].fields[i].type));
  }
  return count;
}

std::uint32_t componentsBefore(const Module& module, Type type, std::uint32_t field) {
  std::uint32_t count = 0;
  for (std::uint32_t i = 0; i < field; ++i) {
    count += componentCount(module, module.structs[type.index].fields[i].type);
  }
  return count;
}

}  // namespace skc::native
