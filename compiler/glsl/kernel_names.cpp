// SPDX-License-Identifier: MIT
#include "glsl/kernel_names.hpp"

#include <algorithm>
#include <set>
#include <string_view>

#include "glsl/constants.hpp"
#include "glsl/words.hpp"
#include "ir/reach.hpp"
#include "ir/walk.hpp"

namespace skc::emit {
namespace {

using namespace ir;
using Names = std::set<std::string>;

/// Adds all identifiers in a piece of GLSL.
void addIdentifiers(std::string_view text, Names& names) {
  const auto isLetter = [](char c) { return c == '_' || (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z'); };
  for (std::size_t i = 0; i < text.size();) {
    std::size_t end = i;
    while (end < text.size() && (isLetter(text[end]) || (end > i && text[end] >= '0' && text[end] <= '9')))
      ++end;
    if (end > i) names.insert(std::string(text.substr(i, end - i)));
    i = std::max(end, i + 1);
  }
}

/// The built-in functions that a function's text may call.
Names builtinsOf(const Function& function) {
  Names names = {"equal", "greaterThan", "greaterThanEqual", "lessThan",       "lessThanEqual",
                 "mix",   "not",         "notEqual",         "uintBitsToFloat"};
  walkExprs(function.body, [&](const Expr& expr) {
    if (std::holds_alternative<Index>(expr.node)) names.insert({"clamp", "min"});
    const auto* n = std::get_if<IntrinsicCall>(&expr.node);
    if (n == nullptr) return;
    addIdentifiers(row(n->intrinsic).glsl, names);
    addIdentifiers(row(n->intrinsic).glslVector, names);
  });
  return names;
}

/// Names a function's variables scope by scope. Siblings may share a name; nested scopes may not, because the
/// inner variable would hide one that the IR can still refer to.
class VariableNamer {
 public:
  VariableNamer(const Function& function, const Names& avoid, bool isEntry)
      : function_(function), avoid_(avoid), names_(function.variables.size()) {
    for (VarId i = 0; i < function.parameterCount; ++i) name(i, isEntry);
    block(function.body);
  }

  std::vector<std::string> take() { return std::move(names_); }

 private:
  void name(VarId var, bool isSymbol) {
    std::string base = glslSafe(function_.variables[var].name);
    if (base.empty()) base = "unnamed";
    if (isSymbol && base.front() == '_') base.insert(0, "p");  // the name is prefixed with `sk_at_`
    names_[var] =
        uniqueName(base, [&](const std::string& n) { return avoid_.contains(n) || visible_.contains(n); });
    visible_.insert(names_[var]);
  }

  void block(const Block& statements) {
    const Names outside = visible_;
    for (const Stmt& stmt : statements) statement(stmt);
    visible_ = outside;
  }

  void statement(const Stmt& stmt) {
    if (const auto* n = std::get_if<Declare>(&stmt.node)) return name(n->var, false);
    const bool sharesScope =
        std::holds_alternative<Loop>(stmt.node) || std::holds_alternative<Switch>(stmt.node);
    if (!sharesScope) return forEachBlock(stmt, [&](const Block& inner) { block(inner); });
    const Names outside = visible_;  // a loop's init, step and body; the cases of a switch
    forEachBlock(stmt, [&](const Block& inner) {
      for (const Stmt& one : inner) statement(one);
    });
    visible_ = outside;
  }

  const Function& function_;
  const Names& avoid_;
  std::vector<std::string> names_;
  Names visible_;
};

/// Names the globals of a body. Functions may share a name if their parameters differ.
class GlobalNamer {
 public:
  explicit GlobalNamer(const TypeNames& types, const Module& module) : types_(types) {
    for (std::uint32_t i = 0; i < module.structs.size(); ++i) taken_.insert(types.structName(i));
  }

  std::string constant(const Constant& constant) {
    std::string name =
        uniqueName(base(constant.name), [&](const std::string& n) { return taken_.contains(n); });
    taken_.insert(name);
    return name;
  }

  std::string function(const Function& function) {
    std::string parameters;
    for (VarId i = 0; i < function.parameterCount; ++i) {
      const Variable& var = function.variables[i];
      const bool isParameter = var.role != VarRole::Gather && var.role != VarRole::AppendOutput;
      if (isParameter) parameters += types_.glsl(var.type) + ",";
    }
    std::string name = uniqueName(base(function.name), [&](const std::string& n) {
      return taken_.contains(n) || overloads_.contains(n + "(" + parameters);
    });
    overloads_.insert(name + "(" + parameters);
    return name;
  }

 private:
  static std::string base(const std::string& name) {
    std::string safe = glslSafe(name);
    return isGlslFunction(safe) ? safe + "_" : safe;
  }

  const TypeNames& types_;
  Names taken_;
  Names overloads_;  ///< "name(float,vec2,"
};

}  // namespace

KernelNames::KernelNames(const Module& module, const Kernel& kernel, const TypeNames& types)
    : entry_(kernel.entry) {
  GlobalNamer globals(types, module);
  std::vector<std::string> constantNames;
  for (const Constant& constant : module.constants) constantNames.push_back(globals.constant(constant));
  const std::vector<FunctionId> functions = functionsOf(module, kernel);
  functions_[entry_].name = globals.function(module.functions[entry_]);  // first: it keeps its name
  for (FunctionId id : functions) {
    if (id != entry_) functions_[id].name = globals.function(module.functions[id]);
  }
  for (FunctionId id : functions) {
    const Function& function = module.functions[id];
    Names avoid = builtinsOf(function);
    for (std::uint32_t i = 0; i < module.structs.size(); ++i) avoid.insert(types.structName(i));
    for (FunctionId callee : callees(function)) avoid.insert(functions_[callee].name);
    walkExprs(function.body, [&](const Expr& expr) {
      if (const auto* n = std::get_if<ConstantRef>(&expr.node)) avoid.insert(constantNames[n->constant]);
    });
    functions_[id].variables = VariableNamer(function, avoid, id == entry_).take();
  }
  const std::vector<bool> isFunction = functionConstants(module);
  for (std::size_t i = 0; i < isFunction.size(); ++i) {
    constants_.push_back(constantNames[i] + (isFunction[i] ? "()" : ""));
  }
}

}  // namespace skc::emit
