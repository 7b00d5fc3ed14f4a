// SPDX-License-Identifier: MIT
//
// Promises: an imported function brings everything that it names, once each and numbered as in its new
// module, which stays valid.
#include "native/library/link_library.hpp"

#include <catch2/catch.hpp>

#include "ir/kernel_builder.hpp"
#include "ir/print.hpp"
#include "ir/validate.hpp"

namespace skc::native {
namespace {

using namespace ir;

/// struct Pair { float[2] values; }; weights; float weigh(Pair); float twice(), which calls it twice.
FunctionId addTwice(Module& module) {
  const Type values = arrayOf(module, floatType, 2);
  module.structs.push_back({"Pair", {}, {{"values", values}}, {}});
  const Type pair = Type::structType(static_cast<std::uint32_t>(module.structs.size() - 1));
  ExprPtr weights = construct(values, exprs(literal(0.5F), literal(0.25F)));
  module.constants.push_back({"weights", values, std::move(weights), atLine(2)});
  const auto constant = static_cast<ConstantId>(module.constants.size() - 1);

  Function weigh;
  weigh.name = "weigh";
  weigh.result = floatType;
  const VarId p = addVariable(weigh, "p", pair, VarRole::In, atLine(3));
  ExprPtr value = index(module, member(module, varRef(weigh, p), 0), literal(1));
  ExprPtr weight = index(module, constantRef(module, constant), literal(1));
  const FunctionId callee =
      addFunction(module, std::move(weigh),
                  block(returnStmt(binary(BinaryOp::Mul, std::move(value), std::move(weight)), atLine(4))));

  Function twice;
  twice.name = "twice";
  twice.result = floatType;
  const auto called = [&] {
    ExprPtr array = construct(values, exprs(literal(1.0F), literal(2.0F)));
    return call(module, callee, exprs(construct(pair, exprs(std::move(array)))), atLine(5));
  };
  return addFunction(module, std::move(twice), block(returnStmt(binary(BinaryOp::Add, called(), called()))));
}

/// A module whose tables are not empty.
Module target() {
  Module module = testModule();
  arrayOf(module, intType, 7);
  module.structs.push_back({"Own", {}, {{"x", floatType}}, {}});
  module.constants.push_back({"own", floatType, literal(1.0F), {}});
  KernelBuilder k(module, "own");
  const VarId r = k.output("r", floatType);
  k.finish(block(assign(k.ref(r), literal(1.0F))));
  return module;
}

TEST_CASE("an imported function is valid where it comes to") {
  Module from = testModule();
  const FunctionId twice = addTwice(from);
  Module to = target();
  FunctionImporter importer(to, from);
  const FunctionId id = importer.import(twice);
  CHECK(importer.import(twice) == id);
  INFO(print(to));
  CHECK(to.functions.size() == 3);
  CHECK(to.functions[id].name == "twice");
  CHECK(to.structs.size() == 2);
  CHECK(to.structs[1].isSynthesized);
  CHECK(to.constants.size() == 2);
  CHECK(to.arrays.size() == 2);

  // a kernel that calls it, so that validation checks it
  KernelBuilder k(to, "f");
  const VarId r = k.output("r", floatType);
  k.finish(block(assign(k.ref(r), call(to, id, {}))));
  CHECK(validate(to, Stage::Specialized).empty());
}

TEST_CASE("an imported function has no source locations, which would be of another file") {
  Module from = testModule();
  const FunctionId twice = addTwice(from);
  Module to = target();
  FunctionImporter(to, from).import(twice);
  for (const Function& function : to.functions) {
    if (function.name == "own") continue;
    CHECK(function.loc.token == 0);
    for (const Variable& variable : function.variables) CHECK(variable.loc.token == 0);
    for (const Stmt& stmt : function.body) CHECK(stmt.loc.token == 0);
  }
  CHECK(to.constants[1].loc.token == 0);
}

}  // namespace
}  // namespace skc::native
