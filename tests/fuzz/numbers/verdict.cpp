// SPDX-License-Identifier: MIT
#include "numbers/verdict.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <optional>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "numbers/judge.hpp"
#include "numbers/operations.hpp"

namespace fuzz::numbers {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

std::int64_t sizeOf(const std::vector<std::int64_t>& shape) {
  std::int64_t size = 1;
  for (const std::int64_t extent : shape) size *= extent;
  return size;
}

/// A fold of numbers that are no sums of reals.
class OtherFold {
 public:
  explicit OtherFold(FoldKind kind) : kind_(kind) {
    if (kind == FoldKind::Least) value_ = infinity;
    if (kind == FoldKind::Most) value_ = -infinity;
    if (kind == FoldKind::MostInt) value_ = std::numeric_limits<std::int32_t>::min();
    if (kind == FoldKind::HashPower) whole_ = 1;
  }
  void take(double x) {
    switch (kind_) {
      case FoldKind::Least: value_ = std::fmin(value_, x); break;
      case FoldKind::Most:
      case FoldKind::MostInt: value_ = std::fmax(value_, x); break;
      case FoldKind::IntSum: whole_ += static_cast<std::uint32_t>(static_cast<std::int64_t>(x)); break;
      case FoldKind::HashValue: whole_ = whole_ * 31 + static_cast<std::uint32_t>(x); break;
      case FoldKind::HashPower: whole_ *= 31; break;
      case FoldKind::FloatSum:
      case FoldKind::DoubleSum: break;
    }
  }
  double value() const {
    switch (kind_) {
      case FoldKind::IntSum: return static_cast<std::int32_t>(whole_);
      case FoldKind::HashValue:
      case FoldKind::HashPower: return whole_;
      default: return value_;
    }
  }

 private:
  FoldKind kind_;
  double value_ = 0;
  std::uint32_t whole_ = 0;
};

class Verdict {
 public:
  Verdict(const Case& one, const std::vector<Values>& results, const Arithmetic& arithmetic)
      : case_(one),
        operation_(operationNamed(one.operation)),
        arithmetic_(arithmetic),
        inputs_(storedInputs(one, arithmetic)),
        results_(results) {}

  std::string mistake() const {
    std::string wrong;
    if (operation_.accepts != nullptr) wrong = mistakeOfElements();
    if (wrong.empty() && operation_.addTerms != nullptr) wrong = mistakeOfFolds();
    return wrong;
  }

 private:
  struct Component {
    std::size_t output, of, count;
  };
  /// Component number `k` of all outputs.
  Component componentOf(std::size_t k) const {
    for (std::size_t output = 0;; ++output) {
      const auto count = static_cast<std::size_t>(components(operation_.outputs[output]));
      if (k < count) return {output, k, count};
      k -= count;
    }
  }
  double resultOf(std::size_t k, std::size_t element) const {
    const Component c = componentOf(k);
    return results_[c.output].at(element * c.count + c.of);
  }

  std::string mistakeOfElements() const {
    const MapJudge judge(arithmetic_, case_.options);
    const std::size_t outputs = operation_.componentsOfElementOutputs();
    const std::size_t count = static_cast<std::size_t>(sizeOf(case_.shape));
    std::vector<double> x;
    for (std::size_t i = 0; i < count; ++i) {
      x.clear();
      for (std::size_t k = 0; k < inputs_.size(); ++k) {
        const auto width = static_cast<std::size_t>(components(operation_.inputs[k].element));
        for (std::size_t c = 0; c < width; ++c) x.push_back(inputs_[k][i * width + c]);
      }
      for (std::size_t k = 0; k < outputs; ++k) {
        const double got = resultOf(k, i);
        if (accepts(judge, x, k, got)) continue;
        std::vector<std::string> arguments;
        for (const double value : x) arguments.push_back(shown(value));
        return fmt::format("output {} of ({}) is {}", k, fmt::join(arguments, ", "), shown(got));
      }
    }
    return {};
  }

  /// Devices that take denormal numbers as 0 may do so with each argument.
  bool accepts(const MapJudge& judge, const std::vector<double>& x, std::size_t output, double got) const {
    if (operation_.accepts(judge, x, output, got)) return true;
    if (!arithmetic_.flushesDenormals) return false;
    std::vector<double> flushed = x;
    for (unsigned choice = 1; choice < (1U << x.size()); ++choice) {
      bool isAnother = false;
      for (std::size_t k = 0; k < x.size(); ++k) {
        const bool isFlushed = (choice >> k & 1U) != 0 && mayBeFlushed(x[k]);
        flushed[k] = isFlushed ? std::copysign(0.0, x[k]) : x[k];
        isAnother = isAnother || isFlushed;
      }
      if (isAnother && operation_.accepts(judge, flushed, output, got)) return true;
    }
    return false;
  }

  std::string mistakeOfFolds() const {
    const std::vector<std::vector<std::size_t>> groups = groupsOf(case_);
    for (std::size_t g = 0; g < groups.size(); ++g) {
      const std::string wrong =
          operation_.kind == Kind::Scan ? mistakeOfScan(groups[g]) : mistakeOfReduce(groups[g], g);
      if (!wrong.empty()) return wrong;
    }
    return {};
  }

  SumFacts factsOf(std::size_t elements, FoldKind kind) const {
    return {.accumulate = case_.options.accumulate,
            .precision = case_.options.precision,
            .isScan = operation_.kind == Kind::Scan,
            .elements = static_cast<double>(elements),
            .areDoubles = kind == FoldKind::DoubleSum};
  }

  void addTerms(std::size_t element, Terms& terms) const {
    const std::int64_t fastest = case_.shape.back();
    operation_.addTerms(inputs_, element, static_cast<std::int64_t>(element) % fastest, terms);
  }

  std::string mistakeOfReduce(const std::vector<std::size_t>& group, std::size_t result) const {
    Fold fold(operation_, arithmetic_, factsOf(0, FoldKind::FloatSum).isWide());
    for (const std::size_t element : group) fold.add(*this, element);
    return mistakeAt(fold, result, result);
  }

  std::string mistakeOfScan(const std::vector<std::size_t>& group) const {
    Fold fold(operation_, arithmetic_, factsOf(0, FoldKind::FloatSum).isWide());
    for (std::size_t i = 0; i < group.size(); ++i) {
      if (case_.options.scan != sk::Scan::Exclusive) fold.add(*this, group[i]);
      std::string wrong = mistakeAt(fold, group[i], i);
      if (!wrong.empty()) return wrong;
      if (case_.options.scan == sk::Scan::Exclusive) fold.add(*this, group[i]);
    }
    return {};
  }

  struct Fold {
    Fold(const Operation& operation, const Arithmetic& arithmetic, bool isWide)
        : sums(operation.folds.size()),
          taken(operation.folds.size()),
          terms(arithmetic, isWide, sums, taken) {
      for (const FoldKind kind : operation.folds) others.emplace_back(kind);
    }
    Fold(const Fold&) = delete;
    void add(const Verdict& verdict, std::size_t element) {
      ++elements;
      verdict.addTerms(element, terms);
      for (std::size_t k = 0; k < taken.size(); ++k) {
        for (const double x : taken[k]) others[k].take(x);
        taken[k].clear();
      }
    }
    std::size_t elements = 0;
    std::vector<SumJudge> sums;
    std::vector<Values> taken;
    std::vector<OtherFold> others;
    Terms terms;
  };

  std::string mistakeAt(const Fold& fold, std::size_t element, std::size_t place) const {
    const std::size_t before = operation_.componentsOfElementOutputs();
    for (std::size_t k = 0; k < operation_.folds.size(); ++k) {
      const double got = resultOf(before + k, element);
      const FoldKind kind = operation_.folds[k];
      std::string wrong;
      if (kind == FoldKind::FloatSum || kind == FoldKind::DoubleSum) {
        const SumFacts facts = factsOf(fold.elements, kind);
        wrong = fold.sums[k].mistake(got, facts, arithmetic_, operation_.startsFromZero);
      } else if (const double wanted = fold.others[k].value(); got != wanted) {
        const bool isFlushed = arithmetic_.flushesDenormals && isDenormal(wanted) && got == 0;
        if (!isFlushed) wrong = fmt::format("{}, not {}", shown(got), shown(wanted));
      }
      if (!wrong.empty()) return fmt::format("accumulator {} at {} is {}", k, place, wrong);
    }
    return {};
  }

  const Case& case_;
  const Operation& operation_;
  const Arithmetic& arithmetic_;
  std::vector<Values> inputs_;
  const std::vector<Values>& results_;
};

}  // namespace

std::vector<Values> storedInputs(const Case& one, const Arithmetic& arithmetic) {
  const Operation& operation = operationNamed(one.operation);
  std::vector<Values> stored = one.inputs;
  for (std::size_t k = 0; k < stored.size(); ++k) {
    const Parameter& parameter = operation.inputs[k];
    if (parameter.role == Role::Uniform) continue;
    const bool isReal = parameter.element == Element::Float || parameter.element == Element::Float3;
    for (double& x : stored[k]) {
      if (isReal && one.storage == sk::Storage::Half) x = toHalf(x);
      if (parameter.element == Element::Double && arithmetic.hasPairs) x = toPair(x);
    }
  }
  return stored;
}

std::vector<std::vector<std::size_t>> groupsOf(const Case& one) {
  const Operation& operation = operationNamed(one.operation);
  std::vector<std::vector<std::size_t>> groups;
  if (!one.starts.empty()) {
    for (std::size_t row = 0; row + 1 < one.starts.size(); ++row) {
      auto& group = groups.emplace_back();
      for (std::int64_t i = one.starts[row]; i < one.starts[row + 1]; ++i)
        group.push_back(static_cast<std::size_t>(i));
    }
    return groups;
  }
  const std::size_t rank = one.shape.size();
  // How many elements of a dimension are in one group.
  std::vector<std::int64_t> extents = one.shape;
  if (operation.kind == Kind::Scan) {
    if (one.options.along) {
      extents.assign(rank, 1);
      const auto along = static_cast<std::size_t>(*one.options.along);
      extents[along] = one.shape[along];
    }
  } else if (!one.result.empty()) {
    for (std::size_t d = 0; d < rank; ++d) extents[d] = one.shape[d] / one.result[d];
  }
  std::vector<std::int64_t> counts(rank);
  for (std::size_t d = 0; d < rank; ++d) counts[d] = one.shape[d] / extents[d];
  groups.resize(static_cast<std::size_t>(sizeOf(counts)));
  std::vector<std::int64_t> index(rank);
  for (std::int64_t i = 0; i < sizeOf(one.shape); ++i) {
    std::int64_t rest = i;
    for (std::size_t d = rank; d-- > 0;) {
      index[d] = rest % one.shape[d];
      rest /= one.shape[d];
    }
    std::int64_t group = 0;
    for (std::size_t d = 0; d < rank; ++d) group = group * counts[d] + index[d] / extents[d];
    groups[static_cast<std::size_t>(group)].push_back(static_cast<std::size_t>(i));
  }
  return groups;
}

std::string mistakeOf(const Case& one, const std::vector<Values>& results, const Arithmetic& arithmetic) {
  return Verdict(one, results, arithmetic).mistake();
}

}  // namespace fuzz::numbers
