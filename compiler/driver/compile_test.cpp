// SPDX-License-Identifier: MIT
//
// Promise: compiling in memory gives the same output as compiling files, any number of times.
#include "driver/compile.hpp"

#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>

#include <unistd.h>

#include <catch2/catch.hpp>

using skc::driver::compile;
using skc::driver::compileText;
using skc::driver::Emit;
using skc::driver::Options;
using skc::driver::Outcome;

namespace {

constexpr const char* program = "kernel void twice(float x<>, out float r<>) { r = 2 * x; }\n";

bool contains(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

}  // namespace

TEST_CASE("a text compiles without a file") {
  Options options;
  const Outcome stubs = compileText(options, "nowhere/twice.sk", program);
  CHECK(stubs.status == 0);
  CHECK(contains(stubs.output, "#include \"twice.sk.hpp\""));
  CHECK(stubs.messages.empty());
  options.emit = Emit::Glsl;
  CHECK(contains(compileText(options, "twice.sk", program).output, "#version 330 core"));
  options.emit = Emit::Ast;
  CHECK(contains(compileText(options, "twice.sk", program).output, "FunctionDecl"));
  for (const Emit native : {Emit::Llvm, Emit::Assembly}) {
    options.emit = native;
    CHECK(contains(compileText(options, "twice.sk", program).output, "_twice"));
  }
}

TEST_CASE("kernels whose structs WebGL refuses are not offered in browsers") {
  Options options;
  options.emit = Emit::Js;
  const auto moduleOf = [&](const std::string& body) {
    return compileText(options, "deep.sk",
                       "struct A { float x; };\nstruct B { A a[2]; };\nstruct C { B b; };\n"
                       "struct D { C c; };\nstruct E { D d; };\nstruct F { C c; double3 y; };\n"
                       "struct G { F f; };\n" +
                           body)
        .output;
  };
  const auto with = [&](const std::string& type, const std::string& member) {
    return moduleOf("kernel void deep(float x<>, out float r<>) { " + type + " t; t." + member +
                    " = x; r = t." + member + "; }\n");
  };
  CHECK_FALSE(contains(with("D", "c.b.a[0].x"), "levels deep"));
  CHECK(contains(with("E", "d.c.b.a[0].x"), "its structs are nested 5 levels deep, but WebGL takes 4"));
  CHECK_FALSE(contains(with("F", "c.b.a[0].x"), "levels deep"));
  CHECK(contains(with("G", "f.c.b.a[0].x"), "its structs are nested 5 levels deep"));
  // what is offered in floats may not be in pairs of floats, each of which is a struct
  const std::string inPairs = moduleOf(
      "[[variants(extended)]] kernel void deep(float x<>, out float r<>) { D t; t.c.b.a[1].x = x; r = "
      "t.c.b.a[1].x * x; }\n"
      "reduce void deepest(float x<>, reduce float r<>) { D t; t.c.b.a[1].x = x; r += t.c.b.a[1].x; }\n");
  CHECK(contains(inPairs, R"("extended":{"whyNot":"its structs are nested 5 levels deep)"));
  CHECK(contains(inPairs, R"("extended":"its structs are nested 5 levels deep)"));
  CHECK_FALSE(contains(inPairs, R"("name":"deep","whyNot")"));
}

TEST_CASE("products and sums are fused in entries of their own alone, and never in the library") {
  Options options;
  options.emit = Emit::Llvm;
  options.native.triple = "x86_64-linux-gnu";
  const auto codeOf = [&](const std::string& body) {
    return compileText(options, "f.sk", "kernel void f(float x<>, out float r<>) { " + body + " }\n").output;
  };
  const std::string fused = codeOf("r = x * x - 2;");
  CHECK(contains(fused, ".run.v3.contracted"));
  CHECK(contains(fused, ".run.v4.contracted"));
  CHECK(contains(fused, "fmul contract"));
  CHECK_FALSE(contains(fused, ".run.contracted"));  // plain x86-64 has no fused multiply-add
  CHECK_FALSE(contains(codeOf("r = x * 3;"), "contract"));
  CHECK_FALSE(contains(codeOf("r = sin(x);"), "contract"));
  CHECK_FALSE(contains(codeOf("r = length(float2(x, 2)) - 1;"), "contract"));
  const std::string sine = codeOf("r = 3 * sin(x) + 1;");  // the library computes it in double
  CHECK(contains(sine, "fmul contract <8 x float>"));
  CHECK_FALSE(contains(sine, "contract <8 x double>"));
  options.emit = Emit::Assembly;
  options.native.levels = {"x86-64"};
  CHECK_FALSE(contains(codeOf("r = x * x - 2;"), "vfm"));
  options.native.levels = {"x86-64-v3"};
  const std::string assembly = codeOf("r = x * x - 2;");
  const std::size_t contracted = assembly.find(".run.v3.contracted:");
  REQUIRE(contracted != std::string::npos);
  CHECK(assembly.substr(0, contracted).find("vfm") == std::string::npos);
  CHECK(assembly.find("vfm", contracted) != std::string::npos);
}

TEST_CASE("files are written for the targets that are asked for") {
  namespace fs = std::filesystem;
  const fs::path folder = fs::temp_directory_path() / ("skc_compile_test." + std::to_string(::getpid()));
  fs::create_directories(folder);
  std::ofstream(folder / "twice.sk") << program;
  Options options;
  options.outputDirectory = (folder / "all").string();
  options.depfile = (folder / "twice.d").string();
  CHECK(compile(options, (folder / "twice.sk").string()) == 0);
  options.outputDirectory = (folder / "drawn").string();
  options.depfile.clear();
  options.nativeTarget = false;
  CHECK(compile(options, (folder / "twice.sk").string()) == 0);
  for (const char* extension : {".hpp", ".cpp", ".o"}) {
    const std::string name = std::string("twice.sk") + extension;
    CHECK(fs::exists(folder / "all" / name));
    CHECK(fs::exists(folder / "drawn" / name) == (extension != std::string(".o")));
    std::ifstream rule(folder / "twice.d");
    CHECK(contains(std::string(std::istreambuf_iterator<char>(rule), {}), "all/" + name));
  }
  fs::remove_all(folder);
}

TEST_CASE("mistakes come back as messages, with the name that was given") {
  const Outcome clangs = compileText({}, "wrong.sk", "kernel void f(out float r<>) { r = y; }\n");
  CHECK(clangs.status == 1);
  CHECK(contains(clangs.messages, "wrong.sk:1:36: error: use of undeclared identifier 'y'"));
  CHECK(clangs.output.empty());
  const Outcome ours = compileText({}, "wrong.sk", std::string("kernel\0", 7));
  CHECK(ours.status == 1);
  CHECK(contains(ours.messages, "'wrong.sk' is not a text file"));
  Options options;
  options.kernel = "thrice";
  const Outcome unknown = compileText(options, "x.sk", program);
  CHECK(unknown.status == 1);
  CHECK(contains(unknown.messages, "'x.sk' has no kernel 'thrice'; it has twice"));
  Options ranges;
  ranges.emit = Emit::Bounds;
  ranges.bounds.ranges.push_back({"y.z", 0, 1});
  CHECK(contains(compileText(ranges, "x.sk", program).messages, "'x.sk' has no parameter 'y.z'; it has "));
}

TEST_CASE("names that C++ or JavaScript cannot have are reported") {
  const auto messages = [](Emit emit, const std::string& text) {
    Options options;
    options.emit = emit;
    options.nativeTarget = false;
    return compileText(options, "x.sk", text).messages;
  };
  const std::string body = "(float x<>, out float r<>) { r = x; }\n";
  CHECK(contains(messages(Emit::Stubs, "kernel void index" + body),
                 "x.sk:1:13: warning: 'index' is declared by headers of C++, so C++ programs call this "
                 "kernel 'index_'; in a "
                 "namespace it would keep its name"));
  CHECK(messages(Emit::Stubs, "namespace a { kernel void index" + body + "}").empty());
  CHECK(messages(Emit::Js, "kernel void index" + body).empty());
  CHECK(contains(messages(Emit::Stubs, "namespace a { kernel void linux" + body + "}"),
                 "'linux' is a macro, so C++ programs call this kernel 'linux_'; another name would stay"));
  const std::string structs =
      "struct tm { float unix; };\nkernel void f(tm x<>, out tm r<>) { r = x; }\nkernel void tm" + body;
  CHECK(contains(messages(Emit::Stubs, structs),
                 "x.sk:1:8: warning: 'tm' is declared by headers of C++, so C++ programs "
                 "call this struct 'tm_'"));
  CHECK(contains(messages(Emit::Stubs, structs),
                 "x.sk:1:8: warning: 'unix' is a macro in C++, so programs cannot write "
                 "the name of this member"));
  CHECK(contains(messages(Emit::Stubs,
                          "template <class T> struct P { T a; };\nusing A = P<int>;\nusing B = P<float>;\n"
                          "kernel void f(A a<>, out B r<>) { r.a = float(a.a); }\n"),
                 "warning: 'P' is a type's name, too, so C++ programs call this struct 'P_2'"));
  CHECK(contains(messages(Emit::Js, "kernel void function" + body),
                 "x.sk:1:13: warning: 'function' is a word of JavaScript or TypeScript, so JavaScript "
                 "programs call this "
                 "kernel 'function_'"));
  CHECK(messages(Emit::Js, "namespace a { kernel void function" + body + "}").empty());
  CHECK(contains(
      messages(Emit::Js, "namespace a { namespace b { kernel void f" + body + "} }\nkernel void a_b" + body),
      "warning: 'a_b' is another export's name, so JavaScript programs call this namespace 'a_b_2'"));
}

TEST_CASE("one compilation leaves nothing for the next") {
  Options options;
  options.emit = Emit::Glsl;
  const std::string first = compileText(options, "twice.sk", program).output;
  CHECK(compileText(options, "twice.sk", "kernel void twice(").status == 1);
  CHECK(compileText(options, "twice.sk", program).output == first);
}
