// SPDX-License-Identifier: MIT
#include "cpp/oracle.hpp"

#include <cstdint>
#include <cstdlib>
#include <fstream>
#include <regex>
#include <sstream>
#include <stdexcept>

#include <dlfcn.h>
#include <sys/wait.h>

#include "temporary_folder.hpp"

namespace fuzz::cpp {
namespace {

/// Overflow wraps, as in .sk. Everything else that C++ leaves undefined ends the process: the generator must not make it.
constexpr const char* compilerCommand =
    "clang++-19 -x c++ -std=c++20 -w -O0 -fPIC -shared -nostdlib -fwrapv -fno-strict-aliasing "
    "-ffp-contract=off "
    "-fsanitize=undefined -fno-sanitize=signed-integer-overflow,function,vptr,alignment,null,object-size "
    "-fsanitize-trap=all -ftrivial-auto-var-init=pattern -include " SK_AS_CPP;

std::string firstError(const std::string& file) {
  std::ifstream in(file);
  for (std::string line; std::getline(in, line);) {
    const std::size_t at = line.find("error: ");
    if (at == std::string::npos) continue;
    std::string source;
    std::getline(in, source);
    return line.substr(at) + "\n" + source;
  }
  return "no message";
}

/// Parameters of kernels, gathers and references as C++ declares them. Names stay.
std::string withDeclarationsOfCpp(const std::string& text) {
  const std::string type = "[A-Za-z_][\\w:]*(?:<[^<>()]*>)?";
  const std::string name = " (\\w+)", declaration = "(" + type + ")" + name;
  static const std::pair<std::regex, const char*> edits[] = {
      {std::regex("\\bkernel void "), "void "},
      {std::regex("\\bspec (?=\\w)"), ""},
      {std::regex("\\bout " + declaration + "<>"), "$1& $2"},
      {std::regex(declaration + "<>"), "const $1 $2"},
      {std::regex(declaration + "\\[\\]\\[\\]\\[\\]\\[\\]"), "gather<$1, 4> $2"},
      {std::regex(declaration + "\\[\\]\\[\\]\\[\\]"), "gather<$1, 3> $2"},
      {std::regex(declaration + "\\[\\]\\[\\]"), "gather<$1, 2> $2"},
      {std::regex(declaration + "\\[\\]"), "gather<$1, 1> $2"},
      {std::regex("\\b(?:in)?out " + declaration + "((?:\\[\\w+\\])+)"), "$1 (&$2)$3"},
      {std::regex("\\b(?:in)?out " + declaration), "$1& $2"},
      {std::regex("\\bindex<([^<>]*)>\\("), "make_index<$1>("},
      // `int2 (&w)[3]` is no call of the macro int2.
      {std::regex("\\b((?:u?char|u?short|u?int|u?long|float|double)[234]) \\(&"), "$1_t (&"},
  };
  std::string result = text;
  for (const auto& [pattern, replacement] : edits) result = std::regex_replace(result, pattern, replacement);
  return result;
}

/// The program as C++. Kernels can be called from outside: those with parameters of their own have a function for it in the text.
std::string asCpp(const std::string& text, std::vector<std::string>& kernels) {
  constexpr std::string_view begin = "kernel void ", beginOfRun = "void run_";
  std::string callable;
  for (std::size_t at = 0; (at = text.find(begin, at)) != std::string::npos; ++at) {
    const std::size_t name = at + begin.size(), parameters = text.find('(', name);
    if (text.compare(parameters, kernelParameters.size(), kernelParameters) != 0) continue;
    kernels.push_back(text.substr(name, parameters - name));
    if (text.find(std::string(beginOfRun) + kernels.back() + "_rank") != std::string::npos)
      kernels.pop_back();
    else
      callable += "SK_KERNEL(" + kernels.back() + ")\n";
  }
  for (std::size_t at = 0; (at = text.find(beginOfRun, at)) != std::string::npos; ++at) {
    const std::size_t name = at + beginOfRun.size();
    kernels.push_back(text.substr(name, text.find('(', name) - name));
  }
  return withDeclarationsOfCpp(text) + callable;
}

}  // namespace

Oracle::Oracle(const std::string& text, const std::string& object, const std::vector<std::string>& symbols) {
  const TemporaryFolder folder;
  const auto named = [&](const char* name) { return (folder.path() / name).string(); };
  std::string table = "extern \"C\" {\n";
  for (const std::string& symbol : symbols) table += "extern const char " + symbol + "[];\n";
  table += "extern const char* const codes[];\nconst char* const codes[] = {";
  for (const std::string& symbol : symbols) table += symbol + ", ";
  std::ofstream(named("program.cpp")) << asCpp(text, kernels_) << table << "nullptr};\n}\n";
  std::string command =
      std::string(compilerCommand) + " -o '" + named("program.so") + "' '" + named("program.cpp") + "'";
  if (!object.empty()) {
    std::ofstream(named("native.o"), std::ios::binary) << object;
    command += " -x none '" + named("native.o") + "'";
  }
  command += " 2>'" + named("messages") + "'";
  const int status = std::system(command.c_str());
  if (WIFEXITED(status) && WEXITSTATUS(status) == 127)
    throw std::runtime_error("there is no clang++-19 to compare with: apt-get install clang-19");
  if (status != 0) throw std::runtime_error("Clang: " + firstError(named("messages")));
  library_ = dlopen(named("program.so").c_str(), RTLD_NOW | RTLD_LOCAL);
  if (library_ == nullptr)
    throw std::runtime_error(std::string("the program cannot be loaded: ") + dlerror());
  codes_ = static_cast<const sk::native::Code* const*>(dlsym(library_, "codes"));
}

std::vector<Outputs> Oracle::run() const {
  using Run =
      void(const std::int32_t*, const std::uint32_t*, const float*, std::int32_t*, std::uint32_t*, float*);
  std::vector<Outputs> all;
  for (const std::string& kernel : kernels_) {
    Outputs& outputs = all.emplace_back(Outputs{.kernel = kernel});
    auto* const run = reinterpret_cast<Run*>(dlsym(library_, ("run_" + kernel).c_str()));
    if (run == nullptr) throw std::runtime_error("there is no kernel " + kernel);
    run(inputs().a.data(), inputs().b.data(), inputs().c.data(), outputs.r0.data(), outputs.r1.data(),
        outputs.r2.data());
  }
  return all;
}

}  // namespace fuzz::cpp
