// SPDX-License-Identifier: MIT
#include "judge.hpp"

#include <algorithm>
#include <exception>
#include <string>
#include <vector>

#include "driver/big_stack.hpp"
#include "driver/compile.hpp"
#include "glsl.hpp"

namespace fuzz {
namespace {

using skc::driver::Emit;

struct OutputKind {
  Emit emit;
  const char* profile;
  const char* name;
};
constexpr OutputKind outputKinds[] = {
    {Emit::Glsl, "glsl330", "glsl for glsl330"}, {Emit::Glsl, "essl300", "glsl for essl300"},
    {Emit::Stubs, "glsl330", "stubs"},           {Emit::Plan, "glsl330", "plan for glsl330"},
    {Emit::Plan, "essl300", "plan for essl300"}, {Emit::Ir, "glsl330", "ir"}};

bool contains(const std::string& text, const char* part) { return text.find(part) != std::string::npos; }

/// A module without kernels has no GLSL and no plan.
/// True if nothing is ever stored in the kernel's outputs.
bool storesNothing(const skc::ir::Kernel& kernel) {
  return std::ranges::all_of(kernel.params, [](const skc::ir::KernelParam& param) {
    using Role = skc::ir::ParamRole;
    if (param.role == Role::VariableOutput || param.role == Role::Scatter) return param.pushes == 0;
    return param.role != Role::Output && param.role != Role::Accumulator;
  });
}

bool mayBeEmpty(Emit emit, const skc::ir::Module& module) {
  return (emit == Emit::Glsl || emit == Emit::Plan) && std::ranges::all_of(module.kernels, storesNothing);
}

/// What is wrong with skc's messages, or "".
std::string mistakeIn(const std::string& messages, bool isAccepted) {
  if (contains(messages, "internal error")) return "speaks of an internal error: " + messages;
  if (isAccepted && contains(messages, "error:")) return "accepted, with an error: " + messages;
  if (!isAccepted && !contains(messages, "error:")) return "refused without an error: " + messages;
  return {};
}

Verdict compile(const Program& program, bool withGlslang) {
  skc::driver::Options options;
  options.emit = Emit::Ast;   // runs only the frontend, which prints the tree even of programs with errors
  const skc::driver::Outcome parsed = skc::driver::compileText(options, program.path, program.text);
  if (parsed.status != 0) return {mistakeIn(parsed.messages, false), "refused"};
  options.emit = Emit::Glsl;
  const auto [module, messages] = skc::driver::translateText(options, program.path, program.text);
  const char* const tally = module ? "accepted" : "refused";
  if (const std::string mistake = mistakeIn(messages, module.has_value()); !mistake.empty() || !module) {
    return {mistake, tally, contains(messages, "here Clang crashed")};
  }
  std::vector<std::string> listings;
  for (const OutputKind& kind : outputKinds) {
    options.emit = kind.emit;
    options.profile = kind.profile;
    const std::string text = emitText(options, *module);
    if (text.empty() && !mayBeEmpty(kind.emit, *module)) {
      return {std::string("accepted, but emits no ") + kind.name, tally};
    }
    if (kind.emit == Emit::Glsl) listings.push_back(text);
  }
  return {withGlslang ? glslComplaint(listings) : "", tally};
}

}  // namespace

Verdict judge(const Program& program, bool withGlslang) {
  Verdict verdict;
  skc::driver::withBigStack([&] {
    try {
      verdict = compile(program, withGlslang);
    } catch (const std::exception& error) {
      verdict = {std::string("throws ") + error.what(), "refused"};
    }
    return 0;
  });
  return verdict;
}

}  // namespace fuzz
