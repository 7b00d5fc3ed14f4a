// SPDX-License-Identifier: MIT
//
// Lowers a pass of a pipeline to the function of a kernel. What its calls write is an output of it, or a variable if
// nothing else reads the stream.
#include <map>
#include <vector>

#include "frontend/lower/function_lowering.hpp"
#include "ir/build.hpp"

namespace skc::frontend {

using Kind = PassSource::Parameter::Kind;

ir::Function FunctionLowering::pass(const PassSource& source) {
  function_.name = source.name;
  function_.loc = module_.loc(source.where);
  function_.result = ir::Type::voidType();
  std::map<const clang::VarDecl*, ir::VarId> inputs;
  std::vector<std::pair<const clang::VarDecl*, ir::VarId>> outputs;
  for (const PassSource::Parameter& given : source.parameters) {
    const auto id = static_cast<ir::VarId>(function_.variables.size());
    ir::Variable variable;
    switch (given.kind) {
      case Kind::Declared: {
        const Bundles::Source& declared = given.declared;
        const bool isMember = !declared.member.empty();
        variable = isMember ? parameter(declared.member.back(), given.name)
                            : parameter(declared.parameter, given.name);
        variable.isConst = variable.isConst || isMember;
        if (isMember)
          members_[{declared.parameter, declared.member}] = id;
        else
          variables_[declared.parameter] = id;
        break;
      }
      case Kind::Gather:
        variable = parameter(given.reader, given.name);
        gathers_[{given.stream, given.reader}] = id;
        break;
      case Kind::Input:
      case Kind::Output:
        variable.name = given.name;
        variable.type = module_.type(given.stream->getType().getNonReferenceType().getUnqualifiedType(),
                                     given.stream->getLocation());
        variable.role = given.kind == Kind::Input ? ir::VarRole::Element : ir::VarRole::InOut;
        variable.isConst = given.kind == Kind::Input;
        variable.loc = module_.loc(given.stream->getLocation());
        if (given.kind == Kind::Input)
          inputs[given.stream] = id;
        else
          outputs.emplace_back(given.stream, id);
        break;
    }
    function_.variables.push_back(std::move(variable));
  }
  if (checks_) addFailed();
  function_.parameterCount = static_cast<std::uint32_t>(function_.variables.size());
  ir::Block body;
  out_ = &body;
  const auto inputOf = [&](const clang::VarDecl* stream) {
    const auto input = inputs.find(stream);
    return input == inputs.end() ? nullptr : ir::varRef(function_, input->second, function_.loc);
  };
  for (const auto& [stream, id] : inputs) variables_[stream] = id;
  for (const auto& [stream, id] : outputs) {
    if (ir::ExprPtr input = inputOf(stream))
      body.push_back(ir::assign(ir::varRef(function_, id, function_.loc), std::move(input), function_.loc));
    variables_[stream] = id;
  }
  for (const clang::VarDecl* stream : source.unstored) {
    const auto id = static_cast<ir::VarId>(function_.variables.size());
    ir::Variable variable;
    variable.name = stream->getNameAsString();
    variable.type =
        module_.type(stream->getType().getNonReferenceType().getUnqualifiedType(), stream->getLocation());
    variable.loc = module_.loc(stream->getLocation());
    function_.variables.push_back(std::move(variable));
    emit(function_.loc, ir::Declare{id, inputOf(stream)});
    variables_[stream] = id;
  }
  for (const PassSource::Step& step : source.steps) {
    if (step.value != nullptr)
      variable(step.value);
    else
      discarded(step.call);
  }
  function_.body = std::move(body);
  return std::move(function_);
}

}  // namespace skc::frontend
