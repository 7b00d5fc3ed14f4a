// SPDX-License-Identifier: MIT
#include "program/used_structs.hpp"

#include <algorithm>

namespace skc::emit {
namespace {

using namespace ir;

void add(const Module& module, Type type, std::vector<std::uint32_t>& list) {
  if (type.kind == Type::Kind::Array) return add(module, module.arrays[type.index].element, list);
  if (type.kind != Type::Kind::Struct || std::ranges::find(list, type.index) != list.end()) return;
  for (const StructField& field : module.structs[type.index].fields) add(module, field.type, list);
  list.push_back(type.index);
}

}  // namespace

std::vector<std::uint32_t> usedStructs(const Module& module) {
  std::vector<std::uint32_t> list;
  for (const Kernel& kernel : module.kernels) {
    if (kernel.isSynthesized) continue;
    for (const KernelParam& param : kernel.params) add(module, param.type, list);
  }
  for (const DeclaredStream& stream : module.streams) add(module, stream.type, list);
  return list;
}

}  // namespace skc::emit
