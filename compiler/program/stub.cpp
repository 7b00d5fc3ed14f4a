// SPDX-License-Identifier: MIT
#include "program/stub.hpp"

#include <algorithm>

#include <fmt/format.h>

#include "program/stub_parts.hpp"
#include "support/text.hpp"

namespace skc::emit {
namespace {

using namespace ir;

bool mayBeStream(const KernelParam& param) {
  return param.role == ParamRole::Uniform && param.type.kind != Type::Kind::Array;
}

std::string parameter(const Module& module, const Kernel& kernel, const KernelParam& param, Uniforms uniforms,
                      const std::vector<std::string>& scope) {
  const std::string name = cppName(kernel, param);
  if (param.type.kind == Type::Kind::Array) {
    const Array& array = module.arrays[param.type.index];
    return fmt::format("std::span<const {}, {}> {}", cppType(module, array.element, scope), array.length,
                       name);
  }
  const std::string type = cppType(module, param.type, scope);
  const auto stream = [&](std::string_view direction) {
    const std::string taken = fmt::format("sk::{}<{}>", direction, type);
    return param.neededIf ? fmt::format("const sk::Optional<{}>& {}", taken, name)
                          : fmt::format("const {}& {}", taken, name);
  };
  switch (param.role) {
    case ParamRole::Spec: return fmt::format("{} {}", type, name);
    case ParamRole::Iterator: return fmt::format("const sk::Iter<{}>& {}", type, name);
    case ParamRole::Uniform:
      if (uniforms == Uniforms::Streams) return fmt::format("const sk::Uniform<{}>& {}", type, name);
      return param.type.isArithmetic() ? fmt::format("{} {}", type, name)
                                       : fmt::format("const {}& {}", type, name);
    case ParamRole::Input: return stream("ElementIn");
    case ParamRole::Gather: return stream("In");
    case ParamRole::VariableOutput: return fmt::format("const sk::VariableOut<{}>& {}", type, name);
    case ParamRole::Output:
    case ParamRole::Scatter:
    case ParamRole::Accumulator: break;
  }
  return stream("Out");
}

}  // namespace

std::vector<Form> formsOf(const Kernel& kernel) {
  if (kernel.isScan) return {Form::Scan};
  if (foldsBesideOutputs(kernel)) return {Form::Fold};
  if (kernel.reduction) return {Form::ReduceToValue, Form::ReduceToStream};
  return {Form::Run};
}

std::vector<Uniforms> uniformsOf(const Kernel& kernel) {
  if (std::ranges::none_of(kernel.params, mayBeStream)) return {Uniforms::Values};
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
  for (const KernelParam& param : kernel.params) {
    const bool isReturned = param.role == ParamRole::Accumulator && form == Form::ReduceToValue;
    if (!isReturned) list.push_back(parameter(module, kernel, param, uniforms, scope));
  }
  return join(list, ", ") + ") const";
}

Stub emitStub(const Module& module, const Program& program, std::string_view fileName,
              const StubOptions& options) {
  StubParts parts{callables(module), {}, fileName, options};
  parts.streams = streamStructs(module, parts.callables, fileName);
  Stub stub;
  stub.header = stubHeader(module, program, parts);
  NativeSymbols symbols(stub.header);
  stub.source = stubSource(module, program, parts, symbols);
  stub.native = symbols.requests();
  return stub;
}

}  // namespace skc::emit
