// SPDX-License-Identifier: MIT
//
// Promises: how each kind of expression is spelled in GLSL's common subset.
#include "emit/glsl_expr.hpp"

#include <limits>

#include <catch2/catch.hpp>

#include "ir/kernel_maker.hpp"

namespace skc::emit {
namespace {

using namespace ir;
using enum BinaryOp;

const Type float2 = Type::of(Scalar::Float, 2);
const Type int3 = Type::of(Scalar::Int, 3);
const Type bool2 = Type::of(Scalar::Bool, 2);

/// A kernel with parameters of several types, and the text of expressions in it.
struct Fixture {
  Module module = testModule();
  KernelMaker k{module, "k"};
  VarId f = k.uniform("f", floatType), i = k.uniform("i", intType), v = k.uniform("v", float2),
        w = k.uniform("w", int3), b = k.uniform("b", bool2), x = k.input("x", floatType),
        u = k.gather("u", floatType, 2), r = k.output("r", floatType);
  Polyfills polyfills;

  Fixture() { k.finish({}); }
  ExprPtr ref(VarId var) const { return varRef(module.functions[0], var); }
  std::string text(ExprPtr expr) {
    const TypeNames types(module);
    const KernelNames names(module, module.kernels[0], types);
    const GlslContext context{module, types, names, module.kernels[0], polyfills};
    return glslExpr(context, 0, *expr);
  }
};

TEST_CASE("literals read back as the same value and type") {
  Fixture t;
  CHECK(t.text(literal(1.0F)) == "1.0");
  CHECK(t.text(literal(-0.0F)) == "-0.0");
  CHECK(t.text(literal(1e-20F)) == "1e-20");
  CHECK(t.text(literal(3U)) == "3u");
  CHECK(t.text(literal(2654435769U)) == "2654435769u");
  CHECK(t.text(literal(0xffffffffU)) == "0xffffffffu");
  CHECK(t.text(literal(0x7f800000)) == "0x7f800000");
  CHECK(t.text(literal(std::numeric_limits<std::int32_t>::min())) == "-2147483647 - 1");
  CHECK(t.text(literal(std::numeric_limits<float>::infinity())) == "uintBitsToFloat(0x7f800000u)");
  CHECK(t.text(literal(true)) == "true");
}

TEST_CASE("negative literals keep away from other signs") {
  Fixture t;
  CHECK(t.text(unary(UnaryOp::Negate, literal(-1.0F))) == "-(-1.0)");
  CHECK(t.text(binary(Sub, t.ref(t.f), literal(-1.0F))) == "f - -1.0");
  CHECK(t.text(binary(Mul, literal(std::numeric_limits<std::int32_t>::min()), t.ref(t.i))) ==
        "(-2147483647 - 1) * i");
}

TEST_CASE("comparisons and truth of vectors are functions") {
  Fixture t;
  CHECK(t.text(binary(Less, t.ref(t.v), t.ref(t.v))) == "lessThan(v, v)");
  CHECK(t.text(binary(NotEqual, t.ref(t.b), t.ref(t.b))) == "notEqual(b, b)");
  CHECK(t.text(unary(UnaryOp::LogicalNot, t.ref(t.b))) == "not(b)");
  CHECK(t.text(unary(UnaryOp::Negate, t.ref(t.v))) == "-v");
  CHECK(t.text(binary(LogicalAnd, t.ref(t.b), t.ref(t.b))) == "sk_and(b, b)");
  CHECK(
      t.polyfills.functions() ==
      std::vector<std::string>{"bvec2 sk_and(bvec2 a, bvec2 b) { return bvec2(a.x && b.x, a.y && b.y); }\n"});
  CHECK(t.text(binary(LogicalOr, binary(Less, t.ref(t.f), t.ref(t.f)), literal(true))) == "f < f || true");
}

TEST_CASE("choices by component") {
  Fixture t;
  CHECK(t.text(select(t.ref(t.b), t.ref(t.v), literalOf(float2, 0))) == "mix(vec2(0.0), v, b)");
  CHECK(t.text(select(t.ref(t.b), swizzle(t.ref(t.w), "xy"), swizzle(t.ref(t.w), "yz"))) ==
        "sk_select(b, w.xy, w.yz)");
  CHECK(t.polyfills.functions().size() == 1);
  CHECK(t.text(binary(Add, select(literal(true), t.ref(t.f), literal(2.0F)), literal(1.0F))) ==
        "(true ? f : 2.0) + 1.0");
}

TEST_CASE("conversions, constructors, swizzles, elements") {
  Fixture t;
  CHECK(t.text(convert(Scalar::Float, t.ref(t.w))) == "vec3(w)");
  CHECK(t.text(convert(Scalar::Bool, t.ref(t.f))) == "bool(f)");
  CHECK(t.text(construct(Type::of(Scalar::Float, 3), exprs(t.ref(t.v), literal(1.0F)))) == "vec3(v, 1.0)");
  CHECK(t.text(swizzle(binary(Add, t.ref(t.v), t.ref(t.v)), "yx")) == "(v + v).yx");
  CHECK(t.text(index(t.module, t.ref(t.v), t.ref(t.i))) == "v[i]");
  const Type array = arrayOf(t.module, floatType, 2);
  const auto pair = [&] { return construct(array, exprs(literal(1.0F), literal(2.0F))); };
  CHECK(t.text(pair()) == "float[2](1.0, 2.0)");
  CHECK(t.text(index(t.module, pair(), literal(1))) == "float[2](1.0, 2.0)[1]");
  CHECK(t.text(index(t.module, pair(), literal(2))) == "float[2](1.0, 2.0)[1]");
  CHECK(t.text(index(t.module, pair(), literal(-7))) == "float[2](1.0, 2.0)[0]");
  CHECK(t.text(index(t.module, pair(), literal(0xffffffffu))) == "float[2](1.0, 2.0)[1u]");
  CHECK(t.text(index(t.module, t.ref(t.v), literal(4))) == "v[1]");
  CHECK(t.text(index(t.module, pair(), t.ref(t.i))) == "float[2](1.0, 2.0)[clamp(i, 0, 1)]");
  CHECK(t.text(index(t.module, pair(), convert(Scalar::Uint, t.ref(t.i)))) ==
        "float[2](1.0, 2.0)[min(uint(i), 1u)]");
}

TEST_CASE("streams are reached through the assembler's functions") {
  Fixture t;
  const auto param = [](VarId id) { return StreamRef{StreamRef::Space::KernelParameter, id}; };
  const ExprPtr at = construct(Type::of(Scalar::Int, 2), exprs(t.ref(t.i), literal(0)));
  CHECK(t.text(gatherRead(floatType, param(t.u), clone(at))) == "sk_at_u(ivec2(i, 0))");
  CHECK(t.text(neighborRead(floatType, param(t.u), clone(at))) == "sk_near_u(ivec2(i, 0))");
  CHECK(t.text(swizzle(indexOf(param(t.x)), "xy")) == "sk_index_x().xy");
  CHECK(t.text(indexOf({StreamRef::Space::Domain, 0})) == "sk_index()");
  CHECK(t.text(indexOf(param(t.r))) == "sk_index()");
  CHECK(t.text(extentOf(param(t.u))) == "sk_extent_u()");
  CHECK(t.text(extentOf({StreamRef::Space::Domain, 0})) == "sk_extent_r()");
}

TEST_CASE("intrinsics: names, patterns with no more brackets than needed, polyfills") {
  Fixture t;
  const auto f = [&] { return t.ref(t.f); };
  CHECK(t.text(intrinsic(Intrinsic::Rsqrt, exprs(f()))) == "inversesqrt(f)");
  CHECK(t.text(intrinsic(Intrinsic::Fma, exprs(f(), f(), f()))) == "f * f + f");
  CHECK(t.text(binary(Mul, literal(2.0F), intrinsic(Intrinsic::Fma, exprs(f(), f(), f())))) ==
        "2.0 * (f * f + f)");
  CHECK(t.text(intrinsic(Intrinsic::Fma, exprs(binary(Add, f(), f()), f(), f()))) == "(f + f) * f + f");
  CHECK(t.text(intrinsic(Intrinsic::Saturate, exprs(binary(Add, f(), f())))) == "clamp(f + f, 0.0, 1.0)");
  CHECK(t.text(intrinsic(Intrinsic::Isfinite, exprs(t.ref(t.v)))) ==
        "lessThan(floatBitsToUint(v) & 0x7f800000u, uvec2(0x7f800000u))");
  CHECK(t.text(intrinsic(Intrinsic::Any, exprs(t.ref(t.b)))) == "any(b)");
  const auto scalars = [&] { return binary(Less, f(), literal(1.0F)); };
  CHECK(t.text(binary(Equal, intrinsic(Intrinsic::Any, exprs(scalars())), literal(true))) ==
        "f < 1.0 == true");
  CHECK(t.polyfills.functions().empty());
  CHECK(t.text(intrinsic(Intrinsic::Fmod, exprs(t.ref(t.v), t.ref(t.v)))) == "sk_fmod(v, v)");
  REQUIRE(t.polyfills.functions().size() == 1);
  CHECK(t.polyfills.functions()[0].find("vec2 sk_fmod(vec2 x, vec2 y)") == 0);
}

}  // namespace
}  // namespace skc::emit
