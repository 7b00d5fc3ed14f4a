// SPDX-License-Identifier: MIT
#include "cpp/lanes.hpp"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <utility>

#include "ir/build.hpp"
#include "transforms/predicate.hpp"
#include "transforms/testing/interpret_lanes.hpp"

namespace fuzz::cpp {
namespace {

using skc::Numbers;
namespace ir = skc::ir;

/// What the kernel gives for all elements, `lanes` at once. In the last group, some lanes have no element.
Outputs outputsOf(const ir::Module& module, const ir::Kernel& kernel, std::size_t lanes,
                  const skc::analysis::Uniformity* shapes) {
  Outputs outputs{.kernel = kernel.name};
  const Inputs& in = inputs();
  const bool hasMask = skc::entryMask(module, kernel).has_value();
  for (std::size_t first = 0; first < sampleCount; first += lanes) {
    std::vector<Numbers> arguments(hasMask ? 7 : 6, Numbers(lanes, 0.0));
    const std::size_t count = std::min<std::size_t>(lanes, sampleCount - first);
    for (std::size_t lane = 0; lane < count; ++lane) {
      arguments[0][lane] = in.a[first + lane];
      arguments[1][lane] = in.b[first + lane];
      arguments[2][lane] = in.c[first + lane];
      if (hasMask) arguments[6][lane] = 1;
    }
    const std::vector<Numbers> after =
        skc::interpretLanes(module, kernel.entry, std::move(arguments),
                            {.count = lanes, .inFull = lanes > 1, .firstIndex = first, .shapes = shapes})
            .parameters;
    for (std::size_t lane = 0; lane < count; ++lane) {
      outputs.r0[first + lane] = static_cast<std::int32_t>(after[3][lane]);
      outputs.r1[first + lane] = static_cast<std::uint32_t>(after[4][lane]);
      outputs.r2[first + lane] = static_cast<float>(after[5][lane]);
    }
  }
  return outputs;
}

}  // namespace

std::string differenceOfLanes(const ir::Module& module, const std::vector<Outputs>& wanted) {
  constexpr std::size_t lanes = 8;
  ir::Module predicated = skc::ir::clone(module);
  skc::predicate(predicated);
  std::string wrong = skc::validatePredicated(predicated);
  if (!wrong.empty()) return "lanes: " + wrong;
  for (const Outputs& outputs : wanted) {
    if (nameOf(outputs).hasOwnParameters) continue;  // the interpreter has no gathers
    const auto named = [&](const ir::Kernel& kernel) {
      return kernel.name == outputs.kernel && !kernel.isSynthesized && !kernel.pass;
    };
    const auto plain = std::ranges::find_if(module.kernels, named);
    wrong = difference(outputsOf(module, *plain, 1, nullptr), outputs);
    if (!wrong.empty()) return "IR: " + wrong;
    const auto kernel = std::ranges::find_if(predicated.kernels, named);
    const skc::analysis::Uniformity shapes(predicated, *kernel);
    wrong = difference(outputsOf(predicated, *kernel, lanes, &shapes), outputs);
    if (!wrong.empty()) return "lanes: " + wrong;
  }
  return {};
}

}  // namespace fuzz::cpp
