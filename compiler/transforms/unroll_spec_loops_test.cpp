// SPDX-License-Identifier: MIT
//
// Promises: loops that an integer spec parameter bounds have variants without loops for its small values, as many as the
// limits of unrolled code allow; other loops have none, and the kernel itself keeps its loops.
#include "transforms/passes.hpp"

#include <catch2/catch.hpp>

#include "ir/kernel_builder.hpp"
#include "ir/print.hpp"
#include "ir/validate.hpp"
#include "support/diagnostics.hpp"

namespace skc {
namespace {

using namespace ir;
using enum BinaryOp;

/// kernel void f(spec int n, int u, float a[], out float r<>), whose loops count i and j.
struct SpecLoopKernel {
  Module module = testModule();
  KernelBuilder k{module, "f"};
  VarId n = k.spec("n", intType);
  VarId u = k.uniform("u", intType);
  VarId a = k.gather("a", floatType, 1);
  VarId r = k.output("r", floatType);
  VarId i = k.local("i", intType);
  VarId j = k.local("j", intType);

  Stmt add(ExprPtr offset) {
    return assign(k.ref(r), Add, neighborRead(floatType, KernelBuilder::stream(a), std::move(offset)));
  }
  /// for (int v = 0; v < to; ++v) body
  Stmt loop(VarId v, ExprPtr to, Block body) {
    return forLoop(block(declare(v, literal(0))), binary(Less, k.ref(v), std::move(to)),
                   block(assign(k.ref(v), Add, literal(1))), std::move(body), {});
  }

  const Kernel& kernel(Block body) {
    const KernelId id = k.finish(std::move(body));
    DiagnosticLog log;
    specializeGathers(module, log);
    unrollSpecLoops(module, log);
    REQUIRE(validate(module, Stage::Specialized) == "");
    return module.kernels[id];
  }
  std::string textOf(const Kernel& kernel) const {
    const std::string text = print(module, module.functions[kernel.entry]);
    return text.substr(text.find('{'));
  }
};

TEST_CASE("each small value of a bound has a variant") {
  SpecLoopKernel s;
  const Kernel& kernel = s.kernel(block(s.loop(s.i, s.k.ref(s.n), block(s.add(s.k.ref(s.i))))));
  REQUIRE(kernel.unrolled.size() == mostUnrolledValue);
  for (std::size_t v = 0; v < kernel.unrolled.size(); ++v) {
    const UnrolledVariant& variant = kernel.unrolled[v];
    CHECK(variant.spec == s.n);
    CHECK(variant.value == v + 1);
    const Kernel& made = s.module.kernels[variant.kernel];
    CHECK(made.isSynthesized);
    CHECK(made.params.size() == kernel.params.size());
    CHECK(s.textOf(made).find("for") == std::string::npos);
  }
  CHECK(s.textOf(kernel).find(" < n") != std::string::npos);
  CHECK(s.textOf(s.module.kernels[kernel.unrolled[1].kernel]).find(" < n") == std::string::npos);
}

TEST_CASE("a value that starts a loop, or that it steps by, bounds it, too") {
  SpecLoopKernel down, strides;
  // for (int i = n; i > 0; --i)
  const Kernel& counted = down.kernel(block(
      forLoop(block(declare(down.i, down.k.ref(down.n))), binary(Greater, down.k.ref(down.i), literal(0)),
              block(assign(down.k.ref(down.i), Sub, literal(1))), block(down.add(down.k.ref(down.i))), {})));
  CHECK(counted.unrolled.size() == mostUnrolledValue);
  // for (int i = 0; i < 8; i += n)
  const Kernel& stepped = strides.kernel(
      block(forLoop(block(declare(strides.i, literal(0))), binary(Less, strides.k.ref(strides.i), literal(8)),
                    block(assign(strides.k.ref(strides.i), Add, strides.k.ref(strides.n))),
                    block(strides.add(strides.k.ref(strides.i))), {})));
  CHECK(stepped.unrolled.size() == mostUnrolledValue);
}

TEST_CASE("all variants together stay within the limit") {
  SpecLoopKernel s;
  // n * n rounds of about 8 expressions
  const Kernel& kernel = s.kernel(
      block(s.loop(s.i, s.k.ref(s.n),
                   block(s.loop(s.j, s.k.ref(s.n), block(s.add(binary(Add, s.k.ref(s.i), s.k.ref(s.j)))))))));
  CHECK(kernel.unrolled.size() >= 3);
  CHECK(kernel.unrolled.size() < mostUnrolledValue);
}

TEST_CASE("other loops have no variants") {
  SpecLoopKernel uniform, mixed, none;
  CHECK(uniform
            .kernel(block(uniform.loop(uniform.i, uniform.k.ref(uniform.u),
                                       block(uniform.add(uniform.k.ref(uniform.i))))))
            .unrolled.empty());
  CHECK(mixed
            .kernel(block(mixed.loop(mixed.i, mixed.k.ref(mixed.n), block(mixed.add(mixed.k.ref(mixed.i)))),
                          mixed.loop(mixed.j, mixed.k.ref(mixed.u), block(mixed.add(mixed.k.ref(mixed.j))))))
            .unrolled.empty());
  CHECK(none.kernel(block(none.add(none.k.ref(none.n)))).unrolled.empty());
  CHECK(none.module.kernels.size() == 1);
  CHECK(mixed.module.kernels.size() == 1);
  CHECK(mixed.module.functions.size() == 1);
}

}  // namespace
}  // namespace skc
