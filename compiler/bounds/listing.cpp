// SPDX-License-Identifier: MIT
#include "bounds/bounds.hpp"

#include <cmath>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "support/text.hpp"

namespace skc::bounds {
std::string_view nameOf(Precision precision) {
  switch (precision) {
    case Precision::Single: return "single";
    case Precision::Half: return "half";
    case Precision::Extended: return "extended";
    case Precision::Double: return "double";
  }
  return "";
}

namespace {

/// Three digits, rounded up: a bound stays one.
std::string bound(double value) {
  if (value == 0) return "0";
  if (!std::isfinite(value)) return "unknown";
  const double unit = std::pow(10, std::floor(std::log10(value)) - 2);
  std::string text = fmt::format("{:.3g}", std::ceil(value / unit * (1 - 1e-12)) * unit);
  return text;
}

/// An end of a range, of which `largest` is the larger magnitude: what the arithmetic of intervals leaves of 0 is 0.
std::string end(double value, double largest) {
  if (std::fabs(value) < 1e-12 * largest) value = 0;
  return std::isfinite(value) ? fmt::format("{:.6g}", value)
                              : std::string(value < 0 ? "-infinity" : "infinity");
}

std::string_view nameOf(Target target) { return target == Target::Native ? "native" : "fragment"; }

class Writer {
 public:
  explicit Writer(const Options& options) : options_(options) {}

  std::string write(const std::vector<KernelBounds>& kernels) {
    text_ = fmt::format("rounding errors, {} precision, {} code; inputs are exact\n",
                        nameOf(options_.precision), nameOf(options_.target));
    for (const KernelBounds& kernel : kernels) {
      text_ += fmt::format("\n{} {}", kernel.word, kernel.name);
      if (kernel.precision != options_.precision)
        text_ += fmt::format(", {} precision", nameOf(kernel.precision));
      if (!kernel.notBounded.empty()) {
        text_ += fmt::format(": not bounded: {}{}\n", kernel.notBounded, line(kernel.loc));
        continue;
      }
      text_ += "\n";
      for (const NumberBound& number : kernel.numbers) writeNumber(number);
    }
    return std::move(text_);
  }

 private:
  static std::string line(Loc loc) { return loc.line == 0 ? "" : fmt::format(" (line {})", loc.line); }

  void add(const std::string& text) { text_ += wrapLine(text, 110, 6) + "\n"; }

  void writeNumber(const NumberBound& number) {
    if (!number.notBounded.empty())
      return add(fmt::format("  {}: not bounded: {}{}", number.name, number.notBounded, line(number.loc)));
    std::string text = fmt::format("  {}: {} to {}, error at most {}", number.name,
                                   end(number.range.low, number.range.magnitude()),
                                   end(number.range.high, number.range.magnitude()), bound(number.absolute));
    if (number.relative) text += fmt::format(", relative {}", bound(*number.relative));
    if (number.isFold && options_.elements > 0) text += fmt::format(", of {} elements", options_.elements);
    add(text);
    bool isFirst = true;
    for (const Contribution& one : number.contributions) {
      if (!isFirst && one.share < 0.1) break;
      add(fmt::format("    {:.0f} % from `{}`{}", 100 * one.share, one.text, line(one.loc)));
      isFirst = false;
    }
    for (const Jump& jump : number.jumps) {
      const std::string change = std::isfinite(jump.change) ? " by up to " + bound(jump.change) : "";
      add(fmt::format("    where rounding flips `{}`{}, the result may also change{}", jump.text,
                      line(jump.loc), change));
    }
    for (const Rewrite& rewrite : number.rewrites)
      add(fmt::format("    with {} for {}: error at most {}", rewrite.to, rewrite.from,
                      bound(rewrite.bound)));
  }

  const Options& options_;
  std::string text_;
};

nlohmann::ordered_json finite(double value) {
  if (std::isfinite(value)) return value;
  return nullptr;
}

nlohmann::ordered_json jsonOf(const NumberBound& number) {
  nlohmann::ordered_json result;
  result["name"] = number.name;
  if (!number.notBounded.empty()) {
    result["not_bounded"] = number.notBounded;
    result["line"] = number.loc.line;
    return result;
  }
  result["range"] = {finite(number.range.low), finite(number.range.high)};
  result["absolute"] = finite(number.absolute);
  result["relative"] = number.relative ? finite(*number.relative) : nullptr;
  result["contributions"] = nlohmann::ordered_json::array();
  for (const Contribution& one : number.contributions)
    result["contributions"].push_back({{"line", one.loc.line}, {"text", one.text}, {"share", one.share}});
  result["jumps"] = nlohmann::ordered_json::array();
  for (const Jump& jump : number.jumps)
    result["jumps"].push_back(
        {{"line", jump.loc.line}, {"condition", jump.text}, {"change", finite(jump.change)}});
  result["rewrites"] = nlohmann::ordered_json::array();
  for (const Rewrite& rewrite : number.rewrites)
    result["rewrites"].push_back(
        {{"from", rewrite.from}, {"to", rewrite.to}, {"bound", finite(rewrite.bound)}});
  return result;
}

}  // namespace

std::string listing(const std::vector<KernelBounds>& kernels, const Options& options) {
  return Writer(options).write(kernels);
}

std::string json(const std::vector<KernelBounds>& kernels, const Options& options) {
  nlohmann::ordered_json all;
  all["precision"] = nameOf(options.precision);
  all["target"] = nameOf(options.target);
  all["kernels"] = nlohmann::ordered_json::array();
  for (const KernelBounds& kernel : kernels) {
    nlohmann::ordered_json one;
    one["name"] = kernel.name;
    one["precision"] = nameOf(kernel.precision);
    if (!kernel.notBounded.empty()) {
      one["not_bounded"] = kernel.notBounded;
      one["line"] = kernel.loc.line;
    }
    one["numbers"] = nlohmann::ordered_json::array();
    for (const NumberBound& number : kernel.numbers) one["numbers"].push_back(jsonOf(number));
    all["kernels"].push_back(std::move(one));
  }
  return all.dump(1) + "\n";
}

}  // namespace skc::bounds
