// SPDX-License-Identifier: MIT
#include "web/js_names.hpp"

#include <algorithm>
#include <iterator>

#include "ir/print.hpp"
#include "program/stream_structs.hpp"
#include "support/namer.hpp"
#include "support/text.hpp"

namespace skc::web {
namespace {

/// Reserved words of JavaScript and TypeScript in modules that C++ allows as names, and what a module's two files import.
constexpr std::string_view words[] = {
    "arguments",  "await",  "debugger", "eval",       "export",    "extends", "finally", "function",
    "implements", "import", "in",       "instanceof", "interface", "let",     "null",    "package",
    "sk",         "super",  "typeof",   "undefined",  "var",       "with",    "yield"};
/// Names of types that TypeScript defines.
constexpr std::string_view types[] = {"any",    "bigint", "never",  "number",
                                      "object", "string", "symbol", "unknown"};
static_assert(std::ranges::is_sorted(words) && std::ranges::is_sorted(types), "for binary search");

bool isJsWord(std::string_view name) { return std::binary_search(std::begin(words), std::end(words), name); }

/// The constants that a module does not export begin with $, which C++ compilers allow in names, too.
bool isReserved(std::string_view name) {
  const bool isText =
      name.starts_with("$text") && name.find_first_not_of("0123456789", 5) == std::string_view::npos;
  return isJsWord(name) || isText || name == "$file" || name == "$programs" || name == "$sk";
}
bool isReservedType(std::string_view name) {
  return isReserved(name) || std::binary_search(std::begin(types), std::end(types), name);
}
/// Every word may name a member; this one would set the object's prototype.
bool isReservedMember(std::string_view name) { return name == "__proto__"; }

/// "geometry_Hit" for geometry::Hit.
std::string joined(const ir::Struct& type) {
  std::string name = join(type.scope, "_") + (type.scope.empty() ? "" : "_") + type.name;
  while (name.back() == '>') name.pop_back();  // Pair<float> is Pair_float
  std::ranges::replace_if(
      name, [](char c) { return c == '<' || c == '>' || c == ',' || c == ' ' || c == ':'; }, '_');
  return name;
}

}  // namespace

JsNames::JsNames(const ir::Module& module) {
  // Names in no namespace come first, and keep theirs.
  std::vector<std::uint32_t> structs;
  for (const std::uint32_t index : emit::usedStructs(module)) {
    if (!module.structs[index].isSynthesized) structs.push_back(index);
  }
  std::ranges::stable_partition(structs,
                                [&](std::uint32_t index) { return module.structs[index].scope.empty(); });

  Namer values(isReserved), interfaces(isReservedType);
  const auto nameStruct = [&](std::uint32_t index) {
    const ir::Struct& type = module.structs[index];
    std::string name = interfaces.take(joined(type));
    name = values.take(std::move(name));
    structs_[index].name = name;
  };
  const auto firstScoped = std::ranges::find_if(
      structs, [&](std::uint32_t index) { return !module.structs[index].scope.empty(); });
  std::for_each(structs.begin(), firstScoped, nameStruct);

  std::map<std::string, Namer> members;
  std::map<std::string, std::size_t> exportOf;  // in its scope, by qualified name in the file
  std::map<std::vector<std::string>, std::size_t> scopeOf;
  const auto findScope = [&](const std::vector<std::string>& path) -> Scope& {
    const auto [known, isNew] = scopeOf.try_emplace(path, scopes_.size());
    if (isNew) scopes_.push_back({{}, path, {}});
    return scopes_[known->second];
  };
  findScope({});
  std::size_t unit = 0;
  for (const bool isGlobal : {true, false}) {
    unit = 0;
    if (!isGlobal) std::for_each(firstScoped, structs.end(), nameStruct);
    for (const ir::Kernel& kernel : module.kernels) {
      if (!emit::isUnit(kernel)) continue;
      const std::size_t number = unit++;
      if (kernel.scope.empty() != isGlobal) continue;
      Scope& scope = findScope(kernel.scope);
      if (!isGlobal && scope.name.empty()) scope.name = values.take(join(kernel.scope, "_"));
      const auto [known, isNew] =
          exportOf.try_emplace(ir::qualifier(kernel.scope) + kernel.name, scope.exports.size());
      if (isNew) {
        Namer& names = isGlobal
                           ? values
                           : members.try_emplace(ir::qualifier(kernel.scope), isReservedMember).first->second;
        scope.exports.push_back({names.take(kernel.name), {}});
      }
      scope.exports[known->second].units.push_back(number);
    }
  }
  for (const ir::BundleType& bundle : module.bundleTypes) {
    std::vector<std::string> path = bundle.scope;
    path.push_back(bundle.name + bundle.arguments);
    bundles_.push_back(interfaces.take(join(path, "_")));
  }
  for (const std::uint32_t index : structs)
    structs_[index].arrays = interfaces.take(structs_[index].name + "Arrays");
}

void reportJsNames(const ir::Module& module, Diagnostics& diagnostics) {
  const JsNames names(module);
  const auto report = [&](Loc loc, std::string_view kind, const std::string& name, const std::string& given) {
    if (name == given) return;
    diagnostics.report(
        Diag::NameTaken, loc,
        {name, isReservedType(name) ? "a word of JavaScript or TypeScript" : "another export's name",
         "JavaScript", kind, given, "another name would stay"});
  };
  for (const std::uint32_t index : emit::usedStructs(module)) {
    const ir::Struct& type = module.structs[index];
    if (!type.isSynthesized) report(type.loc, "struct", joined(type), names.structName(index));
  }
  std::vector<const ir::Kernel*> units;
  for (const ir::Kernel& kernel : module.kernels) {
    if (emit::isUnit(kernel)) units.push_back(&kernel);
  }
  for (const Scope& scope : names.scopes()) {
    for (const Export& one : scope.exports) {
      const ir::Kernel& kernel = *units[one.units.front()];
      report(kernel.loc, ir::wordOf(kernel), kernel.name, one.name);
    }
    if (scope.exports.empty()) continue;
    report(units[scope.exports.front().units.front()]->loc, "namespace", join(scope.path, "_"), scope.name);
  }
}

std::string jsParameterName(std::string_view name) { return std::string(name) + (isJsWord(name) ? "_" : ""); }

}  // namespace skc::web
