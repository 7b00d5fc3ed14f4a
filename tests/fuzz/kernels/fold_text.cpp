// SPDX-License-Identifier: MIT
#include "kernels/fold_text.hpp"

#include <algorithm>
#include <bit>
#include <limits>
#include <string_view>

#include <fmt/format.h>

namespace fuzz {
namespace {

std::int32_t asInt(std::uint32_t word) { return static_cast<std::int32_t>(word); }
float asFloat(std::uint32_t word) { return std::bit_cast<float>(word); }
std::uint32_t wordOf(float value) { return std::bit_cast<std::uint32_t>(value); }

std::string_view nameOf(Scalar scalar) {
  return scalar == Scalar::Int ? "int" : scalar == Scalar::Uint ? "uint" : "float";
}

// ---- operators -------------------------------------------------------------------------------------

/// An operator that accumulators are folded by. `{0}` is the accumulator, `{1}` what is folded into it. An identity
/// without a text is one that skc supplies.
struct Operator {
  std::string_view text;
  struct Identity {
    std::string_view text;
    std::uint32_t word;
  };
  Identity ofInt, ofUint, ofFloat;
  std::uint32_t (*apply)(std::uint32_t, std::uint32_t, Scalar);
  bool foldsFloats = false;

  const Identity& identity(Scalar scalar) const {
    return scalar == Scalar::Int ? ofInt : scalar == Scalar::Uint ? ofUint : ofFloat;
  }
};

constexpr std::uint32_t top = 0x80000000u, infinity = 0x7f800000u;
constexpr Operator::Identity zero{"0", 0}, unsignedZero{"0u", 0}, none{"", 0};
constexpr Operator operators[] = {
    {"{0} += {1}",
     zero,
     unsignedZero,
     {"0.0f", 0},
     [](std::uint32_t a, std::uint32_t b, Scalar scalar) {
       return scalar == Scalar::Float ? wordOf(asFloat(a) + asFloat(b)) : a + b;
     },
     true},
    {"{0} = max({0}, {1})",
     {"-2147483647 - 1", top},
     unsignedZero,
     {"", infinity | top},
     [](std::uint32_t a, std::uint32_t b, Scalar scalar) {
       if (scalar == Scalar::Float) return asFloat(a) < asFloat(b) ? b : a;
       return scalar == Scalar::Int ? (asInt(a) < asInt(b) ? b : a) : std::max(a, b);
     },
     true},
    {"{0} = min({0}, {1})",
     {"2147483647", ~top},
     {"4294967295u", ~0u},
     {"", infinity},
     [](std::uint32_t a, std::uint32_t b, Scalar scalar) {
       if (scalar == Scalar::Float) return asFloat(b) < asFloat(a) ? b : a;
       return scalar == Scalar::Int ? (asInt(b) < asInt(a) ? b : a) : std::min(a, b);
     },
     true},
    {"{0} *= {1}", {"1", 1}, {"1u", 1}, none, [](std::uint32_t a, std::uint32_t b, Scalar) { return a * b; }},
    {"{0} ^= {1}", zero, unsignedZero, none, [](std::uint32_t a, std::uint32_t b, Scalar) { return a ^ b; }},
    {"{0} |= {1}", zero, unsignedZero, none, [](std::uint32_t a, std::uint32_t b, Scalar) { return a | b; }},
    {"{0} &= {1}",
     {"-1", ~0u},
     {"4294967295u", ~0u},
     none,
     [](std::uint32_t a, std::uint32_t b, Scalar) { return a & b; }},
};

// ---- operands --------------------------------------------------------------------------------------

/// What an element has: its inputs as integers, and the rest.
struct Operands {
  std::uint32_t a = 0, b = 0, factor = 0, index = 0, looked = 0, output = 0;
  std::uint32_t x = 0, y = 0;  ///< the inputs as they are
};

/// What is folded. `{0}` is the accumulator's type, `{1}` and `{2}` are the inputs as ints.
struct Term {
  std::string_view text;
  std::uint32_t (*value)(const Operands&);
};

constexpr Term integers[] = {
    {"{0}({1})", [](const Operands& o) { return o.a; }},
    {"{0}({2})", [](const Operands& o) { return o.b; }},
    {"{0}({1}) * {0}({2})", [](const Operands& o) { return o.a * o.b; }},
    {"({0}({1}) ^ {0}(c))", [](const Operands& o) { return o.a ^ o.factor; }},
    {"({0}({2}) + {0}(indexof(x0).x))", [](const Operands& o) { return o.b + o.index; }},
    {"{0}(g[{2} & 15])", [](const Operands& o) { return o.looked; }},
    {"{0}(3)", [](const Operands&) { return 3u; }},
};
constexpr Term ofOutput{"({0}(o0) - {0}({1}))", [](const Operands& o) { return o.output - o.a; }};

/// Whole numbers from -7 to 8, halved.
float smallOf(std::uint32_t word) { return static_cast<float>(asInt(word & 15) - 7) * 0.5f; }
constexpr Term floats[] = {
    {"(float(({1} & 15) - 7) * 0.5f)", [](const Operands& o) { return wordOf(smallOf(o.a)); }},
    {"(float(({1} & 15) - 7) * 0.5f) * (float(({2} & 15) - 7) * 0.5f)",
     [](const Operands& o) { return wordOf(smallOf(o.a) * smallOf(o.b)); }},
    {"float(({2} & 15) - 7) * 0.5f + float(g[{1} & 15] & 7)",
     [](const Operands& o) { return wordOf(smallOf(o.b) + static_cast<float>(o.looked & 7)); }},
};
/// Terms of inputs that are floats themselves.
constexpr Term ofX{"x0", [](const Operands& o) { return o.x; }};
constexpr Term ofProduct{"x0 * x1", [](const Operands& o) { return wordOf(asFloat(o.x) * asFloat(o.y)); }};

struct Condition {
  std::string_view text;
  bool (*holds)(const Operands&);
};
constexpr Condition conditions[] = {
    {"({1} & 3) != 0", [](const Operands& o) { return (o.a & 3) != 0; }},
    {"{1} < {2}", [](const Operands& o) { return asInt(o.a) < asInt(o.b); }},
    {"indexof(x0).x % 5 == 2", [](const Operands& o) { return o.index % 5 == 2; }},
};

std::uint32_t integerOf(Scalar scalar, std::uint32_t word) {
  return scalar == Scalar::Float ? static_cast<std::uint32_t>(static_cast<std::int32_t>(asFloat(word)))
                                 : word;
}

// ---- programs --------------------------------------------------------------------------------------

Scalar randomScalar(Random& random) {
  static constexpr Scalar scalars[] = {Scalar::Int, Scalar::Uint, Scalar::Float};
  return random.pick(scalars);
}
Scalar randomInteger(Random& random) { return random.chance(1, 2) ? Scalar::Int : Scalar::Uint; }

/// One to three accumulators that each fold terms by an operator, once or twice, under conditions and in loops.
class OperatorFold {
 public:
  OperatorFold(FoldText& made, Random& random) : made_(made), random_(random) {}

  void make() {
    made_.takesUniforms = true;
    made_.inputs = {randomScalar(random_), randomScalar(random_)};
    made_.accumulatorIsRecord = random_.chance(1, 3);
    for (std::size_t i = 0; i < 2; ++i) {
      integers_[i] = fmt::format("int(x{})", i);
      if (!random_.chance(1, 3)) continue;
      body_ += fmt::format("  int a{0} = int(x{0});\n", i);
      integers_[i] = fmt::format("a{}", i);
    }
    const int outputs = made_.kind == FoldKind::Kernel ? random_.between(1, 2) : 0;
    for (int i = 0; i < outputs; ++i) addOutput();
    for (int left = random_.between(1, 3); left > 0; --left) addAccumulator();
    addSteps();
    made_.text = text();
    made_.fold = [steps = steps_, inputs = made_.inputs](Words& accumulators, FoldText::Element& element) {
      Operands operands{.a = integerOf(inputs[0], element.inputs[0]),
                        .b = integerOf(inputs[1], element.inputs[1]),
                        .factor = element.factor,
                        .index = element.index,
                        .x = element.inputs[0],
                        .y = element.inputs[1]};
      for (const Step& step : steps) {
        operands.looked = element.table[(step.looksUpA ? operands.a : operands.b) & 15];
        operands.output = element.outputs.empty() ? 0 : element.outputs[0];
        if (step.condition != nullptr && !step.condition->holds(operands)) continue;
        Words& target = step.isOutput ? element.outputs : accumulators;
        for (std::uint32_t i = 0; i < (step.isCounted ? operands.a & 3 : 1); ++i) {
          const std::uint32_t value = step.term->value(operands);
          target[step.at] = step.by == nullptr ? value : step.by->apply(target[step.at], value, step.scalar);
        }
      }
    };
  }

 private:
  struct Step {
    bool isOutput;
    std::size_t at;  ///< which accumulator or output
    Scalar scalar;
    const Operator* by;  ///< null: assigned
    const Term* term;
    const Condition* condition = nullptr;
    bool isCounted = false;  ///< repeated 0 to 3 times, as the first input says
    bool looksUpA = false;
  };

  std::string filled(std::string_view text, Scalar scalar) const {
    return fmt::format(fmt::runtime(text), nameOf(scalar), integers_[0], integers_[1]);
  }

  std::string nameOfAccumulator(std::size_t number) const {
    return made_.accumulatorIsRecord ? fmt::format("s.m{}", number) : fmt::format("s{}", number);
  }

  const Term& termFor(Scalar scalar) {
    const bool hasOutput = !made_.outputs.empty();
    if (scalar != Scalar::Float) return hasOutput && random_.chance(1, 3) ? ofOutput : random_.pick(integers);
    const bool isX = made_.inputs[0] == Scalar::Float && random_.chance(1, 2);
    if (!isX) return random_.pick(floats);
    return made_.inputs[1] == Scalar::Float && random_.chance(1, 2) ? ofProduct : ofX;
  }

  void addOutput() {
    const Scalar scalar = randomInteger(random_);
    const std::size_t number = made_.outputs.size();
    const Term& term = random_.pick(integers);
    body_ += fmt::format("  o{} = {};\n", number, filled(term.text, scalar));
    made_.outputs.push_back(scalar);
    steps_.push_back({.isOutput = true, .at = number, .scalar = scalar, .by = nullptr, .term = &term});
  }

  void addAccumulator() {
    const Operator& by = random_.pick(operators);
    const Scalar scalar = by.foldsFloats ? randomScalar(random_) : randomInteger(random_);
    made_.accumulators.push_back(scalar);
    made_.identities.push_back(by.identity(scalar).word);
    made_.sumsFloats |= scalar == Scalar::Float && &by == operators;
    by_.push_back(&by);
  }

  void addSteps() {
    for (std::size_t number = 0; number < by_.size(); ++number) {
      for (int left = random_.chance(1, 3) ? 2 : 1; left > 0; --left) addStep(number);
    }
    if (made_.outputs.empty() || !random_.chance(1, 2)) return;
    body_ += filled("  o0 ^= {0}({2});\n", made_.outputs[0]);
    steps_.push_back(
        {.isOutput = true, .at = 0, .scalar = made_.outputs[0], .by = &operators[4], .term = &integers[1]});
  }

  void addStep(std::size_t number) {
    const Scalar scalar = made_.accumulators[number];
    const Term& term = termFor(scalar);
    Step step{.isOutput = false, .at = number, .scalar = scalar, .by = by_[number], .term = &term};
    step.looksUpA = &term == &floats[2];
    std::string line =
        fmt::format(fmt::runtime(by_[number]->text), nameOfAccumulator(number), filled(term.text, scalar));
    if (random_.chance(1, 4)) {
      step.isCounted = true;
      line = fmt::format("for (int i = 0; i < ({} & 3); ++i) {}", integers_[0], line);
    }
    if (random_.chance(1, 3)) {
      step.condition = &random_.pick(conditions);
      line = fmt::format("if ({}) {}", filled(step.condition->text, scalar), line);
    }
    body_ += fmt::format("  {};\n", line);
    steps_.push_back(step);
  }

  // ---- the text

  /// True if all identities have a text, which an overload and a struct need.
  bool canSayIdentities() const {
    for (std::size_t i = 0; i < by_.size(); ++i) {
      if (by_[i]->identity(made_.accumulators[i]).text.empty()) return false;
    }
    return true;
  }

  /// The accumulators as parameters, with their identities if `says`.
  std::string accumulatorsText(bool says) const {
    const std::string_view word = made_.kind == FoldKind::Scan ? "scan" : "reduce";
    std::string text, values;
    for (std::size_t i = 0; i < by_.size(); ++i) {
      const std::string_view identity = by_[i]->identity(made_.accumulators[i]).text;
      values += (i == 0 ? "" : ", ") + std::string(identity);
      if (made_.accumulatorIsRecord) continue;
      text += fmt::format(", {} {} s{}<>", word, nameOf(made_.accumulators[i]), i);
      if (says && !identity.empty()) text += fmt::format(" = {}", identity);
    }
    if (!made_.accumulatorIsRecord) return text;
    return fmt::format(", {} R s<>{}", word, says ? " = R{" + values + "}" : "");
  }

  std::string text() {
    const bool canSay = canSayIdentities();
    const bool says =
        canSay && (!random_.chance(1, 4) || (made_.accumulatorIsRecord && made_.kind == FoldKind::Scan));
    std::string text;
    if (made_.accumulatorIsRecord) {
      text += "struct R {\n";
      for (std::size_t i = 0; i < by_.size(); ++i)
        text += fmt::format("  {} m{};\n", nameOf(made_.accumulators[i]), i);
      text += "};\n";
    }
    std::string outputs;
    for (std::size_t i = 0; i < made_.outputs.size(); ++i)
      outputs += fmt::format(", out {} o{}<>", nameOf(made_.outputs[i]), i);
    const std::string_view word = made_.kind == FoldKind::Scan     ? "scan"
                                  : made_.kind == FoldKind::Reduce ? "reduce"
                                                                   : "kernel";
    text +=
        fmt::format("{} void random(uint c, int g[], {} x0<>, {} x1<>{}{}) {{\n{}}}\n", word,
                    nameOf(made_.inputs[0]), nameOf(made_.inputs[1]), outputs, accumulatorsText(says), body_);
    if (says && random_.chance(1, 5)) text += overload();
    return text;
  }

  /// Folds accumulators, as skc would.
  std::string overload() const {
    std::string parts, body;
    for (std::size_t i = 0; i < by_.size(); ++i) {
      const std::string part = made_.accumulatorIsRecord ? fmt::format("p.m{}", i) : fmt::format("p{}", i);
      if (!made_.accumulatorIsRecord)
        parts += fmt::format("{}{} p{}<>", i == 0 ? "" : ", ", nameOf(made_.accumulators[i]), i);
      body += fmt::format("  {};\n", fmt::format(fmt::runtime(by_[i]->text), nameOfAccumulator(i), part));
    }
    if (made_.accumulatorIsRecord) parts = "R p<>";
    return fmt::format("{} void random({}{}) {{\n{}}}\n", made_.kind == FoldKind::Scan ? "scan" : "reduce",
                       parts, accumulatorsText(true), body);
  }

  FoldText& made_;
  Random& random_;
  std::string integers_[2];
  std::string body_;
  std::vector<const Operator*> by_;  ///< one per accumulator
  std::vector<Step> steps_;
};

/// Maps r -> a * r + b, whose composition does not commute. A kernel gives its inputs' sum, too.
void makeMaps(FoldText& made, Random& random) {
  made.inputs = made.accumulators = {Scalar::Uint, Scalar::Uint};
  made.identities = {1, 0};
  made.inputIsRecord = made.accumulatorIsRecord = random.chance(1, 2);
  const bool isKernel = made.kind == FoldKind::Kernel;
  if (isKernel) made.outputs = {Scalar::Uint};
  const std::string_view word = made.kind == FoldKind::Scan ? "scan" : "reduce";
  const auto parameters = made.accumulatorIsRecord
                              ? fmt::format("{} R s<> = R{{1u, 0u}}", word)
                              : fmt::format("{0} uint s0<> = 1u, {0} uint s1<> = 0u", word);
  const std::string_view inputs = made.inputIsRecord ? "R x<>" : "uint x0<>, uint x1<>";
  const std::string_view body = made.accumulatorIsRecord ? "  s = R{s.m0 * x.m0, s.m1 * x.m0 + x.m1};\n"
                                                         : "  s0 *= x0;\n  s1 = s1 * x0 + x1;\n";
  if (made.inputIsRecord) made.text = "struct R {\n  uint m0;\n  uint m1;\n};\n";
  const std::string fold = fmt::format("{} void random({}, {}) {{\n{}}}\n", word, inputs, parameters, body);
  if (isKernel) {
    made.text +=
        fmt::format("kernel void random({}, out uint o0<>, {}) {{\n  o0 = {} + {};\n{}}}\n", inputs,
                    parameters, made.inputIsRecord ? "x.m0" : "x0", made.inputIsRecord ? "x.m1" : "x1", body);
  }
  made.text += fold;
  made.fold = [isKernel](Words& accumulators, FoldText::Element& element) {
    const Words& x = element.inputs;
    if (isKernel) element.outputs[0] = x[0] + x[1];
    accumulators[0] *= x[0];
    accumulators[1] = accumulators[1] * x[0] + x[1];
  };
}

/// The first least element, with what stands beside it. There is no identity.
void makeLeast(FoldText& made, Random& random) {
  made.inputs = made.accumulators = {randomScalar(random), randomScalar(random)};
  made.inputIsRecord = made.accumulatorIsRecord = random.chance(1, 2);
  const bool isKernel = made.kind == FoldKind::Kernel;
  if (isKernel) made.outputs = {made.inputs[1]};
  const std::string_view kind = made.kind == FoldKind::Scan ? "scan" : isKernel ? "kernel" : "reduce";
  const std::string_view word = made.kind == FoldKind::Scan ? "scan" : "reduce";
  const std::string_view first = nameOf(made.inputs[0]), second = nameOf(made.inputs[1]);
  const std::string output = isKernel ? fmt::format(", out {} o0<>", second) : "";
  const std::string_view value = made.inputIsRecord ? "x.m1" : "x1";
  const std::string doubled = isKernel ? fmt::format("  o0 = {0} + {0};\n", value) : "";
  if (made.inputIsRecord) {
    made.text = fmt::format(
        "struct R {{\n  {} m0;\n  {} m1;\n}};\n{} void random(R x<>{}, {} R s<>) {{\n{}  if (x.m0 < s.m0) s "
        "= x;\n}}\n",
        first, second, kind, output, word, doubled);
  } else {
    made.text = fmt::format(
        "{0} void random({1} x0<>, {2} x1<>{3}, {4} {1} s0<>, {4} {2} s1<>) {{\n{5}  if (x0 < s0) {{\n    s0 "
        "= x0;\n    "
        "s1 = x1;\n  }}\n}}\n",
        kind, first, second, output, word, doubled);
  }
  made.fold = [inputs = made.inputs, isKernel](Words& accumulators, FoldText::Element& element) {
    const Words& x = element.inputs;
    if (isKernel) element.outputs[0] = inputs[1] == Scalar::Float ? wordOf(2 * asFloat(x[1])) : x[1] + x[1];
    const bool isLess = inputs[0] == Scalar::Float  ? asFloat(x[0]) < asFloat(accumulators[0])
                        : inputs[0] == Scalar::Uint ? x[0] < accumulators[0]
                                                    : asInt(x[0]) < asInt(accumulators[0]);
    if (isLess) accumulators = x;
  };
}

}  // namespace

FoldText randomFold(FoldKind kind, Random& random) {
  FoldText made;
  made.kind = kind;
  if (random.chance(1, 5)) {
    makeMaps(made, random);
  } else if (random.chance(1, 5)) {
    makeLeast(made, random);
  } else {
    OperatorFold(made, random).make();
  }
  return made;
}

}  // namespace fuzz
