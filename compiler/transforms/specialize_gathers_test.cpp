// SPDX-License-Identifier: MIT
//
// Promises: the header's before and after; one copy for each choice of streams that matters; the index of an
// element follows its stream through calls.
#include "transforms/passes.hpp"

#include <catch2/catch.hpp>

#include "ir/kernel_builder.hpp"
#include "ir/print.hpp"
#include "ir/validate.hpp"
#include "support/diagnostics.hpp"

namespace skc {
namespace {

using namespace ir;

void specialize(Module& module) {
  REQUIRE(validate(module, Stage::Lowered) == "");
  DiagnosticLog log;
  specializeGathers(module, log);
  REQUIRE(validate(module, Stage::Specialized) == "");
}

std::string bodyOf(const Module& module, std::string_view name) {
  for (const Function& function : module.functions) {
    if (function.name == name) return print(module, function);
  }
  return "no function of that name";
}

/// float pairSum(int before, float a[], int i) { return a[i] + a[i + 1]; }
FunctionId addPairSum(Module& module) {
  Function f;
  f.name = "pairSum";
  f.result = floatType;
  addVariable(f, "before", intType, VarRole::In);
  const VarId a = addVariable(f, "a", floatType, VarRole::Gather);
  f.variables[a].rank = 1;
  const VarId i = addVariable(f, "i", intType, VarRole::In);
  const auto read = [&](ExprPtr index) {
    return gatherRead(floatType, KernelBuilder::stream(a), std::move(index));
  };
  ExprPtr next = binary(BinaryOp::Add, varRef(f, i), literal(1));
  ExprPtr sum = binary(BinaryOp::Add, read(varRef(f, i)), read(std::move(next)));
  return addFunction(module, std::move(f), block(returnStmt(std::move(sum))));
}

TEST_CASE("one stream: the function keeps its name and loses the parameter") {
  Module module = testModule();
  const FunctionId pairSum = addPairSum(module);
  KernelBuilder k(module, "f");
  const VarId u = k.gather("u", floatType, 1);
  const VarId r = k.output("r", floatType);
  k.finish(block(assign(k.ref(r), call(module, pairSum, exprs(literal(0), k.ref(u), literal(7))))));
  specialize(module);
  CHECK(bodyOf(module, "pairSum") == "  before: in int\n  i: in int\n{\n  return $0[i] + $0[i + 1];\n}\n");
  CHECK(bodyOf(module, "f") == "  u: gather float rank 1\n  r: inout float\n{\n  r = pairSum(0, 7);\n}\n");
  CHECK(module.kernels[0].entry == 1);   // callees come first
}

TEST_CASE("two streams: two copies that say what they read; the same stream twice: one") {
  Module module = testModule();
  const FunctionId pairSum = addPairSum(module);
  KernelBuilder k(module, "f");
  const VarId u = k.gather("u", floatType, 1);
  const VarId v = k.gather("v", floatType, 1);
  const VarId r = k.output("r", floatType);
  const auto sum = [&](VarId stream) {
    return call(module, pairSum, exprs(literal(0), k.ref(stream), literal(7)));
  };
  k.finish(block(assign(k.ref(r), binary(BinaryOp::Add, binary(BinaryOp::Add, sum(u), sum(v)), sum(u)))));
  specialize(module);
  CHECK(module.functions.size() == 3);
  CHECK(bodyOf(module, "pairSum_v").find("$1[i]") != std::string::npos);
  CHECK(bodyOf(module, "f").find("r = pairSum_u(0, 7) + pairSum_v(0, 7) + pairSum_u(0, 7);") !=
        std::string::npos);
}

TEST_CASE("each kernel has its own copies") {
  Module module = testModule();
  const FunctionId pairSum = addPairSum(module);
  for (const char* name : {"f", "g"}) {
    KernelBuilder k(module, name);
    const VarId u = k.gather("u", floatType, 1);
    const VarId r = k.output("r", floatType);
    k.finish(block(assign(k.ref(r), call(module, pairSum, exprs(literal(0), k.ref(u), literal(7))))));
  }
  specialize(module);   // validate checks that no function has two owners
  CHECK(module.functions.size() == 4);
}

/// kernel void place(float x<>, out float r<>) { r = x + float(indexof(x).x); }
FunctionId addPlace(Module& module) {
  KernelBuilder k(module, "place");
  const VarId x = k.input("x", floatType);
  const VarId r = k.output("r", floatType);
  ExprPtr index = convert(Scalar::Float, swizzle(indexOf(KernelBuilder::stream(x)), "x"));
  k.finish(block(assign(k.ref(r), binary(BinaryOp::Add, k.ref(x), std::move(index)))));
  return module.kernels.back().entry;
}

TEST_CASE("an element's index is its stream's; of a computed value, the domain's") {
  Module module = testModule();
  const FunctionId place = addPlace(module);
  KernelBuilder k(module, "f");
  const VarId y = k.input("y", floatType);
  const VarId r = k.output("r", floatType);
  const VarId s = k.output("s", floatType);
  k.finish(block(callStmt(place, exprs(k.ref(y), k.ref(r))),
                 callStmt(place, exprs(binary(BinaryOp::Add, k.ref(y), literal(1.0F)), k.ref(s)))));
  specialize(module);
  CHECK(bodyOf(module, "place_y").find("r = x + float(indexof($0).x)") != std::string::npos);
  CHECK(bodyOf(module, "place_here").find("r = x + float(indexof(domain).x)") != std::string::npos);
  CHECK(bodyOf(module, "place_y").find("x: in float") != std::string::npos);
}

TEST_CASE("streams that a function does not ask about make no copies") {
  Module module = testModule();
  KernelBuilder inner(module, "twice");
  const VarId a = inner.input("a", floatType);
  const VarId b = inner.output("b", floatType);
  inner.finish(block(assign(inner.ref(b), binary(BinaryOp::Add, inner.ref(a), inner.ref(a)))));
  const FunctionId twice = module.kernels.back().entry;
  KernelBuilder k(module, "f");
  const VarId x = k.input("x", floatType);
  const VarId y = k.input("y", floatType);
  const VarId r = k.output("r", floatType);
  const VarId s = k.output("s", floatType);
  k.finish(block(callStmt(twice, exprs(k.ref(x), k.ref(r))), callStmt(twice, exprs(k.ref(y), k.ref(s)))));
  specialize(module);
  CHECK(module.functions.size() == 3);   // the kernel `twice`, f's copy of it, and f
}

TEST_CASE("streams are followed through several calls") {
  Module module = testModule();
  const FunctionId pairSum = addPairSum(module);
  Function f;
  f.name = "outer";
  f.result = floatType;
  const VarId a = addVariable(f, "a", floatType, VarRole::Gather);
  f.variables[a].rank = 1;
  ExprPtr inner = call(module, pairSum, exprs(literal(0), varRef(f, a), literal(1)));
  const FunctionId outer = addFunction(module, std::move(f), block(returnStmt(std::move(inner))));
  KernelBuilder k(module, "f");
  k.gather("u", floatType, 1);
  const VarId v = k.gather("v", floatType, 1);
  const VarId r = k.output("r", floatType);
  k.finish(block(assign(k.ref(r), call(module, outer, exprs(k.ref(v))))));
  specialize(module);
  CHECK(bodyOf(module, "pairSum").find("return $1[i] + $1[i + 1];") != std::string::npos);
}

}  // namespace
}  // namespace skc
