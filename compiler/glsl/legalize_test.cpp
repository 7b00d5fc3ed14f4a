// SPDX-License-Identifier: MIT
//
// Promises: operations that GLSL leaves undefined for some operands get operands for which it defines them; others stay.
#include "glsl/legalize.hpp"

#include <catch2/catch.hpp>

#include "ir/kernel_builder.hpp"
#include "ir/print.hpp"

namespace skc::emit {
namespace {

using namespace ir;

/// The statements of a kernel, printed after legalize. It has ints i and r, a uint n, a vector v and an array of five floats.
struct LegalKernel {
  Module module = testModule();
  KernelBuilder k{module, "k"};
  VarId i = k.uniform("i", intType), n = k.uniform("n", Type::of(Scalar::Uint)), r = k.output("r", intType);
  VarId v = k.local("v", Type::of(Scalar::Float, 3)), a = k.local("a", arrayOf(module, floatType, 5));

  ExprPtr ref(VarId var) const { return varRef(module.functions[0], var); }
  ExprPtr at(VarId base, ExprPtr number) { return index(module, ref(base), std::move(number)); }
  std::string text(Stmt stmt, const Capabilities& target = glslCapabilities) {
    Function& entry = module.functions[0];
    entry.body = block(std::move(stmt));
    legalize(module, target);
    const std::string all = print(module, entry);
    const std::size_t begin = all.find("{\n  ") + 4;
    return all.substr(begin, all.rfind("\n}") - begin);
  }
  LegalKernel() { k.finish({}); }
};

TEST_CASE("counts of shifts are below 32") {
  LegalKernel s;
  const auto shift = [&](ExprPtr count) {
    return assign(s.ref(s.r), binary(BinaryOp::ShiftLeft, s.ref(s.i), std::move(count)));
  };
  CHECK(s.text(shift(s.ref(s.i))) == "r = i << (i & 31);");
  CHECK(s.text(shift(s.ref(s.n))) == "r = i << (n & 31u);");
  CHECK(s.text(shift(literal(31))) == "r = i << 31;");
  CHECK(s.text(shift(binary(BinaryOp::BitAnd, s.ref(s.i), literal(7)))) == "r = i << (i & 7);");
  CHECK(s.text(assign(s.ref(s.r), BinaryOp::ShiftRight, s.ref(s.i))) == "r = r >> (i & 31);");
  CHECK(s.text(shift(s.ref(s.i)), {.shiftsByAnyCount = true, .clampsIndices = true}) == "r = i << i;");
}

TEST_CASE("indices are within their arrays") {
  LegalKernel s;
  const auto store = [&](VarId base, ExprPtr number) {
    return assign(s.at(base, std::move(number)), literal(1.0F));
  };
  CHECK(s.text(store(s.a, s.ref(s.i))) == "a[clamp(i, 0, 4)] = 1.0;");
  CHECK(s.text(store(s.a, s.ref(s.n))) == "a[min(n, 4u)] = 1.0;");
  CHECK(s.text(store(s.a, literal(7))) == "a[4] = 1.0;");
  CHECK(s.text(store(s.a, literal(-1))) == "a[0] = 1.0;");
  CHECK(s.text(store(s.v, s.ref(s.i))) == "v[clamp(i, 0, 2)] = 1.0;");
  CHECK(s.text(assign(s.at(s.a, literal(0)), s.at(s.v, s.ref(s.i)))) == "a[0] = v[i];");
}

}  // namespace
}  // namespace skc::emit
