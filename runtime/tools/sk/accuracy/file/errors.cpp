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

void ErrorSizes::add(const Results& got, const Results& wanted, std::size_t inputs, int draw) {
  for (std::size_t c = 0; c < scalars_.size(); ++c) {
    const Scalar scalar = scalars_[c].scalar;
    for (std::size_t i = 0; i < got[c].size(); ++i) {
      const ErrorPlace place{inputs, draw, i, c, got[c][i], wanted[c][i]};
      if (!isReal(scalar)) {
        wrongInteger_ += place.got == place.wanted ? 0 : 1;
        continue;
      }
      const double reachable = roundedTo(scalar, place.wanted);
      if (!std::isfinite(reachable) || !std::isfinite(place.got)) {
        if (classOf(reachable) != classOf(place.got) && ++wrongClass_ == 1) worst_ = place;
        continue;
      }
      relative_ = std::max(relative_, relativeError(scalar, place.got, place.wanted));
      const double ulps = std::fabs(place.got - place.wanted) / ulpOf(scalar, place.wanted);
      sum_ += ulps;
      ++numbers_;
      if (ulps <= largest_) continue;
      largest_ = ulps;
      if (wrongClass_ == 0) worst_ = place;
    }
  }
}

std::vector<Metric> ErrorSizes::metrics() const {
  std::vector<Metric> metrics{{"rel err", wrongClass_ > 0 ? HUGE_VAL : relative_},
                              {"max ulp", std::max(largest_, 0.0)},
                              {"mean ulp", numbers_ == 0 ? 0 : sum_ / static_cast<double>(numbers_)},
                              {"wrong class", static_cast<double>(wrongClass_)}};
  const auto isInteger = [](const ResultScalar& scalar) { return !isReal(scalar.scalar); };
  if (std::any_of(scalars_.begin(), scalars_.end(), isInteger)) {
    metrics.push_back({"wrong int", static_cast<double>(wrongInteger_)});
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
