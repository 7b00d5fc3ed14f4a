// SPDX-License-Identifier: MIT
//
// Promise: the time that a file takes grows hardly faster than the file, whatever there is much of in it.
#include <algorithm>
#include <array>
#include <functional>
#include <string>
#include <tuple>
#include <utility>

#include <time.h>

#include <fmt/format.h>
#include <catch2/catch.hpp>

#include "driver/big_stack.hpp"
#include "driver/compile.hpp"

using skc::driver::compileText;
using skc::driver::Emit;
using skc::driver::Options;
using skc::driver::withBigStack;

namespace {

using Program = std::function<std::string(int)>;

/// The seconds that this process has computed, whatever else the machine does.
double seconds() {
  timespec now = {};
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

/// The least time of several runs, if they are short.
double timeOf(const Options& options, const std::string& program, int status) {
  double least = 0;
  for (int run = 0; run < 3; ++run) {
    const double start = seconds();
    REQUIRE(withBigStack([&] { return compileText(options, "many.sk", program).status; }) == status);
    const double took = seconds() - start;
    least = run == 0 ? took : std::min(least, took);
    constexpr double shortRun = 0.1;
    if (took > shortRun) break;
  }
  return least;
}

/// A program with 8 times as many of something may take 2.5 times 8 times as long: n log n stays below that, n^1.5 does not.
void checkGrowth(const Program& program, std::array<int, 3> sizes, const Options& options, int status = 0) {
  constexpr double most = 2.5, slack = 0.5;  // long runs are timed once, on machines that have more to do
  std::array<double, 3> times = {};
  for (std::size_t i = 0; i < sizes.size(); ++i) times[i] = timeOf(options, program(sizes[i]), status);
  const double larger = static_cast<double>(sizes[2] - sizes[0]) / (sizes[1] - sizes[0]);
  INFO(fmt::format("{}, {} and {} take {:.3f}, {:.3f} and {:.3f} s", sizes[0], sizes[1], sizes[2], times[0],
                   times[1], times[2]));
  CHECK(times[2] - times[0] <= most * larger * (times[1] - times[0]) + slack);
}

Options emitting(Emit emit) {
  Options options;
  options.emit = emit;
  options.nativeTarget = false;  // LLVM's own time is not ours
  return options;
}

std::string repeated(int count, const std::function<std::string(int)>& text) {
  std::string all;
  for (int i = 0; i < count; ++i) all += text(i);
  return all;
}

std::string kernels(int count) {
  return repeated(count, [](int i) {
    return fmt::format("kernel void k{0}(float x<>, out float r<>) {{ r = x * {0}.5f + {1}; }}\n", i, i % 7);
  });
}

std::string namespaces(int count) {
  return repeated(count, [](int i) {
    return fmt::format("namespace n{0} {{ kernel void k(float x<>, out float r<>) {{ r = x + {0}; }} }}\n",
                       i);
  });
}

std::string structs(int count) {
  return repeated(count, [](int i) {
    return fmt::format(
        "struct S{0} {{ float a; int b; }};\nkernel void k{0}(S{0} x<>, out S{0} r<>) {{ r = x; r.a += 1; "
        "}}\n",
        i);
  });
}

std::string nestedStructs(int count) {
  return "struct S0 { float a; };\n" +
         repeated(count, [](int i) { return fmt::format("struct S{} {{ S{} s; }};\n", i + 1, i); }) +
         fmt::format("kernel void k(S{0} x<>, out S{0} r<>) {{ r = x; }}\n", count);
}

std::string constants(int count) {
  return repeated(count, [](int i) {
    return fmt::format(
        "const float c{0} = {0}.5f;\nkernel void k{0}(float x<>, out float r<>) {{ r = x + c{0}; }}\n", i);
  });
}

std::string instances(int count) {
  return "template <int N> float f(float x) { return f<N - 1>(x) + 1; }\n"
         "template <> float f<0>(float x) { return x; }\n" +
         fmt::format("kernel void k(float x<>, out float r<>) {{ r = f<{}>(x); }}\n", count);
}

std::string calls(int count) {
  return "float f0(float x) { return x; }\n" +
         repeated(count,
                  [](int i) {
                    return fmt::format("float f{}(float x) {{ return f{}(x) * 1.5f + {}; }}\n", i + 1, i, i);
                  }) +
         fmt::format("kernel void k(float x<>, out float r<>) {{ r = f{}(x); }}\n", count);
}

/// A kernel with `count` statements.
std::string body(int count, const std::function<std::string(int)>& statement) {
  return "kernel void k(float x<>, int m, float g[], out float r<>) {\n  float a = x;\n" +
         repeated(count, statement) + "  r = a;\n}\n";
}

std::string ifs(int count) {
  return body(count,
              [](int i) { return fmt::format("  if (a > {0}) a *= 1.5f; else a += g[m + {0}];\n", i); });
}

std::string loops(int count) {
  return body(count,
              [](int i) { return fmt::format("  for (int i = 0; i < m; ++i) a = a * 1.5f + {};\n", i); });
}

std::string variables(int count) {
  return body(count, [](int i) { return fmt::format("  {{ float b = a * {}; a += b; }}\n", i); });
}

std::string nestedLoops(int count) {
  return "kernel void k(float x<>, float g[], out float r<>) {\n  float a = x;\n  int m = int(x);\n" +
         repeated(count,
                  [](int i) {
                    return fmt::format("for (int i{0} = 0; i{0} < m; ++i{0}) {{ if (a > {0}) break;\n", i);
                  }) +
         "a = a * 1.5f + g[m];" + std::string(static_cast<std::size_t>(count), '}') + "  r = a;\n}\n";
}

std::string outputs(int count) {
  return "kernel void k(float x<>" +
         repeated(count, [](int i) { return fmt::format(", out float r{}<>", i); }) +
         ") {\n  float a = x;\n" +
         repeated(count, [](int i) { return fmt::format("  a = a * 1.5f + x; r{} = a;\n", i); }) + "}\n";
}

/// Statements outside functions, each an error.
std::string mistakes(int count) {
  return "kernel void k(float x<>, out float r<>) { r = x; }\n" +
         repeated(count, [](int) { return "r = x;\n"; });
}

std::string reduces(int count) {
  return repeated(count, [](int i) {
    return fmt::format("reduce void k{0}(float x<>, reduce float t<>) {{ t += x * {0}.5f; }}\n", i);
  });
}

std::string accumulators(int count) {
  return "reduce void k(float x<>" +
         repeated(count, [](int i) { return fmt::format(", reduce float r{}<>", i); }) + ") {\n" +
         repeated(count, [](int i) { return fmt::format("  r{0} += x * {0};\n", i); }) + "}\n";
}

}  // namespace

TEST_CASE("time grows hardly faster than the number of declarations") {
  const std::pair<const char*, Program> programs[] = {{"kernels", kernels},     {"namespaces", namespaces},
                                                      {"structs", structs},     {"constants", constants},
                                                      {"instances", instances}, {"calls", calls}};
  for (const auto& [name, program] : programs) {
    INFO(name);
    checkGrowth(program, {10, 80, 640}, emitting(Emit::Stubs));
  }
  for (const auto& [name, program] : {programs[1], programs[2], programs[5]}) {
    INFO(name << ", for browsers");
    checkGrowth(program, {10, 80, 640}, emitting(Emit::Js));
  }
  checkGrowth(nestedStructs, {10, 80, 640}, emitting(Emit::Json));
}

TEST_CASE("time grows hardly faster than the number of statements") {
  const std::pair<const char*, Program> programs[] = {
      {"ifs", ifs}, {"loops", loops}, {"variables", variables}};
  for (const auto& [name, program] : programs) {
    INFO(name);
    checkGrowth(program, {10, 80, 640}, emitting(Emit::Json));
  }
}

TEST_CASE("time grows hardly faster than the number of mistakes") {
  checkGrowth(mistakes, {400, 3200, 25600}, emitting(Emit::Stubs), 1);
}

TEST_CASE("time grows hardly faster than what a kernel may have few of") {
  const std::tuple<const char*, Program, std::array<int, 3>> programs[] = {
      {"loops in one another", nestedLoops, {2, 20, 120}},
      {"outputs", outputs, {8, 32, 128}},
      {"reduces", reduces, {2, 8, 32}},
      {"accumulators", accumulators, {4, 16, 48}}};
  for (const auto& [name, program, sizes] : programs) {
    INFO(name);
    checkGrowth(program, sizes, emitting(Emit::Json));
  }
}
