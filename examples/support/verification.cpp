// SPDX-License-Identifier: MIT
#include "support/verification.hpp"

#include <cmath>
#include <limits>
#include <utility>

#include <fmt/format.h>

namespace examples {

double distance(std::span<const double> a, std::span<const double> b) {
  double sum = 0.0;
  for (std::size_t i = 0; i < a.size(); ++i) sum += (a[i] - b[i]) * (a[i] - b[i]);
  return std::sqrt(sum);
}

double sumBound(std::int64_t n) {
  constexpr std::int64_t run = 32;
  double passes = 1;
  for (; n > run; n = (n + run - 1) / run) ++passes;
  return passes * (run - 1) * roundoff;
}

Verification::Verification(std::string what, double bound, std::string reason)
    : what_(std::move(what)), bound_(bound), reason_(std::move(reason)) {}

void Verification::compare(std::int64_t place, double got, double expected, double scale) {
  if (got == expected || (std::isnan(got) && std::isnan(expected))) return note(place, 0.0);
  note(place, std::abs(got - expected) / scale);
}

void Verification::note(std::int64_t place, double error) {
  if (std::isnan(error)) error = std::numeric_limits<double>::infinity();
  if (error > largest_ || count_ == 0) {
    largest_ = error;
    place_ = place;
  }
  ++count_;
}

bool Verification::passed() const { return count_ > 0 && largest_ <= bound_; }

std::string Verification::text() const {
  if (count_ == 0) return fmt::format("{}: nothing was compared: FAILED", what_);
  const std::string where = largest_ > 0.0 ? fmt::format(" at {}", place_) : "";
  const std::string allowed = bound_ > 0.0 ? fmt::format("allowed {:.2g}", bound_) : "none allowed";
  return fmt::format("{}: largest error {:.2g}{} of {}, {} ({}): {}", what_, largest_, where, count_, allowed,
                     reason_, passed() ? "ok" : "FAILED");
}

}  // namespace examples
