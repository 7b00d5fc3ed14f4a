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

/// The statements of a kernel, printed after legalize. It has ints i and r, a uint n, vectors v and d, of
/// doubles, matrices m and p, and an array a of five floats.
struct LegalKernel {
  Module module = testModule();
  KernelBuilder k{module, "k"};
  VarId i = k.uniform("i", intType), n = k.uniform("n", Type::of(Scalar::Uint)), r = k.output("r", intType);
  VarId v = k.local("v", Type::of(Scalar::Float, 3)), a = k.local("a", arrayOf(module, floatType, 5));
  VarId d = k.local("d", Type::of(Scalar::Double, 3));
  VarId m = k.local("m", Type::matrix(3)), p = k.local("p", Type::matrix(3));

  ExprPtr ref(VarId var) const { return varRef(module.functions[0], var); }
  ExprPtr at(VarId base, ExprPtr number) { return index(module, ref(base), std::move(number)); }
  std::string text(Stmt stmt, const Capabilities& target = glslCapabilities) {
    module.functions[0].body = block(std::move(stmt));
    legalize(module, target);
    const std::string all = print(module, module.functions[0]);
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
  CHECK(s.text(shift(s.ref(s.i)), {.shiftsByAnyCount = true}) == "r = i << i;");
}

TEST_CASE("operations that GLSL lacks are calls, and known operands need none") {
  LegalKernel s;
  const auto set = [&](BinaryOp op, ExprPtr value) {
    return s.text(assign(s.ref(s.r), op, std::move(value)));
  };
  CHECK(set(BinaryOp::Add, s.ref(s.i)) == "r += i;");
  CHECK(set(BinaryOp::Div, literal(2)) == "r /= 2;");
  CHECK(set(BinaryOp::Div, s.ref(s.i)) == "r = sk_div(r, i);");
  CHECK(set(BinaryOp::Rem, literal(2)) == "r = sk_rem(r, 2);");
  CHECK(set(BinaryOp::ShiftLeft, literal(2)) == "r <<= 2;");
  CHECK(set(BinaryOp::Add, convert(Scalar::Int, s.at(s.v, literal(0)))) == "r += sk_int(v[0]);");
  const Capabilities able = {.dividesIntegers = true, .convertsAnyFloat = true};
  CHECK(s.text(assign(s.ref(s.r), BinaryOp::Div, s.ref(s.i)), able) == "r /= i;");
}

TEST_CASE("parts of vectors of doubles are replaced in a copy of the whole") {
  LegalKernel s;
  const auto sum = [&] { return convert(Scalar::Double, literal(1.0F)); };
  CHECK(s.text(assign(s.at(s.d, literal(1)), sum())) == "d.y = sk_to_double(1.0);");
  CHECK(s.text(assign(s.at(s.d, s.ref(s.i)), sum())) == "d = sk_with(d, clamp(i, 0, 2), sk_to_double(1.0));");
  CHECK(s.text(assign(swizzle(s.ref(s.d), "zx"), swizzle(s.ref(s.d), "xy"))) ==
        "d = sk_with_zx(d, sk_xy(d));");
  CHECK(s.text(assign(s.ref(s.d), BinaryOp::Mul, sum())) == "d = sk_mul(d, sk_to_double(1.0));");
}

TEST_CASE("factors of matrices change order") {
  LegalKernel s;
  CHECK(s.text(assign(s.ref(s.v), binary(BinaryOp::Mul, s.ref(s.m), s.ref(s.v)))) == "v = v * m;");
  CHECK(s.text(assign(s.ref(s.m), BinaryOp::Mul, s.ref(s.p))) == "m = p * m;");
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
  CHECK(s.text(assign(s.at(s.a, literal(0)), s.at(s.v, s.ref(s.i)))) == "a[0] = sk_component(v, i);");
}

}  // namespace
}  // namespace skc::emit
