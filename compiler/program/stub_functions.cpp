// SPDX-License-Identifier: MIT
//
// The callables' functions in FILE.sk.cpp, which pass their arguments to the runtime.
#include <algorithm>
#include <optional>
#include <span>

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
      for (const SameFunction& same : sameFunctions(module_, overloadsOf(module_, callable))) {
        const Kernel& first = *same.kernels.front();
        for (Form form : formsOf(first)) {
          for (Uniforms uniforms : uniformsOf(first)) function(callable, same, form, uniforms);
        }
      }
    }
    return std::move(text_);
  }

 private:
  void function(const Callable& callable, const SameFunction& same, Form form, Uniforms uniforms) {
    const Kernel& kernel = *same.kernels.front();
    const std::string head = fmt::format("{} {}{}::operator()(", resultType(module_, kernel, form, {}),
                                         qualifier(callable.scope), callable.type);
    text_ += "\n" +
             wrapLine(head + parameterList(module_, kernel, form, uniforms, {}) + " {", 100, head.size()) +
             "\n";
    same.choosers.empty() ? call(kernel, form, uniforms) : choose(same, form, uniforms);
    text_ += "}\n";
  }

  void call(const Kernel& kernel, Form form, Uniforms uniforms) {
    for (const BundleParam& bundle : kernel.bundles) {
      if (bundle.count == 0)
        text_ += fmt::format("  static_cast<void>({});  // nothing of it is read\n", bundle.name);
    }
    if (const std::optional<std::size_t> pipeline = pipelineOf(kernel)) {
      text_ += fmt::format("  sk::run(sk::program::{}, {}, this->options);\n", pipelineName(*pipeline),
                           arguments(kernel, form, uniforms));
      return;
    }
    const std::string& name = nameOf(kernel);
    switch (form) {
      case Form::Run: run(kernel, name, uniforms); break;
      case Form::ReduceToValue: reduceToValue(kernel, name, uniforms); break;
      case Form::ReduceToStream:
      case Form::Scan:
      case Form::Fold:
        text_ += fmt::format("  sk::{}(sk::program::{}, {}, this->options);\n",
                             form == Form::Fold ? "fold" : wordOf(kernel), name + Part::Reduction,
                             arguments(kernel, form, uniforms));
    }
  }

  /// Calls the kernel whose gather has the rank of its argument.
  void choose(const SameFunction& same, Form form, Uniforms uniforms) {
    const Kernel& first = *same.kernels.front();
    const std::string rank = localName(first, "rank");
    const std::string& chooser = same.choosers.front()->name;
    text_ += fmt::format("  int {} = sk::detail::rankOf({}.argument());\n", rank, chooser);
    for (const KernelParam* other : std::span(same.choosers).subspan(1))
      text_ += fmt::format("  if ({0} == 0) {0} = sk::detail::rankOf({1}.argument());\n", rank, other->name);
    std::vector<std::string> ranks;
    for (const Kernel* kernel : same.kernels) {
      const auto gather = std::ranges::find(kernel->params, chooser, &KernelParam::name);
      ranks.push_back(std::to_string(gather->rank));
      text_ += fmt::format("  if ({} == {}) {{\n", rank, ranks.back());
      const std::size_t begin = text_.size();
      call(*kernel, form, uniforms);
      for (std::size_t at = begin; at < text_.size(); at = text_.find('\n', at) + 1) {
        text_.insert(at, "  ");
        if (text_.find('\n', at) == std::string::npos) break;
      }
      if (form != Form::ReduceToValue) text_ += "    return;\n";
      text_ += "  }\n";
    }
    text_ += fmt::format("  sk::detail::refuseRank(\"{}\", \"{}\", {}, \"{}\");\n", first.name, chooser, rank,
                         join(ranks, " or "));
  }

  void run(const Kernel& kernel, const std::string& name, Uniforms uniforms) {
    text_ += fmt::format("  sk::run(sk::program::{}, {}, this->options);\n", name + Part::Kernel,
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

  void reduceToValue(const Kernel& kernel, const std::string& name, Uniforms uniforms) {
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
                         name + Part::Reduction, list, results, value);
  }

  /// A name for a local variable that differs from all parameters.
  static std::string localName(const Kernel& kernel, std::string name) {
    Namer names;
    for (const auto& [param, bundle] : cppParameters(kernel))
      names.reserve(bundle != nullptr ? bundle->name : cppName(kernel, *param));
    return names.take(std::move(name));
  }

  /// The pipeline that has this face.
  std::optional<std::size_t> pipelineOf(const Kernel& kernel) const {
    for (std::size_t i = 0; i < module_.pipelines.size(); ++i) {
      if (&module_.pipelines[i].face == &kernel) return i;
    }
    return std::nullopt;
  }

  /// The prefix of the constants that describe a kernel.
  const std::string& nameOf(const Kernel& kernel) const {
    std::size_t unit = 0;
    while (&kernelOf(unit) != &kernel) ++unit;
    return names_[unit];
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
