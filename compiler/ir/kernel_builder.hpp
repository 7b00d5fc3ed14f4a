// SPDX-License-Identifier: MIT
//
// For tests: builds kernels from hand-written IR without naming every table twice.
#pragma once

#include <string>
#include <utility>

#include "ir/build.hpp"

namespace skc::ir {

inline constexpr Type floatType = Type::of(Scalar::Float);
inline constexpr Type intType = Type::of(Scalar::Int);

/// A module of one file, "test.sk".
inline Module testModule() {
  Module module;
  module.file = "test.sk";
  module.sources = {"test.sk"};
  return module;
}

inline Loc atLine(std::uint32_t line) { return {.token = line, .line = line, .file = 0}; }

/// A kernel builder: declare parameters, then locals, then call finish(body).
class KernelBuilder {
 public:
  KernelBuilder(Module& module, std::string name, std::uint32_t line = 1) : module_(module) {
    kernel_.name = name;
    kernel_.loc = atLine(line);
    function_.name = std::move(name);
    function_.loc = atLine(line);
  }

  VarId uniform(std::string name, Type type) {
    return param(std::move(name), ParamRole::Uniform, type, VarRole::In);
  }
  VarId iterator(std::string name, Type type) {
    return param(std::move(name), ParamRole::Iterator, type, VarRole::In);
  }
  VarId spec(std::string name, Type type) {
    return param(std::move(name), ParamRole::Spec, type, VarRole::In);
  }
  VarId input(std::string name, Type type) {
    return param(std::move(name), ParamRole::Input, type, VarRole::Element);
  }
  VarId output(std::string name, Type type) {
    return param(std::move(name), ParamRole::Output, type, VarRole::InOut);
  }
  VarId gather(std::string name, Type type, int rank, Boundary boundary = Boundary::Clamp,
               ExprPtr border = nullptr) {
    const VarId var = param(std::move(name), ParamRole::Gather, type, VarRole::Gather);
    function_.variables[var].rank = static_cast<std::uint8_t>(rank);
    kernel_.params[var].rank = static_cast<std::uint8_t>(rank);
    kernel_.params[var].boundary = boundary;
    kernel_.params[var].border = std::move(border);
    return var;
  }
  VarId variableOutput(std::string name, Type type) {
    return param(std::move(name), ParamRole::VariableOutput, type, VarRole::AppendOutput);
  }
  VarId scatterOutput(std::string name, Type type, int rank) {
    const VarId var = param(std::move(name), ParamRole::Scatter, type, VarRole::AppendOutput);
    function_.variables[var].rank = kernel_.params[var].rank = static_cast<std::uint8_t>(rank);
    return var;
  }
  /// Adds an accumulator, which makes the kernel a reduce.
  VarId accumulator(std::string name, Type type, ExprPtr identity = nullptr) {
    const VarId var = param(std::move(name), ParamRole::Accumulator, type, VarRole::InOut);
    kernel_.params[var].identity = std::move(identity);
    kernel_.reduction = Reduction{};
    return var;
  }
  VarId local(std::string name, Type type) { return addVariable(function_, std::move(name), type); }

  ExprPtr ref(VarId var) const { return varRef(function_, var); }
  static StreamRef stream(VarId var) { return {StreamRef::Space::Variable, var}; }
  Kernel& kernel() { return kernel_; }
  Function& function() { return function_; }

  KernelId finish(Block body, std::string signature = "") {
    function_.body = std::move(body);
    kernel_.entry = static_cast<FunctionId>(module_.functions.size());
    kernel_.signature = std::move(signature);
    module_.functions.push_back(std::move(function_));
    module_.kernels.push_back(std::move(kernel_));
    return static_cast<KernelId>(module_.kernels.size() - 1);
  }

 private:
  VarId param(std::string name, ParamRole role, Type type, VarRole varRole) {
    KernelParam param;
    param.name = name;
    param.role = role;
    param.type = type;
    param.loc = kernel_.loc;
    kernel_.params.push_back(std::move(param));
    return addVariable(function_, std::move(name), type, varRole, kernel_.loc);
  }

  Module& module_;
  Kernel kernel_;
  Function function_;
};

/// Adds a helper function to the module, after parameters and locals were added by addVariable.
inline FunctionId addFunction(Module& module, Function function, Block body) {
  function.body = std::move(body);
  module.functions.push_back(std::move(function));
  return static_cast<FunctionId>(module.functions.size() - 1);
}

}  // namespace skc::ir
