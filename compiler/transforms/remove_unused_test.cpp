// SPDX-License-Identifier: MIT
//
// Promises: what no kernel needs is removed, what has an effect stays, and references follow their entries.
#include "transforms/passes.hpp"

#include <catch2/catch.hpp>

#include "ir/kernel_builder.hpp"
#include "ir/print.hpp"
#include "ir/validate.hpp"
#include "support/diagnostics.hpp"

namespace skc {
namespace {

using namespace ir;

void run(Module& module) {
  REQUIRE(validate(module, Stage::Specialized) == "");
  DiagnosticLog log;
  removeUnused(module, log);
  REQUIRE(validate(module, Stage::Specialized) == "");
}

std::string body(const Module& module, FunctionId id) {
  const std::string text = print(module, module.functions[id]);
  return text.substr(text.find('{'));
}

/// float name(float x) { return x; }, or with `inout` a function that writes to its argument.
FunctionId addIdentity(Module& module, std::string name) {
  Function f;
  f.name = std::move(name);
  f.result = floatType;
  const VarId x = addVariable(f, "x", floatType, VarRole::In);
  ExprPtr value = varRef(f, x);
  return addFunction(module, std::move(f), block(returnStmt(std::move(value))));
}

FunctionId addIncrement(Module& module) {
  Function f;
  f.name = "increment";
  const VarId x = addVariable(f, "x", floatType, VarRole::InOut);
  Block statements = block(assign(varRef(f, x), BinaryOp::Add, literal(1.0F)));
  return addFunction(module, std::move(f), std::move(statements));
}

TEST_CASE("a local that is never read goes with its writes, and what only it used goes too") {
  Module module = testModule();
  KernelBuilder k(module, "f");
  const VarId x = k.input("x", floatType);
  const VarId r = k.output("r", floatType);
  const VarId a = k.local("a", floatType);
  const VarId b = k.local("b", floatType);
  k.finish(block(declare(a, k.ref(x)), declare(b, k.ref(a)), assign(k.ref(b), BinaryOp::Add, k.ref(a)),
                 assign(k.ref(r), k.ref(x))));
  run(module);
  CHECK(body(module, 0) == "{\n  r = x;\n}\n");
}

TEST_CASE("a local that a call writes to stays") {
  Module module = testModule();
  const FunctionId increment = addIncrement(module);
  KernelBuilder k(module, "f");
  const VarId r = k.output("r", floatType);
  const VarId a = k.local("a", floatType);
  k.finish(block(declare(a, literal(0.0F)), callStmt(increment, exprs(k.ref(a))),
                 assign(k.ref(r), literal(1.0F))));
  run(module);
  CHECK(body(module, 1).find("increment(a);") != std::string::npos);
}

TEST_CASE("an index on the way to a dead place is dead as well; on the way to a live one it is read") {
  Module module = testModule();
  const Type array = arrayOf(module, floatType, 2);
  KernelBuilder k(module, "f");
  const VarId r = k.output("r", floatType);
  const VarId w = k.local("w", array);
  const VarId i = k.local("i", intType);
  k.finish(block(declare(w, construct(array, exprs(literal(0.0F), literal(0.0F)))), declare(i, literal(1)),
                 assign(index(module, k.ref(w), k.ref(i)), literal(1.0F)),
                 assign(k.ref(r), index(module, k.ref(w), literal(0)))));
  run(module);
  CHECK(body(module, 0).find("w[i] = 1.0;") != std::string::npos);
}

TEST_CASE("functions, constants and types without use go, and the others are renumbered") {
  Module module = testModule();
  module.structs.push_back({"Unused", {}, {{"a", floatType}}, {}});
  module.structs.push_back({"Inner", {}, {{"a", floatType}}, {}});
  module.structs.push_back({"Outer", {}, {{"inner", Type::structType(1)}}, {}});
  module.constants.push_back({"unused", floatType, literal(1.0F), {}});
  module.constants.push_back({"base", floatType, literal(2.0F), {}});
  module.constants.push_back({"used", floatType, constantRef(module, 1), {}});
  addIdentity(module, "unused");
  const FunctionId used = addIdentity(module, "used");
  KernelBuilder k(module, "f");
  const VarId o = k.input("o", Type::structType(2));
  const VarId r = k.output("r", floatType);
  ExprPtr leaf = member(module, member(module, k.ref(o), 0), 0);
  k.finish(block(assign(
      k.ref(r), call(module, used, exprs(binary(BinaryOp::Add, std::move(leaf), constantRef(module, 2)))))));
  run(module);
  REQUIRE(module.functions.size() == 2);
  CHECK(module.functions[0].name == "used");
  REQUIRE(module.structs.size() == 2);
  CHECK(module.structs[0].name == "Inner");
  REQUIRE(module.constants.size() == 2);
  CHECK(module.constants[0].name == "base");
  CHECK(body(module, 1) == "{\n  r = used(o.inner.a + used);\n}\n");
}

TEST_CASE(
    "whatever refers to a type or a constant is renumbered: held types, plans and conditions of streams") {
  Module module = testModule();
  module.structs.push_back({"Unused", {}, {{"a", floatType}}, {}});
  module.structs.push_back({"Pair", {}, {{"a", floatType}, {"b", floatType}}, {}});
  module.structs.push_back(
      {"WidePair", {}, {{"a", Type::of(Scalar::Double)}, {"b", Type::of(Scalar::Double)}}, {}});
  const Type pair = Type::structType(1), wide = Type::structType(2);
  module.constants.push_back({"unused", intType, literal(1), {}});
  module.constants.push_back({"two", intType, literal(2), {}});
  KernelBuilder k(module, "f");
  const VarId mode = k.spec("mode", intType);
  const VarId p = k.input("p", wide);
  const VarId r = k.output("r", wide);
  ExprPtr condition = binary(BinaryOp::Equal, k.ref(mode), constantRef(module, 1));
  k.finish(block(assign(k.ref(r), k.ref(p))));
  Kernel& kernel = module.kernels[0];
  kernel.params[p].held = pair;
  kernel.params[r].held = pair;
  kernel.params[p].neededIf = std::move(condition);
  kernel.plans.push_back(
      Plan{.limits = {}, .temporaries = {{"t", pair, 1, 1}}, .stacks = {{wide, {}}}, .passes = {}});
  run(module);
  REQUIRE(module.structs.size() == 2);
  const Kernel& after = module.kernels[0];
  CHECK(after.params[p].type == Type::structType(1));
  CHECK(after.params[p].held == Type::structType(0));
  CHECK(after.params[r].held == Type::structType(0));
  CHECK(after.plans[0].temporaries[0].type == Type::structType(0));
  CHECK(after.plans[0].stacks[0].type == Type::structType(1));
  REQUIRE(module.constants.size() == 1);
  CHECK(print(module, module.functions[0], *after.params[p].neededIf) == "mode == two");
}

TEST_CASE("the combining kernel's function and the constants of borders and identities are needed") {
  Module module = testModule();
  module.constants.push_back({"zero", floatType, literal(0.0F), {}});
  KernelBuilder k(module, "sum");
  const VarId x = k.input("x", intType);
  const VarId total = k.accumulator("total", floatType, constantRef(module, 0));
  k.finish(block(assign(k.ref(total), BinaryOp::Add, convert(Scalar::Float, k.ref(x)))));
  KernelBuilder combine(module, "sum");
  const VarId a = combine.input("a", floatType);
  const VarId b = combine.accumulator("b", floatType);
  combine.finish(block(assign(combine.ref(b), BinaryOp::Add, combine.ref(a))));
  module.kernels[0].reduction = Reduction{1, {0, 0}, false};
  run(module);
  CHECK(module.functions.size() == 2);
  CHECK(module.constants.size() == 1);
}

}  // namespace
}  // namespace skc
