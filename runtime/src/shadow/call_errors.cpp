// SPDX-License-Identifier: MIT
//
// What is known of the elements that a call has written: how wrong they are, and whose errors that is. Calls that are not compared are
// taken to add what compared calls of their kernel have added.
#include "shadow/shadow_call.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <exception>
#include <numeric>
#include <optional>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "device/region.hpp"
#include "shadow/errors.hpp"

namespace sk {

using shadow::OutputErrors;

/// How much the error of each input counts in an output: by what calls have shown, or else by the inputs' relative errors.
std::vector<double> CallFollower::weightsOf(const Written& written) const {
  std::vector<double> errors, weights;
  for (const Read& read : read_) {
    errors.push_back(read.errors.relative);
    const std::optional<double> factor =
        device_.influences().of(call_.kernel, written.argument, read.argument);
    if (errors.back() == 0) {
      weights.push_back(0);
    } else if (factor) {
      weights.push_back(*factor * errors.back());
    }
  }
  const bool areKnown =
      weights.size() == errors.size() && std::ranges::any_of(weights, [](double each) { return each > 0; });
  return areKnown ? weights : errors;
}

/// What is known of the elements of an output now. The error consists of what the call has added, and of what its inputs had.
StreamErrors CallFollower::errorsAfter(const Written& written, const OutputErrors& errors, int kernel) const {
  StreamErrors after;
  double own = errors.ownShare();
  after.relative = errors.lost > 0 ? std::max(errors.relativeTotal(), 1.0) : errors.relativeTotal();
  if (errors.relativeIntegers() > after.relative) {
    after.relative = errors.relativeIntegers();
    own = std::min(
        1.0, static_cast<double>(errors.ownDecisions.count) / static_cast<double>(errors.decisions.count));
  }
  after.hasNan = errors.nans.count > 0;
  after.hasInfinity = errors.infinities.count > 0;
  if (after.relative > 0) {
    after.shares.add(kernel, own);
    const std::vector<double> weights = weightsOf(written);
    const double inputs = std::accumulate(weights.begin(), weights.end(), 0.0);
    for (std::size_t i = 0; i < read_.size() && inputs > 0; ++i)
      after.shares.add(read_[i].errors.shares, (1 - own) * weights[i] / inputs);
    const double missing = 1 - after.shares.sum();
    if (missing > 1e-6 && own < 1 - 1e-6) after.shares.add(shadow::writtenByHost, missing);
  }
  addRest(written, after);
  return after;
}

/// Elements outside of the region have the errors that they had.
void CallFollower::addRest(const Written& written, StreamErrors& after) const {
  if (written.stream != nullptr && written.stream->shape.size() > regionOf(written).shape.size()) {
    const StreamErrors& before = written.stream->errors;
    const double part = static_cast<double>(regionOf(written).shape.size()) /
                        static_cast<double>(written.stream->shape.size());
    const double here = after.relative * after.relative * part,
                 there = before.relative * before.relative * (1 - part);
    shadow::Shares shares;
    shares.add(after.shares, here);
    shares.add(before.shares, there);
    after.shares = shares;
    after.relative = std::sqrt(here + there);
    after.hasNan = after.hasNan || before.hasNan;
    after.hasInfinity = after.hasInfinity || before.hasInfinity;
    if (before.isEstimated && (!after.isEstimated || before.unseen != after.unseen))
      after.unseen = after.isEstimated ? shadow::notCompared : before.unseen;
    after.isEstimated = after.isEstimated || before.isEstimated;
  }
  after.shares.normalize();
}

/// What a call that is not compared is taken to leave: what compared calls of the kernel add, and what its inputs have, as those
/// calls have magnified it. The sum is more than errors of different signs add up to; what exceeds it, when the elements are
/// compared, is of calls that were not compared.
StreamErrors CallFollower::estimatedErrors(const Written& written) const {
  const shadow::Influences::Compared known = device_.influences().comparedOf(call_.kernel, written.argument);
  StreamErrors after;
  after.isEstimated = true;
  after.unseen = kernel_;
  double inputs = 0;
  for (const Read& read : read_) {
    inputs = std::max(inputs, read.errors.relative);
    after.hasNan = after.hasNan || read.errors.hasNan;
    after.hasInfinity = after.hasInfinity || read.errors.hasInfinity;
    after.exception = std::max(after.exception, read.errors.exception);
    if (read.errors.isEstimated && read.errors.unseen != kernel_) after.unseen = shadow::notCompared;
  }
  const double inherited = known.amplification * inputs;
  after.relative = known.own + inherited;
  const std::vector<double> weights = weightsOf(written);
  const double sum = std::accumulate(weights.begin(), weights.end(), 0.0);
  if (!isKnown_) {
    // The kernel may add anything, and may magnify errors of its inputs or drop them: no other kernel gets a share through it.
    after.unseen = shadow::notCompared;
    after.shares.addThrough(kernel_, 1);
    for (std::size_t i = 0; i < read_.size(); ++i)
      after.shares.addPath(read_[i].errors.shares, sum > 0 ? weights[i] / sum : 1);
  } else if (after.relative > 0) {
    after.shares.add(kernel_, known.own);
    for (std::size_t i = 0; i < read_.size() && sum > 0; ++i)
      after.shares.add(read_[i].errors.shares, inherited * weights[i] / sum);
    const double missing = after.relative - after.shares.sum();
    if (missing > 1e-6 * after.relative) after.shares.add(shadow::writtenByHost, missing);
    after.shares.normalize();
  }
  addRest(written, after);
  return after;
}

void StreamErrors::measure(double measured) {
  if (!std::exchange(isEstimated, false)) return;
  constexpr double slack = 2;  // errors of one kernel differ as much from call to call
  if (measured > slack * relative) {
    const double part = slack * relative / measured;
    shadow::Shares all;
    all.add(shares, part);
    all.add(unseen, 1 - part);
    all.addPath(shares, 1 - part);
    shares = all;
    shares.normalize();
  }
  relative = measured;
}

/// Errors of one call that was not compared, whose outputs the reference has.
void CallFollower::estimateAll() {
  const auto start = std::chrono::steady_clock::now();
  try {
    for (Written& written : written_) {
      if (written.stream == nullptr) {
        takeValue(written);
        OutputErrors errors = shadow::compare(*written.device, nullptr, nullptr, *written.total);
        StreamErrors after = estimatedErrors(written);
        after.measure(std::max(errors.relativeTotal(), errors.relativeIntegers()));
        exception_ = after.exception;
        shadow::Recorder::Access report(device_.recorder());
        recordValue(written, errors, after, *report);
      } else if (!recordPushed(written, /*hasOwn=*/false)) {
        written.stream->errors = estimatedErrors(written);
      }
    }
  } catch (const std::exception& error) {
    device_.recorder().note(fmt::format("what call {} of {} has written was not compared: {}", number_,
                                        call_.kernel.name, error.what()));
  }
  comparisonSeconds_ += std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

}  // namespace sk
