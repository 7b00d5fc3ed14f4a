// SPDX-License-Identifier: MIT
#include "program/shared_headers.hpp"

#include <algorithm>
#include <filesystem>

#include <fmt/format.h>

#include "program/cpp_names.hpp"
#include "program/elements.hpp"
#include "program/stream_structs.hpp"
#include "support/header_files.hpp"
#include "support/text.hpp"

namespace skc::emit {
namespace {

using namespace ir;
namespace fs = std::filesystem;

fs::path normal(const std::string& path) { return fs::absolute(path).lexically_normal(); }

bool isInside(const fs::path& relative) { return !relative.empty() && *relative.begin() != ".."; }

std::string includePath(const std::string& header, const std::string& file,
                        const std::vector<std::string>& folders) {
  const fs::path wanted = normal(header);
  for (const std::string& folder : folders) {
    const fs::path relative = wanted.lexically_relative(normal(folder + "/"));
    if (isInside(relative)) return relative.generic_string();
  }
  return wanted.lexically_relative(normal(file).parent_path()).generic_string();
}

}  // namespace

bool isShared(const Module& module, const Struct& type) {
  return !type.isSynthesized && type.loc.file < module.sources.size() &&
         isCppHeader(module.sources[type.loc.file]);
}

std::vector<std::string> sharedHeaders(const Module& module, const std::vector<std::string>& folders) {
  std::vector<std::string> paths;
  for (const std::uint32_t index : usedStructs(module)) {
    const Struct& type = module.structs[index];
    if (!isShared(module, type)) continue;
    std::string path = includePath(module.sources[type.loc.file], module.file, folders);
    if (std::ranges::find(paths, path) == paths.end()) paths.push_back(std::move(path));
  }
  return paths;
}

namespace {

/// Empty for a struct of a .sk file.
std::string layoutCheck(const Module& module, const TypeNames& types, std::uint32_t index) {
  const Struct& type = module.structs[index];
  if (!isShared(module, type)) return {};
  const std::string name = "::" + cppType(module, Type::structType(index));
  std::vector<std::string> members;
  for (const StructField& field : type.fields) {
    const bool isArray = field.type.kind == Type::Kind::Array;
    const Array* array = isArray ? &module.arrays[field.type.index] : nullptr;
    const std::string held = cppType(module, isArray ? array->element : field.type);
    members.push_back(fmt::format("sk::detail::holds<decltype({}::{}), {}{}>", name, field.name, held,
                                  isArray ? fmt::format("[{}]", array->length) : ""));
  }
  members.push_back(
      fmt::format("sizeof({}) == {}", name, elementLayout(module, types, Type::structType(index)).size));
  return fmt::format("static_assert({},\n              \"{} is another struct in C++ than in kernels\");\n",
                     join(members, " &&\n                  "), name.substr(2));
}

}  // namespace

std::string layoutChecks(const Module& module) {
  const TypeNames types(module);
  std::string text;
  for (const std::uint32_t index : usedStructs(module)) text += layoutCheck(module, types, index);
  return text;
}

}  // namespace skc::emit
