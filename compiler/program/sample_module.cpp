// SPDX-License-Identifier: MIT
#include "program/sample_module.hpp"

#include <cassert>
#include <utility>

#include "ir/kernel_builder.hpp"
#include "ir/validate.hpp"

namespace skc::emit {
namespace {

using namespace ir;
using enum BinaryOp;

const Type int2 = Type::of(Scalar::Int, 2);

/// `average`, with `a` bound to parameter 1 of its kernel.
FunctionId addAverage(Module& module) {
  Function f;
  f.name = "average";
  f.result = floatType;
  f.loc = atLine(4);
  const VarId p = addVariable(f, "p", int2, VarRole::In);
  const VarId s = addVariable(f, "s", floatType);
  const VarId i = addVariable(f, "i", intType);
  const auto ref = [&](VarId var) { return varRef(f, var); };
  ExprPtr at = construct(int2, exprs(binary(Add, swizzle(ref(p), "x"), ref(i)), swizzle(ref(p), "y")));
  ExprPtr read = gatherRead(floatType, {StreamRef::Space::KernelParameter, 1}, std::move(at));
  Block inner =
      block(ifStmt(binary(Equal, ref(i), literal(0)), block(continueStmt(atLine(7))), {}, atLine(7)),
            assign(ref(s), Add, std::move(read), atLine(8)));
  Block body = block(declare(s, literal(0.0F), atLine(5)),
                     forLoop(block(declare(i, literal(-1), atLine(6))), binary(LessEqual, ref(i), literal(1)),
                             block(assign(ref(i), Add, literal(1), atLine(6))), std::move(inner), atLine(6)),
                     returnStmt(binary(Mul, ref(s), constantRef(module, 0)), atLine(10)));
  return addFunction(module, std::move(f), std::move(body));
}

void addDiffuse(Module& module) {
  const FunctionId average = addAverage(module);
  KernelBuilder k(module, "diffuse", 14);
  k.kernel().scope = {"heat"};
  const VarId factor = k.uniform("k", floatType);
  const VarId u = k.gather("u", floatType, 2, Boundary::Wrap);
  const VarId v = k.output("v", floatType);
  const VarId p = k.local("p", int2);
  const auto near = [&](int x, int y) {
    return neighborRead(floatType, {StreamRef::Space::KernelParameter, u},
                        construct(int2, exprs(literal(x), literal(y))));
  };
  ExprPtr change = binary(Sub, near(1, 0), binary(Mul, literal(4.0F), near(0, 0)));
  ExprPtr value =
      binary(Add, call(module, average, exprs(k.ref(p))), binary(Mul, k.ref(factor), std::move(change)));
  k.finish(block(declare(p, swizzle(indexOf({StreamRef::Space::Domain, 0}), "xy"), atLine(15)),
                 assign(k.ref(v), std::move(value), atLine(16))),
           "kernel void diffuse(float k, [[wrap]] float u[][], out float v<>)");
}

/// Makes the last kernel of the module combine its own partial results.
void combineByItself(Module& module, bool seeded) {
  const auto id = static_cast<KernelId>(module.kernels.size() - 1);
  module.kernels[id].reduction = Reduction{id, {0, 1}, seeded};
}

void addSum(Module& module) {
  KernelBuilder k(module, "sum", 20);
  const VarId x = k.input("x", floatType);
  const VarId total = k.accumulator("total", floatType, literal(0.0F));
  k.finish(block(assign(k.ref(total), Add, k.ref(x), atLine(20))),
           "reduce void sum(float x<>, reduce float total<> = 0)");
  combineByItself(module, false);
}

void addNearest(Module& module) {
  const Type hit = Type::structType(0);
  KernelBuilder k(module, "nearest", 22);
  const VarId h = k.input("h", hit);
  const VarId best = k.accumulator("best", hit);
  ExprPtr nearer = binary(Less, member(module, k.ref(h), 0), member(module, k.ref(best), 0));
  k.finish(block(ifStmt(std::move(nearer), block(assign(k.ref(best), k.ref(h), atLine(22))), {}, atLine(22))),
           "reduce void nearest(Hit h<>, reduce Hit best<>)");
  combineByItself(module, true);
}

void addPower(Module& module) {
  KernelBuilder k(module, "power", 24);
  const VarId x = k.input("x", floatType);
  const VarId total = k.accumulator("total", floatType, literal(0.0F));
  k.finish(block(assign(k.ref(total), Add, binary(Mul, k.ref(x), k.ref(x)), atLine(24))),
           "reduce void power(float x<>, reduce float total<>)");
  const auto power = static_cast<KernelId>(module.kernels.size() - 1);
  module.kernels[power].reduction = Reduction{power + 1, {0, 0}, false};
  KernelBuilder combine(module, "power_combine", 24);
  combine.kernel().isSynthesized = true;
  const VarId part = combine.input("total_part", floatType);
  const VarId whole = combine.accumulator("total", floatType);
  combine.finish(block(assign(combine.ref(whole), Add, combine.ref(part), atLine(24))));
  combineByItself(module, true);
}

}  // namespace

Module sampleModule() {
  Module module = testModule();
  module.structs.push_back({"Hit", {}, {{"t", floatType}, {"id", intType}}, atLine(1)});
  module.constants.push_back({"scale", floatType, literal(0.25F), atLine(2)});
  addDiffuse(module);
  addSum(module);
  addNearest(module);
  addPower(module);
  assert(validate(module, Stage::Specialized).empty());
  return module;
}

}  // namespace skc::emit
