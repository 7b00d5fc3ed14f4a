// SPDX-License-Identifier: MIT
#include "scale/quantities.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <optional>
#include <span>
#include <stdexcept>

#include <fmt/format.h>

namespace sk_tool {

namespace {

struct Unit {
  std::string_view name;
  double size;
};

constexpr std::array<Unit, 5> times = {{{"ns", 1e-9}, {"us", 1e-6}, {"µs", 1e-6}, {"ms", 1e-3}, {"s", 1}}};
constexpr std::array<Unit, 14> memories = {{{"B", 1},
                                            {"kB", 1e3},
                                            {"MB", 1e6},
                                            {"GB", 1e9},
                                            {"TB", 1e12},
                                            {"KiB", 0x1p10},
                                            {"MiB", 0x1p20},
                                            {"GiB", 0x1p30},
                                            {"TiB", 0x1p40},
                                            {"bit", 0.125},
                                            {"kbit", 125},
                                            {"Mbit", 125e3},
                                            {"Gbit", 125e6},
                                            {"Tbit", 125e9}}};

constexpr std::int64_t mostDevices = 1 << 20;

/// Parses a number at the start of `text`, and removes it.
std::optional<double> takeNumber(std::string_view& text) {
  double number = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  if (error != std::errc{} || !std::isfinite(number)) return std::nullopt;
  text.remove_prefix(static_cast<std::size_t>(end - text.data()));
  return number;
}

/// A positive number with one of the units; nullopt if the text is something else.
std::optional<double> quantityIn(std::string_view text, std::span<const Unit> units) {
  const std::optional<double> number = takeNumber(text);
  const auto unit = std::ranges::find(units, text, &Unit::name);
  if (!number || *number <= 0 || unit == units.end()) return std::nullopt;
  return *number * unit->size;
}

/// A whole number of at least 1, which may be written as "1e4".
std::optional<std::int64_t> wholeIn(std::string_view text) {
  const std::optional<double> number = takeNumber(text);
  if (!number || !text.empty() || *number < 1 || *number > 0x1p62 || *number != std::floor(*number))
    return std::nullopt;
  return static_cast<std::int64_t>(*number);
}

}  // namespace

std::vector<std::string> wordsOf(const std::string& text, char separator) {
  std::vector<std::string> words{""};
  for (const char c : text) {
    if (c == separator) {
      words.emplace_back();
    } else {
      words.back() += c;
    }
  }
  return words;
}

std::vector<std::int64_t> parseGrid(const std::string& text) {
  std::vector<std::int64_t> extents;
  double elements = 1;
  for (const std::string& word : wordsOf(text, 'x')) {
    const std::optional<std::int64_t> extent = wholeIn(word);
    if (!extent) {
      throw std::runtime_error(
          fmt::format("'{}' is no grid; give the extents, rows first, as in 1e4x1e4x500", text));
    }
    extents.push_back(*extent);
    elements *= static_cast<double>(*extent);
  }
  if (extents.size() > 4)
    throw std::runtime_error(fmt::format("the grid '{}' has more than four dimensions", text));
  if (elements >= 0x1p62)
    throw std::runtime_error(fmt::format("the grid '{}' has 2^62 elements or more", text));
  return extents;
}

std::vector<std::int64_t> parseCounts(const std::string& text) {
  const auto count = [&text](const std::string& word) {
    const std::optional<std::int64_t> number = wholeIn(word);
    if (!number || *number > mostDevices) {
      throw std::runtime_error(fmt::format(
          "'{}' is no number of GPUs; give a range as in 1..4096, or a list as in 1,2,6, of at most {}", text,
          mostDevices));
    }
    return *number;
  };
  std::vector<std::int64_t> counts;
  if (const std::size_t dots = text.find(".."); dots != std::string::npos) {
    const std::int64_t first = count(text.substr(0, dots)), last = count(text.substr(dots + 2));
    if (last < first) throw std::runtime_error(fmt::format("the range '{}' ends before it begins", text));
    for (std::int64_t number = first; number < last; number *= 2) counts.push_back(number);
    counts.push_back(last);
  } else {
    for (const std::string& word : wordsOf(text, ',')) counts.push_back(count(word));
    std::sort(counts.begin(), counts.end());
    counts.erase(std::unique(counts.begin(), counts.end()), counts.end());
  }
  return counts;
}

double parseBandwidth(std::string_view text) {
  const bool isRate = text.ends_with("/s");
  const std::optional<double> bytes = quantityIn(text.substr(0, text.size() - (isRate ? 2 : 0)), memories);
  if (!isRate || !bytes) {
    throw std::runtime_error(fmt::format("'{}' is no bandwidth; give one as in 25GB/s or 200Gbit/s", text));
  }
  return *bytes;
}

double parseTime(std::string_view text) {
  const std::optional<double> time = quantityIn(text, times);
  if (!time) throw std::runtime_error(fmt::format("'{}' is no time; give one as in 2us or 800ns", text));
  return *time;
}

double parseBytes(std::string_view text) {
  const std::optional<double> bytes = quantityIn(text, memories);
  if (!bytes)
    throw std::runtime_error(fmt::format("'{}' is no size of memory; give one as in 80GB or 64GiB", text));
  return *bytes;
}

}  // namespace sk_tool
