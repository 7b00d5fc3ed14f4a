// SPDX-License-Identifier: MIT
//
// Draws numbers to add, from a fixed seed: easy ones, and ones that cancel.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string_view>
#include <vector>

namespace sk_tool {

enum class SumData : std::uint8_t { Uniform, Signed, Wide, IllConditioned, Tiny };

struct SumDataName {
  SumData data;
  std::string_view name;
  std::string_view about;
};

inline constexpr std::array<SumDataName, 5> sumDataNames{{
    {SumData::Uniform, "uniform", "in [0, 1]"},
    {SumData::Signed, "signed", "in [-1, 1]"},
    {SumData::Wide, "wide", "of either sign, magnitudes from e^-10 to e^10"},
    {SumData::IllConditioned, "illconditioned", "that cancel but for 10^-12 of them"},
    {SumData::Tiny, "tiny", "of either sign, which, or whose products, are 2^-126 to 2^-90"},
}};

struct Pairs {
  std::vector<float> x, y;
};

/// Returns numbers x and factors y, whose products x * y are to be added; all factors are 1 unless
/// `hasFactors`.
Pairs drawPairs(SumData data, std::size_t count, bool hasFactors, unsigned seed);

}  // namespace sk_tool
