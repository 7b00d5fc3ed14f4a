// SPDX-License-Identifier: MIT
#include "glsl/kernel_names.hpp"

#include <set>
#include <utility>

#include "glsl/polyfills.hpp"
#include "glsl/words.hpp"
#include "ir/call_graph.hpp"
#include "ir/walk.hpp"

namespace skc::emit {
namespace {

using namespace ir;
using Names = std::set<std::string>;

/// The built-in functions that a function's text may call.
Names builtinsOf(const Function& function) {
  Names names = {"equal", "greaterThan", "greaterThanEqual", "lessThan",       "lessThanEqual",
                 "mix",   "not",         "notEqual",         "uintBitsToFloat"};
  walkExprs(function.body, [&](const Expr& expr) {
    if (const auto* n = std::get_if<IntrinsicCall>(&expr.node))
      names.insert(std::string(row(n->intrinsic).glsl));
  });
  return names;
}

/// Names a function's variables scope by scope. Siblings may share a name; nested scopes may not, because the
/// inner variable would hide one that the IR can still refer to.
class VariableNamer {
 public:
  VariableNamer(const Function& function, const TypeNames& types, const Names& avoid, bool isEntry)
      : function_(function), types_(types), avoid_(avoid), names_(function.variables.size()) {
    for (VarId i = 0; i < function.parameterCount; ++i) name(i, isEntry);
    block(function.body);
  }

  std::vector<std::string> take() { return std::move(names_); }

 private:
  void name(VarId var, bool isSymbol) {
    std::string base = glslSafe(function_.variables[var].name);
    if (base.empty()) base = "unnamed";
    if (isSymbol && base.front() == '_') base.insert(0, "p");  // the name is prefixed with `sk_at_`
    names_[var] = unique(base);
    visible_.insert(names_[var]);
    order_.push_back(names_[var]);
  }

  /// Begins with the number that follows the last one given, instead of 2: what was given is visible.
  std::string unique(const std::string& base) {
    const auto isTaken = [&](const std::string& n) {
      return types_.isStructName(n) || avoid_.contains(n) || visible_.contains(n);
    };
    if (!isTaken(base)) return base;
    const std::string start = base + (base.back() == '_' ? "" : "_");
    int& number = numbers_.try_emplace(base, 2).first->second;
    changes_.emplace_back(base, number);
    while (isTaken(start + std::to_string(number))) ++number;
    return start + std::to_string(number);
  }

  /// Runs `inside`; what it names leaves its scope.
  template <class Fn>
  void scoped(Fn&& inside) {
    const std::size_t names = order_.size(), changes = changes_.size();
    inside();
    for (; order_.size() > names; order_.pop_back()) visible_.erase(order_.back());
    for (; changes_.size() > changes; changes_.pop_back())
      numbers_[changes_.back().first] = changes_.back().second;
  }

  void block(const Block& statements) {
    scoped([&] {
      for (const Stmt& stmt : statements) statement(stmt);
    });
  }

  void statement(const Stmt& stmt) {
    if (const auto* n = std::get_if<Declare>(&stmt.node)) return name(n->var, false);
    const bool sharesScope =
        std::holds_alternative<Loop>(stmt.node) || std::holds_alternative<Switch>(stmt.node);
    if (!sharesScope) return forEachBlock(stmt, [&](const Block& inner) { block(inner); });
    scoped([&] {  // a loop's init, step and body; the cases of a switch
      forEachBlock(stmt, [&](const Block& inner) {
        for (const Stmt& one : inner) statement(one);
      });
    });
  }

  const Function& function_;
  const TypeNames& types_;
  const Names& avoid_;
  std::vector<std::string> names_;
  Names visible_;
  std::vector<std::string> order_;  ///< the visible names, the last one last
  std::map<std::string, int> numbers_;  ///< for each name, a number below which all are taken
  std::vector<std::pair<std::string, int>> changes_;  ///< what these were before
};

/// Names the functions of a body. They may share a name if their parameters differ.
class FunctionNamer {
 public:
  explicit FunctionNamer(const TypeNames& types) : types_(types) {}

  std::string name(const Function& function) {
    std::string parameters;
    for (VarId i = 0; i < function.parameterCount; ++i) {
      const Variable& var = function.variables[i];
      const bool isParameter = var.role != VarRole::Gather && var.role != VarRole::AppendOutput;
      if (isParameter) parameters += types_.glsl(var.type) + ",";
    }
    const auto isTaken = [&](const std::string& n) {
      return types_.isStructName(n) || types_.isConstantName(n) || overloads_.contains(n + "(" + parameters);
    };
    std::string name = unique_.find(glslSafeGlobal(function.name), isTaken, "(" + parameters);
    overloads_.insert(name + "(" + parameters);
    return name;
  }

 private:
  const TypeNames& types_;
  Names overloads_;  ///< "name(float,vec2,"
  UniqueNames unique_;
};

}  // namespace

KernelNames::KernelNames(const Module& module, const Kernel& kernel, const TypeNames& types)
    : entry_(kernel.entry) {
  FunctionNamer namer(types);
  const std::vector<FunctionId> functions = ownFunctionsOf(module, kernel);
  functions_[entry_].name = namer.name(module.functions[entry_]);  // first: it keeps its name
  for (FunctionId id : functions) {
    if (id != entry_) functions_[id].name = namer.name(module.functions[id]);
  }
  for (FunctionId id : functions) {
    const Function& function = module.functions[id];
    Names avoid = builtinsOf(function);
    for (FunctionId callee : callees(function)) {
      if (!module.functions[callee].isLibrary) avoid.insert(functions_[callee].name);
    }
    walkExprs(function.body, [&](const Expr& expr) {
      if (const auto* n = std::get_if<ConstantRef>(&expr.node)) avoid.insert(types.constantName(n->constant));
    });
    functions_[id].variables = VariableNamer(function, types, avoid, id == entry_).take();
  }
}

}  // namespace skc::emit
