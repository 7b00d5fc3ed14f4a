// SPDX-License-Identifier: MIT
//
// Promises: names that GLSL allows stay; others change as the headers say; no two entities share
// a name.
#include "glsl/kernel_names.hpp"

#include <catch2/catch.hpp>

#include "glsl/legalize.hpp"
#include "glsl/words.hpp"
#include "ir/kernel_builder.hpp"

namespace skc::emit {
namespace {

using namespace ir;

TEST_CASE("words of every version are known") {
  for (const char* word : {"active",
                           "bool",
                           "common",
                           "filter",
                           "half",
                           "hvec2",
                           "image2D",
                           "input",
                           "main",
                           "mat4x4",
                           "output",
                           "packed",
                           "precise",
                           "row_major",
                           "sample",
                           "sampler2DRectShadow",
                           "superp",
                           "texture2D",
                           "usamplerCubeArray",
                           "using",
                           "utexture1D",
                           "varying",
                           "writeonly"}) {
    INFO(word);
    CHECK(isGlslWord(word));
  }
  for (const char* name :
       {"abs", "EmitVertex", "dFdx", "lessThan", "mix", "noise1", "texture", "usubBorrow"}) {
    INFO(name);
    CHECK(isGlslFunction(name));
    CHECK_FALSE(isGlslWord(name));
  }
  CHECK_FALSE(isGlslWord("diffuse"));
  CHECK_FALSE(isGlslFunction("lerp"));
}

TEST_CASE("only what GLSL forbids is changed") {
  CHECK(glslSafe("velocity") == "velocity");
  CHECK(glslSafe("sample") == "sample_");
  CHECK(glslSafe("a__b___c") == "a_b_c");
  CHECK(glslSafe("sk_index") == "user_sk_index");
  CHECK(glslSafe("gl_Position") == "user_gl_Position");
  CHECK(glslSafe("gr\xc3\xb6\xc3\x9f"
                 "e") == "gru00f6u00dfe");
  CHECK(glslSafe("skip") == "skip");
}

struct Sample {
  Module module = testModule();
  KernelBuilder k{module, "f"};
  KernelNames names() {
    const TypeNames types(module);
    return KernelNames(module, module.kernels.back(), types);
  }
};

TEST_CASE("parameters: keywords, and no underscore in front, since assembled names end with them") {
  Sample s;
  s.k.input("sample", floatType);
  s.k.input("_x", floatType);
  s.k.output("f", floatType);
  s.k.finish({});
  const KernelNames names = s.names();
  CHECK(names.symbol(0) == "sample_");
  CHECK(names.symbol(1) == "p_x");
  CHECK(names.symbol(2) == "f");   // hides the function, which is not called
}

TEST_CASE("nested variables of one name are told apart, siblings are not") {
  Sample s;
  const VarId a = s.k.local("i", intType);
  const VarId b = s.k.local("i", intType);
  const VarId c = s.k.local("i", intType);
  s.k.finish(block(scope(block(declare(a), scope(block(declare(b))))), scope(block(declare(c)))));
  const KernelNames names = s.names();
  CHECK(names.variable(0, a) == "i");
  CHECK(names.variable(0, b) == "i_2");
  CHECK(names.variable(0, c) == "i");
}

TEST_CASE("a variable does not hide what its function calls") {
  Sample s;
  const VarId root = s.k.local("sqrt", floatType);
  const VarId step = s.k.local("step", floatType);
  const VarId clamp = s.k.local("clamp", Type::of(Scalar::Float, 2));
  s.k.finish(
      block(declare(step, literal(1.0F)), declare(root, intrinsic(Intrinsic::Sqrt, exprs(s.k.ref(step)))),
            declare(clamp),
            assign(index(s.module, s.k.ref(clamp), swizzle(indexOf({StreamRef::Space::Domain, 0}), "x")),
                   s.k.ref(root))));
  legalize(s.module, glslCapabilities);
  const KernelNames names = s.names();
  CHECK(names.variable(0, root) == "sqrt_2");
  CHECK(names.variable(0, step) == "step");
  CHECK(names.variable(0, clamp) == "clamp_2");   // clamping the index calls clamp
}

FunctionId addFunctionOf(Module& module, const std::string& name, Type type) {
  Function f;
  f.name = name;
  f.result = floatType;
  addVariable(f, "x", type, VarRole::In);
  return addFunction(module, std::move(f), block(returnStmt(literal(1.0F))));
}

TEST_CASE("overloads keep their name while their parameters differ; built-ins are not redefined") {
  Sample s;
  s.module.structs.push_back({"Hit", {"a"}, {{"t", floatType}}, {}});
  s.module.structs.push_back(
      {"Hit", {"b"}, {{"input", floatType}, {"length", floatType}, {"length_", floatType}}, {}});
  s.module.constants.push_back({"mix", floatType, literal(1.0F), {}});
  const FunctionId first = addFunctionOf(s.module, "half_of", floatType);
  const FunctionId second = addFunctionOf(s.module, "half_of", intType);
  const FunctionId third = addFunctionOf(s.module, "half_of", floatType);   // in another namespace
  const FunctionId noise = addFunctionOf(s.module, "noise1", floatType);
  s.k.finish(block(callStmt(first, exprs(literal(1.0F))), callStmt(second, exprs(literal(1))),
                   callStmt(third, exprs(literal(1.0F))), callStmt(noise, exprs(literal(1.0F)))));
  const KernelNames names = s.names();
  CHECK(names.function(first) == "half_of");
  CHECK(names.function(second) == "half_of");
  CHECK(names.function(third) == "half_of_2");
  CHECK(names.function(noise) == "noise1_");
  const TypeNames types(s.module);
  CHECK(types.constantName(0) == "mix_");
  CHECK(types.structName(0) == "Hit");
  CHECK(types.structName(1) == "b_Hit");
  CHECK(types.fieldName(1, 0) == "input_");
  CHECK(types.fieldName(1, 1) == "length_");
  CHECK(types.fieldName(1, 2) == "length_2");
}

}  // namespace
}  // namespace skc::emit
