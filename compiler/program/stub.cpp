// SPDX-License-Identifier: MIT
//
// Prints FILE.sk.cpp: the descriptors as constants, and the other definitions of the file.
#include "program/stub.hpp"

#include <algorithm>
#include <map>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "program/constants.hpp"
#include "program/cpp_literals.hpp"
#include "program/shared_headers.hpp"
#include "program/stub_parts.hpp"
#include "support/text.hpp"

namespace skc::emit {
namespace {

using namespace ir;

bool mayBeStream(const KernelParam& param) {
  return param.role == ParamRole::Uniform && param.type.kind != Type::Kind::Array;
}

/// The type as C++ declares it: "const sk::In<float>&".
std::string parameterType(const Module& module, const KernelParam& param, Uniforms uniforms,
                          const std::vector<std::string>& scope) {
  if (param.type.kind == Type::Kind::Array) {
    const Array& array = module.arrays[param.type.index];
    return fmt::format("std::span<const {}, {}>", cppType(module, array.element, scope), array.length);
  }
  const std::string type = cppType(module, param.type, scope);
  const auto stream = [&](std::string_view direction) {
    const std::string taken = fmt::format("sk::{}<{}>", direction, type);
    return param.neededIf ? fmt::format("const sk::Optional<{}>&", taken) : fmt::format("const {}&", taken);
  };
  switch (param.role) {
    case ParamRole::Spec: return type;
    case ParamRole::Iterator: return fmt::format("const sk::Iter<{}>&", type);
    case ParamRole::Uniform:
      if (uniforms == Uniforms::Streams) return fmt::format("const sk::Uniform<{}>&", type);
      return param.type.isArithmetic() ? type : fmt::format("const {}&", type);
    case ParamRole::Input: return stream("ElementIn");
    case ParamRole::Gather: return stream("In");
    case ParamRole::VariableOutput: return fmt::format("const sk::VariableOut<{}>&", type);
    case ParamRole::Output:
    case ParamRole::Scatter:
    case ParamRole::Accumulator: break;
  }
  return stream("Out");
}

bool isReturned(const KernelParam& param, Form form) {
  return param.role == ParamRole::Accumulator && form == Form::ReduceToValue;
}

/// The parameters without those that are members of bundles.
std::vector<const KernelParam*> ownParameters(const Kernel& kernel) {
  std::vector<const KernelParam*> list;
  for (const CppParameter& parameter : cppParameters(kernel)) {
    if (parameter.param != nullptr) list.push_back(parameter.param);
  }
  return list;
}

/// The parameters that a function takes: its type and its name each.
std::vector<std::pair<std::string, std::string>> functionParameters(const Module& module,
                                                                    const Kernel& kernel, Form form,
                                                                    Uniforms uniforms,
                                                                    const std::vector<std::string>& scope) {
  std::vector<std::pair<std::string, std::string>> list;
  for (const auto& [param, bundle] : cppParameters(kernel)) {
    if (bundle != nullptr) {
      list.emplace_back(fmt::format("const {}&", cppType(module, module.bundleTypes[bundle->type], scope)),
                        bundle->name);
    } else if (!isReturned(*param, form)) {
      list.emplace_back(parameterType(module, *param, uniforms, scope), cppName(kernel, *param));
    }
  }
  return list;
}

}  // namespace

namespace {

/// All types by which C++ tells a kernel's functions from those of others.
std::string signatureOf(const Module& module, const Kernel& kernel) {
  std::string text;
  for (const Form form : formsOf(kernel)) {
    for (const Uniforms uniforms : uniformsOf(kernel))
      text += parameterTypes(module, kernel, form, uniforms) + ";";
  }
  return text;
}

/// The gather of that name; null if there is none.
const KernelParam* gatherNamed(const Kernel& kernel, std::string_view name) {
  const auto found = std::ranges::find(kernel.params, name, &KernelParam::name);
  return found != kernel.params.end() && found->role == ParamRole::Gather ? &*found : nullptr;
}

/// The ranks of a gather in each kernel; empty if one has no such gather, or if two have it in one rank.
std::vector<int> ranksOf(const std::vector<const Kernel*>& kernels, std::string_view name) {
  std::vector<int> ranks;
  for (const Kernel* kernel : kernels) {
    const KernelParam* gather = gatherNamed(*kernel, name);
    if (gather == nullptr || std::ranges::count(ranks, gather->rank) > 0) return {};
    ranks.push_back(gather->rank);
  }
  return ranks;
}

/// The first gather of all kernels that has another rank in each, and those that have its ranks.
std::vector<const KernelParam*> choosersOf(const std::vector<const Kernel*>& kernels) {
  std::vector<const KernelParam*> choosers;
  std::vector<int> ranks;
  if (kernels.size() < 2) return choosers;
  for (const KernelParam& param : kernels.front()->params) {
    const std::vector<int> own = ranksOf(kernels, param.name);
    if (own.empty() || (!ranks.empty() && own != ranks)) continue;
    ranks = own;
    choosers.push_back(&param);
  }
  return choosers;
}

}  // namespace

std::vector<SameFunction> sameFunctions(const Module& module, const std::vector<const Kernel*>& overloads) {
  std::vector<SameFunction> functions;
  std::map<std::pair<std::string, std::vector<Form>>, std::size_t> known;
  for (const Kernel* kernel : overloads) {
    const auto [at, isNew] =
        known.try_emplace({signatureOf(module, *kernel), formsOf(*kernel)}, functions.size());
    if (isNew) functions.emplace_back();
    functions[at->second].kernels.push_back(kernel);
  }
  for (SameFunction& function : functions) function.choosers = choosersOf(function.kernels);
  return functions;
}

std::vector<CppParameter> cppParameters(const Kernel& kernel) {
  std::vector<CppParameter> list;
  auto bundle = kernel.bundles.begin();
  for (std::uint32_t i = 0; i <= kernel.params.size();) {
    if (bundle != kernel.bundles.end() && bundle->first == i) {
      list.push_back({nullptr, &*bundle});
      i += (bundle++)->count;
    } else if (i < kernel.params.size()) {
      list.push_back({&kernel.params[i++], nullptr});
    } else {
      break;
    }
  }
  return list;
}

std::string bundleMembers(const Module& module, const BundleType& bundle,
                          const std::vector<std::string>& scope) {
  std::string text;
  for (const BundleMember& member : bundle.members) {
    std::string type;
    if (member.bundle) {
      type = cppType(module, module.bundleTypes[*member.bundle], scope);
    } else if (member.type.kind == Type::Kind::Array) {
      const Array& array = module.arrays[member.type.index];
      type = fmt::format("sk::UniformMember<std::array<{}, {}>>", cppType(module, array.element, scope),
                         array.length);
    } else {
      const std::string_view kind = member.role == ParamRole::Gather ? "Gather"
                                    : member.role == ParamRole::Spec ? "Spec"
                                                                     : "Uniform";
      type = fmt::format("sk::{}Member<{}>", kind, cppType(module, member.type, scope));
    }
    text += fmt::format("  {} {}{{}};\n", type, member.name);
  }
  return text;
}

std::vector<Form> formsOf(const Kernel& kernel) {
  if (kernel.isScan) return {Form::Scan};
  if (foldsBesideOutputs(kernel)) return {Form::Fold};
  if (kernel.reduction) return {Form::ReduceToValue, Form::ReduceToStream};
  return {Form::Run};
}

std::vector<Uniforms> uniformsOf(const Kernel& kernel) {
  const auto isUniform = [](const KernelParam* param) { return mayBeStream(*param); };
  if (std::ranges::none_of(ownParameters(kernel), isUniform)) return {Uniforms::Values};
  return {Uniforms::Values, Uniforms::Streams};
}

std::string resultType(const Module& module, const Kernel& kernel, Form form,
                       const std::vector<std::string>& scope) {
  if (form != Form::ReduceToValue) return "void";
  std::vector<std::string> types;
  for (const KernelParam& param : kernel.params) {
    if (param.role == ParamRole::Accumulator) types.push_back(cppType(module, param.type, scope));
  }
  return types.size() == 1 ? types.front() : fmt::format("std::tuple<{}>", join(types, ", "));
}

std::string parameterList(const Module& module, const Kernel& kernel, Form form, Uniforms uniforms,
                          const std::vector<std::string>& scope) {
  std::vector<std::string> list;
  for (const auto& [type, name] : functionParameters(module, kernel, form, uniforms, scope))
    list.push_back(type + ' ' + name);
  return join(list, ", ") + ") const";
}

std::string parameterTypes(const Module& module, const Kernel& kernel, Form form, Uniforms uniforms) {
  std::vector<std::string> list;
  for (const auto& [type, name] : functionParameters(module, kernel, form, uniforms, {}))
    list.push_back(type);
  return join(list, ", ");
}

Stub emitStub(const Module& module, const Program& program, std::string_view fileName,
              const StubOptions& options) {
  StubParts parts{.callables = callables(module),
                  .streams = {},
                  .fileName = fileName,
                  .options = options,
                  .names = constantNames(module, program),
                  .requests = {}};
  parts.streams = streamStructs(module, parts.callables, fileName);
  Stub stub;
  stub.header = stubHeader(module, program, parts);
  if (options.native)
    parts.requests = NativeRequests(module, program, parts.names, stub.header, options.quad);
  stub.source = stubSource(module, program, parts);
  stub.native = parts.requests.list();
  return stub;
}

namespace {

class SourceWriter {
 public:
  SourceWriter(const Module& module, const Program& program, const StubParts& parts)
      : module_(module), program_(program), parts_(parts) {}

  std::string text() {
    std::string head = fmt::format(
        "// Generated by skc from {0}. Edit that file instead.\n#include \"{0}.hpp\"\n", parts_.fileName);
    if (parts_.options.withLibrary) head += "\n#include <sk/library.hpp>";
    if (!parts_.names.empty()) head += "\n#include <sk/linked_file.hpp>";
    const std::string checks = layoutChecks(module_);
    if (!checks.empty()) head += "\n#include <sk/shared_struct.hpp>";
    if (parts_.options.withLibrary || !parts_.names.empty() || !checks.empty()) head += "\n";
    if (!parts_.names.empty()) descriptors();
    if (!checks.empty()) text_ += "\n" + checks;
    text_ += stubFunctions(module_, program_, parts_.callables);
    for (const StreamStruct& streams : parts_.streams) text_ += "\n" + constructor(module_, streams);
    if (parts_.options.withLibrary) library();
    return head + nativeDeclarations() + text_;
  }

 private:
  void descriptors() {
    text_ += "\nnamespace sk::program {\nnamespace {\n\nusing std::string_view_literals::operator\"\"sv;\n\n";
    std::vector<std::string> files;
    for (const std::string_view source : module_.sources) files.push_back(quoted(source));
    text_ += constantList("std::string_view", "sources", files);
    text_ += constantsText(module_, program_, parts_.names, parts_.requests);
    text_ += pipelineConstants(module_, program_, parts_.names);
    linkedFile();
    text_ += "}  // namespace\n}  // namespace sk::program\n";
  }

  /// Registers the file before the application's static objects, such as devices, are constructed.
  void linkedFile() {
    std::vector<std::string> kernels, tables;
    for (const Unit& unit : program_.units()) kernels.push_back(quoted(unit.kernel.name));
    for (const sk::program::Table* table : program_.tables()) {
      if (table != nullptr) tables.push_back(quoted(table->function));
    }
    text_ += constantList("std::string_view", "kernelNames", kernels);
    text_ += constantList("std::string_view", "tableNames", tables);
    const sk::program::Kernel& any = program_.units().front().kernel;
    text_ += fmt::format(
        "[[gnu::init_priority(101)]] const LinkedFile linkedFile(\n    {{.glsl = {}, .native = {}}}, "
        "kernelNames, {});\n\n",
        any.drawn || any.dispatched, parts_.options.native, tables.empty() ? "{}" : "tableNames");
  }

  /// Declares the functions in the object file that the descriptors point to.
  std::string nativeDeclarations() const {
    if (parts_.requests.list().empty()) return {};
    std::string text = "\nnamespace sk::native {\n\nextern \"C\" {\n";
    for (const native::KernelRequest& request : parts_.requests.list()) {
      text += fmt::format("[[gnu::visibility(\"hidden\")]] extern const Code {};\n", request.symbol);
    }
    return text + "}\n\n}  // namespace sk::native\n";
  }

  /// Prints the list of all descriptors, under a name that dlsym() can find.
  void library() {
    std::vector<std::string> kernels, reductions;
    for (std::size_t i = 0; i < parts_.names.size(); ++i) {
      const bool isReduction = program_.units()[i].reduction != nullptr;
      (isReduction ? reductions : kernels)
          .push_back("&" + (parts_.names[i] + (isReduction ? Part::Reduction : Part::Kernel)));
    }
    text_ += "\nnamespace sk::program {\nnamespace {\n\n";
    text_ += constantList("const Kernel*", "allKernels", kernels);
    text_ += constantList("const Reduction*", "allReductions", reductions);
    text_ += fmt::format(
        "}}  // namespace\n\nconst Library sk_library{{{}, {}}};\n\n}}  // namespace sk::program\n",
        kernels.empty() ? "{}" : "allKernels", reductions.empty() ? "{}" : "allReductions");
  }

  const Module& module_;
  const Program& program_;
  const StubParts& parts_;
  std::string text_;
};

}  // namespace

std::string stubSource(const Module& module, const Program& program, const StubParts& parts) {
  return SourceWriter(module, program, parts).text();
}

}  // namespace skc::emit
