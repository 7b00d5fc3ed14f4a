// SPDX-License-Identifier: MIT
#include "accuracy/element_errors.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>

#include <fmt/format.h>

#include "info/error_statistics.hpp"

namespace sk_tool {

namespace {

Json inputsAt(const std::vector<NamedInput>& inputs, std::size_t at) {
  Json json;
  for (const NamedInput& input : inputs) {
    const float value = (*input.values)[at];
    json[input.name] = {{"value", value},
                        {"bits", fmt::format("0x{:08x}", std::bit_cast<std::uint32_t>(value))}};
  }
  return json;
}

/// The reference, or infinity if it is out of the range of floats.
double inRangeOfFloats(double reference) {
  constexpr double largest = std::numeric_limits<float>::max();
  return std::fabs(reference) > largest ? std::copysign(HUGE_VAL, reference) : reference;
}

}  // namespace

Grade gradeElements(const std::vector<float>& results, const std::vector<double>& reference,
                    const std::vector<NamedInput>& inputs) {
  constexpr double smallest = std::numeric_limits<float>::min();
  double relative = 0, largest = -1, sum = 0, wrongClass = 0;
  std::size_t worst = 0, numbers = 0;
  for (std::size_t i = 0; i < results.size(); ++i) {
    const double exact = inRangeOfFloats(reference[i]);
    if (!std::isfinite(exact) || !std::isfinite(results[i])) {
      const bool isRight = std::isnan(exact) ? std::isnan(results[i]) : exact == results[i];
      if (!isRight && ++wrongClass == 1) worst = i;
      continue;
    }
    const double error = std::fabs(results[i] - exact);
    relative = std::max(relative, error / std::max(std::fabs(exact), smallest));
    const double ulps = error / ulpOf(exact);
    sum += ulps;
    ++numbers;
    if (ulps > largest) {
      largest = ulps;
      if (wrongClass == 0) worst = i;
    }
  }
  if (wrongClass > 0) relative = HUGE_VAL;
  return {.metrics = {{"rel err", relative},
                      {"max ulp", numbers == 0 && wrongClass > 0 ? HUGE_VAL : std::max(largest, 0.0)},
                      {"mean ulp", numbers > 0      ? sum / static_cast<double>(numbers)
                                   : wrongClass > 0 ? HUGE_VAL
                                                    : 0},
                      {"wrong class", wrongClass}},
          .worst = inputsAt(inputs, worst)};
}

}  // namespace sk_tool
