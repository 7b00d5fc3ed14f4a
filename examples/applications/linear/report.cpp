// SPDX-License-Identifier: MIT
#include "report.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <vector>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

namespace linear {
namespace {

/// Powers of ten from below the smallest to above the largest residual, and the last iteration.
struct Axes {
  Axes(std::span<const HistoryPoint> history, double tolerance) {
    int least = std::numeric_limits<int>::max(), greatest = std::numeric_limits<int>::min();
    const auto take = [&](double value) {
      if (!(value > 0.0) || !std::isfinite(value)) return;
      least = std::min(least, static_cast<int>(std::floor(std::log10(value))));
      greatest = std::max(greatest, static_cast<int>(std::ceil(std::log10(value))));
    };
    for (const HistoryPoint& p : history) take(p.residual);
    take(tolerance);
    low = least;
    high = std::max(greatest, least + 1);
    last = std::max<std::int64_t>(history.back().iteration, 1);
  }
  /// From 0, at the bottom, to 1.
  double heightOf(double residual) const {
    if (!(residual > 0.0)) return 0.0;
    return std::clamp((std::log10(residual) - low) / (high - low), 0.0, 1.0);
  }
  double placeOf(std::int64_t iteration) const {
    return static_cast<double>(iteration) / static_cast<double>(last);
  }

  int low = 0, high = 1;
  std::int64_t last = 1;
};

std::string escaped(const std::string& text) {
  std::string result;
  for (const char c : text) {
    if (c == '<')
      result += "&lt;";
    else if (c == '&')
      result += "&amp;";
    else
      result += c;
  }
  return result;
}

}  // namespace

std::string textOf(const Account& account, const Solution& solution) {
  std::string text;
  const auto out = std::back_inserter(text);
  fmt::format_to(out, "layout {}", account.layout);
  if (!account.offsetBits.empty()) fmt::format_to(out, ", offsets of {} bits", account.offsetBits);
  if (account.stored > 0) fmt::format_to(out, ", {} entries stored for {}", account.stored, account.entries);
  for (std::size_t i = 0; i < account.costs.size(); ++i)
    fmt::format_to(out, "{}{} {:.3g} KB", i == 0 ? "; estimated cost of a product: " : ", ",
                   account.costs[i].layout, account.costs[i].bytes / 1000.0);
  if (account.bandwidths)
    fmt::format_to(out, "\nentries at most {} from the diagonal, {} before the unknowns were reordered",
                   account.bandwidths->after, account.bandwidths->before);
  if (account.hierarchy) {
    std::string sizes;
    for (const HierarchyAccount::Level& level : account.hierarchy->levels)
      sizes += fmt::format("{}{}", sizes.empty() ? "" : ", ", level.unknowns);
    fmt::format_to(out, "\nlevels of {} unknowns, operator complexity {:.3g}, set up in {:.3g} ms", sizes,
                   account.hierarchy->operatorComplexity(), account.hierarchy->seconds * 1000.0);
  }
  fmt::format_to(out, "\n{} after {} iterations", nameOf(solution.outcome), solution.iterations);
  if (solution.restarts > 0)
    fmt::format_to(out, ", begun anew {} times for the residual in double precision", solution.restarts);
  fmt::format_to(
      out, "\nresidual {:.3g} (known to {:.1g}; {:.3g} as the method computed it), backward error {:.3g}\n",
      solution.residualTrue, solution.residualError, solution.residualRecurred, solution.backwardError);
  if (solution.removedMean != 0.0)
    fmt::format_to(out, "the right-hand side's mean {:.6g} was removed, for no x reaches a constant\n",
                   solution.removedMean);
  return text;
}

std::string jsonOf(const Account& account, const Solution& solution) {
  nlohmann::ordered_json json;
  json["outcome"] = nameOf(solution.outcome);
  json["iterations"] = solution.iterations;
  json["restarts"] = solution.restarts;
  json["residual_true"] = solution.residualTrue;
  json["residual_error"] = solution.residualError;
  json["residual_recurred"] = solution.residualRecurred;
  json["backward_error"] = solution.backwardError;
  json["removed_mean"] = solution.removedMean;
  json["seconds"] = solution.seconds;
  json["layout"] = account.layout;
  if (!account.offsetBits.empty()) json["offset_bits"] = account.offsetBits;
  json["fill"] = account.fill();
  if (account.bandwidths)
    json["bandwidth"] = {{"before", account.bandwidths->before}, {"after", account.bandwidths->after}};
  if (!account.factors.empty()) {
    json["factors"] = account.factors;
    json["factor_entries"] = account.factorEntries;
  }
  if (account.distance) json["distance_to_direct"] = *account.distance;
  json["device"] = account.device;
  const double iterations = static_cast<double>(std::max<std::int64_t>(1, solution.iterations));
  json["rates"]["per_iteration"] = std::pow(solution.residualTrue, 1.0 / iterations);
  json["rates"]["levels"] = nlohmann::ordered_json::array();
  for (const LevelRate& level : account.rates) {
    nlohmann::ordered_json row;
    for (int d = level.grid.rank() - 1; d >= 0; --d) row["grid"].push_back(level.grid[d]);
    row["rate"] = level.rate;
    json["rates"]["levels"].push_back(row);
  }
  if (account.hierarchy) {
    auto& hierarchy = json["hierarchy"];
    hierarchy["levels"] = nlohmann::ordered_json::array();
    for (const HierarchyAccount::Level& level : account.hierarchy->levels)
      hierarchy["levels"].push_back(
          {{"unknowns", level.unknowns}, {"entries", level.entries}, {"layout", level.layout}});
    hierarchy["operator_complexity"] = account.hierarchy->operatorComplexity();
    hierarchy["setup_seconds"] = account.hierarchy->seconds;
  }
  return json.dump(2) + "\n";
}

std::string textChart(std::span<const HistoryPoint> history, double tolerance) {
  if (history.size() < 2) return "";
  constexpr int width = 64, height = 12;
  const Axes axes(history, tolerance);
  std::vector<std::string> lines(height, std::string(width, ' '));
  const auto lineOf = [&](double residual) {
    return static_cast<std::size_t>(std::lround((1.0 - axes.heightOf(residual)) * (height - 1)));
  };
  lines[lineOf(tolerance)].assign(width, '.');
  for (const HistoryPoint& p : history)
    lines[lineOf(p.residual)]
         [static_cast<std::size_t>(std::lround(axes.placeOf(p.iteration) * (width - 1)))] = '*';
  std::string text;
  for (std::size_t i = 0; i < lines.size(); ++i) {
    const std::string label = i == 0                  ? fmt::format("1e{}", axes.high)
                              : i + 1 == lines.size() ? fmt::format("1e{}", axes.low)
                                                      : "";
    fmt::format_to(std::back_inserter(text), "  {:>6} |{}\n", label,
                   lines[i].substr(0, lines[i].find_last_not_of(' ') + 1));
  }
  fmt::format_to(std::back_inserter(text), "  {:>6} +{:-<{}}\n  {:>6}  0{:>{}}\n", "", "", width, "",
                 axes.last, width - 1);
  return text;
}

std::string svgChart(std::span<const HistoryPoint> history, double tolerance, const std::string& title) {
  constexpr double width = 640.0, height = 400.0, left = 64.0, right = 16.0, top = 40.0, bottom = 48.0;
  const std::vector<HistoryPoint> points = history.empty()
                                               ? std::vector<HistoryPoint>{{0, 1.0}}
                                               : std::vector<HistoryPoint>(history.begin(), history.end());
  const Axes axes(points, tolerance);
  const auto x = [&](std::int64_t iteration) {
    return left + axes.placeOf(iteration) * (width - left - right);
  };
  const auto y = [&](double residual) {
    return top + (1.0 - axes.heightOf(residual)) * (height - top - bottom);
  };
  std::string svg = fmt::format(
      "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {0} {1}\" font-family=\"sans-serif\" "
      "font-size=\"12\">\n"
      "<rect width=\"{0}\" height=\"{1}\" fill=\"white\"/>\n<text x=\"{2}\" y=\"24\" "
      "font-size=\"14\">{3}</text>\n",
      width, height, left, escaped(title));
  const auto out = std::back_inserter(svg);
  const int step = std::max(1, (axes.high - axes.low) / 8);
  for (int e = axes.low; e <= axes.high; e += step) {
    const double at = y(std::pow(10.0, e));
    fmt::format_to(out,
                   "<line x1=\"{0}\" x2=\"{1}\" y1=\"{2:.1f}\" y2=\"{2:.1f}\" stroke=\"#ddd\"/>\n"
                   "<text x=\"{3}\" y=\"{4:.1f}\" text-anchor=\"end\">1e{5}</text>\n",
                   left, width - right, at, left - 8.0, at + 4.0, e);
  }
  fmt::format_to(
      out,
      "<line x1=\"{}\" x2=\"{}\" y1=\"{:.1f}\" y2=\"{:.1f}\" stroke=\"#c33\" stroke-dasharray=\"4 3\"/>\n"
      "<polyline fill=\"none\" stroke=\"#236\" stroke-width=\"1.5\" points=\"",
      left, width - right, y(tolerance), y(tolerance));
  for (const HistoryPoint& p : points) fmt::format_to(out, "{:.1f},{:.1f} ", x(p.iteration), y(p.residual));
  fmt::format_to(out,
                 "\"/>\n<text x=\"{}\" y=\"{}\">0</text>\n<text x=\"{}\" y=\"{}\" text-anchor=\"end\">{} "
                 "iterations</text>\n</svg>\n",
                 left, height - bottom + 20.0, width - right, height - bottom + 20.0, axes.last);
  return svg;
}

}  // namespace linear
