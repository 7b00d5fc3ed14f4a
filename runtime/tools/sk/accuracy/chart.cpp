// SPDX-License-Identifier: MIT
#include "accuracy/chart.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>

#include <fmt/format.h>

#include "accuracy/gnuplot.hpp"
#include "accuracy/label_places.hpp"

namespace sk_tool {

namespace {

/// An error of 0 has no logarithm: it is drawn a decade below the smallest other error.
double floorOf(const Experiment& experiment) {
  double least = 0x1p-24;
  for (const Row& row : experiment.rows) {
    if (!row.isRefused() && row.grade.error() > 0) least = std::min(least, row.grade.error());
  }
  return least / 10;
}

struct Point {
  double time, error;  ///< as drawn: a ratio, and a decimal logarithm
  std::string text;
  bool isPareto;
};

std::vector<Point> pointsOf(const Experiment& experiment) {
  std::vector<Point> points;
  for (const Row& row : experiment.rows) {
    const double error = row.grade.metrics.empty() ? HUGE_VAL : row.grade.error();
    if (row.isRefused() || !std::isfinite(error)) continue;
    points.push_back({row.time.median, std::log10(std::max(error, floorOf(experiment))),
                      error == 0 ? row.mode + " (error 0)" : row.mode, row.isPareto});
  }
  return points;
}

/// The range of an axis.
struct Span {
  double low, high;

  double size() const { return high - low; }
  /// Covers all values and at least `least`, with margins as fractions of the range.
  static Span around(const std::vector<Point>& points, double Point::* value, double least, double below,
                     double above) {
    const auto less = [value](const Point& a, const Point& b) { return a.*value < b.*value; };
    const auto [first, last] = std::minmax_element(points.begin(), points.end(), less);
    const double middle = ((*first).*value + (*last).*value) / 2;
    const double size = std::max((*last).*value - (*first).*value, least);
    return {middle - size / 2 - below * size, middle + size / 2 + above * size};
  }
};

// Sizes in pixels: a panel, and the part of it inside the axes.
constexpr double panelWidth = 520, panelHeight = 360;
constexpr double leftMargin = 70, rightMargin = 20, bottomMargin = 60, topMargin = 40;
constexpr double plotWidth = panelWidth - leftMargin - rightMargin;
constexpr double plotHeight = panelHeight - bottomMargin - topMargin;
constexpr double headHeight = 40;  ///< of the head above all panels
constexpr double letterWidth = 7.6;  ///< of a letter, generously

const char* colorOf(const Point& point) { return point.isPareto ? "#1b5e9b" : "#888888"; }

/// The names of points, with lines to names that are further away.
std::string labelsOf(const std::vector<Point>& points, const Span& times, const Span& errors) {
  std::vector<LabelledPoint> places;
  for (const Point& point : points) {
    places.push_back({(point.time - times.low) / times.size() * plotWidth,
                      (point.error - errors.low) / errors.size() * plotHeight,
                      letterWidth * static_cast<double>(point.text.size())});
  }
  const std::vector<LabelPlace> labels = placeLabels(places, plotWidth, plotHeight);
  std::string script;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const LabelPlace& label = labels[i];
    fmt::format_to(std::back_inserter(script),
                   "set label {} at graph {:.4f},{:.4f} left noenhanced tc rgb '{}'\n",
                   quoted(points[i].text), label.x / plotWidth, label.y / plotHeight, colorOf(points[i]));
    if (!label.isApart) continue;
    const bool isRight = label.x > places[i].x;
    const double end = isRight ? label.x - 3 : label.x + places[i].textWidth;
    fmt::format_to(std::back_inserter(script),
                   "set arrow from graph {:.4f},{:.4f} to graph {:.4f},{:.4f} nohead lc rgb '#bbbbbb' back\n",
                   places[i].x / plotWidth, places[i].y / plotHeight, end / plotWidth, label.y / plotHeight);
  }
  return script;
}

std::string panelOf(const Experiment& experiment, std::size_t number) {
  const std::vector<Point> points = pointsOf(experiment);
  std::string script = "unset label\nunset arrow\n";
  std::string plot = " NaN";
  if (!points.empty()) {
    const Span times = Span::around(points, &Point::time, 0.2, 0.15, 0.45);
    const Span errors = Span::around(points, &Point::error, 2, 0.15, 0.15);
    fmt::format_to(std::back_inserter(script), "set xrange [{}:{}]\nset yrange [{}:{}]\n{}$points{} << END\n",
                   times.low, times.high, errors.low, errors.high, labelsOf(points, times, errors), number);
    for (const Point& point : points) {
      fmt::format_to(std::back_inserter(script), "{} {} {}\n", point.time, point.error,
                     point.isPareto ? "0x1b5e9b" : "0x888888");
    }
    script += "END\n";
    plot = fmt::format(" $points{} using 1:2:3 with points pt 7 ps 0.8 lc rgb variable", number);
  }
  return fmt::format("{}set title {}\nplot{}\n", script, quoted(experiment.program + ", " + experiment.data),
                     plot);
}

/// The margins of a panel, as fractions of the whole picture, as gnuplot requires.
std::string marginsOf(std::size_t number, std::size_t columns, std::size_t rows) {
  const double width = static_cast<double>(columns) * panelWidth;
  const double height = static_cast<double>(rows) * panelHeight + headHeight;
  const double left = static_cast<double>(number % columns) * panelWidth + leftMargin;
  const double bottom = static_cast<double>(rows - 1 - number / columns) * panelHeight + bottomMargin;
  return fmt::format(
      "set lmargin at screen {:.4f}\nset rmargin at screen {:.4f}\nset bmargin at screen {:.4f}\nset tmargin "
      "at screen {:.4f}\n",
      left / width, (left + plotWidth) / width, bottom / height, (bottom + plotHeight) / height);
}

std::string scriptOf(const std::string& file, const std::string& device,
                     const std::vector<Experiment>& experiments) {
  const std::size_t columns = experiments.size() > 1 ? 2 : 1;
  const std::size_t rows = (experiments.size() + columns - 1) / columns;
  std::string script = terminalOf(file, static_cast<double>(columns) * panelWidth,
                                  static_cast<double>(rows) * panelHeight + headHeight);
  script += fmt::format(
      "set key off\nset grid lt 1 lc rgb '#dddddd'\nset border 3\nset tics nomirror\n"
      "set xlabel 'time over that of the first mode'\nset ylabel 'log10 of the relative error'\n"
      "set multiplot title {} noenhanced\n",
      quoted("sk accuracy on " + device));
  for (std::size_t i = 0; i < experiments.size(); ++i) {
    script += marginsOf(i, columns, rows) + panelOf(experiments[i], i);
  }
  return script + "unset multiplot\n";
}

}  // namespace

void drawChart(const std::string& file, const std::string& device,
               const std::vector<Experiment>& experiments) {
  runGnuplot(file, scriptOf(file, device, experiments));
}

}  // namespace sk_tool
