// SPDX-License-Identifier: MIT
#include "program/cpp_names.hpp"

#include <algorithm>
#include <cctype>
#include <map>
#include <utility>

#include <fmt/format.h>

#include "ir/print.hpp"
#include "program/shared_headers.hpp"
#include "program/stub_parts.hpp"
#include "program/used_structs.hpp"
#include "support/namer.hpp"

namespace skc::emit {
namespace {

using namespace ir;

bool isReservedInGlobalScope(std::string_view name) { return isGlobalCName(name) || isMacro(name); }
bool isReservedForStruct(std::string_view name) { return isReservedInGlobalScope(name) || isCTag(name); }

/// The names of each namespace.
class Scopes {
 public:
  /// Structs, their aliases and namespaces are there before kernels.
  explicit Scopes(const Module& module) {
    for (const std::uint32_t index : usedStructs(module)) {
      const Struct& type = module.structs[index];
      Namer& names = namesOf(type.scope);
      names.reserve(cppName(module, type));
      for (const std::string& alias : type.aliases) names.reserve(alias);
      reserveNamespaces(type.scope);
    }
    for (const Kernel& kernel : module.kernels) reserveNamespaces(kernel.scope);
    for (const DeclaredStream& stream : module.streams) reserveNamespaces(stream.scope);
  }

  Namer& namesOf(const std::vector<std::string>& scope) {
    return scopes_.try_emplace(qualifier(scope), scope.empty() ? isReservedInGlobalScope : isMacro)
        .first->second;
  }

 private:
  void reserveNamespaces(std::vector<std::string> scope) {
    while (!scope.empty()) {
      std::string name = std::move(scope.back());
      scope.pop_back();
      namesOf(scope).reserve(std::move(name));
    }
  }

  std::map<std::string, Namer> scopes_;
};

}  // namespace

std::string pascalCase(std::string_view name) {
  std::string result;
  bool startsWord = true;
  for (char c : name) {
    const auto byte = static_cast<unsigned char>(c);
    if (byte < 0x80 && std::isalnum(byte) == 0) {
      startsWord = true;
      continue;
    }
    result += startsWord && byte < 0x80 ? static_cast<char>(std::toupper(byte)) : c;
    startsWord = false;
  }
  const bool isName = !result.empty() && std::isdigit(static_cast<unsigned char>(result.front())) == 0;
  return isName ? result : "K" + result;
}

std::string camelCase(std::string_view name) {
  std::string result = pascalCase(name);
  const auto first = static_cast<unsigned char>(result.front());
  if (first < 0x80) result.front() = static_cast<char>(std::tolower(first));
  return result;
}

std::vector<Callable> callables(const Module& module) {
  std::vector<Callable> list;
  std::vector<const Kernel*> kernels;   // the first of each callable
  std::map<std::pair<std::vector<std::string>, std::string>, std::size_t> known;
  std::size_t unit = 0;
  for (const Kernel& kernel : module.kernels) {
    if (!isUnit(kernel)) continue;
    const auto [callable, isNew] = known.try_emplace({kernel.scope, kernel.name}, list.size());
    if (!isNew) {
      list[callable->second].units.push_back(unit++);
      continue;
    }
    kernels.push_back(&kernel);
    list.push_back({kernel.scope, {}, {}, {unit++}});
  }
  Scopes scopes(module);
  for (std::size_t i = 0; i < list.size(); ++i)
    list[i].object = scopes.namesOf(list[i].scope).take(kernels[i]->name);
  for (std::size_t i = 0; i < list.size(); ++i) {
    const std::string type = pascalCase(kernels[i]->name) + pascalCase(wordOf(*kernels[i]));
    list[i].type = scopes.namesOf(list[i].scope).take(type);
  }
  return list;
}

std::string cppType(const Module& module, Type type, const std::vector<std::string>& scope) {
  if (type.isVector() || type.isMatrix()) return "sk::" + print(module, type);
  if (type.isScalar()) return std::string(row(type.scalar).cpp);
  const Struct& entry = module.structs[type.index];
  const std::string name = cppName(module, entry);
  return entry.scope == scope ? name : qualifier(entry.scope) + name;
}

std::string cppName(const Module& module, const Struct& type) {
  if (isShared(module, type)) return type.name;
  Namer names(type.scope.empty() ? isReservedForStruct : isMacro);
  const auto isSame = [&](const Struct& other) {
    return other.name == type.name && other.scope == type.scope;
  };
  if (std::ranges::count_if(module.structs, isSame) == 1) return names.take(type.name);
  // Instances of a template, and structs within structs.
  for (const std::uint32_t index : usedStructs(module)) {
    const Struct& other = module.structs[index];
    if (&other == &type) break;
    if (isSame(other)) names.take(other.name);
  }
  return names.take(type.name);
}

std::string cppName(const Kernel& kernel, const KernelParam& param) {
  std::string name = param.name;
  const auto isTaken = [&] {
    return isMacro(name) ||
           (name != param.name && std::ranges::count(kernel.params, name, &KernelParam::name) > 0);
  };
  while (isTaken()) name += '_';
  return name;
}

namespace {

/// Why C++ has a kernel or struct of this name, if it is not its own name.
std::string_view whatHas(const std::string& name, bool isGlobal) {
  if (isMacro(name)) return "a macro";
  return isGlobal && (isGlobalCName(name) || isCTag(name)) ? "declared by headers of C++"
                                                           : "a type's name, too";
}

void reportName(Diagnostics& diagnostics, Loc loc, std::string_view kind, const std::string& name,
                const std::string& given, bool isGlobal) {
  if (name == given) return;
  const bool helps = isGlobal && !isMacro(name);
  diagnostics.report(Diag::NameTaken, loc,
                     {name, whatHas(name, isGlobal), "C++", kind, given,
                      helps ? "in a namespace it would keep its name" : "another name would stay"});
}

/// The kernels that C++ programs call.
std::vector<const Kernel*> unitsOf(const Module& module) {
  std::vector<const Kernel*> units;
  for (const Kernel& kernel : module.kernels) {
    if (isUnit(kernel)) units.push_back(&kernel);
  }
  return units;
}

void reportAlike(const Module& module, const std::vector<const Kernel*>& overloads,
                 Diagnostics& diagnostics) {
  std::map<std::string, const Kernel*> taken;
  for (const Kernel* kernel : overloads) {
    for (const Form form : formsOf(*kernel)) {
      for (const Uniforms uniforms : uniformsOf(*kernel)) {
        const std::string types = parameterTypes(module, *kernel, form, uniforms);
        const auto [entry, isNew] = taken.emplace(types, kernel);
        if (isNew || entry->second == kernel) continue;
        const Loc& other = entry->second->loc;
        return diagnostics.report(
            Diag::OverloadsAlike, kernel->loc,
            {kernel->name, fmt::format("{}:{}", module.sources[other.file], other.line), types});
      }
    }
  }
}

}  // namespace

void reportCppNames(const Module& module, Diagnostics& diagnostics) {
  const auto reportMacro = [&](const std::string& name, std::string_view kind, Loc loc) {
    if (isMacro(name)) diagnostics.report(Diag::NameIsMacro, loc, {name, kind});
  };
  for (const std::uint32_t index : usedStructs(module)) {
    const Struct& type = module.structs[index];
    if (type.isSynthesized || isShared(module, type)) continue;
    reportName(diagnostics, type.loc, "struct", type.name, cppName(module, type), type.scope.empty());
    for (const StructField& field : type.fields) reportMacro(field.name, "member", type.loc);
  }
  for (const DeclaredStream& stream : module.streams) reportMacro(stream.name, "stream", stream.loc);
  const std::vector<const Kernel*> units = unitsOf(module);
  for (const Callable& callable : callables(module)) {
    const Kernel& kernel = *units[callable.units.front()];
    for (const std::string& scope : kernel.scope) reportMacro(scope, "namespace", kernel.loc);
    reportName(diagnostics, kernel.loc, wordOf(kernel), kernel.name, callable.object, kernel.scope.empty());
  }
}

void reportOverloads(const Module& module, Diagnostics& diagnostics) {
  const std::vector<const Kernel*> units = unitsOf(module);
  for (const Callable& callable : callables(module)) {
    std::vector<const Kernel*> overloads;
    for (const std::size_t unit : callable.units) overloads.push_back(units[unit]);
    reportAlike(module, overloads, diagnostics);
  }
}

}  // namespace skc::emit
