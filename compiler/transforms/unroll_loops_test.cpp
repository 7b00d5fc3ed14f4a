// SPDX-License-Identifier: MIT
//
// Promises: short counted loops whose counters are offsets or indices are unrolled, with locals of their own,
// constant indices and elements, and without jumps that are known; float results do not change; loops that
// are too long, not counted or left by some elements stay, with a reason.
#include "transforms/passes.hpp"

#include <functional>

#include <catch2/catch.hpp>

#include "ir/kernel_builder.hpp"
#include "ir/print.hpp"
#include "ir/validate.hpp"
#include "support/diagnostics.hpp"

namespace skc {
namespace {

using namespace ir;
using enum BinaryOp;

/// A kernel with a gather `a`, a uniform `u`, an output `r`, and some locals.
struct LoopKernel {
  Module module = testModule();
  KernelBuilder k{module, "f"};
  VarId a = k.gather("a", floatType, 1);
  VarId u = k.uniform("u", intType);
  VarId r = k.output("r", floatType);
  VarId i = k.local("i", intType);
  VarId j = k.local("j", intType);

  ExprPtr near(ExprPtr offset) {
    return neighborRead(floatType, KernelBuilder::stream(a), std::move(offset));
  }
  Stmt add(ExprPtr value) { return assign(k.ref(r), Add, std::move(value)); }
  /// for (int v = from; v < to; ++v) body
  Stmt loop(VarId v, ExprPtr from, ExprPtr to, Block body, std::uint32_t line = 1) {
    return forLoop(block(declare(v, std::move(from))), binary(Less, k.ref(v), std::move(to)),
                   block(assign(k.ref(v), Add, literal(1))), std::move(body), atLine(line));
  }
  Stmt loop(VarId v, int from, int to, Block body) {
    return loop(v, literal(from), literal(to), std::move(body));
  }

  std::string unrolled(Block body) {
    k.finish(std::move(body));
    DiagnosticLog log;
    specializeGathers(module, log);
    unrollLoops(module, log);
    REQUIRE(validate(module, Stage::Specialized) == "");
    const std::string text = print(module, module.functions[module.kernels[0].entry]);
    return text.substr(text.find('{'));
  }
  const LoopNote& note(std::size_t number = 0) const { return module.kernels[0].loops.at(number); }
};

TEST_CASE("offsets of neighbours become constants") {
  LoopKernel s;
  CHECK(s.unrolled(block(s.loop(s.i, -1, 2, block(s.add(s.near(binary(Mul, s.k.ref(s.i), literal(2)))))))) ==
        "{\n  r += neighbor($0, -2);\n  r += neighbor($0, 0);\n  r += neighbor($0, 2);\n}\n");
  CHECK(s.note().whyNot.empty());
  CHECK(s.note().tripCount == 3);
}

TEST_CASE("loops in loops count together, also where the outer counter bounds the inner") {
  LoopKernel s;
  CHECK(s.unrolled(
            block(s.loop(s.i, 0, 3,
                         block(s.loop(s.j, s.k.ref(s.i), literal(2),
                                      block(s.add(s.near(binary(Sub, s.k.ref(s.i), s.k.ref(s.j)))))))))) ==
        "{\n  r += neighbor($0, 0);\n  r += neighbor($0, -1);\n  r += neighbor($0, 0);\n}\n");
}

TEST_CASE("each iteration has locals of its own, and those of a known integer are gone") {
  LoopKernel s;
  const VarId t = s.k.local("t", floatType), d = s.k.local("d", intType);
  const std::string text = s.unrolled(
      block(s.loop(s.i, 0, 2,
                   block(declare(d, binary(Add, s.k.ref(s.i), literal(1))), declare(t, s.near(s.k.ref(d))),
                         assign(s.k.ref(t), Mul, literal(0.5F)), s.add(s.k.ref(t))))));
  CHECK(text.find("neighbor($0, 1)") != std::string::npos);
  CHECK(text.find("neighbor($0, 2)") != std::string::npos);
  CHECK(s.module.functions[0].variables.size() == 9);  // t and d twice
}

TEST_CASE("elements of constant arrays take their places; outside, it is the nearest") {
  LoopKernel s;
  const Type floats = arrayOf(s.module, floatType, 2);
  const VarId w = s.k.local("w", floats);
  CHECK(s.unrolled(block(declare(w, construct(floats, exprs(literal(0.25F), literal(0.75F)))),
                         s.loop(s.i, 0, 3, block(s.add(index(s.module, s.k.ref(w), s.k.ref(s.i))))))) ==
        "{\n  float[2] w = float[2]{0.25, 0.75};\n  r += 0.25;\n  r += 0.75;\n  r += 0.75;\n}\n");
}

TEST_CASE("arithmetic on floats is left to the device") {
  LoopKernel s;
  CHECK(s.unrolled(block(
            s.loop(s.i, 1, 3,
                   block(s.add(binary(Mul, binary(Mul, convert(Scalar::Float, s.k.ref(s.i)), literal(0.1F)),
                                      s.near(s.k.ref(s.i)))))))) ==
        "{\n  r += 1.0 * 0.1 * neighbor($0, 1);\n  r += 2.0 * 0.1 * neighbor($0, 2);\n}\n");
}

TEST_CASE("jumps that are decided are gone, and what continues skips the rest of its iteration") {
  LoopKernel s;
  CHECK(s.unrolled(block(
            s.loop(s.i, 0, 9,
                   block(ifStmt(binary(Equal, s.k.ref(s.i), literal(1)), block(continueStmt())),
                         ifStmt(binary(Equal, s.k.ref(s.i), literal(3)), block(breakStmt())),
                         ifStmt(binary(Less, s.near(s.k.ref(s.i)), literal(0.0F)), block(continueStmt())),
                         s.add(literal(1.0F)))))) ==
        "{\n  if (!(neighbor($0, 0) < 0.0)) {\n    r += 1.0;\n  }\n"
        "  if (!(neighbor($0, 2) < 0.0)) {\n    r += 1.0;\n  }\n}\n");
}

TEST_CASE("a loop that elements leave stays, with its reason") {
  LoopKernel s;
  const std::string text = s.unrolled(
      block(s.loop(s.i, 0, 3,
                   block(ifStmt(binary(Less, s.near(s.k.ref(s.i)), literal(0.0F)), block(breakStmt())),
                         s.add(literal(1.0F))))));
  CHECK(text.find("for (int i = 0;") != std::string::npos);
  CHECK(s.note().whyNot.find("at different times") != std::string::npos);
}

TEST_CASE("a loop of unknown bounds, a changed counter or too many iterations stays, with its reason") {
  const auto whyNot = [](const std::function<Block(LoopKernel&)>& make) {
    LoopKernel s;
    CHECK(s.unrolled(make(s)).find("for (int i") != std::string::npos);
    return s.note().whyNot;
  };
  const auto read = [](LoopKernel& s) { return block(s.add(s.near(s.k.ref(s.i)))); };
  CHECK(whyNot([&](LoopKernel& s) { return block(s.loop(s.i, literal(0), s.k.ref(s.u), read(s))); }) ==
        "the bounds of its counter 'i' are not constants");
  CHECK(whyNot([&](LoopKernel& s) {
          Block body = read(s);
          body.push_back(assign(s.k.ref(s.i), Add, literal(1)));
          return block(s.loop(s.i, 0, 4, std::move(body)));
        }) == "its body changes the counter 'i'");
  CHECK(whyNot([&](LoopKernel& s) {
          return block(s.loop(s.i, 0, 1000, read(s)));
        }).starts_with("with the loops in it, it has 1000 iterations"));
}

TEST_CASE("a counter may be passed by value to a function, but not to be changed") {
  const auto unrolled = [](VarRole role) {
    LoopKernel s;
    Function f;
    f.name = "add";
    f.result = Type::voidType();
    addVariable(f, "n", intType, role);
    f.parameterCount = 1;
    const FunctionId add = addFunction(s.module, std::move(f), {});
    Block body = block(s.add(s.near(s.k.ref(s.i))), callStmt(add, exprs(s.k.ref(s.i))));
    const std::string text = s.unrolled(block(s.loop(s.i, 0, 2, std::move(body))));
    return std::pair(text.find("for (int i") == std::string::npos, s.note().whyNot);
  };
  CHECK(unrolled(VarRole::In) == std::pair(true, std::string()));
  CHECK(unrolled(VarRole::InOut) == std::pair(false, std::string("its body changes the counter 'i'")));
}

TEST_CASE("a nest is unrolled as a whole or not at all; a loop in one that stays, by itself") {
  LoopKernel s;
  const std::string text =
      s.unrolled(block(s.loop(s.i, 0, 1000, block(s.loop(s.j, 0, 2, block(s.add(s.near(s.k.ref(s.j)))))))));
  CHECK(text.find("for (int i = 0;") != std::string::npos);
  CHECK(text.find("neighbor($0, 1)") != std::string::npos);
}

TEST_CASE("a bound that is a local of a known value is a constant") {
  LoopKernel s;
  const VarId radius = s.k.local("radius", intType);
  CHECK(s.unrolled(block(declare(radius, literal(1)),
                         s.loop(s.i, unary(UnaryOp::Negate, s.k.ref(radius)), s.k.ref(radius),
                                block(s.add(s.near(s.k.ref(s.i))))))) ==
        "{\n  int radius = 1;\n  r += neighbor($0, -1);\n  r += neighbor($0, 0);\n}\n");
}

TEST_CASE("an unsigned counter that never ends its loop is not counted") {
  LoopKernel s;
  const Type uintType = Type::of(Scalar::Uint);
  const VarId n = s.k.local("n", uintType);
  const std::string text = s.unrolled(block(forLoop(
      block(declare(n, literal(3U))), binary(GreaterEqual, s.k.ref(n), literal(0U)),
      block(assign(s.k.ref(n), Sub, literal(1U))), block(s.add(s.near(convert(Scalar::Int, s.k.ref(n))))))));
  CHECK(text.find("for (uint n = 3u") != std::string::npos);
}

}  // namespace
}  // namespace skc
