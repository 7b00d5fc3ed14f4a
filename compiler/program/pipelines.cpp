// SPDX-License-Identifier: MIT
//
// Prints the descriptors of pipelines, which refer to those of their kernels.
#include <string>
#include <vector>

#include <fmt/format.h>

#include "ir/print.hpp"
#include "program/constants.hpp"
#include "program/cpp_literals.hpp"
#include "program/schema.hpp"
#include "program/stub_parts.hpp"

namespace skc::emit {

using namespace ir;

namespace {

std::string roleText(ParamRole role) {
  std::string name(nameOf(static_cast<sk::program::Role>(role)));
  name.front() = static_cast<char>(name.front() - 'a' + 'A');
  return "Role::" + name;
}

/// The number of the unit that describes a kernel.
std::size_t unitOf(const Program& program, KernelId id) {
  std::size_t unit = 0;
  while (program.units()[unit].id != id) ++unit;
  return unit;
}

}  // namespace

std::string pipelineName(std::size_t number) { return fmt::format("sk_pipeline_{}", number + 1); }

std::string pipelineConstants(const Module& module, const Program& program,
                              const std::vector<std::string>& names) {
  std::string text;
  for (std::size_t number = 0; number < module.pipelines.size(); ++number) {
    const Pipeline& pipeline = module.pipelines[number];
    if (pipeline.isKernel) continue;
    const std::string name = pipelineName(number);
    std::vector<std::string> parameters, locals, passes;
    for (const KernelParam& param : pipeline.face.params)
      parameters.push_back(fmt::format("{{{}, {}}}", emit::quoted(param.name), roleText(param.role)));
    for (const LocalStream& local : pipeline.locals) locals.push_back(emit::quoted(local.name));
    for (std::size_t i = 0; i < pipeline.passes.size(); ++i) {
      const PipelinePass& pass = pipeline.passes[i];
      std::vector<std::string> operands;
      for (const PassOperand& operand : pass.operands)
        operands.push_back(fmt::format("{{{}, {}}}", operand.isTemporary, operand.index));
      const std::string list = fmt::format("{}_operands_{}", name, i + 1);
      text += constantList("PassOperand", list, operands);
      const std::size_t unit = unitOf(program, pass.kernel);
      const bool folds = program.units()[unit].reduction != nullptr;
      passes.push_back(fmt::format(
          "{{{}, {}, {}, {}, {}}}",
          folds ? fmt::format("&{}.fold", names[unit] + Part::Reduction) : "&" + (names[unit] + Part::Kernel),
          folds ? "&" + (names[unit] + Part::Reduction) : "nullptr", program.units()[unit].isScan,
          pass.isOverDomain, list));
    }
    text += constantList("PipelineParameter", name + "_parameters", parameters);
    text += constantList("std::string_view", name + "_locals", locals);
    text += constantList("PipelinePass", name + "_passes", passes);
    text += fmt::format("constexpr Pipeline {0} = {{{1}, {0}_parameters, {2}, {0}_passes}};\n\n", name,
                        emit::quoted(qualifier(pipeline.face.scope) + pipeline.face.name),
                        locals.empty() ? "{}" : name + "_locals");
  }
  return text;
}

}  // namespace skc::emit
