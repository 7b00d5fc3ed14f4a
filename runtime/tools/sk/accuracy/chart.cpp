// SPDX-License-Identifier: MIT
#include "accuracy/chart.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>

#include <fmt/format.h>

#include "accuracy/child_process.hpp"

namespace sk_tool {

namespace {

constexpr double gap = 9;  ///< from the centre of a point to its text
constexpr double radius = 5;  ///< of a point, with a margin
constexpr double farGap = 20;  ///< to a text connected by a line
constexpr int halfLines = 24;  ///< up and down, in half lines

struct Box {
  double left, bottom, right, top;
};

bool overlap(const Box& a, const Box& b) {
  return a.left < b.right && b.left < a.right && a.bottom < b.top && b.bottom < a.top;
}

Box boxOf(const LabelPlace& place, double textWidth) {
  return {place.x, place.y - labelHeight / 2, place.x + textWidth, place.y + labelHeight / 2};
}

/// In order of preference: beside the point, then further above and below; to the left only if that is much
/// nearer.
std::vector<LabelPlace> candidatesFor(const LabelledPoint& point) {
  constexpr int leftIsWorse = 4;  // half lines by which the left is worse
  std::vector<LabelPlace> places{{point.x + gap, point.y}};
  const auto add = [&](int step, bool isLeft) {
    const double away = step * labelHeight / 2;
    const double x = isLeft ? point.x - farGap - point.textWidth : point.x + farGap;
    places.push_back({x, point.y + away, true});
    places.push_back({x, point.y - away, true});
  };
  for (int step = 1; step <= halfLines; ++step) {
    add(step, false);
    if (step > leftIsWorse) add(step - leftIsWorse, true);
  }
  return places;
}

/// The line between a point and a distant text, as a row of dots; the text begins at its end.
std::vector<Box> lineOf(const LabelledPoint& point, const LabelPlace& place) {
  std::vector<Box> dots;
  if (!place.isApart) return dots;
  const double end = place.x > point.x ? place.x : place.x + point.textWidth;
  constexpr int count = 8;
  for (int i = 2; i < count; ++i) {  // the first dots are among the points
    const double x = point.x + (end - point.x) * i / count;
    const double y = point.y + (place.y - point.y) * i / count;
    dots.push_back({x - 1, y - 1, x + 1, y + 1});
  }
  return dots;
}

/// Occupied areas: texts and lines must not overlap other texts and lines, and texts no points.
class Taken {
 public:
  explicit Taken(std::span<const LabelledPoint> points) {
    for (const LabelledPoint& point : points) {
      points_.push_back({point.x - radius, point.y - radius, point.x + radius, point.y + radius});
    }
  }

  bool leaves(const LabelledPoint& point, const LabelPlace& place) const {
    const Box text = boxOf(place, point.textWidth);
    const std::vector<Box> line = lineOf(point, place);
    const auto meetsLine = [&](const Box& other) {
      return std::any_of(line.begin(), line.end(), [&](const Box& dot) { return overlap(dot, other); });
    };
    const auto meets = [&](const Box& other) { return overlap(text, other) || meetsLine(other); };
    return std::none_of(points_.begin(), points_.end(),
                        [&](const Box& other) { return overlap(text, other); }) &&
           std::none_of(labels_.begin(), labels_.end(), meets);
  }

  void add(const LabelledPoint& point, const LabelPlace& place) {
    labels_.push_back(boxOf(place, point.textWidth));
    const std::vector<Box> line = lineOf(point, place);
    labels_.insert(labels_.end(), line.begin(), line.end());
  }

 private:
  std::vector<Box> points_, labels_;
};

}  // namespace

std::vector<LabelPlace> placeLabels(std::span<const LabelledPoint> points, double width, double height) {
  Taken taken(points);
  std::vector<LabelPlace> places;
  for (const LabelledPoint& point : points) {
    const std::vector<LabelPlace> candidates = candidatesFor(point);
    const auto isFree = [&](const LabelPlace& place) {
      const Box text = boxOf(place, point.textWidth);
      const bool isInside = text.left >= 0 && text.right <= width && text.bottom >= 0 && text.top <= height;
      return isInside && taken.leaves(point, place);
    };
    const auto free = std::find_if(candidates.begin(), candidates.end(), isFree);
    places.push_back(free == candidates.end() ? candidates.front() : *free);
    taken.add(point, places.back());
  }
  return places;
}

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
