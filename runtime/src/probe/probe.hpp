// SPDX-License-Identifier: MIT
//
// Finding out whether a device's compiler can be kept from simplifying rounding errors away, by a program that computes
// them. It runs where a program first needs to know, and what comes of it is kept for the driver (support/cache_folder.hpp).
#pragma once

#include <array>
#include <string_view>
#include <utility>
#include <vector>

#include "sk/arithmetic.hpp"
#include "sk/types.hpp"

namespace sk {

class GlDevice;

/// As options and environment spell them.
inline constexpr std::array<std::pair<Barrier, std::string_view>, 3> barrierNames{
    {{Barrier::Precise, "precise"}, {Barrier::Xor, "xor"}, {Barrier::None, "none"}}};

/// Pairs whose sum and product, and what these lose, are normal numbers or 0: the corners, and random ones over the
/// range, close to each other and far apart. The same in every process.
std::vector<float2> trialPairs(std::size_t count);
/// The sum, what it loses, the product and what that loses, as IEEE 754 rounds them.
float4 exactSumAndProduct(const float2& pair);

/// The first barrier of the device, in that order, that holds. Where none does, the device keeps the strongest that
/// its language has, for programs that can do with less than exact sums. No DeviceScope may be open.
Arithmetic probeArithmetic(GlDevice& device);

}  // namespace sk
