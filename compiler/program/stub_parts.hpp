// SPDX-License-Identifier: MIT
//
// Private to emitStub: printing the two files, and what both share.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "native/kernel_request.hpp"
#include "program/cpp_names.hpp"
#include "program/stream_structs.hpp"
#include "program/stub.hpp"

namespace skc::emit {

/// The symbols by which the descriptors of FILE.sk.cpp refer to the code in FILE.sk.o, and the requests for that code.
class NativeSymbols {
 public:
  /// `header` is the text of FILE.sk.hpp. Every symbol contains its hash, so that objects of several .sk
  /// files can be linked together. Files with equal headers define the same callable objects, which the
  /// linker rejects anyway. The header contains no folder, so symbols do not depend on it.
  explicit NativeSymbols(std::string_view header);

  /// Requests code and returns its symbol: "sk_0123456789abcdef_diffuse" for `descriptor` "diffuse". Sets the
  /// symbol of the request.
  std::string add(const std::string& descriptor, native::KernelRequest request);

  /// All requests, in the order in which they were added.
  const std::vector<native::KernelRequest>& requests() const { return requests_; }

 private:
  std::string prefix_;
  std::vector<native::KernelRequest> requests_;
};

/// What a stub declares besides the structs that kernels use.
struct StubParts {
  std::vector<Callable> callables;
  std::vector<StreamStruct> streams;
  std::string_view fileName;
  StubOptions options;
};

std::string stubHeader(const ir::Module& module, const Program& program, const StubParts& parts);
/// Also adds the requests for native code that the descriptors refer to.
std::string stubSource(const ir::Module& module, const Program& program, const StubParts& parts,
                       NativeSymbols& symbols);

/// The functions of the callable objects, for FILE.sk.cpp.
std::string stubFunctions(const ir::Module& module, const Program& program,
                          const std::vector<Callable>& callables);

/// The name of the enumerator.
inline std::string_view nameOf(sk::program::Scalar scalar) {
  return ir::row(static_cast<ir::Scalar>(scalar)).name;
}

/// A callable's functions: a kernel (Fold: one with folded outputs) and a scan have one, a reduce one that returns a
/// value and one that fills a stream.
enum class Form : std::uint8_t { Run, ReduceToValue, ReduceToStream, Scan, Fold };
std::vector<Form> formsOf(const ir::Kernel& kernel);

/// Each function of a kernel with uniform parameters is declared twice: for values, and for calls where streams of
/// one element stand for some of them. The first is preferred by C++ wherever it fits.
enum class Uniforms : std::uint8_t { Values, Streams };
std::vector<Uniforms> uniformsOf(const ir::Kernel& kernel);

/// A function's result type as written inside namespace `scope`.
std::string resultType(const ir::Module& module, const ir::Kernel& kernel, Form form,
                       const std::vector<std::string>& scope);
/// The text after "(": "float k, const sk::In<float>& u, const sk::Out<float>& v) const".
std::string parameterList(const ir::Module& module, const ir::Kernel& kernel, Form form, Uniforms uniforms,
                          const std::vector<std::string>& scope);
/// The same without names, by which C++ tells overloads apart: "float, const sk::In<float>&, const sk::Out<float>&".
std::string parameterTypes(const ir::Module& module, const ir::Kernel& kernel, Form form, Uniforms uniforms);

}  // namespace skc::emit
