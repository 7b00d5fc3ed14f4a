// SPDX-License-Identifier: MIT
#include "program/stub.hpp"

#include <algorithm>
#include <utility>

#include <fmt/format.h>

#include "program/constant_names.hpp"
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
    if (isReturned(param, form)) continue;
    list.push_back(parameterType(module, param, uniforms, scope) + ' ' + cppName(kernel, param));
  }
  return join(list, ", ") + ") const";
}

std::string parameterTypes(const Module& module, const Kernel& kernel, Form form, Uniforms uniforms) {
  std::vector<std::string> list;
  for (const KernelParam& param : kernel.params) {
    if (!isReturned(param, form)) list.push_back(parameterType(module, param, uniforms, {}));
  }
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

}  // namespace skc::emit
