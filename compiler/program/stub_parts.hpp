// SPDX-License-Identifier: MIT
//
// Private to emitStub: printing the two files, and what both share.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "program/cpp_names.hpp"
#include "program/native_requests.hpp"
#include "program/stream_structs.hpp"
#include "program/stub.hpp"

namespace skc::emit {

/// What a stub declares besides the structs that kernels use.
struct StubParts {
  std::vector<Callable> callables;
  std::vector<StreamStruct> streams;
  std::string_view fileName;
  StubOptions options;
  std::vector<std::string> names;  ///< constantNames()
  NativeRequests requests;
};

std::string stubHeader(const ir::Module& module, const Program& program, const StubParts& parts);
std::string stubSource(const ir::Module& module, const Program& program, const StubParts& parts);

/// The functions of the callable objects, for FILE.sk.cpp.
std::string stubFunctions(const ir::Module& module, const Program& program,
                          const std::vector<Callable>& callables);

/// The constant that describes a pipeline, Module::pipelines[number].
std::string pipelineName(std::size_t number);
/// The descriptors of pipelines that are no kernels.
std::string pipelineConstants(const ir::Module& module, const Program& program,
                              const std::vector<std::string>& names);

/// A callable's functions: a kernel (Fold: one with folded outputs) and a scan have one, a reduce one that returns a
/// value and one that fills a stream.
enum class Form : std::uint8_t { Run, ReduceToValue, ReduceToStream, Scan, Fold };
std::vector<Form> formsOf(const ir::Kernel& kernel);

/// Each function of a kernel with uniform parameters is declared twice: for values, and for calls where streams of
/// one element stand for some of them. The first is preferred by C++ wherever it fits.
enum class Uniforms : std::uint8_t { Values, Streams };
std::vector<Uniforms> uniformsOf(const ir::Kernel& kernel);

/// Overloads that are one function in C++, since their parameters have the same types: it chooses by the rank of a gather.
struct SameFunction {
  std::vector<const ir::Kernel*> kernels;
  /// The gathers of all kernels that have the same rank in each, and another one in each other; empty if there is one kernel,
  /// or if no gather tells them apart. The first that is given chooses.
  std::vector<const ir::KernelParam*> choosers = {};
};
/// Groups overloads, in the order of the first of each group.
std::vector<SameFunction> sameFunctions(const ir::Module& module,
                                        const std::vector<const ir::Kernel*>& overloads);

/// A parameter of a callable's functions: one of the kernel's, or a bundle, which stands for several. The other is null.
struct CppParameter {
  const ir::KernelParam* param;
  const ir::BundleParam* bundle;
};
std::vector<CppParameter> cppParameters(const ir::Kernel& kernel);

/// The structs of bundles, for FILE.sk.hpp.
std::string bundleMembers(const ir::Module& module, const ir::BundleType& bundle,
                          const std::vector<std::string>& scope);

/// A function's result type as written inside namespace `scope`.
std::string resultType(const ir::Module& module, const ir::Kernel& kernel, Form form,
                       const std::vector<std::string>& scope);
/// The text after "(": "float k, const sk::In<float>& u, const sk::Out<float>& v) const".
std::string parameterList(const ir::Module& module, const ir::Kernel& kernel, Form form, Uniforms uniforms,
                          const std::vector<std::string>& scope);
/// The same without names, by which C++ tells overloads apart: "float, const sk::In<float>&, const sk::Out<float>&".
std::string parameterTypes(const ir::Module& module, const ir::Kernel& kernel, Form form, Uniforms uniforms);

}  // namespace skc::emit
