// SPDX-License-Identifier: MIT
//
// Promises: callables keep the kernel's name where C++ allows it, and overloads share one object.
#include "program/cpp_names.hpp"

#include <set>

#include <catch2/catch.hpp>

#include "ir/kernel_builder.hpp"
#include "program/constants.hpp"

namespace skc::emit {
namespace {

using namespace ir;

TEST_CASE("names of the C library are known, with their float and long forms") {
  for (const char* name :
       {"abs", "exp", "expf", "powl", "index", "y0", "yn", "write", "acos", "trunc", "bsearch"}) {
    INFO(name);
    CHECK(isGlobalCName(name));
  }
  CHECK_FALSE(isGlobalCName("diffuse"));
  CHECK_FALSE(isGlobalCName("f"));
}

void addKernel(Module& module, std::string name, Type type, std::vector<std::string> scope = {}) {
  KernelBuilder k(module, std::move(name));
  k.kernel().scope = std::move(scope);
  k.output("r", type);
  k.finish({});
}

TEST_CASE("file names become names of types") {
  CHECK(pascalCase("gray_scott") == "GrayScott");
  CHECK(pascalCase("my-file.v2") == "MyFileV2");
  CHECK(pascalCase("\xc3\x80_la") == "\xc3\x80La");   // a capital A with grave
  CHECK(pascalCase("2d heat") == "K2dHeat");
  CHECK(pascalCase("") == "K");
}

TEST_CASE("objects and their types") {
  Module module = testModule();
  module.structs.push_back({"GrayScottKernel", {}, {{"a", floatType}}, {}});
  addKernel(module, "gray_scott", floatType);
  addKernel(module, "exp", floatType);
  addKernel(module, "exp", Type::structType(0), {"my"});
  addKernel(module, "gray_scott", intType);
  const std::vector<Callable> list = callables(module);
  REQUIRE(list.size() == 3);
  CHECK(list[0].object == "gray_scott");
  CHECK(list[0].type == "GrayScottKernel_");
  CHECK(list[0].units == std::vector<std::size_t>{0, 3});
  CHECK(list[1].object == "exp_");
  CHECK(list[2].object == "exp");
  CHECK(constantNames(module, Program(module)) ==
        std::vector<std::string>{"grayScott", "exp", "exp_2", "grayScott_2"});
}

TEST_CASE("objects keep their names, and types give way") {
  Module module = testModule();
  addKernel(module, "blur", floatType);
  addKernel(module, "BlurKernel", floatType);
  addKernel(module, "linux", floatType, {"my"});
  addKernel(module, "read", floatType, {"my"});
  addKernel(module, "scale", floatType, {"my", "BlurKernel"});
  addKernel(module, "blur", floatType, {"my"});
  const std::vector<Callable> list = callables(module);
  REQUIRE(list.size() == 6);
  CHECK(list[0].object == "blur");
  CHECK(list[0].type == "BlurKernel_2");
  CHECK(list[1].object == "BlurKernel");
  CHECK(list[2].object == "linux_");  // a macro of GNU C++ in every namespace
  CHECK(list[3].object == "read");
  CHECK(list[5].type == "BlurKernel_");  // a namespace
}

TEST_CASE("no two constants have one name, whatever kernels are called") {
  std::vector<std::string> words = {""};
  for (const std::string_view word : partWords()) words.emplace_back(word);
  Module module = testModule();
  for (const std::string& first : words) {
    for (const std::string& second : words) addKernel(module, "scale" + first + second, floatType);
  }
  std::set<std::string> names;
  bool isUnique = true;
  const auto add = [&](const std::string& name) { isUnique = names.insert(name).second && isUnique; };
  for (const std::string& unit : constantNames(module, Program(module))) {
    for (const std::string_view word : partWords()) add(unit + std::string(word));
    if (unit != "scale") continue;
    for (const std::string_view first : partWords()) {
      for (const std::string_view second : partWords()) {
        const std::string both = (unit + std::string(first)).append(second);
        add(both);
        for (const std::string_view third : partWords()) add(both + std::string(third));
      }
    }
  }
  CHECK(isUnique);
}

TEST_CASE("types as C++ writes them") {
  Module module = testModule();
  module.structs.push_back({"Hit", {"geometry", "rays"}, {{"t", floatType}}, {}});
  CHECK(cppType(module, floatType) == "float");
  CHECK(cppType(module, Type::of(Scalar::Uint)) == "unsigned");
  CHECK(cppType(module, Type::of(Scalar::Uint, 3)) == "sk::uint3");
  CHECK(cppType(module, Type::structType(0)) == "geometry::rays::Hit");
}

}  // namespace
}  // namespace skc::emit
