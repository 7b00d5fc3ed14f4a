// SPDX-License-Identifier: MIT
#include "program/cpp_names.hpp"

#include <algorithm>
#include <cctype>
#include <set>

#include "glsl/type_names.hpp"
#include "ir/print.hpp"

namespace skc::emit {
namespace {

using namespace ir;

std::string camelCase(std::string_view name) {
  std::string result = pascalCase(name);
  const auto first = static_cast<unsigned char>(result.front());
  if (first < 0x80) result.front() = static_cast<char>(std::tolower(first));
  return result;
}

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

std::vector<Callable> callables(const Module& module, const Program& program) {
  std::set<std::string> taken;   // qualified names
  for (const Struct& type : module.structs) taken.insert(qualifier(type.scope) + type.name);
  std::vector<Callable> list;
  std::vector<std::string> names;   // by callable, as in the .sk file
  for (std::size_t i = 0; i < program.units().size(); ++i) {
    const Kernel& kernel = module.kernels[program.units()[i].id];
    const std::string scope = qualifier(kernel.scope);
    const auto known = std::find(names.begin(), names.end(), scope + kernel.name);
    if (known != names.end()) {
      list[static_cast<std::size_t>(known - names.begin())].units.push_back(i);
      continue;
    }
    const auto isTaken = [&](const std::string& name) {
      return taken.contains(scope + name) || (kernel.scope.empty() && isGlobalCName(name));
    };
    Callable callable{kernel.scope, kernel.name, {}, {i}};
    while (isTaken(callable.object)) callable.object += '_';
    taken.insert(scope + callable.object);
    callable.type = uniqueName(pascalCase(kernel.name) + pascalCase(wordOf(kernel)), isTaken);
    taken.insert(scope + callable.type);
    names.push_back(scope + kernel.name);
    list.push_back(std::move(callable));
  }
  return list;
}

std::vector<std::string> descriptorNames(const Module& module, const Program& program) {
  std::vector<std::string> names;
  for (const Unit& unit : program.units()) {
    names.push_back(uniqueName(camelCase(module.kernels[unit.id].name), [&](const std::string& name) {
      return std::find(names.begin(), names.end(), name) != names.end();
    }));
  }
  return names;
}

std::vector<std::string> tableNames(const Module& module) {
  std::vector<std::string> names;
  for (const Table& table : module.tables) {
    names.push_back(uniqueName("sk_" + camelCase(table.name), [&](const std::string& name) {
      return std::find(names.begin(), names.end(), name) != names.end();
    }));
  }
  return names;
}

std::string cppType(const Module& module, Type type, const std::vector<std::string>& scope) {
  if (type.isVector() || type.isMatrix()) return "sk::" + print(module, type);
  if (type.isScalar()) return std::string(row(type.scalar).cpp);
  const Struct& entry = module.structs[type.index];
  return entry.scope == scope ? entry.name : qualifier(entry.scope) + entry.name;
}

}  // namespace skc::emit
