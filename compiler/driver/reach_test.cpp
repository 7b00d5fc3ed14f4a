// SPDX-License-Identifier: MIT
//
// Promises: the reach of a gather holds every index that its kernel reads, in each dimension and on each side, and is the
// nearest such range for the ways in which kernels are written; indices from data are computed, and those that do not
// depend on the element are whole.
#include <string>

#include <catch2/catch.hpp>

#include "driver/compile.hpp"
#include "ir/print.hpp"

namespace skc::driver {
namespace {

/// The reach of the first gather of the last declared kernel of a program.
std::string reachIn(const std::string& program) {
  const Translation translated = translateText({}, "reach.sk", program);
  INFO(translated.messages);
  REQUIRE(translated.module);
  std::string text;
  for (const ir::Kernel& kernel : translated.module->kernels) {
    if (kernel.isSynthesized || kernel.pass) continue;
    for (const ir::KernelParam& param : kernel.params) {
      if (param.role != ir::ParamRole::Gather) continue;
      text = printReach(kernel, param);
      if (param.reachShapes != 0) text += " if of the domain's shape";
      break;
    }
  }
  return text;
}

/// The reach of u in a kernel over one or two dimensions with this body.
std::string along(const std::string& body, const std::string& parameters = "") {
  return reachIn("kernel void f(" + parameters + "float u[], out float r<>) { int i = indexof(r).x; r = 0; " +
                 body + " }");
}
std::string across(const std::string& body, const std::string& parameters = "") {
  return reachIn("kernel void f(" + parameters +
                 "float u[][], out float r<>) { int2 p = indexof(r).xy; r = 0; " + body + " }");
}

TEST_CASE("constant offsets reach as far as they say, on each side alone") {
  CHECK(along("r = u[i];") == "x 0");
  CHECK(along("r = u[i - 1];") == "x -1 to 0");
  CHECK(along("r = u[i - 3] + u[i + 1];") == "x -3 to 1");
  CHECK(along("r = neighbor(u, 2);") == "x 0 to 2");
  CHECK(across("r = u[p + int2(0, 2)] + u[p.y - 1][p.x];") == "x 0, y -1 to 2");
  CHECK(across("int2 q = p; q.x += 3; q.y -= 2; r = u[q];") == "x 0 to 3, y -2 to 0");
  CHECK(across("r = extentof(u).x;") == "x 0, y 0");
  CHECK(reachIn("kernel void f([[wrap]] float u[][][], out float r<>) { int3 p = indexof(r).xyz;"
                " r = u[p - int3(1, 2, 3)] + neighbor(u, 1, 0, 0); }") == "x -1 to 1, y -2 to 0, z -3 to 0");
}

TEST_CASE("a boundary mode does not change the reach") {
  for (const std::string mode : {"[[clamp]]", "[[wrap]]", "[[mirror]]", "[[border(0)]]"}) {
    CHECK(reachIn("kernel void f(" + mode +
                  " float u[], out float r<>) { int i = indexof(r).x; r = u[i - 1] + u[i + 4]; }") ==
          "x -1 to 4");
  }
}

TEST_CASE("counted loops reach as far as their last round") {
  CHECK(along("for (int k = -2; k < 4; ++k) r += u[i + k];") == "x -2 to 3");
  CHECK(along("for (int k = 100; k >= -100; k -= 3) r += u[i + k];") == "x -98 to 100");
  CHECK(along("for (int k = 0; k < 200; ++k) r += u[i - 2 * k];") == "x -398 to 0");
  CHECK(across("for (int y = -70; y <= 70; ++y) for (int x = -80; x <= 80; ++x) r += u[p + int2(x, y)];") ==
        "x -80 to 80, y -70 to 70");
  CHECK(along("for (int j = i - 90; j <= i + 91; ++j) r += u[j];") == "x -90 to 91");
  CHECK(along("int j = i - 2; while (j < i + 50) { r += u[j]; j += 1; }") == "x -2 to 49");
  CHECK(along("int j = 0; do { r += u[i + j]; ++j; } while (j < 99);") == "x 0 to 98");
  CHECK(along("for (int k = 0;; ++k) { if (k > 77) break; if (k == 3) continue; r += u[i + k]; }") ==
        "x 0 to 77");
}

TEST_CASE("loops that Spec parameters bound reach as far as their values say") {
  CHECK(along("for (int k = -radius; k <= radius; ++k) r += u[i + k];", "spec int radius, ") ==
        "x -radius to radius");
  CHECK(along("for (int k = 0; k < 2 * n; ++k) r += u[i + k + 1] + u[i];", "spec int n, ") == "x 0 to 2 * n");
  CHECK(across("for (int k = -a; k < a; ++k) for (int m = 0; m <= b; ++m) r += u[p + int2(k + m, m)];",
               "spec int a, spec int b, ") == "x -a to a + b - 1, y 0 to b");
  CHECK(along("r = u[i - 2]; for (int k = -radius; k <= radius; ++k) r += u[i + k];", "spec int radius, ") ==
        "x -max(2, radius) to radius");
}

TEST_CASE("variables, branches and selections hold what flows into them") {
  CHECK(along("int k = 1; if (r < 1) k = 3; else k = -2; r = u[i + k];") == "x -2 to 3");
  CHECK(along("r = u[i + (r < 1 ? 2 : -5)];") == "x -5 to 2");
  CHECK(
      along(
          "int k; switch (i % 3) { case 0: k = -1; break; case 1: k = 4; default: k = 2; } r = u[i + k];") ==
      "x -1 to 2");
  CHECK(along("r = u[i + int(r > 0)];") == "x 0 to 1");
  CHECK(along("const int o[3] = {-1, 0, 7}; for (int k = 0; k < 3; ++k) r += u[i + o[k]];") == "x -1 to 7");
  CHECK(along("int o[2]; o[0] = 4; o[1] = -4; r = u[i + o[i % 2]];") == "x -4 to 4");
  CHECK(along("r = u[i + i % 4];") == "x 0 to 3");
  CHECK(along("r = u[i + (i & 7)];") == "x 0 to 7");
  CHECK(reachIn("struct S { int2 at; float w; }; kernel void f(float u[][], out float r<>) { S s; s.at = "
                "indexof(r).xy;"
                " s.at.y += 2; r = u[s.at]; }") == "x 0, y 0 to 2");
}

TEST_CASE("functions and kernels that are called reach as each call says") {
  CHECK(reachIn("int left(int i, int by) { return i - by; }\n"
                "kernel void f(float u[][], out float r<>) { int2 p = indexof(r).xy;"
                " r = u[left(p.y, 2)][left(p.x, 1)]; }") == "x -1 to 0, y -2 to 0");
  CHECK(reachIn("float at(float u[], int i, int d) { return u[i + d] + u[i - 2 * d]; }\n"
                "kernel void f(float u[], out float r<>) { r = at(u, indexof(r).x, 3); }") == "x -6 to 3");
  CHECK(
      reachIn(
          "void move(int& i) { i += 5; }\n"
          "kernel void f(float u[], out float r<>) { int i = indexof(r).x; move(i); move(i); r = u[i]; }") ==
      "x 0 to 10");
  CHECK(reachIn("kernel void one(float u[], out float r<>) { r = u[indexof(r).x + 1]; }\n"
                "kernel void f(float u[], out float r<>) { one(u, r); r += neighbor(u, -2); }") ==
        "x -2 to 1");
}

TEST_CASE("indices that are kept inside by hand reach no farther") {
  CHECK(along("r = u[max(i - 1, 0)];") == "x -1 to 0");
  CHECK(along("r = u[min(i + 1, extentof(r).x - 1)];") == "x 0 to 1");
  CHECK(along("r = u[min(i + 1, extentof(u).x - 1)];") == "x 0 to 1 if of the domain's shape");
  CHECK(along("r = u[clamp(i - 3, 0, extentof(r).x - 1)];") == "x -3 to 0");
  CHECK(along("r = u[i > 0 ? i - 1 : 0];") == "x -1 to 0");
  CHECK(along("int n = extentof(r).x; r = u[i + 1 < n ? i + 1 : n - 1];") == "x 0 to 1");
  CHECK(along("int j = int(r); if (j >= i - 2 && j <= i + 2) r = u[j];") == "x -2 to 2");
  CHECK(along("r = u[clamp(int(r), i - 1, i + 2)];") == "x -1 to 2");
}

TEST_CASE("indices from data, and multiples of the element's index, are computed") {
  CHECK(along("r = u[int(u[i])];") == "x computed");
  CHECK(reachIn("kernel void f(float u[], int at<>, out float r<>) { r = u[at]; }") == "x computed");
  CHECK(along("r = u[2 * i + 1];") == "x computed");
  CHECK(along("r = u[-i];") == "x computed");
  CHECK(along("r = u[extentof(u).x - 1 - i];") == "x computed");
  CHECK(along("r = u[i + shift];", "int shift, ") == "x computed");
  CHECK(along("r = u[i / 2];") == "x computed");
  CHECK(along("int j = i; while (u[j] > 0) ++j;") == "x computed");
  CHECK(along("for (int k = 0; k < n; ++k) r += u[i + k];", "int n, ") == "x computed");
  CHECK(across("r = u[p.x][p.y];") == "x computed, y computed");
  CHECK(across("r = u[p.y + 1][int(x)];", "float x<>, ") == "x computed, y 0 to 1");
  CHECK(reachIn(
            "kernel void f(float u[], out float r<>) { uint i = uint(indexof(r).x); r = u[int(i - 1u)]; }") ==
        "x computed");
  CHECK(across("r = sample(u, float2(p));") == "x computed, y computed");
  CHECK(reachIn("kernel void f(float u[], float x<>, out float r<>) { r = u[indexof(x).x + 1]; }") ==
        "x 0 to 1 if of the domain's shape");
}

TEST_CASE("a table is read whole") {
  CHECK(along("r = u[3];") == "x whole");
  CHECK(along("for (int k = 0; k < extentof(u).x; ++k) r += u[k];") == "x whole");
  CHECK(along("r = u[at];", "int at, ") == "x whole");
  CHECK(across("for (int k = 0; k < extentof(u).x; ++k) r += u[p.y][k];") == "x whole, y 0");
  CHECK(along("r = u[i] + u[0];") == "x whole");
}

TEST_CASE("reductions and outputs that are appended to reach as their elements do") {
  CHECK(reachIn(
            "reduce void f(float x<>, float u[], reduce float t<> = 0) { t += x * u[indexof(x).x + 1]; }") ==
        "x 0 to 1 if of the domain's shape");
  CHECK(reachIn(
            "kernel void f(float x<>, float u[], vout float r<>) { if (x > 0) push(r, neighbor(u, -3)); }") ==
        "x -3 to 0");
}

TEST_CASE("a promise counts where nothing is known") {
  const std::string head =
      "kernel void f([[halo(2, 3)]] float u[][], out float r<>) { int2 p = indexof(r).xy; ";
  CHECK(reachIn(head + "r = u[int(u[p])][p.x + 1]; }") == "x 0 to 1, y -3 to 3, as promised");
  CHECK(reachIn(head + "r = sample(u, float2(p)); }") == "x -2 to 2, y -3 to 3, as promised");
  CHECK(reachIn("kernel void f([[halo(1)]] float u[][][], out float r<>) { r = 0;"
                " for (int k = 0; k < 3; ++k) r += u[k][2 * indexof(r).y][indexof(r).x]; }") ==
        "x 0, y -1 to 1, z whole, as promised");
  CHECK(reachIn("kernel void f([[wrap, halo(1)]] float u[], out float r<>) { int n = extentof(r).x;"
                " r = u[(indexof(r).x + n - 1) % n]; }") == "x -1 to 1, as promised");
}

TEST_CASE("nested loops and calls are analysed in little time") {
  std::string program = "int f0(int i) { return i; }\n";
  for (int k = 1; k < 13; ++k) {
    const std::string last = "f" + std::to_string(k - 1);
    program +=
        "int f" + std::to_string(k) + "(int i) { return max(" + last + "(i), " + last + "(i) - 1); }\n";
  }
  program +=
      "kernel void f(float u[], out float r<>) { int i = indexof(r).x; r = 0; "
      "for (int a = 0; a < 99; ++a) for (int b = 0; b < 99; ++b) for (int c = 0; c < 99; ++c) "
      "for (int d = 0; d < 99; ++d) r += u[f12(i) + a - b + c - d]; }";
  CHECK(reachIn(program) == "x -196 to 196");
}

}  // namespace
}  // namespace skc::driver
