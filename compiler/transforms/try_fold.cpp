// SPDX-License-Identifier: MIT
#include "transforms/try_fold.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "transforms/try_function.hpp"

namespace skc {
namespace {

using namespace ir;

constexpr int samples = 16;

/// Numbers that neither overflow nor vanish, and whose sums and products identify their operands. The second
/// half of the samples includes negative ones.
double sampleOf(Scalar scalar, int sample, int number) {
  constexpr std::array<double, 11> reals = {1, 2.5, 4, 0.75, 3.25, 1.5, 6, 0.5, 2.25, 5.5, 1.75};
  constexpr std::array<int, 11> integers = {1, 3, 2, 7, 5, 4, 9, 6, 11, 8, 10};
  const auto at = static_cast<std::size_t>(sample * 5 + number * 3) % reals.size();
  const bool isNegative = sample >= samples / 2 && (sample + number) % 2 == 0;
  switch (scalar) {
    case Scalar::Bool: return static_cast<double>((sample + number * 2) / 2 % 2);
    case Scalar::Uint:
    case Scalar::Uchar:
    case Scalar::Ushort: return integers[at];
    case Scalar::Int:
    case Scalar::Char:
    case Scalar::Short: return isNegative ? -integers[at] : integers[at];
    case Scalar::Unorm8:
    case Scalar::Unorm16:
    case Scalar::Snorm8:
    case Scalar::Snorm16: return reals[at] / 16;
    case Scalar::Float:
    case Scalar::Double:
    case Scalar::Half: break;
  }
  return isNegative ? -reals[at] : reals[at];
}

/// Appends a sample of a value.
void addSample(const Module& module, Type type, int sample, int& number, Numbers& all) {
  if (type.kind == Type::Kind::Struct) {
    for (const StructField& field : module.structs[type.index].fields)
      addSample(module, field.type, sample, number, all);
    return;
  }
  if (type.kind == Type::Kind::Array) {
    const Array& array = module.arrays[type.index];
    for (std::uint32_t i = 0; i < array.length; ++i) addSample(module, array.element, sample, number, all);
    return;
  }
  const int count = type.isMatrix() ? type.width * type.width : type.width;
  for (int i = 0; i < count; ++i) all.push_back(sampleOf(type.scalar, sample, number++));
}

/// The values of several accumulators, or of the elements folded into them.
using Values = std::vector<Numbers>;

class FoldEvaluator {
 public:
  FoldEvaluator(const Module& module, const Kernel& kernel) : module_(module), kernel_(kernel) {}

  Values element(int sample, int which) const {
    Values values;
    int number = 17 * which;
    for (const KernelParam& param : kernel_.params) {
      if (param.role == ParamRole::Accumulator)
        addSample(module_, param.type, sample, number, values.emplace_back());
    }
    return values;
  }

  std::optional<Values> identities() const {
    Values values;
    for (const KernelParam& param : kernel_.params) {
      if (param.role != ParamRole::Accumulator) continue;
      std::optional<Numbers> value = param.identity ? tryConstant(module_, *param.identity) : std::nullopt;
      if (!value) return std::nullopt;
      values.push_back(std::move(*value));
    }
    return values;
  }

  /// The accumulators after one element.
  std::optional<Values> fold(const Values& accumulators, const Values& elements, int uniforms) const {
    std::vector<Numbers> arguments;
    std::size_t input = 0, accumulator = 0;
    int number = 5;
    for (const KernelParam& param : kernel_.params) {
      Numbers& value = arguments.emplace_back();
      switch (param.role) {
        case ParamRole::Input: value = elements[input++]; break;
        case ParamRole::Accumulator: value = accumulators[accumulator++]; break;
        case ParamRole::Uniform:
        case ParamRole::Spec: addSample(module_, param.type, uniforms, number, value); break;
        case ParamRole::Output:
        case ParamRole::Gather:
        case ParamRole::VariableOutput:
        case ParamRole::Scatter:
        case ParamRole::Iterator: break;
      }
    }
    const auto ends = tryFunction(module_, kernel_.entry, std::move(arguments));
    if (!ends) return std::nullopt;
    Values result;
    for (std::size_t i = 0; i < kernel_.params.size(); ++i) {
      if (kernel_.params[i].role == ParamRole::Accumulator) result.push_back((*ends)[i]);
    }
    return result;
  }

  std::string words(const Values& values) const {
    std::vector<std::string> all;
    for (const Numbers& value : values) {
      const std::string text = fmt::format("{:.6g}", fmt::join(value, ", "));
      all.push_back(value.size() == 1 ? text : "{" + text + "}");
    }
    return all.size() == 1 ? all[0] : fmt::format("({})", fmt::join(all, ", "));
  }

 private:
  const Module& module_;
  const Kernel& kernel_;
};

/// True if they differ by more than double rounding explains; nullopt if a value is not a number.
std::optional<bool> differ(const Values& a, const Values& b) {
  bool differs = false;
  for (std::size_t i = 0; i < a.size(); ++i) {
    for (std::size_t j = 0; j < a[i].size(); ++j) {
      const double x = a[i][j], y = b[i][j];
      if (!std::isfinite(x) || !std::isfinite(y)) {
        if (x == y) continue;
        return std::nullopt;
      }
      differs = differs || std::fabs(x - y) > 1e-6 * std::max({std::fabs(x), std::fabs(y), 1e-3});
    }
  }
  return differs;
}

void count(FoldTrial& trial, const std::optional<Values>& one, const std::optional<Values>& other,
           auto&& describe) {
  if (!one || !other) return;
  const std::optional<bool> differs = differ(*one, *other);
  if (!differs) return;
  ++trial.tried;
  if (!*differs) return;
  if (trial.failed++ == 0) trial.example = describe();
}

}  // namespace

FoldTrial tryAssociativity(const Module& module, const Kernel& kernel) {
  const FoldEvaluator evaluator(module, kernel);
  FoldTrial trial;
  for (int sample = 0; sample < samples; ++sample) {
    const Values a = evaluator.element(sample, 0), b = evaluator.element(sample, 1),
                 c = evaluator.element(sample, 2);
    const std::optional<Values> ab = evaluator.fold(a, b, sample), bc = evaluator.fold(b, c, sample);
    if (!ab || !bc) return {};
    const std::optional<Values> left = evaluator.fold(*ab, c, sample), right = evaluator.fold(a, *bc, sample);
    count(trial, left, right, [&] {
      return fmt::format(
          "{}, {} and {} give {} where the first two are folded first, and {} where the last two are",
          evaluator.words(a), evaluator.words(b), evaluator.words(c), evaluator.words(*left),
          evaluator.words(*right));
    });
  }
  return trial;
}

IdentityTrial tryIdentity(const Module& module, const Kernel& kernel) {
  const FoldEvaluator evaluator(module, kernel);
  IdentityTrial trial;
  const std::optional<Values> identity = evaluator.identities();
  if (!identity) return trial;
  for (int sample = 0; sample < samples / 2; ++sample) {
    const Values element = evaluator.element(sample, 0);
    const std::optional<Values> folded = evaluator.fold(*identity, element, sample);
    count(trial, folded, element, [&] {
      return fmt::format("{} folded into {} gives {}", evaluator.words(element), evaluator.words(*identity),
                         evaluator.words(*folded));
    });
  }
  const std::optional<Values> twice = evaluator.fold(*identity, *identity, 0);
  trial.isIdempotent = twice && differ(*twice, *identity) == false;
  return trial;
}

bool computesWithOthers(const Module& module, const Kernel& kernel) {
  const FoldEvaluator evaluator(module, kernel);
  for (int sample = 0; sample < samples; ++sample) {
    const Values a = evaluator.element(sample, 0), b = evaluator.element(sample, 1);
    const std::optional<Values> one = evaluator.fold(a, b, 0), other = evaluator.fold(a, b, 1 + sample);
    if (!one || !other) return false;
    const auto chooses = [&](const Values& result) {
      return differ(result, a) == false || differ(result, b) == false;
    };
    if (differ(*one, *other) == true && !(chooses(*one) && chooses(*other))) return true;
  }
  return false;
}

}  // namespace skc
