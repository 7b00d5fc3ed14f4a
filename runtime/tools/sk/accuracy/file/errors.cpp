// SPDX-License-Identifier: MIT
#include "accuracy/file/errors.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

namespace sk_tool {

namespace {

using sk::program::Scalar;

constexpr double tolerated = 0.01;  ///< relative error

/// A number for the class of a value: NaN, each infinity, 0 and the rest.
int classOf(double value) {
  if (std::isnan(value)) return 3;
  if (std::isinf(value)) return value > 0 ? 2 : -2;
  return value == 0 ? 0 : 1;
}

double relativeError(Scalar scalar, double got, double wanted) {
  return std::fabs(got - wanted) / std::max(std::fabs(wanted), smallestOf(scalar));
}

}  // namespace

double ulpsOf(Scalar scalar, double got, double wanted) {
  if (!isReal(scalar)) return got == wanted ? 0 : HUGE_VAL;
  const double reachable = roundedTo(scalar, wanted);
  if (!std::isfinite(reachable) || !std::isfinite(got))
    return classOf(reachable) == classOf(got) ? 0 : HUGE_VAL;
  return std::fabs(got - wanted) / ulpOf(scalar, wanted);
}

std::vector<Metric> ScalarErrors::metrics() const {
  const bool isOther = wrongClass > 0;
  std::vector<Metric> all;
  if (scale == Scale::RootMeanSquare) all.push_back({"err/rms", isOther ? HUGE_VAL : ofScale});
  const std::vector<Metric> others = {{"rel err", isOther ? HUGE_VAL : relative},
                                      {"abs err", isOther ? HUGE_VAL : absolute},
                                      {"max ulp", isOther && wrongClass == tried ? HUGE_VAL : largest},
                                      {"mean ulp", isOther && wrongClass == tried ? HUGE_VAL
                                                   : numbers == 0                 ? 0
                                                                  : sum / static_cast<double>(numbers)},
                                      {"wrong class", static_cast<double>(wrongClass)}};
  all.insert(all.end(), others.begin(), others.end());
  return all;
}

void ErrorSizes::add(const Results& got, const Results& wanted, std::size_t inputs, int draw, bool isDrawn) {
  for (std::size_t c = 0; c < scalars_.size(); ++c) {
    const Scalar scalar = scalars_[c].scalar;
    ScalarErrors& errors = errors_[c];
    for (std::size_t i = 0; i < got[c].size(); ++i) {
      const ErrorPlace place{inputs, draw, i, c, got[c][i], wanted[c][i]};
      const double ulps = ulpsOf(scalar, place.got, place.wanted);
      if (!isReal(scalar)) {
        errors.wrongInteger += ulps == 0 ? 0 : 1;
        continue;
      }
      ++errors.tried;
      if (std::isinf(ulps)) {
        if (++errors.wrongClass == 1) errors.worst = place;
        keep(place, ulps);
        continue;
      }
      if (!std::isfinite(place.got)) continue;  // as it should be
      errors.relative = std::max(errors.relative, relativeError(scalar, place.got, place.wanted));
      errors.absolute = std::max(errors.absolute, std::fabs(place.got - place.wanted));
      if (isDrawn) {
        errors.sum += ulps;
        ++errors.numbers;
      }
      if (ulps > 0) keep(place, ulps);
      errors.largest = std::max(errors.largest, ulps);
      errors.squares += place.wanted * place.wanted;
      const double size = errors.scale == Scale::RootMeanSquare ? std::fabs(place.got - place.wanted) : ulps;
      if (size <= errors.worstSize && errors.tried > 1) continue;
      errors.worstSize = std::max(errors.worstSize, size);
      if (errors.wrongClass == 0) errors.worst = place;
    }
    const double rms =
        std::sqrt(errors.squares / static_cast<double>(std::max<std::size_t>(errors.tried, 1)));
    errors.ofScale = errors.absolute == 0 ? 0 : errors.absolute / rms;
  }
}

void ErrorSizes::keep(const ErrorPlace& place, double ulps) {
  constexpr std::size_t kept = 32;
  if (largest_.size() == kept && ulps <= largest_.back().ulps) return;
  const auto at = std::ranges::find_if(largest_, [&](const LargeError& one) { return one.ulps < ulps; });
  largest_.insert(at, {place, ulps});
  if (largest_.size() > kept) largest_.pop_back();
}

ScalarErrors ErrorSizes::total() const {
  ScalarErrors total;
  bool isFirst = true;
  for (std::size_t c = 0; c < errors_.size(); ++c) {
    if (!isReal(scalars_[c].scalar)) {
      total.wrongInteger += errors_[c].wrongInteger;
      continue;
    }
    const ScalarErrors& one = errors_[c];
    const bool isLarger =
        one.scale == Scale::RootMeanSquare ? one.ofScale > total.ofScale : one.largest > total.largest;
    const bool isWorse = total.wrongClass == 0 && (one.wrongClass > 0 || isLarger);
    if (isFirst || isWorse) total.worst = one.worst;
    isFirst = false;
    total.scale = one.scale;
    total.ofScale = std::max(total.ofScale, one.ofScale);
    total.relative = std::max(total.relative, one.relative);
    total.absolute = std::max(total.absolute, one.absolute);
    total.largest = std::max(total.largest, one.largest);
    total.sum += one.sum;
    total.numbers += one.numbers;
    total.tried += one.tried;
    total.wrongClass += one.wrongClass;
  }
  return total;
}

std::vector<Metric> ErrorSizes::metrics() const {
  const ScalarErrors all = total();
  std::vector<Metric> metrics = all.metrics();
  const auto isInteger = [](const ResultScalar& scalar) { return !isReal(scalar.scalar); };
  if (std::any_of(scalars_.begin(), scalars_.end(), isInteger)) {
    metrics.push_back({"wrong int", static_cast<double>(all.wrongInteger)});
  }
  return metrics;
}

void ErrorCounts::add(const Results& got, const Results& wanted, std::size_t inputs, int draw) {
  for (std::size_t i = 0; i < got.front().size(); ++i) {
    std::optional<ErrorPlace> otherInClass, otherInValue;
    for (std::size_t c = 0; c < scalars_.size(); ++c) {
      const Scalar scalar = scalars_[c].scalar;
      const ErrorPlace place{inputs, draw, i, c, got[c][i], wanted[c][i]};
      const double reachable = roundedTo(scalar, place.wanted);
      if (isReal(scalar) && classOf(reachable) != classOf(place.got)) {
        otherInClass = otherInClass.value_or(place);
      } else if (std::isfinite(reachable) && relativeError(scalar, place.got, reachable) > tolerated) {
        otherInValue = otherInValue.value_or(place);
      }
    }
    ++tried_;
    if (otherInClass && ++otherClass_ == 1) classExample_ = *otherInClass;
    if (!otherInClass && otherInValue && ++otherValue_ == 1) valueExample_ = *otherInValue;
  }
}

}  // namespace sk_tool
