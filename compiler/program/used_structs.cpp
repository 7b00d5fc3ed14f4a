// SPDX-License-Identifier: MIT
#include "program/used_structs.hpp"

#include <algorithm>
#include <utility>

#include "ir/call_graph.hpp"
#include "ir/walk.hpp"

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

class Levels {
 public:
  explicit Levels(const Module& module) : module_(module), ofStructs_(module.structs.size(), 0) {}

  int of(Type type) {
    if (type.kind == Type::Kind::Array) return of(module_.arrays[type.index].element);
    if (type.kind != Type::Kind::Struct) return type.scalar != Scalar::Double ? 0 : type.isScalar() ? 1 : 2;
    int& levels = ofStructs_[type.index];
    if (levels > 0) return levels;
    int inner = 0;
    for (const StructField& field : module_.structs[type.index].fields)
      inner = std::max(inner, of(field.type));
    return levels = 1 + inner;
  }

 private:
  const Module& module_;
  std::vector<int> ofStructs_;
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

int structLevels(const Module& module, const Kernel& kernel) {
  Levels levels(module);
  int most = 0;
  for (const FunctionId id : functionsOf(module, kernel)) {
    const Function& function = module.functions[id];
    for (const Variable& variable : function.variables) most = std::max(most, levels.of(variable.type));
    walkExprs(function.body, [&](const Expr& expr) { most = std::max(most, levels.of(expr.type)); });
  }
  return most;
}

}  // namespace skc::emit
