// SPDX-License-Identifier: MIT
//
// Promises: bodies look like their .sk file, and every kind of statement is printed so that its meaning in
// GLSL is its meaning in C++.
#include "glsl/body.hpp"

#include <functional>

#include <catch2/catch.hpp>

#include "assemble/glsl/own_arithmetic.hpp"
#include "ir/kernel_builder.hpp"
#include "ir/validate.hpp"
#include "program/descriptors.hpp"
#include "program/sample_module.hpp"

namespace skc::emit {
namespace {

using namespace ir;
using enum BinaryOp;

/// A body as it is where drivers may compute floats as they like.
std::string plain(std::string_view body) { return sk::assemble::unmarked(body); }

TEST_CASE("a kernel with a helper, a constant and a loop") {
  const Module module = sampleModule();
  const Program program(module);
  CHECK(plain(program.units()[0].kernel.body) == R"(const float scale = 0.25;

#line 4 1
float average_(ivec2 p) {
  float s = 0.0;
  for (int i = -1; i <= 1; ++i) {
    if (i == 0) continue;
    s += sk_at_u(ivec2(p.x + i, p.y));
  }
  return s * scale;
}

#line 14 1
void diffuse(float k, out float v) {
  ivec2 p = sk_index().xy;
  v = average_(p) + k * (sk_near_u(ivec2(1, 0)) - 4.0 * sk_near_u(ivec2(0, 0)));
}
)");
}

TEST_CASE("structs are declarations, and a function on one line stays there") {
  const Module module = sampleModule();
  const Program program(module);
  const sk::program::Kernel& nearest = program.units()[2].kernel;
  CHECK(nearest.declarations == "struct Hit {\n  float t;\n  int id;\n};\n\n");
  CHECK(plain(nearest.body) ==
        "#line 22 1\nvoid nearest(Hit h, inout Hit best) { if (h.t < best.t) best = h; }\n");
}

/// The body of `void f(float x, out float r)` at line 1, with locals i, j (int) and t (float).
std::string body(const std::function<Block(KernelBuilder&)>& make) {
  Module module = testModule();
  KernelBuilder k(module, "f");
  k.input("x", floatType);
  k.output("r", floatType);
  k.local("i", intType);
  k.local("j", intType);
  k.local("t", floatType);
  Block statements = make(k);
  k.finish(std::move(statements));
  REQUIRE(validate(module, Stage::Specialized) == "");
  const Program program(module);
  const std::string text = plain(program.units()[0].kernel.body);
  const std::string head = "#line 1 1\nvoid f(float x, out float r) {";
  REQUIRE(text.substr(0, head.size()) == head);
  return text.substr(head.size());
}

constexpr VarId x = 0, r = 1, i = 2, j = 3, t = 4;

Stmt set(KernelBuilder& k, float value, std::uint32_t line) {
  return assign(k.ref(r), literal(value), atLine(line));
}
ExprPtr positive(KernelBuilder& k) { return binary(Greater, k.ref(x), literal(0.0F)); }

TEST_CASE("braces stand where the .sk file has a line for them") {
  CHECK(body([](KernelBuilder& k) {
          return block(ifStmt(positive(k), block(set(k, 1, 3)), {}, atLine(2)), set(k, 2, 5));
        }) == "\n  if (x > 0.0) {\n    r = 1.0;\n  }\n  r = 2.0;\n}\n");
  CHECK(body([](KernelBuilder& k) {
          return block(ifStmt(positive(k), block(set(k, 1, 3)), {}, atLine(2)), set(k, 2, 4));
        }) == "\n  if (x > 0.0)\n    r = 1.0;\n  r = 2.0;\n}\n");
  CHECK(body([](KernelBuilder& k) {
          return block(ifStmt(positive(k), block(set(k, 1, 2)), {}, atLine(2)), set(k, 2, 3));
        }) == "\n  if (x > 0.0) r = 1.0;\n  r = 2.0;\n}\n");
}

TEST_CASE("else, and chains of them") {
  CHECK(body([](KernelBuilder& k) {
          return block(ifStmt(positive(k), block(set(k, 1, 3)), block(set(k, 2, 5)), atLine(2)),
                       set(k, 3, 7));
        }) == "\n  if (x > 0.0) {\n    r = 1.0;\n  } else {\n    r = 2.0;\n  }\n  r = 3.0;\n}\n");
  CHECK(body([](KernelBuilder& k) {
          return block(ifStmt(positive(k), block(set(k, 1, 2)), block(set(k, 2, 2)), atLine(2)),
                       set(k, 3, 3));
        }) == "\n  if (x > 0.0) r = 1.0; else r = 2.0;\n  r = 3.0;\n}\n");
  CHECK(body([](KernelBuilder& k) {
          Stmt inner = ifStmt(positive(k), block(set(k, 2, 5)), block(set(k, 3, 7)), atLine(4));
          return block(ifStmt(positive(k), block(set(k, 1, 3)), block(std::move(inner)), atLine(2)));
        }) ==
        "\n  if (x > 0.0) {\n    r = 1.0;\n  } else if (x > 0.0) {\n    r = 2.0;\n  } else {\n    r = 3.0;\n "
        " }\n}\n");
}

TEST_CASE("chains on one line, and lines of their own without braces") {
  CHECK(body([](KernelBuilder& k) {
          Stmt inner = ifStmt(positive(k), block(set(k, 2, 2)), {}, atLine(2));
          return block(ifStmt(positive(k), block(set(k, 1, 2)), block(std::move(inner)), atLine(2)),
                       set(k, 3, 3));
        }) == "\n  if (x > 0.0) r = 1.0; else if (x > 0.0) r = 2.0;\n  r = 3.0;\n}\n");
  CHECK(body([](KernelBuilder& k) {
          return block(ifStmt(positive(k), block(set(k, 1, 3)), block(set(k, 2, 5)), atLine(2)),
                       set(k, 3, 6));
        }) == "\n  if (x > 0.0)\n    r = 1.0;\n  else\n    r = 2.0;\n  r = 3.0;\n}\n");
  CHECK(body([](KernelBuilder& k) {
          return block(ifStmt(positive(k), block(set(k, 1, 2)), block(set(k, 2, 3)), atLine(2)),
                       set(k, 3, 4));
        }) == "\n  if (x > 0.0) r = 1.0;\n  else r = 2.0;\n  r = 3.0;\n}\n");
}

TEST_CASE("a block on one line that does not fit there gets a line for each statement") {
  const auto make = [](int count) {
    return [count](KernelBuilder& k) {
      Block inner;
      for (int n = 0; n < count; ++n) inner.push_back(set(k, 1, 2));
      Block once = block(ifStmt(positive(k), std::move(inner), {}, atLine(2)));
      return block(whileLoop(positive(k), std::move(once), atLine(2)), set(k, 3, 3));
    };
  };
  CHECK(body(make(2)) == "\n  while (x > 0.0) { if (x > 0.0) { r = 1.0; r = 1.0; } }\n  r = 3.0;\n}\n");
  CHECK(body(make(8)) ==
        "\n  while (x > 0.0) {\n    if (x > 0.0) { r = 1.0; r = 1.0; r = 1.0; r = 1.0; r = 1.0; "
        "r = 1.0; r = 1.0; r = 1.0; }\n  }\n#line 3 1\n  r = 3.0;\n}\n");
  const std::string longest = body(make(11));
  CHECK(longest.find("if (x > 0.0) {\n      r = 1.0;\n      r = 1.0;\n") != std::string::npos);
}

TEST_CASE("loops keep their form") {
  CHECK(body([](KernelBuilder& k) {
          Block init = block(declare(i, literal(0), atLine(2)), declare(j, literal(9), atLine(2)));
          Block step = block(assign(k.ref(i), Add, literal(1)), assign(k.ref(j), Sub, literal(2)));
          return block(forLoop(std::move(init), binary(Less, k.ref(i), k.ref(j)), std::move(step),
                               block(set(k, 1, 3)), atLine(2)));
        }) == "\n  for (int i = 0, j = 9; i < j; ++i, j -= 2) {\n    r = 1.0;\n  }\n}\n");
  CHECK(body([](KernelBuilder& k) {
          return block(whileLoop(nullptr, block(breakStmt(atLine(3))), atLine(2)), set(k, 1, 5));
        }) == "\n  while (true) {\n    break;\n  }\n  r = 1.0;\n}\n");
  CHECK(body([](KernelBuilder& k) {
          return block(doWhileLoop(block(set(k, 1, 3)), positive(k), atLine(2)));
        }) == "\n  do {\n    r = 1.0;\n  } while (x > 0.0);\n}\n");
  CHECK(body([](KernelBuilder& k) {
          return block(forLoop({}, nullptr, {}, block(breakStmt(atLine(2))), atLine(2)), set(k, 1, 3));
        }) == "\n  for (;;) break;\n  r = 1.0;\n}\n");
}

TEST_CASE("a head that GLSL has no form for moves into the loop, and continue still leads to the step") {
  CHECK(body([](KernelBuilder& k) {
          Block init = block(declare(i, literal(0), atLine(2)), declare(t, literal(0.0F), atLine(2)));
          Block step =
              block(ifStmt(positive(k), block(assign(k.ref(i), Add, literal(1), atLine(2))), {}, atLine(2)));
          return block(forLoop(std::move(init), binary(Less, k.ref(i), literal(3)), std::move(step),
                               block(continueStmt(atLine(3))), atLine(2)));
        }) == R"(
  { int i = 0; float t = 0.0;
    for (bool sk_again = false; ; sk_again = true) {
      if (sk_again) { if (x > 0.0) i += 1; }
      if (!(i < 3)) break;
#line 3 1
      continue;
    }
  }
}
)");
}

TEST_CASE("a step that shows after a jump moves into the loop") {
  const auto loop = [](bool isLasting, Stmt jump) {
    return body([&](KernelBuilder& k) {
      Block init = block(declare(i, literal(0), atLine(2)));
      Block step = block(assign(k.ref(i), Add, literal(1)));
      if (isLasting) step.push_back(assign(k.ref(r), Add, literal(2.0F)));
      return block(set(k, 1, 1),
                   forLoop(std::move(init), binary(Less, k.ref(i), literal(3)), std::move(step),
                           block(ifStmt(positive(k), block(std::move(jump)), {}, atLine(3))), atLine(2)));
    });
  };
  const std::string moved = "for (bool sk_again = false; ; sk_again = true)";
  CHECK(loop(true, returnStmt()).find(moved) != std::string::npos);
  CHECK(loop(true, breakStmt()).find(moved) != std::string::npos);
  CHECK(loop(true, whileLoop(nullptr, block(returnStmt()))).find(moved) != std::string::npos);
  CHECK(loop(true, continueStmt()).find(moved) == std::string::npos);
  CHECK(loop(true, whileLoop(nullptr, block(breakStmt()))).find(moved) == std::string::npos);
  CHECK(loop(false, returnStmt()).find(moved) == std::string::npos);
  CHECK(loop(false, breakStmt()).find(moved) == std::string::npos);
  CHECK(body([](KernelBuilder& k) {
          return block(
              declare(i, literal(0), atLine(2)),
              forLoop({}, binary(Less, k.ref(i), literal(3)), block(assign(k.ref(i), Add, literal(1))),
                      block(ifStmt(positive(k), block(breakStmt()), {}, atLine(3))), atLine(3)),
              set(k, 1, 5));
        }).find("for (; i < 3; ++i)") != std::string::npos);
}

TEST_CASE("switches fall through, and the last label has a statement") {
  CHECK(body([](KernelBuilder& k) {
          std::vector<Case> cases;
          cases.push_back({{1, 2}, false, block(set(k, 1, 4)), atLine(3)});
          cases.push_back({{-3}, false, block(set(k, 2, 5), breakStmt(atLine(5))), atLine(5)});
          cases.push_back({{}, true, {}, atLine(6)});
          return block(switchStmt(literal(2), std::move(cases), atLine(2)));
        }) ==
        "\n  switch (2) {\n    case 1: case 2:\n      r = 1.0;\n    case -3: r = 2.0; break;\n"
        "    default: break;\n  }\n}\n");
}

TEST_CASE("an empty block is no statement for the last label") {
  CHECK(body([](KernelBuilder&) {
          std::vector<Case> cases;
          cases.push_back({{1}, false, block(scope({}, atLine(3))), atLine(3)});
          return block(switchStmt(literal(2), std::move(cases), atLine(2)));
        }) == "\n  switch (2) {\n    case 1: {} break;\n  }\n}\n");
}

TEST_CASE("a bracket does not close on a line that only #line numbers alike") {
  CHECK(body([](KernelBuilder& k) {
          Stmt inner = ifStmt(positive(k), block(set(k, 1, 4)), {}, atLine(3));
          return block(ifStmt(positive(k), block(std::move(inner)), block(set(k, 2, 5)), atLine(2)),
                       set(k, 3, 6));
        }).find("} else {\n#line 5 1\n    r = 2.0;\n  }\n") != std::string::npos);
}

TEST_CASE("a block of a case closes under its label") {
  CHECK(body([](KernelBuilder& k) {
          std::vector<Case> cases;
          cases.push_back(
              {{1}, false, block(scope(block(set(k, 1, 4)), atLine(3)), breakStmt(atLine(6))), atLine(3)});
          return block(switchStmt(literal(2), std::move(cases), atLine(2)));
        }) == "\n  switch (2) {\n    case 1: {\n      r = 1.0;\n    }\n    break;\n  }\n}\n");
}

TEST_CASE("a head of several lines ends right before its body") {
  Module module = testModule();
  KernelBuilder k(module, "f", 10);
  k.output("r", floatType);
  k.finish(block(assign(k.ref(0), literal(1.0F), atLine(13))));
  CHECK(plain(Program(module).units()[0].kernel.body) ==
        "#line 12 1\nvoid f(out float r) {\n  r = 1.0;\n}\n");
}

TEST_CASE("long statements are wrapped") {
  const std::string text = body([](KernelBuilder& k) {
    ExprPtr sum = k.ref(x);
    for (int n = 0; n < 20; ++n)
      sum = binary(Add, std::move(sum), intrinsic(Intrinsic::Sin, exprs(k.ref(x))));
    return block(assign(k.ref(r), std::move(sum), atLine(2)), set(k, 1, 3));
  });
  CHECK(text.find("+\n      sk_sin(x)") != std::string::npos);
  CHECK(text.find("#line 3 1\n  r = 1.0;") != std::string::npos);
}

}  // namespace
}  // namespace skc::emit
