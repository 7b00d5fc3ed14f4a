// SPDX-License-Identifier: MIT
//
// Parses the quantities of `sk scale`: grids, numbers of devices, bandwidths and times. Every function throws
// std::runtime_error, which repeats the text and shows what is accepted.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace sk_tool {

/// "1e4x1e4x500": one to four extents, rows first, with a product below 2^62.
std::vector<std::int64_t> parseGrid(const std::string& text);

/// "1,2,6", or "1..4096" for the powers of two times the first number, and the last; ascending.
std::vector<std::int64_t> parseCounts(const std::string& text);

/// "25GB/s", "400Gbit/s", "1.5GiB/s": bytes per second.
double parseBandwidth(std::string_view text);

/// "2us", "800ns": seconds.
double parseTime(std::string_view text);

/// "80GB", "64GiB": bytes.
double parseBytes(std::string_view text);

/// Splits "a,b" at each separator; "" gives one empty word.
std::vector<std::string> wordsOf(const std::string& text, char separator);

}  // namespace sk_tool
