// SPDX-License-Identifier: MIT
#include "program/used_structs.hpp"

#include <utility>

namespace skc::emit {
namespace {

using namespace ir;

struct Finder {
  const Module& module;
  std::vector<bool> isFound;
  std::vector<std::uint32_t> list;

  void add(Type type) {
    if (type.kind == Type::Kind::Array) return add(module.arrays[type.index].element);
    if (type.kind != Type::Kind::Struct || isFound[type.index]) return;
    for (const StructField& field : module.structs[type.index].fields) add(field.type);
    isFound[type.index] = true;
    list.push_back(type.index);
  }
};

}  // namespace

std::vector<std::uint32_t> usedStructs(const Module& module) {
  Finder finder{module, std::vector<bool>(module.structs.size(), false), {}};
  for (const Kernel& kernel : module.kernels) {
    if (kernel.isSynthesized) continue;
    for (const KernelParam& param : kernel.params) finder.add(param.type);
  }
  for (const DeclaredStream& stream : module.streams) finder.add(stream.type);
  return std::move(finder.list);
}

}  // namespace skc::emit
