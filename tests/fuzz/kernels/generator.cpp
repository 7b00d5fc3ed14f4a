// SPDX-License-Identifier: MIT
//
// Makes a random kernel: structs, constants, helper functions, parameters, and a body.
#include <algorithm>

#include <fmt/format.h>

#include "kernels/kernels.hpp"
#include "kernels/statements.hpp"

namespace fuzz {
namespace {

/// The number of texels in a layer on a device whose textures are limited to 64 x 64.
constexpr std::int64_t fewTexels = 64 * 64;

}  // namespace

class RandomKernel::Generator {
 public:
  Generator(RandomKernel& kernel, Random& random) : kernel_(kernel), random_(random) {}

  void make() {
    scope_.records = &kernel_.records_;
    makeRecords();
    makeConstants();
    for (int left = random_.between(0, 2); left > 0; --left) makeHelper();
    makeDomain();
    makeParameters();
    makeBody();
    kernel_.slots_ = names_.slots;
  }

 private:
  Records& records() { return kernel_.records_; }
  std::string& text() { return kernel_.text_; }

  void makeRecords() {
    for (int left = random_.between(0, 2); left > 0; --left) {
      Record record{names_.fresh("S"), {}};
      int components = 0;
      for (int members = random_.between(1, 4); members > 0; --members) {
        const Type type = randomVector(random_);
        if (components + type.width > 16) break;
        components += type.width;
        record.members.push_back({names_.fresh("m"), type});
      }
      text() += fmt::format("struct {} {{\n", record.name);
      for (const Record::Member& member : record.members) {
        text() += fmt::format("  {} {};\n", spelling({}, member.type), member.name);
      }
      text() += "};\n";
      records().push_back(record);
    }
  }

  void makeConstants() {
    for (int left = random_.between(0, 2); left > 0; --left) {
      static constexpr Scalar scalars[] = {Scalar::Bool, Scalar::Int, Scalar::Uint, Scalar::Float};
      const Type type{random_.pick(scalars), random_.between(1, 4)};
      const int length = random_.chance(1, 2) ? random_.between(1, 5) : 0;
      const Variable variable{names_.fresh("c"), type, names_.take(std::max(length, 1)), length, false};
      std::string values;
      for (int i = 0; i < std::max(length, 1); ++i) {
        const Value value = randomValue({}, type, random_);
        kernel_.constants_.emplace_back(variable.slot + i, value);
        values += (i == 0 ? "" : ", ") + literal(type, value);
      }
      const std::string name = length == 0 ? variable.name : fmt::format("{}[{}]", variable.name, length);
      text() += fmt::format("{} {} {} = {};\n", type.width == 1 ? "constexpr" : "const", spelling({}, type),
                            name, length == 0 ? values : "{" + values + "}");
      scope_.variables.push_back(variable);
    }
  }

  /// Makes a helper function, which ends with a return.
  void makeHelper() {
    static constexpr Scalar scalars[] = {Scalar::Bool, Scalar::Int, Scalar::Uint, Scalar::Float};
    Function function{names_.fresh("f"), {random_.pick(scalars), random_.between(1, 4)}, {}, {}};
    Scope scope{&records(), scope_.variables, {}, scope_.functions, {}};
    std::string parameters;
    for (int left = random_.between(1, 3); left > 0; --left) {
      const Type type = randomType(records(), random_);
      const Variable parameter{names_.fresh("p"), type, names_.take(1), 0, true};
      parameters += (parameters.empty() ? "" : ", ") + spelling(records(), type) + " " + parameter.name;
      function.parameters.push_back(parameter);
      scope.variables.push_back(parameter);
    }
    Statements statements(scope, names_, random_, false);
    const Statement body = statements.block(random_.between(0, 4), 2, "  ");
    Expressions expressions(scope, random_);
    const Expr result = expressions.makeKept(function.result, 3);
    text() += fmt::format("{} {}({}) {{\n{}", spelling(records(), function.result), function.name, parameters,
                          body.text);
    std::function<Value(Frame&)> early, condition;
    if (random_.chance(1, 3)) {
      const Expr test = expressions.condition(2), value = expressions.makeKept(function.result, 2);
      text() += fmt::format("  if ({}) return {};\n", test.text, value.text);
      condition = test.value;
      early = value.value;
    }
    text() += fmt::format("  return {};\n}}\n", result.text);
    function.call = [run = body.run, condition, early, value = result.value](Frame& frame) {
      run(frame);
      if (condition && condition(frame).bits[0] != 0) return early(frame);
      return value(frame);
    };
    scope_.functions.push_back(function);
  }

  void makeDomain() {
    static const std::vector<std::vector<std::int64_t>> domains = {
        {1}, {7}, {130}, {61, 3}, {61, 3}, {1, 17}, {5, 9}, {4, 70}, {0}, {3, 5, 7}};
    kernel_.domain_ = random_.pick(domains);
  }

  // ---- parameters -------------------------------------------------------------------------------

  void makeParameters() {
    // Some kernels are too large for one pass, others have append outputs; kernels with those are never split.
    const bool hasAppendOutputs = random_.chance(1, 4), isLarge = !hasAppendOutputs && random_.chance(1, 3);
    const auto streamType = [&] {
      return hasAppendOutputs ? randomVector(random_) : randomType(records(), random_);
    };
    std::vector<Role> roles;
    const auto add = [&](Role role, int least, int most) {
      roles.insert(roles.end(), static_cast<std::size_t>(random_.between(least, most)), role);
    };
    add(Role::Uniform, 0, 4);
    add(Role::Spec, 0, random_.between(0, 2));
    add(Role::Input, isLarge ? 3 : 1, isLarge ? 8 : 4);
    add(Role::Gather, 0, 3);
    add(Role::Iterator, 0, random_.between(0, 1));
    add(Role::Output, isLarge ? 4 : 1, isLarge ? 9 : hasAppendOutputs ? 2 : 4);
    if (hasAppendOutputs) add(random_.chance(1, 2) ? Role::VariableOutput : Role::Scatter, 1, 2);
    std::string list;
    for (const Role role : roles) {
      const std::size_t before = kernel_.parameters_.size();
      const std::string declared = makeParameter(role, streamType());
      if (kernel_.parameters_.size() > before) list += (list.empty() ? "" : ",\n              ") + declared;
    }
    text() += fmt::format("kernel void k({}) {{\n", list);
  }

  /// Adds a parameter and returns its declaration. `type` is the type of its elements, if it has any.
  std::string makeParameter(Role role, const Type& type) {
    kernel_.streams_.emplace_back();
    switch (role) {
      case Role::Spec: return makeSpec();
      case Role::Input: return makeInput(type);
      case Role::Gather: return makeGather();
      case Role::Iterator: return makeIterator();
      case Role::Output: {
        const Variable& variable = addParameter(role, "r", type, 0);
        scope_.variables.back().isWritable = true;
        scope_.indexed.push_back(variable.name);
        return fmt::format("out {} {}<>", spelling(records(), variable.type), variable.name);
      }
      case Role::VariableOutput: return makeVariableOutput(type);
      case Role::Scatter: return makeScatter(type);
      default: return makeUniform();
    }
  }

  const Variable& addParameter(Role role, const char* kind, const Type& type, int length) {
    const Variable variable{names_.fresh(kind), type, names_.take(std::max(length, 1)), length, false};
    kernel_.parameters_.push_back({role, variable, {}});
    scope_.variables.push_back(variable);
    return kernel_.parameters_.back().variable;
  }

  std::string makeUniform() {
    const int length = random_.chance(1, 3) ? random_.between(1, 5) : 0;
    const Variable variable = addParameter(Role::Uniform, "u", randomType(records(), random_), length);
    for (int i = 0; i < std::max(length, 1); ++i) {
      kernel_.parameters_.back().values.push_back(randomValue(records(), variable.type, random_));
    }
    const std::string declared = spelling(records(), variable.type) + " " + variable.name;
    return length == 0 ? declared : fmt::format("{}[{}]", declared, length);
  }

  std::string makeSpec() {
    static constexpr Scalar scalars[] = {Scalar::Bool, Scalar::Int, Scalar::Uint, Scalar::Float};
    const Variable variable = addParameter(Role::Spec, "k", {random_.pick(scalars), 1}, 0);
    kernel_.parameters_.back().values = {randomValue({}, variable.type, random_)};
    return fmt::format("spec {} {}", spelling({}, variable.type), variable.name);
  }

  std::string makeInput(const Type& type) {
    const Variable variable = addParameter(Role::Input, "x", type, 0);
    std::vector<std::int64_t> shape = kernel_.domain_;
    bool isRepeated = false;
    for (std::int64_t& extent : shape) {
      if (extent != 0 && random_.chance(1, 8)) extent = 1, isRepeated = true;
    }
    fill(variable.type, shape);
    if (!isRepeated) scope_.indexed.push_back(variable.name);
    return fmt::format("{} {}<>", spelling(records(), variable.type), variable.name);
  }

  std::string makeGather() {
    Gather gather{names_.fresh("g"),
                  randomVector(random_),
                  random_.between(1, 2),
                  static_cast<int>(kernel_.streams_.size()) - 1,
                  {},
                  {},
                  false};
    gather.hasNeighbors = gather.rank == static_cast<int>(kernel_.domain_.size());
    gather.boundary = static_cast<sk::program::Boundary>(random_.below(4));
    const Type arithmetic{arithmeticScalar(gather.type.scalar), gather.type.width};
    std::string attribute;
    switch (gather.boundary) {
      case sk::program::Boundary::Clamp: attribute = random_.chance(1, 2) ? "[[clamp]] " : ""; break;
      case sk::program::Boundary::Wrap: attribute = "[[wrap]] "; break;
      case sk::program::Boundary::Mirror: attribute = "[[mirror]] "; break;
      case sk::program::Boundary::Border:
        gather.border = randomValue({}, gather.type, random_);
        if (isNormalized(gather.type.scalar)) gather.border = {};
        attribute = literal(arithmetic, gather.border);
        if (isNarrow(gather.type.scalar))
          attribute = fmt::format("{}({})", spelling({}, gather.type), attribute);
        attribute = fmt::format("[[border({})]] ", attribute);
        break;
    }
    std::vector<std::int64_t> shape;
    for (int d = 0; d < gather.rank; ++d) shape.push_back(random_.between(1, 80));
    if (gather.rank == 2) shape[1] = std::min(shape[1], fewTexels / shape[0]);
    kernel_.parameters_.push_back({Role::Gather, {gather.name, gather.type, 0, 0, false}, {}});
    fill(gather.type, shape);
    scope_.gathers.push_back(gather);
    return fmt::format("{}{} {}{}", attribute, spelling({}, gather.type), gather.name,
                       gather.rank == 1 ? "[]" : "[][]");
  }

  std::string makeIterator() {
    static constexpr Scalar scalars[] = {Scalar::Int, Scalar::Uint, Scalar::Float};
    const bool isVector = random_.chance(1, 2);
    const int rank = static_cast<int>(kernel_.domain_.size());
    const int width = !isVector ? 1 : rank == 1 ? random_.between(2, 4) : rank;
    const Variable variable = addParameter(Role::Iterator, "i", {random_.pick(scalars), width}, 0);
    Value begin, step;
    for (int i = 0; i < width; ++i) {
      if (variable.type.scalar == Scalar::Float) {  // small enough that the last value is within `kept`
        begin.set(i, static_cast<float>(random_.between(-16, 16)) / 16);
        step.set(i, static_cast<float>(random_.between(-3, 3)) / 16);
      } else {
        begin.set(i, static_cast<std::uint32_t>(random_.between(0, 1000)));
        step.set(i, static_cast<std::uint32_t>(random_.between(0, 5)));
      }
    }
    kernel_.parameters_.back().values = {begin, step};
    scope_.indexed.push_back(variable.name);
    return fmt::format("iter {} {}<>", spelling({}, variable.type), variable.name);
  }

  std::string makeVariableOutput(const Type& type) {
    const AppendOutput output{names_.fresh("o"), type, static_cast<int>(kernel_.streams_.size()) - 1};
    kernel_.parameters_.push_back({Role::VariableOutput, {output.name, type, 0, 0, false}, {}});
    kernel_.streams_.back() = {type, {0}, {}};
    appendOutputs_.push_back(output);
    return fmt::format("vout {} {}<>", spelling(records(), type), output.name);
  }

  std::string makeScatter(const Type& type) {
    const AppendOutput output{names_.fresh("o"), type, static_cast<int>(kernel_.streams_.size()) - 1,
                              random_.between(1, 2), randomScatterOp(type, random_)};
    kernel_.parameters_.push_back({Role::Scatter, {output.name, type, 0, 0, false}, {}});
    std::vector<std::int64_t> shape;
    for (int d = 0; d < output.rank; ++d) shape.push_back(random_.between(leastScattered, 40));
    fill(type, shape);
    appendOutputs_.push_back(output);
    return fmt::format("out {} {}{}", spelling(records(), type), output.name,
                       output.rank == 1 ? "[]" : "[][]");
  }

  void fill(const Type& type, const std::vector<std::int64_t>& shape) {
    HostStream& stream = kernel_.streams_.back();
    stream = {type, shape, {}};
    std::int64_t size = 1;
    for (const std::int64_t extent : shape) size *= extent;
    for (std::int64_t i = 0; i < size; ++i) stream.elements.push_back(randomValue(records(), type, random_));
  }

  // ---- the body ---------------------------------------------------------------------------------

  void makeBody() {
    // First writes every output, by expressions that read no output. The rest then changes them.
    Statements statements(scope_, names_, random_, true, appendOutputs_);
    std::vector<std::function<Flow(Frame&)>> parts;
    const std::vector<Variable> all = scope_.variables;
    std::erase_if(scope_.variables, [](const Variable& variable) { return variable.isWritable; });
    for (const Variable& variable : all) {
      if (!variable.isWritable) continue;
      Expressions expressions(scope_, random_);
      const Expr value = expressions.makeKept(variable.type, 3);
      const Place place{variable.type, variable.name,
                        [slot = variable.slot](Frame&) {
                          Where where{slot, {}};
                          for (std::size_t i = 0; i < 16; ++i)
                            where.components[i] = static_cast<std::uint8_t>(i);
                          return where;
                        },
                        true};
      const Statement one = statements.assignTo(place, value, "  ");
      text() += one.text;
      parts.push_back(one.run);
      scope_.variables.push_back(variable);
    }
    const Statement rest = statements.block(random_.between(2, 8), 3, "  ");
    text() += rest.text + "}\n";
    parts.push_back(rest.run);
    kernel_.body_ = [parts](Frame& frame) {
      for (const auto& part : parts) {
        if (part(frame) == Flow::Return) return Flow::Return;
      }
      return Flow::Next;
    };
  }

  RandomKernel& kernel_;
  Random& random_;
  Names names_;
  Scope scope_;
  std::vector<AppendOutput> appendOutputs_;
};

RandomKernel::RandomKernel(std::uint64_t seed, std::uint64_t number) {
  Random random(seed, number);
  Generator(*this, random).make();
}

}  // namespace fuzz
