// SPDX-License-Identifier: MIT
#include "program/stream_structs.hpp"

#include <algorithm>
#include <utility>

#include <fmt/format.h>

#include "glsl/type_names.hpp"
#include "ir/call_graph.hpp"
#include "ir/print.hpp"
#include "ir/walk.hpp"
#include "support/text.hpp"

namespace skc::emit {
namespace {

using namespace ir;

bool contains(const std::vector<std::string>& list, std::string_view name) {
  return std::find(list.begin(), list.end(), name) != list.end();
}

bool hasStream(const StreamStruct& streams, std::string_view name) {
  return std::any_of(streams.streams.begin(), streams.streams.end(),
                     [&](const DeclaredStream* stream) { return stream->name == name; });
}

/// "gray_scott.sk" gives "GrayScottStreams".
std::string nameFor(const Module& module, const std::vector<Callable>& callables, std::string_view fileName,
                    const StreamStruct& streams) {
  const std::string_view stem = fileName.substr(0, fileName.rfind('.'));
  return uniqueName(pascalCase(stem) + "Streams", [&](const std::string& name) {
    const bool isStruct = std::any_of(module.structs.begin(), module.structs.end(), [&](const Struct& type) {
      return type.scope == streams.scope && type.name == name;
    });
    const bool isCallable = std::any_of(callables.begin(), callables.end(), [&](const Callable& callable) {
      return callable.scope == streams.scope && (callable.object == name || callable.type == name);
    });
    return isStruct || isCallable || hasStream(streams, name);
  });
}

/// The name of the constructor's first parameter.
std::string deviceName(const StreamStruct& streams) {
  return uniqueName("device", [&](const std::string& name) {
    return contains(streams.arguments, name) || hasStream(streams, name);
  });
}

/// "sk::Device& device, std::int64_t height)"
std::string parameters(const StreamStruct& streams) {
  std::string text = fmt::format("sk::Device& {}", deviceName(streams));
  for (const std::string& argument : streams.arguments) text += fmt::format(", std::int64_t {}", argument);
  return text + ")";
}

std::string extents(const DeclaredStream& stream) {
  std::vector<std::string> texts;
  for (const DeclaredExtent& extent : stream.extents) {
    texts.push_back(extent.name.empty() ? std::to_string(extent.value) : extent.name);
  }
  return join(texts, ", ");
}

}  // namespace

std::vector<StreamStruct> streamStructs(const Module& module, const std::vector<Callable>& callables,
                                        std::string_view fileName) {
  std::vector<StreamStruct> structs;
  for (const DeclaredStream& stream : module.streams) {
    auto group = std::find_if(structs.begin(), structs.end(),
                              [&](const StreamStruct& known) { return known.scope == stream.scope; });
    if (group == structs.end()) group = structs.insert(structs.end(), {stream.scope, {}, {}, {}});
    group->streams.push_back(&stream);
    for (const DeclaredExtent& extent : stream.extents) {
      const bool isNew = !extent.name.empty() && !contains(group->arguments, extent.name);
      if (isNew) group->arguments.push_back(extent.name);
    }
  }
  for (StreamStruct& group : structs) group.name = nameFor(module, callables, fileName, group);
  return structs;
}

std::string declaration(const Module& module, const StreamStruct& streams) {
  const std::string head = fmt::format("  {}{}(", streams.arguments.empty() ? "explicit " : "", streams.name);
  std::string text = fmt::format("struct {} {{\n", streams.name);
  text += wrapLine(head + parameters(streams) + ";", 100, head.size()) + "\n\n";
  for (const DeclaredStream* stream : streams.streams) {
    text += fmt::format("  sk::Stream<{}> {};   ///< {{{}}}\n", cppType(module, stream->type, streams.scope),
                        stream->name, extents(*stream));
  }
  return text + "};\n";
}

std::string constructor(const Module& module, const StreamStruct& streams) {
  const std::string head = fmt::format("{0}{1}::{1}(", qualifier(streams.scope), streams.name);
  std::string text = wrapLine(head + parameters(streams), 100, head.size());
  std::vector<std::string> members;
  for (const DeclaredStream* stream : streams.streams) {
    members.push_back(fmt::format("{0}({1}.stream<{2}>({{{3}}}, sk::Storage::Default, \"{4}{0}\"))",
                                  stream->name, deviceName(streams), cppType(module, stream->type),
                                  extents(*stream), qualifier(streams.scope)));
  }
  return text + "\n    : " + join(members, ",\n      ") + " {}\n";
}

namespace {

struct Finder {
  const Module& module;
  std::vector<bool> isFound;
  std::vector<std::uint32_t> list;

  void add(Type type) {
    if (type.kind == Type::Kind::Array) return add(module.arrays[type.index].element);
    if (type.kind != Type::Kind::Struct || isFound[type.index]) return;
    for (const StructField& field : module.structs[type.index].fields) add(field.type);
    isFound[type.index] = true;
    list.push_back(type.index);
  }
};

class Levels {
 public:
  explicit Levels(const Module& module) : module_(module), ofStructs_(module.structs.size(), 0) {}

  int of(Type type) {
    if (type.kind == Type::Kind::Array) return of(module_.arrays[type.index].element);
    if (type.kind != Type::Kind::Struct) return !type.is64Bit() ? 0 : type.isScalar() ? 1 : 2;
    int& levels = ofStructs_[type.index];
    if (levels > 0) return levels;
    int inner = 0;
    for (const StructField& field : module_.structs[type.index].fields)
      inner = std::max(inner, of(field.type));
    return levels = 1 + inner;
  }

 private:
  const Module& module_;
  std::vector<int> ofStructs_;
};

}  // namespace

std::vector<std::uint32_t> usedStructs(const Module& module) {
  Finder finder{module, std::vector<bool>(module.structs.size(), false), {}};
  for (const Kernel& kernel : module.kernels) {
    if (kernel.isSynthesized) continue;
    for (const KernelParam& param : kernel.params) finder.add(param.type);
  }
  for (const DeclaredStream& stream : module.streams) finder.add(stream.type);
  for (const BundleType& bundle : module.bundleTypes) {
    for (const BundleMember& member : bundle.members) finder.add(member.type);
  }
  return std::move(finder.list);
}

int structLevels(const Module& module, const Kernel& kernel) {
  Levels levels(module);
  int most = 0;
  for (const FunctionId id : functionsOf(module, kernel)) {
    const Function& function = module.functions[id];
    for (const Variable& variable : function.variables) most = std::max(most, levels.of(variable.type));
    walkExprs(function.body, [&](const Expr& expr) { most = std::max(most, levels.of(expr.type)); });
  }
  return most;
}

}  // namespace skc::emit
