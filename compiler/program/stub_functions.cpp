// SPDX-License-Identifier: MIT
//
// The callables' functions in FILE.sk.cpp, which pass their arguments to the runtime.
#include <algorithm>

#include <fmt/format.h>

#include "ir/print.hpp"
#include "program/constants.hpp"
#include "program/stub_parts.hpp"
#include "support/namer.hpp"
#include "support/text.hpp"

namespace skc::emit {
namespace {

using namespace ir;

class FunctionWriter {
 public:
  FunctionWriter(const Module& module, const Program& program)
      : module_(module), program_(program), names_(constantNames(module, program)) {}

  std::string text(const std::vector<Callable>& callables) {
    for (const Callable& callable : callables) {
      for (std::size_t unit : callable.units) {
        for (Form form : formsOf(kernelOf(unit))) {
          for (Uniforms uniforms : uniformsOf(kernelOf(unit))) function(callable, unit, form, uniforms);
        }
      }
    }
    return std::move(text_);
  }

 private:
  void function(const Callable& callable, std::size_t unit, Form form, Uniforms uniforms) {
    const Kernel& kernel = kernelOf(unit);
    const std::string head = fmt::format("{} {}{}::operator()(", resultType(module_, kernel, form, {}),
                                         qualifier(callable.scope), callable.type);
    text_ += "\n" +
             wrapLine(head + parameterList(module_, kernel, form, uniforms, {}) + " {", 100, head.size()) +
             "\n";
    switch (form) {
      case Form::Run: run(kernel, unit, uniforms); break;
      case Form::ReduceToValue: reduceToValue(kernel, unit, uniforms); break;
      case Form::ReduceToStream:
      case Form::Scan:
      case Form::Fold:
        text_ += fmt::format("  sk::{}(sk::program::{}, {}, this->options);\n",
                             form == Form::Fold ? "fold" : wordOf(kernel), names_[unit] + Part::Reduction,
                             arguments(kernel, form, uniforms));
    }
    text_ += "}\n";
  }

  void run(const Kernel& kernel, std::size_t unit, Uniforms uniforms) {
    text_ += fmt::format("  sk::run(sk::program::{}, {}, this->options);\n", names_[unit] + Part::Kernel,
                         arguments(kernel, Form::Run, uniforms));
  }

  /// Writes the array of arguments, and returns its name.
  std::string arguments(const Kernel& kernel, Form form, Uniforms uniforms) {
    std::vector<std::string> items;
    for (const auto& [param, bundle] : cppParameters(kernel)) {
      if (bundle != nullptr) {
        for (std::uint32_t i = 0; i < bundle->count; ++i)
          items.push_back(kernel.params[bundle->first + i].name + ".argument()");
        continue;
      }
      const bool isReturned = param->role == ParamRole::Accumulator && form == Form::ReduceToValue;
      items.push_back(isReturned ? "{}" : argument(kernel, *param, uniforms));
    }
    const std::string list = localName(kernel, "arguments");
    const std::string head = fmt::format("  const sk::Argument {}[] = {{", list);
    text_ += wrapLine(head + join(items, ", ") + "};", 100, head.size()) + "\n";
    return list;
  }

  static std::string argument(const Kernel& kernel, const KernelParam& param, Uniforms uniforms) {
    const std::string name = cppName(kernel, param);
    if (param.role == ParamRole::Iterator) return fmt::format("sk::argumentOf({})", name);
    if (param.type.kind == Type::Kind::Array) return fmt::format("{{.value = {}.data()}}", name);
    const bool isValue = param.role == ParamRole::Uniform && uniforms == Uniforms::Values;
    if (isValue || param.role == ParamRole::Spec) {
      return fmt::format("{{.value = &{}}}", name);
    }
    return name + ".argument()";
  }

  void reduceToValue(const Kernel& kernel, std::size_t unit, Uniforms uniforms) {
    const auto count =
        std::count_if(kernel.params.begin(), kernel.params.end(),
                      [](const KernelParam& param) { return param.role == ParamRole::Accumulator; });
    const std::string value = localName(kernel, "value");
    std::vector<std::string> places;
    for (std::ptrdiff_t i = 0; i < count; ++i) {
      places.push_back(count == 1 ? "&" + value : fmt::format("&std::get<{}>({})", i, value));
    }
    text_ += fmt::format("  {} {};\n", resultType(module_, kernel, Form::ReduceToValue, {}), value);
    const std::string list = arguments(kernel, Form::ReduceToValue, uniforms);
    const std::string results = localName(kernel, "results");
    const std::string head = fmt::format("  void* const {}[] = {{", results);
    text_ += wrapLine(head + join(places, ", ") + "};", 100, head.size()) + "\n";
    text_ += fmt::format("  sk::reduce(sk::program::{}, {}, {}, this->options);\n  return {};\n",
                         names_[unit] + Part::Reduction, list, results, value);
  }

  /// A name for a local variable that differs from all parameters.
  static std::string localName(const Kernel& kernel, std::string name) {
    Namer names;
    for (const auto& [param, bundle] : cppParameters(kernel))
      names.reserve(bundle != nullptr ? bundle->name : cppName(kernel, *param));
    return names.take(std::move(name));
  }

  const Kernel& kernelOf(std::size_t unit) const { return module_.kernels[program_.units()[unit].id]; }

  const Module& module_;
  const Program& program_;
  std::vector<std::string> names_;
  std::string text_;
};

}  // namespace

std::string stubFunctions(const Module& module, const Program& program,
                          const std::vector<Callable>& callables) {
  return FunctionWriter(module, program).text(callables);
}

}  // namespace skc::emit
