// SPDX-License-Identifier: MIT
//
// Promises: a module gets the library functions that its kernels call, and no others; it stays valid.
#include "driver/native_library.hpp"

#include <catch2/catch.hpp>

#include <algorithm>
#include <set>
#include <string>
#include <utility>

#include "driver/compile.hpp"
#include "ir/print.hpp"
#include "ir/validate.hpp"
#include "ir/walk.hpp"

using namespace skc;

namespace {

ir::Module translated(const std::string& text) {
  driver::Translation translation = driver::translateText({}, "test.sk", text);
  INFO(translation.messages);
  REQUIRE(translation.module);
  return std::move(*translation.module);
}

}  // namespace

TEST_CASE("intrinsics of floats get functions, and what these need") {
  ir::Module module = translated(
      "constexpr float weights[2] = {0.5, 0.25};\n"
      "kernel void wave(float2 x<>, int i, out float2 r<>) { r = weights[i] * sin(x); }\n"
      "kernel void angle(float y<>, float x<>, out float a<>) { a = atan(y, x); }\n");
  const std::size_t functions = module.functions.size();
  const native::LinkedFunctions linked = driver::linkNativeLibrary(module);
  const auto sine = linked.find(ir::Intrinsic::Sin, ir::Scalar::Float);
  const auto angle = linked.find(ir::Intrinsic::AtanYX, ir::Scalar::Float);
  REQUIRE(sine);
  REQUIRE(angle);
  CHECK(module.functions[*sine].name == "sin");
  CHECK(module.functions[*sine].parameterCount == 1);
  CHECK(module.functions[*angle].parameterCount == 2);
  CHECK(*sine >= functions);
  CHECK_FALSE(linked.find(ir::Intrinsic::Cos, ir::Scalar::Float));
  CHECK(linked.find(ir::Intrinsic::Sin, ir::Scalar::Double));  // called by the variant in double
  INFO(ir::print(module));
  CHECK(ir::validate(module, ir::Stage::Specialized).empty());
}

TEST_CASE("a module without such intrinsics stays as it is") {
  ir::Module module =
      translated("kernel void root(float x<>, out float r<>) { r = sqrt(abs(x)) + min(x, 1); }\n");
  const std::string before = ir::print(module);
  CHECK(driver::linkNativeLibrary(module).empty());
  CHECK(ir::print(module) == before);
}

/// The columns of ir/intrinsics.def that this test needs.
struct Row {
  std::string spelling, signatures, library;
  bool isIn(const char* files) const { return library.rfind(files, 0) == 0; }
  bool isBinary() const { return signatures.find(',') < signatures.find(')'); }
};
const Row rows[] = {
#define SKC_INTRINSIC(Name, spelling, signatures, library, native, glsl, polyfill) \
  {spelling, signatures, #library},
#include "ir/intrinsics.def"
#undef SKC_INTRINSIC
};

TEST_CASE("every intrinsic has the functions that its row names") {
  const auto [type, scalar] =
      GENERATE(std::pair("float", ir::Scalar::Float), std::pair("double", ir::Scalar::Double));
  std::string sum = "0";
  for (const Row& row : rows) {
    if (row.isIn("Reals") || (scalar == ir::Scalar::Float && row.isIn("Floats")))
      sum += " + " + row.spelling + (row.isBinary() ? "(x, y)" : "(x)");
  }
  ir::Module module = translated(std::string("using T = ") + type +
                                 ";\nkernel void all(T x<>, T y, out T r<>) { r = " + sum + "; }\n");
  const native::LinkedFunctions linked = driver::linkNativeLibrary(module);
  std::set<ir::Intrinsic> called;
  for (const ir::Function& function : module.functions) {
    ir::walkExprs(function.body, [&](const ir::Expr& expr) {
      const auto* call = std::get_if<ir::IntrinsicCall>(&expr.node);
      if (call == nullptr || function.name != "all") return;
      INFO(ir::row(call->intrinsic).name);
      CHECK(linked.find(call->intrinsic, scalar));
      called.insert(call->intrinsic);
    });
  }
  CHECK(called.size() == static_cast<std::size_t>(std::ranges::count(sum, '+')));
  CHECK(ir::validate(module, ir::Stage::Specialized).empty());
}
