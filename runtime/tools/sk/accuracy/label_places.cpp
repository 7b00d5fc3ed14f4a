// SPDX-License-Identifier: MIT
#include "accuracy/label_places.hpp"

#include <algorithm>

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

}  // namespace sk_tool
