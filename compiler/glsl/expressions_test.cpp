// SPDX-License-Identifier: MIT
//
// Promise: each kind of expression is spelled right in GLSL's common subset.
#include "glsl/expressions.hpp"

#include <limits>

#include <catch2/catch.hpp>

#include "glsl/body.hpp"
#include "glsl/float_intrinsics.hpp"
#include "glsl/legalize.hpp"
#include "ir/intrinsics.hpp"
#include "ir/kernel_builder.hpp"

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
  KernelBuilder k{module, "k"};
  VarId f = k.uniform("f", floatType), i = k.uniform("i", intType), v = k.uniform("v", float2),
        w = k.uniform("w", int3), b = k.uniform("b", bool2), x = k.input("x", floatType),
        u = k.gather("u", floatType, 2), r = k.output("r", floatType);
  Polyfills polyfills{module};

  Fixture() { k.finish({}); }
  ExprPtr ref(VarId var) const { return varRef(module.functions[0], var); }
  std::string text(ExprPtr expr, bool isMarked = false, bool isStored = false) {
    const TypeNames types(module);
    const KernelNames names(module, module.kernels[0], types);
    const GlslContext context{module, types, names, module.kernels[0], polyfills, isMarked};
    legalize(module, glslCapabilities, polyfills, expr);
    return glslExpr(context, 0, *expr, Precedence::Lowest, isStored);
  }
  /// What a kernel whose body is this assignment prints before its function.
  GlslBody body(ExprPtr expr) {
    Function& entry = module.functions[0];
    const VarId result = addVariable(entry, "t", expr->type);
    entry.body = block(declare(result, std::move(expr)));
    polyfills = legalize(module, glslCapabilities);
    const TypeNames types(module);
    const KernelNames names(module, module.kernels[0], types);
    GlslBody whole = glslBody({module, types, names, module.kernels[0], polyfills});
    whole.body.erase(whole.body.find("#line"));
    return whole;
  }
};

TEST_CASE("marks say where floats are computed") {
  Fixture t;
  const auto marked = [&](ExprPtr expr, bool isStored) { return t.text(std::move(expr), true, isStored); };
  const auto sum = [&] { return binary(Add, t.ref(t.f), t.ref(t.x)); };
  CHECK(marked(binary(Mul, sum(), literal(0.1F)), true) == "$($[f + x$] * 0.1$)");
  CHECK(marked(binary(Mul, sum(), literal(0.1F)), false) == "$v1$($[f + x$] * 0.1$)$;");
  CHECK(marked(binary(Less, sum(), t.ref(t.f)), true) == "$(f + x$) < f");
  CHECK(marked(binary(Less, sum(), t.ref(t.f)), false) == "$v1$(f + x$)$; < f");
  CHECK(marked(intrinsic(Intrinsic::Sin, exprs(sum())), true) == "sk_sin($v1$(f + x$)$;)");
  CHECK(marked(intrinsic(Intrinsic::Sqrt, exprs(sum())), true) == "$(sqrt($(f + x$))$)");
  CHECK(marked(intrinsic(Intrinsic::Dot, exprs(t.ref(t.v), t.ref(t.v))), false) == "$v1$fdot(v, v)$;");
  CHECK(marked(binary(Add, t.ref(t.i), t.ref(t.i)), false) == "i + i");
  CHECK(marked(binary(Mul, literal(2.0F), literal(0.5F)), false) == "1.0");
  CHECK(marked(binary(Add, t.ref(t.f), literal(-0.0F)), true) == "$(f + -$0$)");
  CHECK(marked(binary(Mul, t.ref(t.f), binary(Sub, literal(1.0F), literal(1.0F))), true) == "$(f * $0$)");
  CHECK(marked(binary(Less, t.ref(t.f), literal(0.0F)), true) == "f < 0.0");
  CHECK(marked(binary(Sub, t.ref(t.x), t.ref(t.x)), true) == "$($<x$> - x$)");
  CHECK(marked(binary(Mul, convert(Scalar::Float, t.ref(t.i)), t.ref(t.x)), true) == "$($<float(i)$> * x$)");
  const auto divided = [&](ExprPtr divisor) {
    return marked(binary(Div, t.ref(t.f), std::move(divisor)), true);
  };
  CHECK(divided(literal(3.0F)) == "$(f / $/3.0$|$)");
  CHECK(divided(literal(-0.1F)) == "$(f / $/-0.1$|$)");
  CHECK(divided(literal(-4.0F)) == "$(f / -4.0$)");
  CHECK(divided(sum()) == "$(f / $[f + x$]$)");
  CHECK(divided(t.ref(t.x)) == "$(f / x$)");
  CHECK(divided(t.ref(t.r)) == "$(f / $/r$|$)");
}

TEST_CASE("values that are only copied to outputs have no marks of operations") {
  Module module = testModule();
  KernelBuilder k(module, "k");
  const VarId x = k.input("x", floatType), r = k.output("r", floatType), s = k.output("s", floatType);
  const VarId p = k.local("p", floatType), q = k.local("q", floatType);
  const auto ref = [&](VarId var) { return k.ref(var); };
  Block body;
  body.push_back(declare(p, binary(Mul, ref(x), literal(0.1F))));  // is added
  body.push_back(declare(q, binary(Add, ref(p), literal(0.2F))));  // is copied
  body.push_back(assign(ref(r), select(binary(Less, ref(x), ref(p)), ref(q), literal(0.0F))));
  body.push_back(assign(ref(s), binary(Sub, ref(x), ref(p))));
  body.push_back(assign(ref(s), Mul, ref(x)));  // which computes with what s had
  k.finish(std::move(body));
  const analysis::CopiedValues copied = analysis::copiedValues(module, module.kernels[0]);
  const auto isCopied = [&](std::size_t statement) {
    const Stmt& stmt = module.functions[0].body[statement];
    const auto* declared = std::get_if<Declare>(&stmt.node);
    return copied.count((declared != nullptr ? declared->init : std::get<Assign>(stmt.node).value).get()) ==
           1;
  };
  CHECK_FALSE(isCopied(0));
  CHECK(isCopied(1));
  CHECK(isCopied(2));
  CHECK_FALSE(isCopied(3));
  CHECK_FALSE(isCopied(4));
}

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
  CHECK(t.body(binary(LogicalAnd, t.ref(t.b), t.ref(t.b))).body ==
        "bvec2 sk_and(bvec2 a, bvec2 b) { return bvec2(a.x && b.x, a.y && b.y); }\n\n");
  CHECK(t.text(binary(LogicalOr, binary(Less, t.ref(t.f), t.ref(t.f)), literal(true))) == "f < f || true");
}

TEST_CASE("choices by component") {
  Fixture t;
  CHECK(t.text(select(t.ref(t.b), t.ref(t.v), literalOf(float2, 0))) == "mix(vec2(0.0), v, b)");
  CHECK(t.text(select(t.ref(t.b), swizzle(t.ref(t.w), "xy"), swizzle(t.ref(t.w), "yz"))) ==
        "sk_select(b, w.xy, w.yz)");
  CHECK(t.text(binary(Add, select(literal(true), t.ref(t.f), literal(2.0F)), literal(1.0F))) ==
        "(true ? f : 2.0) + 1.0");
}

TEST_CASE("the magnitude of an int is no abs, of which drivers believe that it cannot be negative") {
  Fixture t;
  CHECK(t.text(intrinsic(Intrinsic::Abs, exprs(t.ref(t.i)))) == "sk_abs(i)");
  CHECK(t.text(intrinsic(Intrinsic::Abs, exprs(t.ref(t.w)))) == "sk_abs(w)");
  CHECK(t.text(intrinsic(Intrinsic::Abs, exprs(t.ref(t.f)))) == "abs(f)");
  CHECK(t.body(intrinsic(Intrinsic::Abs, exprs(t.ref(t.w)))).body ==
        "ivec3 sk_abs(ivec3 x) { return max(x, -x); }\n\n");
}

TEST_CASE("whether a whole number is 0 is no comparison of floats, which drivers turn into another one") {
  Fixture t;
  const auto floor = [&] { return intrinsic(Intrinsic::Floor, exprs(t.ref(t.f))); };
  CHECK(t.text(binary(NotEqual, floor(), literal(0.0F))) == "sk_nonzero(floor(f))");
  CHECK(t.text(binary(Equal, literal(-0.0F), binary(Add, floor(), t.ref(t.x)))) ==
        "!sk_nonzero(floor(f) + x)");
  CHECK(t.text(binary(Equal, floor(), t.ref(t.f))) == "floor(f) == f");
  CHECK(t.text(binary(NotEqual, t.ref(t.f), literal(0.0F))) == "f != 0.0");
}

TEST_CASE("conversions, constructors, swizzles, elements") {
  Fixture t;
  CHECK(t.text(convert(Scalar::Float, t.ref(t.w))) == "vec3(w)");
  CHECK(t.text(convert(Scalar::Bool, t.ref(t.f))) == "sk_nonzero(f)");
  CHECK(t.text(convert(Scalar::Bool, t.ref(t.i))) == "bool(i)");
  CHECK(t.text(construct(Type::of(Scalar::Float, 3), exprs(t.ref(t.v), literal(1.0F)))) == "vec3(v, 1.0)");
  CHECK(t.text(swizzle(binary(Add, t.ref(t.v), t.ref(t.v)), "yx")) == "(v + v).yx");
  CHECK(t.text(index(t.module, t.ref(t.v), t.ref(t.i))) == "sk_component(v, i)");
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
  CHECK(t.text(intrinsic(Intrinsic::Saturate, exprs(binary(Add, f(), f())))) == "sk_saturate(f + f)");
  CHECK(t.text(intrinsic(Intrinsic::Isfinite, exprs(t.ref(t.v)))) ==
        "lessThan(floatBitsToUint(v) & 0x7f800000u, uvec2(0x7f800000u))");
  CHECK(t.text(intrinsic(Intrinsic::Any, exprs(t.ref(t.b)))) == "any(b)");
  const auto scalars = [&] { return binary(Less, f(), literal(1.0F)); };
  CHECK(t.text(binary(Equal, intrinsic(Intrinsic::Any, exprs(scalars())), literal(true))) ==
        "f < 1.0 == true");
  const auto exponent = [&] { return intrinsic(Intrinsic::FrexpExponent, exprs(t.ref(t.v))); };
  CHECK(t.text(exponent()) == "sk_frexp_exponent(v)");
  CHECK(t.body(exponent()).body.starts_with("ivec2 sk_frexp_exponent(vec2 x)"));
}

TEST_CASE("intrinsics that the assembler defines take arguments of one width, and are told of") {
  using Defined = sk::program::Intrinsic;
  Fixture t;
  CHECK(t.text(intrinsic(Intrinsic::Sin, exprs(t.ref(t.f)))) == "sk_sin(f)");
  CHECK(t.text(intrinsic(Intrinsic::Sin, exprs(t.ref(t.v)))) == "sk_sin(v)");
  CHECK(t.text(intrinsic(Intrinsic::Fmax, exprs(t.ref(t.v), literal(0.0F)))) == "sk_max(v, vec2(0.0))");
  CHECK(t.text(intrinsic(Intrinsic::Max, exprs(t.ref(t.i), literal(0)))) == "max(i, 0)");
  CHECK(t.text(intrinsic(Intrinsic::Clamp, exprs(t.ref(t.i), literal(0), literal(1)))) == "clamp(i, 0, 1)");
  const GlslBody body =
      t.body(construct(Type::of(Scalar::Float, 3),
                       exprs(intrinsic(Intrinsic::Fmax, exprs(intrinsic(Intrinsic::Sin, exprs(t.ref(t.v))),
                                                              intrinsic(Intrinsic::Sin, exprs(t.ref(t.f))))),
                             literal(0.0F))));
  CHECK(body.body.empty());
  REQUIRE(body.intrinsics.size() == 2);
  CHECK(body.intrinsics[0].intrinsic == Defined::Sin);
  CHECK(body.intrinsics[0].widths == 0b11);
  CHECK(body.intrinsics[1].intrinsic == Defined::Max);
  CHECK(body.intrinsics[1].widths == 0b10);
}

TEST_CASE("intrinsics of doubles: the assembler defines them of one, the body of vectors") {
  Fixture t;
  const auto wide = [&](VarId var) { return convert(Scalar::Double, t.ref(var)); };
  CHECK(t.text(intrinsic(Intrinsic::Exp, exprs(wide(t.f)))) == "sk_exp(sk_to_double(f))");
  CHECK(t.body(intrinsic(Intrinsic::Exp, exprs(wide(t.f)))).body.empty());
  const auto angle = [&] { return intrinsic(Intrinsic::AtanYX, exprs(wide(t.v), wide(t.v))); };
  CHECK(t.text(angle()) == "sk_atan2(sk_to_double(v), sk_to_double(v))");
  const GlslBody body = t.body(angle());
  CHECK(body.body.find("sk_double2 sk_atan2(") != std::string::npos);
  REQUIRE(body.intrinsics.size() == 1);
  CHECK(body.intrinsics[0].ofDouble);
  CHECK(body.intrinsics[0].widths == 0);
}

TEST_CASE("an intrinsic without GLSL of its own is defined by the assembler, or replaced") {
  Fixture t;
  for (const IntrinsicRow& entry : intrinsicRows()) {
    for (const IntrinsicOverload& one : overloads(entry.id)) {
      if (!entry.glsl.empty() || entry.id == Intrinsic::AnyLane) continue;
      INFO(entry.name);
      std::vector<ExprPtr> args;
      for (const Type type : one.arguments) args.push_back(literalOf(type, 0));
      ExprPtr expr = intrinsic(entry.id, std::move(args));
      legalize(t.module, glslCapabilities, t.polyfills, expr);
      const auto* call = std::get_if<IntrinsicCall>(&expr->node);
      CHECK((call == nullptr || definedIntrinsic(*call)));
    }
  }
}

TEST_CASE("operations that GLSL leaves undefined for some operands") {
  Fixture t;
  const auto i = [&] { return t.ref(t.i); };
  const auto u = [&] { return convert(Scalar::Uint, t.ref(t.i)); };
  CHECK(t.text(binary(Div, i(), i())) == "sk_div(i, i)");
  CHECK(t.text(binary(Div, i(), literal(3))) == "i / 3");
  CHECK(t.text(binary(Div, i(), literal(-3))) == "i / -3");
  CHECK(t.text(binary(Div, i(), literal(0))) == "sk_div(i, 0)");
  CHECK(t.text(binary(Div, i(), literal(-1))) == "sk_div(i, -1)");
  CHECK(t.text(binary(Div, u(), literal(0xffffffffU))) == "uint(i) / 0xffffffffu");
  CHECK(t.text(binary(Rem, i(), literal(3))) == "sk_rem(i, 3)");
  CHECK(t.text(binary(Rem, u(), literal(3U))) == "uint(i) % 3u");
  CHECK(t.text(binary(Rem, u(), u())) == "sk_rem(uint(i), uint(i))");
  CHECK(t.text(binary(Div, t.ref(t.w), i())) == "sk_div(w, i)");
  CHECK(t.text(binary(ShiftLeft, i(), literal(31))) == "i << 31");
  CHECK(t.text(binary(ShiftLeft, i(), literal(32))) == "i << (32 & 31)");
  CHECK(t.text(binary(ShiftRight, i(), binary(Add, i(), literal(1)))) == "i >> ((i + 1) & 31)");
  CHECK(t.text(binary(ShiftRight, i(), binary(BitAnd, i(), literal(7)))) == "i >> (i & 7)");
  CHECK(t.text(binary(ShiftRight, t.ref(t.w), u())) == "w >> (uint(i) & 31u)");
  CHECK(t.text(convert(Scalar::Int, t.ref(t.f))) == "sk_int(f)");
  CHECK(t.text(convert(Scalar::Uint, t.ref(t.v))) == "sk_uint(v)");
  CHECK(t.text(convert(Scalar::Int, literal(2.5F))) == "int(2.5)");
  CHECK(t.text(convert(Scalar::Uint, literal(-1.0F))) == "sk_uint(-1.0)");
}

}  // namespace
}  // namespace skc::emit
