// SPDX-License-Identifier: MIT
#include "cpp/kernel_generator.hpp"

#include <algorithm>

#include "cpp/samples.hpp"

namespace fuzz::cpp {
namespace {

constexpr int kernelCost = 3000, kernelSize = 600;
/// What a kernel may take, so that every device runs it in one pass.
constexpr int mostPlanes = 8, mostSpecs = 6;

std::string listed(Unit& unit, const std::vector<Field>& parameters) {
  std::string text;
  for (const Field& field : parameters) text += ", " + declared(unit, field, true);
  return text;
}

std::string kernelHead(const std::string& name, const std::string& others) {
  std::string head(cpp::kernelParameters);
  head.insert(head.find(", out"), others);
  return "kernel void " + name + head;
}

}  // namespace

/// Parameters of a kernel beside the common ones: what the functions need that no kernel calls yet, and others.
std::vector<Field> KernelGenerator::pickParameters(bool isOfAnyRank) {
  std::vector<Field> parameters;
  int planes = 0, specs = 0;
  const auto add = [&](Field field) {
    const bool isThere = std::ranges::any_of(parameters, [&](const Field& other) {
      return types_.isOfStreams(field.type) && other.type == field.type;
    });
    const int more = types_.planes(field.type), moreSpecs = field.isSpec ? 1 : types_.specs(field.type);
    if (isThere || planes + more > mostPlanes || specs + moreSpecs > mostSpecs) return;
    planes += more;
    specs += moreSpecs;
    field.name = "s" + std::to_string(parameters.size());
    if (types_.isGather(field.type)) pickMode(unit_, field);
    parameters.push_back(std::move(field));
  };
  if (!unit_.has("gathers")) return parameters;
  // The rank of a gather tells the instances apart, read or not.
  if (isOfAnyRank) add({.name = {}, .type = types_.gather(random_.pick(streams_.elements), anyRank)});
  for (const Function& function : unit_.functions) {
    if (function.isReached) continue;
    const int rank = isOfAnyRank ? anyRank : random_.between(1, 3);
    if (function.owner >= 0 && types_.isBundle(function.owner))
      add({.name = {}, .type = types_.atRank(function.owner, rank)});
    for (const Parameter& parameter : function.parameters) {
      if (types_.isOfStreams(parameter.type)) add({.name = {}, .type = types_.atRank(parameter.type, rank)});
    }
  }
  const int others = random_.between(0, 3);
  for (int i = 0; i < others; ++i) {
    const Member kind = unit_.with("uniforms", 1, 3) ? Member::Uniform
                        : unit_.with("specs", 1, 3)  ? Member::Spec
                                                     : Member::Gather;
    add(*pickMember(unit_, streams_, kind, isOfAnyRank));
  }
  return parameters;
}

void KernelGenerator::addKernel(int number) {
  const bool isOfAnyRank = unit_.hasAnyRank() && random_.chance(1, 4);
  const std::vector<Field> parameters = pickParameters(isOfAnyRank);
  const bool isTemplate =
      std::ranges::any_of(parameters, [&](const Field& field) { return types_.isOfAnyRank(field.type); });
  Body body(unit_, -1, kernelCost, kernelSize);
  if (isTemplate) body.beOfAnyRank();
  declareKernel(body, parameters);
  NodePtr statements = body.statements(random_.between(2, 6));
  NodePtr list = std::move(statements->children[0]);
  unit_.reach(body.callees());
  for (std::size_t f = unit_.functions.size(); f-- > 0;) {  // later functions call earlier ones
    if (!unit_.functions[f].isReached && body.addCall(*list, unit_.functions[f])) unit_.reach(body.callees());
  }
  body.foldInto(*list);
  const std::string name = "k" + std::to_string(number);
  add(makeStatement((isTemplate ? "template <int N>\n" : "") + kernelHead(name, listed(unit_, parameters)) +
                        " {\nr0 = 0;\nr1 = 0u;\nr2 = 0.0f;\n$}",
                    std::move(list)));
  ++program_.functions;
  if (!isTemplate) {
    if (!parameters.empty()) add(makeStatement(run(name, parameters, random_.between(1, 3))));
    return;
  }
  for (const int rank : {1, 2, random_.between(3, 4)}) {
    std::vector<Field> instance = parameters;
    for (Field& field : instance) field.type = types_.atRank(field.type, rank);
    const std::string text = run(name, instance, rank);
    for (Field& field : instance) field.mode.clear();  // the template says it
    add(makeStatement("template " +
                      kernelHead(name + "<" + std::to_string(rank) + ">", listed(unit_, instance)) + ";\n" +
                      text));
  }
}

/// A kernel that others call.
void KernelGenerator::addInnerKernel() {
  const std::string name = unit_.newName("inner");
  Function function{.name = name};
  for (const Scalar scalar : {Scalar::Int, Scalar::Uint, Scalar::Float})
    function.parameters.push_back({.type = Types::of(scalar)});
  std::vector<Field> parameters;
  const int count = random_.between(0, 2);
  for (int i = 0; i < count; ++i) {
    Field& field = parameters.emplace_back();
    field = {.name = "s" + std::to_string(i), .type = pickStream(unit_, streams_, false)};
    if (types_.isGather(field.type)) pickMode(unit_, field);
    function.parameters.push_back({.type = field.type});
  }
  for (const Scalar scalar : {Scalar::Int, Scalar::Uint, Scalar::Float})
    function.parameters.push_back({.type = Types::of(scalar), .passing = Passing::Reference});
  Body body(unit_, -1, functionCost, functionSize);
  declareKernel(body, parameters);
  NodePtr statements = body.statements(random_.between(1, 4));
  body.finish(std::move(function));
  add(makeStatement(kernelHead(name, listed(unit_, parameters)) + " {\nr0 = a;\nr1 = b;\nr2 = c;\n$\n}",
                    std::move(statements)));
}

void KernelGenerator::declareKernel(Body& body, const std::vector<Field>& parameters) {
  body.declareConstants();
  body.declare("a", Types::of(Scalar::Int), false);
  body.declare("b", Types::of(Scalar::Uint), false);
  body.declare("c", Types::of(Scalar::Float), false);
  for (const Field& field : parameters) {
    Variable& variable = body.declare(field.name, field.type, false);
    variable.isReferable = false;
    variable.isPointer = types_[field.type].kind == Type::Kind::Array;
  }
  body.declare("r0", Types::of(Scalar::Int), true);
  body.declare("r1", Types::of(Scalar::Uint), true);
  body.declare("r2", Types::of(Scalar::Float), true);
  body.beKernel();
}

/// What calls the kernel in C++, for all elements of a domain of a rank.
std::string KernelGenerator::run(const std::string& name, const std::vector<Field>& parameters,
                                 int rank) const {
  const std::string number = std::to_string(rank);
  std::string text = "#ifndef __SKC__\nextern \"C\" void run_" + name.substr(0, name.find('<')) + "_rank" +
                     number + "(SK_RUN_PARAMETERS) {\n",
              given, values;
  for (const Field& field : parameters) {
    text += types_.declare(field.type, field.name) + ";\n";
    values += bindings(types_, field);
    given += ", " + field.name;
  }
  return text + values + "SK_RUN(" + number + ", " + name + "(a[i], b[i], c[i]" + given +
         ", r0[i], r1[i], r2[i]))\n}\n#endif";
}

}  // namespace fuzz::cpp
