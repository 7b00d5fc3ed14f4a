// SPDX-License-Identifier: MIT
#include "transforms/fold_trial.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string_view>
#include <tuple>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "ir/build.hpp"
#include "ir/type.hpp"
#include "support/function_ref.hpp"
#include "transforms/interpreter.hpp"

namespace skc {

using namespace ir;

namespace {

// Numbers on which a fold is tried. They are the same in every run of skc.

/// What an author may know about the numbers of an element.
enum class SampleKind : std::uint8_t {
  Positive,
  Signed,  ///< whole numbers
  Few,  ///< 1, 2 or 3, so that many are equal
  Unit,  ///< between 0 and 1; integers are 0 or 1
  Ascending,  ///< within an element, such as the bounds of an interval
  Descending,
  Equal,  ///< within an element
  Powers,  ///< of two
  OneHot,  ///< all numbers of an element but one are 0
};
/// In the order in which they are tried. The first three are what most programs have.
inline constexpr std::array sampleKinds = {
    SampleKind::Positive,   SampleKind::Signed, SampleKind::Few,    SampleKind::Unit,  SampleKind::Ascending,
    SampleKind::Descending, SampleKind::Equal,  SampleKind::Powers, SampleKind::OneHot};

/// Says which number is wanted.
struct SampleNumber {
  SampleKind kind;
  int sample;
  int number;  ///< differs for all numbers of a sample
  int element;  ///< what the number belongs to: the same for all numbers of one element
  int within, count;  ///< the number's position in its element, and how many numbers that has
};

/// A number below `count` that looks random.
int pick(int a, int b, int count) {
  std::uint32_t bits =
      static_cast<std::uint32_t>(a) * 0x9e3779b1U + static_cast<std::uint32_t>(b) * 0x85ebca6bU + 1;
  bits = (bits ^ bits >> 15U) * 0x2c1b3c6dU;
  bits = (bits ^ bits >> 12U) * 0x297a2d39U;
  return static_cast<int>((bits ^ bits >> 15U) % static_cast<std::uint32_t>(count));
}

std::size_t row(const SampleNumber& n, std::size_t rows) {
  const int at = (n.sample * 5 + n.number * 3) % static_cast<int>(rows);
  return static_cast<std::size_t>(at < 0 ? at + static_cast<int>(rows) : at);
}

double integer(const SampleNumber& n) {
  constexpr std::array<int, 11> values = {1, 3, 2, 7, 5, 4, 9, 6, 11, 8, 10};
  const int random = pick(n.sample, n.number, 4);
  switch (n.kind) {
    case SampleKind::Positive:
    case SampleKind::Signed: return values[row(n, values.size())];
    case SampleKind::Few: return 1 + pick(n.sample, n.number, 3);
    case SampleKind::Unit: return random % 2;
    case SampleKind::Ascending: return 1 + 4 * n.within + random;
    case SampleKind::Descending: return 1 + 4 * (n.count - 1 - n.within) + random;
    case SampleKind::Equal: return 1 + pick(n.sample, n.element, 8);
    case SampleKind::Powers: return 1 << random;
    case SampleKind::OneHot:
      if (n.count == 1) return 1 + random;
      return pick(n.sample, n.element, n.count) == n.within ? 1 : 0;
  }
  return 0;
}

double real(const SampleNumber& n) {
  constexpr std::array<double, 11> values = {1, 2.5, 4, 0.75, 3.25, 1.5, 6, 0.5, 2.25, 5.5, 1.75};
  switch (n.kind) {
    case SampleKind::Positive: return values[row(n, values.size())];
    case SampleKind::Unit: return (1 + pick(n.sample, n.number, 16)) / 16.0;
    case SampleKind::Signed:
    case SampleKind::Few:
    case SampleKind::OneHot: return integer(n);
    case SampleKind::Ascending:
    case SampleKind::Descending:
    case SampleKind::Equal: return integer(n) / 4;
    case SampleKind::Powers: return integer(n) / 2;
  }
  return 0;
}

bool isNormalized(Scalar scalar) {
  return scalar == Scalar::Unorm8 || scalar == Scalar::Unorm16 || scalar == Scalar::Snorm8 ||
         scalar == Scalar::Snorm16;
}

bool isUnsigned(Scalar scalar) {
  return scalar == Scalar::Uint || scalar == Scalar::Ulong || scalar == Scalar::Uchar ||
         scalar == Scalar::Ushort || scalar == Scalar::Unorm8 || scalar == Scalar::Unorm16;
}

/// A number that neither overflows nor vanishes. Sums and products of a few such numbers are exact.
double sampleOf(Scalar scalar, const SampleNumber& n) {
  if (scalar == Scalar::Bool) {
    const bool isFirst = n.kind == SampleKind::Positive || n.kind == SampleKind::Signed;
    return isFirst ? (n.sample + n.number * 2) / 2 & 1 : pick(n.sample, n.number, 2);
  }
  const bool isReal = ir::isReal(arithmeticScalar(scalar));
  double value = isReal ? real(n) : integer(n);
  if (isNormalized(scalar) && n.kind != SampleKind::Unit && n.kind != SampleKind::OneHot) value /= 16;
  const bool isNegative =
      n.kind == SampleKind::Signed && !isUnsigned(scalar) && (n.sample + n.number) % 2 == 0;
  return isNegative ? -value : value;
}

constexpr int samplesOfKind = 8;
/// What the samples of a kind may take together, in steps of the interpreter.
constexpr int mostSteps = 100'000;

/// The values of several accumulators, or of the elements folded into them.
using Values = std::vector<Numbers>;

/// Appends the scalar type of each number of a value.
void addScalars(const Module& module, Type type, std::vector<Scalar>& all) {
  if (type.kind == Type::Kind::Struct) {
    for (const StructField& field : module.structs[type.index].fields) addScalars(module, field.type, all);
  } else if (type.kind == Type::Kind::Array) {
    const Array& array = module.arrays[type.index];
    for (std::uint32_t i = 0; i < array.length; ++i) addScalars(module, array.element, all);
  } else {
    all.insert(all.end(), static_cast<std::size_t>(scalarCount(module, type)), type.scalar);
  }
}

/// A fold with the values that one sample gives its parameters.
class FoldSample {
 public:
  FoldSample(const Module& module, const Kernel& kernel, SampleKind kind, int sample, int& steps)
      : module_(module), kernel_(kernel), kind_(kind), sample_(sample), steps_(steps) {
    streams_.extent = {16, 1, 1, 1};
    int number = 5;
    for (const KernelParam& param : kernel.params) {
      const bool isWanted = scalarCount(module, param.type) <= mostNumbers;
      std::vector<Scalar>& scalars = scalars_.emplace_back();
      if (isWanted) addScalars(module, param.type, scalars);
      isKnown_ = isKnown_ && isWanted;
      firstNumbers_.push_back(count_);
      if (param.role == ParamRole::Input) count_ += static_cast<int>(scalars.size());
      Numbers& value = uniforms_.emplace_back();
      if (param.role != ParamRole::Uniform && param.role != ParamRole::Spec) continue;
      for (const Scalar scalar : scalars)
        value.push_back(sampleOf(scalar, {kind, sample, number++, 0, 0, 1}));
    }
  }

  /// Chooses other values for uniform and spec parameters.
  void takeUniforms(const FoldSample& other) { uniforms_ = other.uniforms_; }

  int number() const { return sample_; }

  Values element(int position) const {
    Values values;
    for (VarId i = 0; i < kernel_.params.size(); ++i) {
      if (kernel_.params[i].role == ParamRole::Input) values.push_back(read(i, {position, 0, 0, 0}));
    }
    return values;
  }

  std::optional<Values> identities() const {
    Values values;
    for (const KernelParam& param : kernel_.params) {
      if (param.role != ParamRole::Accumulator) continue;
      std::optional<Numbers> value =
          param.identity ? interpretConstant(module_, *param.identity) : std::nullopt;
      if (!value) return std::nullopt;
      values.push_back(std::move(*value));
    }
    return values;
  }

  /// The accumulators after the element at a position.
  std::optional<Values> fold(const Values& accumulators, int position) const {
    return step(kernel_, accumulators, element(position), position, {});
  }

  /// The results of two blocks, combined. `total` is that of the earlier elements.
  std::optional<Values> combine(const Values& total, const Values& part) const {
    const Kernel& combination = module_.kernels[*kernel_.reduction->combine];
    return step(combination, total, part, 0, kernel_.reduction->operands);
  }

  /// The same for a fold that combines its own results.
  std::optional<Values> combineByItself(const Values& total, const Values& part) const {
    return step(kernel_, total, part, 0, {});
  }

  /// The result of a block. Without a start, its first element stands for the accumulators.
  std::optional<Values> block(const std::optional<Values>& start, int first, int count) const {
    std::optional<Values> values = start ? start : element(first);
    for (int i = start ? 0 : 1; values && i < count; ++i) values = fold(*values, first + i);
    return values;
  }

  std::string words(int position) const { return words(element(position)); }
  static std::string words(const Values& values) {
    std::vector<std::string> all;
    for (const Numbers& value : values) {
      const std::string text = fmt::format("{:.6g}", fmt::join(value, ", "));
      all.push_back(value.size() == 1 ? text : "{" + text + "}");
    }
    return all.size() == 1 ? all[0] : fmt::format("({})", fmt::join(all, ", "));
  }

  /// "1, 2 and 3", and what uniforms were.
  std::string elementWords(int first, int count) const {
    std::string text;
    for (int i = 0; i < count; ++i)
      text += (i == 0 ? "" : i + 1 == count ? " and " : ", ") + words(first + i);
    std::string others;
    for (std::size_t i = 0; i < kernel_.params.size(); ++i) {
      if (uniforms_[i].empty() || uniforms_[i].size() > 4) continue;
      others += (others.empty() ? "" : ", ") + kernel_.params[i].name + " = " + words(Values{uniforms_[i]});
    }
    return others.empty() ? text : text + " (with " + others + ")";
  }

  std::vector<Scalar> accumulatorScalars() const {
    std::vector<Scalar> all;
    for (const KernelParam& param : kernel_.params) {
      if (param.role == ParamRole::Accumulator) addScalars(module_, param.type, all);
    }
    return all;
  }

 private:
  static constexpr std::uint64_t mostNumbers = 256;

  /// An element of an input, or of a gather, which holds other numbers.
  Numbers read(VarId param, const InterpretedStreams::Index& index) const {
    const auto position =
        static_cast<int>((index[0] + 7 * index[1] + 49 * index[2] + 343 * index[3]) % 10'000);
    const bool isInput = kernel_.params[param].role == ParamRole::Input;
    Numbers value;
    for (const Scalar scalar : scalars_[param]) {
      const auto at = static_cast<int>(value.size());
      const int within = isInput ? firstNumbers_[param] + at : at;
      const int number =
          isInput ? 17 * position + within : 17 * position + 101 * (1 + static_cast<int>(param)) + at;
      const int count = isInput ? count_ : static_cast<int>(scalars_[param].size());
      value.push_back(sampleOf(scalar, {kind_, sample_, number, position, within, count}));
    }
    return value;
  }

  /// Folds by `kernel`, which is this one or combines its results. `operands` has, for each of its parameters, the one
  /// of this kernel that it stands for; it is empty for this kernel itself.
  std::optional<Values> step(const Kernel& kernel, const Values& accumulators, const Values& elements,
                             int position, const std::vector<std::uint32_t>& operands) const {
    if (!isKnown_) return std::nullopt;
    const auto own = [&](std::size_t param) { return operands.empty() ? param : operands[param]; };
    std::vector<Numbers> arguments;
    std::size_t input = 0, accumulator = 0;
    for (std::size_t i = 0; i < kernel.params.size(); ++i) {
      const KernelParam& param = kernel.params[i];
      Numbers& value = arguments.emplace_back();
      switch (param.role) {
        case ParamRole::Input: value = elements.at(input++); break;
        case ParamRole::Accumulator: value = accumulators.at(accumulator++); break;
        case ParamRole::Uniform:
        case ParamRole::Spec: value = uniforms_[own(i)]; break;
        case ParamRole::Output:
          value.assign(static_cast<std::size_t>(scalarCount(module_, param.type)), 0.0);
          break;
        case ParamRole::Iterator:
          value.assign(static_cast<std::size_t>(scalarCount(module_, param.type)), 1 + 0.5 * position);
          break;
        case ParamRole::Gather:
        case ParamRole::VariableOutput:
        case ParamRole::Scatter: break;
      }
    }
    InterpretedStreams streams = streams_;
    streams.index = {position, 0, 0, 0};
    streams.read = [&](VarId param, const InterpretedStreams::Index& index) {
      return read(static_cast<VarId>(own(param)), index);
    };
    const auto ends = interpret(module_, kernel.entry, std::move(arguments), streams, steps_);
    if (!ends) return std::nullopt;
    Values result;
    for (std::size_t i = 0; i < kernel.params.size(); ++i) {
      if (kernel.params[i].role == ParamRole::Accumulator) result.push_back((*ends)[i]);
    }
    return result;
  }

  const Module& module_;
  const Kernel& kernel_;
  SampleKind kind_;
  int sample_;
  int& steps_;
  InterpretedStreams streams_;
  bool isKnown_ = true;
  int count_ = 0;  ///< the numbers of an element
  std::vector<int> firstNumbers_;  ///< of each input, in the element
  std::vector<std::vector<Scalar>> scalars_;  ///< for each parameter
  std::vector<Numbers> uniforms_;  ///< for each parameter; empty for those of other roles
};

/// Compares results. Rounding counts from the largest magnitude that a number had in any result of the sample.
class Comparison {
 public:
  explicit Comparison(const FoldSample& sample)
      : scalars_(sample.accumulatorScalars()), largest_(scalars_.size(), 1e-3) {}

  std::optional<Values> noted(std::optional<Values> values) {
    if (values)
      visit(*values, [&](std::size_t i, double v) { largest_[i] = std::max(largest_[i], std::fabs(v)); });
    return values;
  }

  /// True if they differ by more than double rounding explains; nullopt if a value is not a number.
  std::optional<bool> differ(const Values& a, const Values& b) const {
    std::vector<double> others;
    visit(b, [&](std::size_t, double v) { others.push_back(v); });
    bool differs = false, isNumber = true;
    visit(a, [&](std::size_t i, double v) {
      const double w = others.at(i);
      if (v == w) return;
      isNumber = isNumber && std::isfinite(v) && std::isfinite(w);
      const bool rounds = isReal(arithmeticScalar(scalars_[i]));
      differs = differs || std::fabs(v - w) > (rounds ? 1e-6 * largest_[i] : 0.0);
    });
    return isNumber ? std::optional(differs) : std::nullopt;
  }

 private:
  static void visit(const Values& values, FunctionRef<void(std::size_t, double)> fn) {
    std::size_t i = 0;
    for (const Numbers& numbers : values) {
      for (const double v : numbers) fn(i++, v);
    }
  }

  std::vector<Scalar> scalars_;
  std::vector<double> largest_;
};

/// What trying one sample shows.
struct Finding {
  bool runs = false;
  std::string failure = {};  ///< empty if it passed

  void add(const Comparison& comparison, const std::optional<Values>& one, const std::optional<Values>& other,
           FunctionRef<std::string()> describe) {
    if (!one || !other || !failure.empty()) return;
    const std::optional<bool> differs = comparison.differ(*one, *other);
    if (!differs) return;
    runs = true;
    if (*differs) failure = describe();
  }
};

/// How a fold does with numbers of one kind.
struct KindTally {
  int tried = 0, failed = 0;
  bool isCut = false;  ///< it took too many steps to try them all
  std::string example = {};
  bool passes() const { return (tried > 0 || isCut) && failed == 0; }
};

using TryOne = FunctionRef<Finding(const FoldSample&)>;

/// How the fold does with numbers of a kind.
KindTally tally(const Module& module, const Kernel& kernel, SampleKind kind, TryOne tryOne) {
  KindTally result;
  int steps = mostSteps;
  const int first = kind == SampleKind::Signed ? samplesOfKind : 0;
  for (int i = 0; i < samplesOfKind; ++i) {
    const Finding finding = tryOne(FoldSample(module, kernel, kind, first + i, steps));
    if (steps <= 0 && finding.failure.empty()) {
      result.isCut = true;
      break;
    }
    if (!finding.runs) continue;
    ++result.tried;
    if (finding.failure.empty()) continue;
    if (result.failed++ == 0) result.example = finding.failure;
  }
  return result;
}

FoldTrial tryKinds(const Module& module, KernelId id, TryOne tryOne) {
  const Kernel& kernel = module.kernels[id];
  constexpr std::size_t usual = 3;
  std::array<KindTally, sampleKinds.size()> tallies;
  FoldTrial trial;
  bool anyFails = false, anyPasses = false;
  for (std::size_t i = 0; i < sampleKinds.size(); ++i) {
    if (i == usual && (!anyFails || anyPasses)) break;  // the others cannot make it an error
    tallies[i] = tally(module, kernel, sampleKinds[i], tryOne);
    trial.runs = trial.runs || tallies[i].tried > 0;
    anyFails = anyFails || tallies[i].failed > 0;
    anyPasses = anyPasses || tallies[i].passes();
    if (trial.example.empty()) trial.example = tallies[i].example;
  }
  trial.failsOnce = anyFails;
  trial.fails = anyFails && !anyPasses;
  const auto& [positive, negative, few] = std::tie(tallies[0], tallies[1], tallies[2]);
  // many folds are for positive numbers only
  trial.mayFail =
      positive.failed > 0 || few.failed > 0 || (negative.failed > 0 && 2 * negative.failed >= negative.tried);
  return trial;
}

/// Elements 0 to `count`, of which the first `split` are one block and the others another.
struct Split {
  int count, split;
};
constexpr std::array splits = {Split{3, 1}, Split{3, 2}, Split{2, 1}, Split{5, 2}};

std::string_view countWord(int count) {
  constexpr std::array<std::string_view, 4> words = {"", "", " two", " three"};
  return words.at(static_cast<std::size_t>(count));
}

}  // namespace

FoldTrial tryAssociativity(const Module& module, KernelId id) {
  return tryKinds(module, id, [](const FoldSample& sample) {
    Comparison comparison(sample);
    const Values a = sample.element(0), b = sample.element(1), c = sample.element(2);
    const auto join = [&](const std::optional<Values>& total, const std::optional<Values>& part) {
      return comparison.noted(total && part ? sample.combineByItself(*total, *part) : std::nullopt);
    };
    const std::optional<Values> left = join(join(a, b), c), right = join(a, join(b, c));
    Finding finding;
    finding.add(comparison, left, right, [&] {
      return fmt::format("{} give {} where the first two are folded first, and {} where the last two are",
                         sample.elementWords(0, 3), FoldSample::words(*left), FoldSample::words(*right));
    });
    return finding;
  });
}

FoldTrial tryCombination(const Module& module, KernelId id) {
  const bool isSeeded = module.kernels[id].reduction->seeded;
  return tryKinds(module, id, [&](const FoldSample& sample) {
    Finding finding;
    const std::optional<Values> start = isSeeded ? std::nullopt : sample.identities();
    if (!isSeeded && !start) return finding;
    for (const auto& [count, split] : splits) {
      Comparison comparison(sample);
      const auto block = [&](int first, int length) {
        return comparison.noted(sample.block(start, first, length));
      };
      const std::optional<Values> one = block(0, split), other = block(split, count - split),
                                  whole = block(0, count);
      const std::optional<Values> combined =
          one && other ? comparison.noted(sample.combine(*one, *other)) : std::nullopt;
      finding.add(comparison, whole, combined, [&] {
        return fmt::format(
            "{} give {} one after the other, and {} where the result of the first{} is combined with "
            "that of the other{}",
            sample.elementWords(0, count), FoldSample::words(*whole), FoldSample::words(*combined),
            countWord(split), countWord(count - split));
      });
    }
    return finding;
  });
}

FoldTrial tryStart(const Module& module, KernelId id) {
  return tryKinds(module, id, [&](const FoldSample& sample) {
    Finding finding;
    const std::optional<Values> start = sample.identities();
    if (!start) return finding;
    Comparison comparison(sample);
    const std::optional<Values> result = comparison.noted(sample.block(start, 0, 1 + sample.number() % 2));
    if (!result) return finding;
    const auto with = [&](const Values& total, const Values& part) {
      const std::optional<Values> combined = comparison.noted(sample.combine(total, part));
      finding.add(comparison, combined, result, [&] {
        return fmt::format("{} combined with {} gives {}", FoldSample::words(total), FoldSample::words(part),
                           FoldSample::words(*combined));
      });
    };
    with(*start, *result);
    with(*result, *start);
    return finding;
  });
}

IdentityTrial tryIdentity(const Module& module, KernelId id) {
  IdentityTrial trial{tryKinds(module, id, [](const FoldSample& sample) {
    Finding finding;
    const std::optional<Values> identity = sample.identities();
    if (!identity) return finding;
    Comparison comparison(sample);
    const Values element = sample.element(0);
    const std::optional<Values> folded = comparison.noted(sample.combineByItself(*identity, element));
    finding.add(comparison, folded, element, [&] {
      return fmt::format("{} folded into {} gives {}", FoldSample::words(element),
                         FoldSample::words(*identity), FoldSample::words(*folded));
    });
    return finding;
  })};
  int steps = mostSteps;
  const FoldSample sample(module, module.kernels[id], SampleKind::Positive, 0, steps);
  if (const std::optional<Values> identity = sample.identities()) {
    const std::optional<Values> twice = sample.combineByItself(*identity, *identity);
    trial.isIdempotent = twice && Comparison(sample).differ(*twice, *identity) == false;
  }
  return trial;
}

bool computesWithOthers(const Module& module, KernelId id) {
  const Kernel& kernel = module.kernels[id];
  int steps = mostSteps;
  for (int i = 0; i < 2 * samplesOfKind; ++i) {
    const SampleKind kind = i < samplesOfKind ? SampleKind::Positive : SampleKind::Signed;
    FoldSample sample(module, kernel, kind, i, steps);
    const Values a = sample.element(0), b = sample.element(1);
    sample.takeUniforms(FoldSample(module, kernel, SampleKind::Positive, 0, steps));
    const std::optional<Values> one = sample.combineByItself(a, b);
    sample.takeUniforms(FoldSample(module, kernel, kind, 1 + i, steps));
    const std::optional<Values> other = sample.combineByItself(a, b);
    if (!one || !other) return false;
    const Comparison comparison(sample);
    const auto chooses = [&](const Values& result) {
      return comparison.differ(result, a) == false || comparison.differ(result, b) == false;
    };
    if (comparison.differ(*one, *other) == true && !(chooses(*one) && chooses(*other))) return true;
  }
  return false;
}

}  // namespace skc
