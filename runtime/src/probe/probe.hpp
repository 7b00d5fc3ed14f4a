// SPDX-License-Identifier: MIT
//
// Determines, with a program that computes rounding errors, whether a device's compiler can be kept from
// simplifying them away. The program runs when the answer is first needed; the result is cached for the
// driver (support/cache_folder.hpp).
#pragma once

#include <array>
#include <string_view>
#include <utility>
#include <vector>

#include "sk/arithmetic.hpp"
#include "sk/types.hpp"

namespace sk {

class GlDevice;

/// The spellings in options and the environment.
inline constexpr std::array<std::pair<Barrier, std::string_view>, 3> barrierNames{
    {{Barrier::Precise, "precise"}, {Barrier::Xor, "xor"}, {Barrier::None, "none"}}};

/// Pairs whose sum, product and rounding errors are normal numbers or 0: corner cases, and random pairs over
/// the whole range, of similar and of very different magnitude. The same in every process.
std::vector<float2> trialPairs(std::size_t count);
/// The sum, its rounding error, the product and its rounding error, according to IEEE 754.
float4 exactSumAndProduct(const float2& pair);

/// Sets the device's barrier to the first one that works, in the order above. If none works, the device keeps
/// the strongest that its language has, for programs that do not need exact sums. No DeviceScope may be open.
Arithmetic probeArithmetic(GlDevice& device);

}  // namespace sk
