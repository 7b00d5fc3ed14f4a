// SPDX-License-Identifier: MIT
//
// Tests the IR that the frontend produces for function bodies, mostly effects and their order.
// tests/diagnostics covers messages.
#include "frontend/frontend.hpp"

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <string_view>

#include <unistd.h>
#include <catch2/catch.hpp>

#include "ir/intrinsics.hpp"
#include "ir/print.hpp"
#include "ir/validate.hpp"

namespace {

namespace fs = std::filesystem;
using skc::frontend::Frontend;

/// A temporary .sk file, deleted by the destructor.
class SourceFile {
 public:
  explicit SourceFile(const std::string& text) {
    static int count = 0;
    path_ = fs::temp_directory_path() /
            ("skc_frontend_" + std::to_string(getpid()) + "_" + std::to_string(count++) + ".sk");
    std::ofstream(path_) << text;
  }
  ~SourceFile() { fs::remove(path_); }
  std::string path() const { return path_.string(); }

 private:
  fs::path path_;
};

/// The body of the last function, without the surrounding braces and indentation.
std::string lowered(const std::string& text) {
  const SourceFile file(text);
  Frontend frontend({});
  const std::optional<skc::ir::Module> module = frontend.compile(file.path());
  REQUIRE(module);
  CHECK(skc::ir::validate(*module, skc::ir::Stage::Lowered) == "");
  std::string printed = skc::ir::print(*module, module->functions.back());
  printed = printed.substr(printed.find("{\n") + 2);
  printed = printed.substr(0, printed.rfind("}"));
  std::string result;
  for (std::size_t at = 0; at < printed.size();) {
    const std::size_t end = printed.find('\n', at);
    std::string line = printed.substr(at, end - at);
    line.erase(0, std::min(line.size(), std::size_t{2}));
    result += line + "\n";
    at = end + 1;
  }
  return result;
}

std::string inKernel(const std::string& body) {
  return lowered(
      "float f(float& x) { x += 1; return x; }\n"
      "kernel void k(int n, float4 w, float x<>, [[wrap]] float u[][], out float v<>) {\n" +
      body + "\n}\n");
}

}  // namespace

TEST_CASE("effects become statements in front, in C++'s order", "[frontend]") {
  CHECK(inKernel("int i = 0; v = w[i++] * 2;") == "int i = 0;\nint t = i;\ni += 1;\nv = w[t] * 2.0;\n");
  CHECK(inKernel("int i = 0; i = ++i + 1; v = i;") == "int i = 0;\ni += 1;\ni = i + 1;\nv = float(i);\n");
  CHECK(inKernel("v = x; float y = v + f(v);") ==
        "v = x;\nfloat t#6 = v;\nfloat t#5;\nt#5 = f(v);\nfloat y = t#6 + t#5;\n");
  CHECK(inKernel("float a, b; a = b = x; v = a;") == "float a;\nfloat b;\nb = x;\na = b;\nv = a;\n");
}

TEST_CASE("a side's effects happen only where it is evaluated", "[frontend]") {
  CHECK(inKernel("v = x; if (x > 0 && f(v) > 1) v = 0;") ==
        "v = x;\nbool t#6 = x > 0.0;\nif (t#6) {\n  float t#5;\n  t#5 = f(v);\n  t#6 = t#5 > 1.0;\n}\n"
        "if (t#6) {\n  v = 0.0;\n}\n");
  CHECK(inKernel("v = x; v = x > 0 ? x : v;") == "v = x;\nv = x > 0.0 ? x : v;\n");
}

TEST_CASE("loops keep their shape", "[frontend]") {
  CHECK(inKernel("v = 0; for (int i = 0; i < n; ++i) { if (i == 2) continue; v += i; }") ==
        "v = 0.0;\nfor (int i = 0; i < n; i += 1) {\n  if (i == 2) {\n    continue;\n  }\n  v += "
        "float(i);\n}\n");
  CHECK(inKernel("v = x; do { v *= 2; } while (v < 8);") ==
        "v = x;\ndo {\n  v *= 2.0;\n} while (v < 8.0);\n");
  // a condition with effects moves into the body
  CHECK(inKernel("v = 0; int i = 0; while (i++ < n) v += 1;").find("while (true)") != std::string::npos);
}

TEST_CASE("vector comparisons are masks, and conditions see through them", "[frontend]") {
  CHECK(inKernel("v = any(w < x) ? 1 : 0;") == "v = float(any(w < float4{x}) ? 1 : 0);\n");
  CHECK(inKernel("bool4 m = bool4(w > 1); v = m.x;") == "bool4 m = w > float4{1.0};\nv = float(m.x);\n");
}

TEST_CASE("comparisons of integers stay integers", "[frontend]") {
  CHECK(
      inKernel("int2 a = int2(n), b = a + 1; v = any(lessThan(a, b)) ? 1 : 0;").find("any(lessThan(a, b))") !=
      std::string::npos);
}

TEST_CASE("a member function takes a reference to an array of vectors", "[frontend]") {
  CHECK(inKernel("struct S { float k; float f(float2 (&q)[1]) const { return k * q[0].x; } };"
                 "float2 q[1] = {w.xy}; v = S{x}.f(q);")
            .find("f(") != std::string::npos);
}

TEST_CASE("gathers are indexed with x first", "[frontend]") {
  CHECK(inKernel("int2 p = indexof(v).xy; v = u[p.y][p.x] + u[p] + neighbor(u, 1, -1);") ==
        "int2 p = indexof(domain).xy;\nv = u[int2{p.x, p.y}] + u[p] + neighbor(u, int2{1, -1});\n");
}

TEST_CASE("a helper may repeat the boundary mode of a kernel's gather", "[frontend]") {
  CHECK(lowered("float f(float4 w, [[border(-1)]] float u[][]) { return w.x * neighbor(u, 1, 0); }\n"
                "kernel void k(float4 w, [[border(-1)]] float u[][], out float v<>) { v = f(w, u); }\n") ==
        "v = f(w, u);\n");
}

TEST_CASE("literals are rounded once", "[frontend]") {
  // 1 + 2^-24 + 2^-54: through double it would be a tie and round to 1
  CHECK(inKernel("v = 1.00000005960464483090177;") == "v = 1.0000001;\n");
  // 1 + 3 * 2^-11 is a tie of halves: a number just below it and one just above it, of which it is the nearest float
  CHECK(inKernel("half h = 1.001464843744; v = h;") == "half h = half(1.0009766);\nv = float(h);\n");
  CHECK(inKernel("half h = 1.000488281256; v = h;") == "half h = half(1.0009766);\nv = float(h);\n");
  CHECK(inKernel("v = 0.1 + x;") == "v = 0.1 + x;\n");
  CHECK(inKernel("v = 1;") == "v = 1.0;\n");
}

TEST_CASE("formulas of literals are double where they meet doubles", "[frontend]") {
  CHECK(inKernel("double d = 0.1; v = float(d);") == "double d = 0.1d;\nv = float(d);\n");
  CHECK(inKernel("double d = x; d *= -(1.0 / 3) + 0.1; v = x * 0.1;") ==
        "double d = double(x);\nd *= -(1.0d / 3.0d) + 0.1d;\nv = x * 0.1;\n");
  CHECK(inKernel("double d = max(double(x), 0.1) + double2(0.1, x).x; v = d > 0.1f ? 0.1 : 1;") ==
        "double d = max(double(x), 0.1d) + double2{0.1d, double(x)}.x;\nv = d > 0.10000000149011612d ? 0.1 : "
        "1.0;\n");
  CHECK(inKernel("v = x * 1'0.0 + 0x1.8p1 + .5;") == "v = x * 10.0 + 3.0 + 0.5;\n");
  CHECK(inKernel("double d = x > 0 ? 0.1 : -0.2; v = d;") ==
        "double d = x > 0.0 ? 0.1d : -0.2d;\nv = float(d);\n");
}

TEST_CASE("names that kernels have are not explained as foreign ones", "[frontend]") {
  for (const std::string_view name : {
#define SKC_FOREIGN_NAME(known, advice) known,
#define SKC_FOREIGN_WORD(known, ours) known,
#include "frontend/foreign_names.def"
       }) {
    INFO(name);
    CHECK(std::ranges::find(skc::ir::intrinsicRows(), name, &skc::ir::IntrinsicRow::spelling) ==
          skc::ir::intrinsicRows().end());
  }
}

TEST_CASE("dependencies are the main file and what it includes", "[frontend]") {
  const SourceFile included("float twice(float x) { return 2 * x; }\n");
  const SourceFile main("#include \"" + included.path() +
                        "\"\nkernel void k(float x<>, out float v<>) { v = twice(x); }\n");
  Frontend frontend({});
  REQUIRE(frontend.compile(main.path()));
  CHECK(frontend.dependencies() == std::vector<std::string>{main.path(), included.path()});
}

TEST_CASE("structs are called as typedefs and aliases call them", "[frontend]") {
  const SourceFile file(
      "typedef struct { float a; } A;\n"
      "typedef struct { int b; } B;\n"
      "typedef struct Pair_t { A a; B b; } Pair;\n"
      "using Both = Pair;\n"
      "struct Nested { struct { float x; } p; struct { float y; } q; };\n"
      "namespace other { using Pair = Pair_t; }\n"
      "kernel void f(Pair p<>, Nested n<>, out A a<>, out B b<>) { a = p.a; b = p.b; a.a += n.p.x + n.q.y; "
      "}\n");
  Frontend frontend({});
  const std::optional<skc::ir::Module> module = frontend.compile(file.path());
  REQUIRE(module);
  std::vector<std::string> names;
  for (const skc::ir::Struct& type : module->structs) {
    names.push_back(type.name);
    for (const std::string& alias : type.aliases) names.push_back(type.name + " is " + alias);
  }
  CHECK(names == std::vector<std::string>{"A", "B", "Pair_t", "Pair_t is Pair", "Pair_t is Both", "Anonymous",
                                          "Anonymous2", "Nested"});
}
