// SPDX-License-Identifier: MIT
#include "scale/rates.hpp"

#include <algorithm>
#include <chrono>
#include <functional>
#include <stdexcept>

#include <fmt/format.h>

#include "accuracy/file/call.hpp"
#include "accuracy/file/inputs.hpp"
#include "quantile.hpp"
#include "scale/quantities.hpp"

namespace sk_tool {

namespace {

constexpr int rounds = 5;
constexpr double leastTime =
    0.02;  ///< seconds of a round, so that the clock and the last finish() do not matter
constexpr std::int64_t smallElements = 1 << 12;

/// Seconds of one call of `work`, the median of several rounds with as many calls as `leastTime` takes.
double timeOf(sk::Device& device, const std::function<void()>& work) {
  using Clock = std::chrono::steady_clock;
  const auto seconds = [&](int calls) {
    device.finish();
    const Clock::time_point start = Clock::now();
    for (int i = 0; i < calls; ++i) work();
    device.finish();
    return std::chrono::duration<double>(Clock::now() - start).count();
  };
  seconds(1);  // compiles
  const double once = std::max(seconds(1), 1e-7);
  const int calls = static_cast<int>(std::clamp(leastTime / once, 1.0, 1000.0));
  std::vector<double> times;
  for (int round = 0; round < rounds; ++round) times.push_back(seconds(calls) / calls);
  return median(times);
}

/// A fixed time and a time for each unit, from the times of two amounts.
struct Line {
  double fixed, perUnit;

  Line(double fewUnits, double fewTime, double manyUnits, double manyTime)
      : perUnit(std::max((manyTime - fewTime) / (manyUnits - fewUnits), 1e-15)) {
    fixed = std::max(fewTime - fewUnits * perUnit, 0.0);
  }
};

/// The time of a call with inputs for a domain, and the number of its elements.
std::pair<double, double> timeOfCall(sk::Device& device, const Subject& subject, const Ranges& ranges,
                                     int rank, std::int64_t elements) {
  const sk::Shape domain = cubeOf(rank, elements);
  const Extent extent{.domain = domain, .results = subject.isReduce() ? cubeOf(rank, 1) : domain, .draws = 1};
  const Inputs inputs = drawInputs(subject, ranges, extent, Extremes::None);
  Call call(device, subject, inputs);
  return {timeOf(device, [&] { call.run({}, 0); }), static_cast<double>(domain.size())};
}

/// Times the interior and a border of a domain, as calls that exchange halos compute them.
Boxes measureBoxes(sk::Device& device, const Subject& subject, const Ranges& ranges, int rank,
                   std::int64_t elements, double wholeTime) {
  constexpr std::int64_t border = 4;
  const sk::Shape domain = cubeOf(rank, elements);
  if (domain[0] <= 4 * border) return {.borderTime = wholeTime};
  const Inputs inputs =
      drawInputs(subject, ranges, {.domain = domain, .results = domain, .draws = 1}, Extremes::None);
  Call call(device, subject, inputs);
  sk::Box inner{sk::Index::origin(rank), sk::Index::origin(rank)};
  for (int d = 0; d < rank; ++d) inner.end[d] = domain[d];
  sk::Box first = inner;
  inner.begin[0] = border;
  inner.end[0] -= border;
  first.end[0] = border;
  const double innerTime = timeOf(device, [&] { call.run({.box = inner}, 0); });
  const double share = static_cast<double>(domain[0] - 2 * border) / static_cast<double>(domain[0]);
  return {.factor = std::max(innerTime / (share * wholeTime), 1.0),
          .borderTime = timeOf(device, [&] { call.run({.box = first}, 0); })};
}

}  // namespace

GivenRate GivenRate::parse(const std::string& text) {
  const std::size_t equals = text.find('=');
  const std::vector<std::string> words =
      wordsOf(text.substr(equals == std::string::npos ? 0 : equals + 1), ',');
  std::size_t read = 0;
  double perSecond = 0;
  try {
    perSecond = std::stod(words[0], &read);
  } catch (const std::logic_error&) {  // not a number
  }
  if (equals == std::string::npos || equals == 0 || words.size() > 2 || words[0].substr(read) != "/s" ||
      !(perSecond > 0) || perSecond > 1e18) {
    throw std::runtime_error(fmt::format(
        "'{}' is no rate; give KERNEL=ELEMENTS/s[,TIME OF A CALL] as in diffuse=2.5e9/s,5us", text));
  }
  const double perCall = words.size() > 1 ? parseTime(words[1]) : 0;
  return {.kernel = text.substr(0, equals),
          .rate = {.perCall = perCall,
                   .perElement = 1 / perSecond,
                   .source = "given",
                   .boxes = {.borderTime = perCall}}};
}

std::string obstacleToMeasuring(const Subject& subject) {
  if (subject.reduction == nullptr || subject.reduction->parts == nullptr) return {};
  return fmt::format(
      "'{}' folds beside its outputs, which cannot be measured with drawn inputs; give --rate {}=ELEMENTS/s",
      subject.name(), subject.name());
}

Rate measureRate(sk::Device& device, const Subject& subject, const Ranges& ranges, int rank,
                 std::int64_t elements) {
  const auto [fewTime, few] =
      timeOfCall(device, subject, ranges, rank, std::min(smallElements, elements / 8));
  const auto [manyTime, many] = timeOfCall(device, subject, ranges, rank, elements);
  const Line line(few, fewTime, many, manyTime);
  Rate rate{.perCall = line.fixed,
            .perElement = line.perUnit,
            .source = fmt::format("measured, {} elements", many),
            .boxes = {.borderTime = line.fixed}};
  if (subject.reduction == nullptr && !device.shadingLanguage().empty())
    rate.boxes = measureBoxes(device, subject, ranges, rank, elements, manyTime);
  return rate;
}

Staging measureStaging(sk::Device& device) {
  if (device.shadingLanguage().empty()) return {};
  constexpr std::int64_t few = 1 << 12, many = 1 << 18;
  double read[2], write[2];
  for (const bool isLarge : {false, true}) {
    const std::int64_t elements = isLarge ? many : few;
    auto stream = device.stream<float>({elements});
    std::vector<float> host(static_cast<std::size_t>(elements));
    write[isLarge] = timeOf(device, [&] { stream.write(host); });
    read[isLarge] = timeOf(device, [&] { stream.read(host); });
  }
  const Line reading(4 * few, read[0], 4 * many, read[1]), writing(4 * few, write[0], 4 * many, write[1]);
  return {.readTime = reading.fixed,
          .readBandwidth = 1 / reading.perUnit,
          .writeTime = writing.fixed,
          .writeBandwidth = 1 / writing.perUnit};
}

}  // namespace sk_tool
