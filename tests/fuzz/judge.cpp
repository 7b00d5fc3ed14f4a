// SPDX-License-Identifier: MIT
#include "judge.hpp"

#include <exception>
#include <string>
#include <vector>

#include "driver/big_stack.hpp"
#include "driver/compile.hpp"
#include "shaders.hpp"

namespace fuzz {
namespace {

using skc::driver::Emit;

struct Form {
  Emit emit;
  const char* profile;
  const char* name;
};
constexpr Form forms[] = {
    {Emit::Glsl, "glsl330", "glsl for glsl330"}, {Emit::Glsl, "essl300", "glsl for essl300"},
    {Emit::Stubs, "glsl330", "stubs"},           {Emit::Plan, "glsl330", "plan for glsl330"},
    {Emit::Plan, "essl300", "plan for essl300"}, {Emit::Ir, "glsl330", "ir"}};

bool contains(const std::string& text, const char* part) { return text.find(part) != std::string::npos; }

Verdict compile(const Program& program, bool withGlslang) {
  skc::driver::Options options;
  const auto [module, messages] = skc::driver::translateText(options, program.path, program.text);
  if (contains(messages, "internal error")) return {"speaks of an internal error: " + messages, "refused"};
  if (!module) {
    if (!contains(messages, "error:")) return {"refused without an error: " + messages, "refused"};
    options.emit = Emit::Ast;   // which prints the tree of programs with mistakes, too
    const int status = skc::driver::compileText(options, program.path, program.text).status;
    if (status != 0 && status != 1) return {"--emit=ast has status " + std::to_string(status), "refused"};
    return {"", "refused"};
  }
  if (contains(messages, "error:")) return {"accepted, with an error: " + messages, "accepted"};
  std::vector<std::string> listings;
  for (const Form& form : forms) {
    options.emit = form.emit;
    options.profile = form.profile;
    const std::string text = emitText(options, *module);
    if (text.empty()) return {std::string("accepted, but emits no ") + form.name, "accepted"};
    if (form.emit == Emit::Glsl) listings.push_back(text);
  }
  return {withGlslang ? complaints(listings) : "", "accepted"};
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
