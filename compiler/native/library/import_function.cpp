// SPDX-License-Identifier: MIT
#include "native/library/import_function.hpp"

#include <utility>

#include "ir/build.hpp"
#include "ir/walk.hpp"

namespace skc::native {

using namespace ir;

FunctionId FunctionImporter::import(FunctionId id) {
  if (const auto known = functions_.find(id); known != functions_.end()) return known->second;
  Function copy = clone(from_.functions[id]);
  copy.loc = {};
  copy.isLibrary = true;
  copy.result = importType(copy.result);
  for (Variable& variable : copy.variables) {
    variable.type = importType(variable.type);
    variable.loc = {};
  }
  adapt(copy.body);
  to_.functions.push_back(std::move(copy));
  return functions_[id] = static_cast<FunctionId>(to_.functions.size() - 1);
}

ConstantId FunctionImporter::importConstant(ConstantId id) {
  if (const auto known = constants_.find(id); known != constants_.end()) return known->second;
  const Constant& constant = from_.constants[id];
  Constant copy{constant.name, importType(constant.type), clone(*constant.value), {}};
  walkExprs(*copy.value, [&](Expr& expr) { adapt(expr); });
  to_.constants.push_back(std::move(copy));  // after the constants that its value names
  return constants_[id] = static_cast<ConstantId>(to_.constants.size() - 1);
}

Type FunctionImporter::importType(Type type) {
  if (type.kind == Type::Kind::Struct) return Type::structType(importStruct(type.index));
  if (type.kind != Type::Kind::Array) return type;
  const Array& array = from_.arrays[type.index];
  return arrayOf(to_, importType(array.element), array.length);
}

std::uint32_t FunctionImporter::importStruct(std::uint32_t index) {
  if (const auto known = structs_.find(index); known != structs_.end()) return known->second;
  Struct copy = from_.structs[index];
  for (StructField& field : copy.fields) field.type = importType(field.type);
  copy.loc = {};
  copy.isSynthesized = true;  // not a type of the user's program
  to_.structs.push_back(std::move(copy));
  return structs_[index] = static_cast<std::uint32_t>(to_.structs.size() - 1);
}

void FunctionImporter::adapt(Expr& expr) {
  expr.loc = {};
  expr.type = importType(expr.type);
  if (auto* call = std::get_if<Call>(&expr.node)) call->callee = import(call->callee);
  if (auto* reference = std::get_if<ConstantRef>(&expr.node))
    reference->constant = importConstant(reference->constant);
}

void FunctionImporter::adapt(Block& block) {
  walkStmts(block, [&](Stmt& stmt) {
    stmt.loc = {};
    if (auto* call = std::get_if<CallStmt>(&stmt.node)) call->callee = import(call->callee);
    if (auto* choice = std::get_if<Switch>(&stmt.node)) {
      for (Case& one : choice->cases) one.loc = {};
    }
  });
  walkExprs(block, [&](Expr& expr) { adapt(expr); });
}

}  // namespace skc::native
