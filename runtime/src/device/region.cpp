// SPDX-License-Identifier: MIT
//
// Regions as affine maps, and the views that are made of regions: parts, strides and other shapes.
#include "device/region.hpp"

#include <algorithm>
#include <array>
#include <cstddef>
#include <numeric>
#include <vector>

#include <fmt/format.h>

#include "device/stream_state.hpp"
#include "sk/error.hpp"
#include "sk/limits.hpp"

namespace sk {

namespace {

std::size_t fromFastest(int rank, int dimension) { return static_cast<std::size_t>(rank - 1 - dimension); }

/// The same elements as a box of the stream, if they are one; else as they were given.
StreamRegion asBox(const StreamRegion& region) {
  const Shape& whole = region.stream->shape;
  if (region.shape.rank() != whole.rank() || region.shape.size() == 0) return region;
  StreamRegion box{region.stream, Index::origin(whole.rank()), region.shape};
  std::int64_t natural = whole.size(), rest = region.first;
  for (int d = 0; d < whole.rank(); ++d) {
    natural /= whole[d];
    if (region.shape[d] > 1 && region.stride[d] != natural) return region;
    box.begin[d] = rest / natural;
    rest %= natural;
    if (box.begin[d] + region.shape[d] > whole[d]) return region;
  }
  return box;
}

/// A box by its strides.
StreamRegion asStrides(const StreamRegion& region) {
  if (!isBox(region)) return region;
  const AffineRegion all = affine(region);
  StreamRegion result{region.stream, {}, region.shape, Index::origin(region.shape.rank()), all.first};
  for (int d = 0; d < region.shape.rank(); ++d)
    result.stride[d] = all.stride[fromFastest(region.shape.rank(), d)];
  return result;
}

/// A dimension of a region; 0 is the slowest.
struct Dimension {
  std::int64_t extent, stride;
};

/// A list that does not allocate.
class Dimensions {
 public:
  bool isEmpty() const { return count_ == 0; }
  Dimension& back() { return dimensions_[count_ - 1]; }
  void add(const Dimension& dimension) { dimensions_[count_++] = dimension; }
  void removeBack() { --count_; }

 private:
  std::array<Dimension, 4> dimensions_{};
  std::size_t count_ = 0;
};

/// The dimensions of a region, joined where one continues the next, without those of extent 1.
Dimensions joined(const StreamRegion& strides) {
  Dimensions dimensions;
  for (int d = 0; d < strides.shape.rank(); ++d) {
    const Dimension next{strides.shape[d], strides.stride[d]};
    if (next.extent == 1) continue;
    if (!dimensions.isEmpty() && dimensions.back().stride == next.stride * next.extent) {
      dimensions.back() = {dimensions.back().extent * next.extent, next.stride};
    } else {
      dimensions.add(next);
    }
  }
  return dimensions;
}

/// Sets the strides of `shape` so that it has the elements of these dimensions in the same order; false if there are
/// none.
bool divide(Dimensions dimensions, const Shape& shape, Index& stride) {
  for (int d = shape.rank() - 1; d >= 0; --d) {
    stride[d] = dimensions.isEmpty() ? 1 : dimensions.back().stride;
    if (shape[d] == 1) continue;
    Dimension& last = dimensions.back();
    if (last.extent % shape[d] != 0) return false;
    last = {last.extent / shape[d], last.stride * shape[d]};
    if (last.extent == 1) dimensions.removeBack();
  }
  return true;
}

/// A number of steps of one length, from `least` to `most`.
struct DimensionSteps {
  std::int64_t length, least, most;
};

/// Whether steps[from] and those after it can add up to `distance`. Lengths decrease.
bool reaches(const std::vector<DimensionSteps>& steps, std::size_t from, std::int64_t distance) {
  if (from == steps.size()) return distance == 0;
  std::int64_t least = 0, most = 0, divisor = 0;
  for (std::size_t s = from; s < steps.size(); ++s) {
    least += steps[s].length * steps[s].least;
    most += steps[s].length * steps[s].most;
    divisor = std::gcd(divisor, steps[s].length);
  }
  if (distance < least || distance > most || distance % divisor != 0) return false;
  if (from + 1 == steps.size()) return true;
  // how far the shorter steps reach leaves few numbers of the longest one
  const auto [length, fewest, mostOf] = steps[from];
  const std::int64_t restLeast = least - length * fewest, restMost = most - length * mostOf;
  const auto divideDown = [](std::int64_t a, std::int64_t b) { return a / b - (a % b < 0 ? 1 : 0); };
  const std::int64_t first = std::max(fewest, -divideDown(restMost - distance, length));
  const std::int64_t last = std::min(mostOf, divideDown(distance - restLeast, length));
  constexpr std::int64_t mostTried = 16;
  if (last - first >= mostTried) return true;
  for (std::int64_t count = first; count <= last; ++count) {
    if (reaches(steps, from + 1, distance - count * length)) return true;
  }
  return false;
}

}  // namespace

std::int64_t AffineRegion::last() const {
  std::int64_t number = first;
  for (std::size_t d = 0; d < extent.size(); ++d) number += (extent[d] - 1) * stride[d];
  return number;
}

AffineRegion affine(const StreamRegion& region) {
  AffineRegion result;
  const int rank = region.shape.rank();
  if (!isBox(region)) {
    result.first = region.first;
    for (int d = 0; d < rank; ++d) {
      result.extent[fromFastest(rank, d)] = region.shape[d];
      result.stride[fromFastest(rank, d)] = region.stride[d];
    }
    return result;
  }
  const Shape& whole = region.stream->shape;
  std::int64_t stride = 1;
  for (int d = rank - 1; d >= 0; --d) {
    result.extent[fromFastest(rank, d)] = region.shape[d];
    result.stride[fromFastest(rank, d)] = stride;
    result.first += region.begin[d] * stride;
    stride *= whole[d];
  }
  return result;
}

bool isWhole(const StreamRegion& region) { return region.shape.size() == region.stream->shape.size(); }

bool isSameRegion(const StreamRegion& a, const StreamRegion& b) {
  return a.shape == b.shape && a.placement == b.placement && affine(a) == affine(b);
}

bool overlap(const StreamRegion& a, const StreamRegion& b) {
  if (a.stream != b.stream || a.shape.size() == 0 || b.shape.size() == 0) return false;
  if (isBox(a) && isBox(b)) {
    for (int d = 0; d < a.shape.rank(); ++d) {
      if (a.begin[d] + a.shape[d] <= b.begin[d] || b.begin[d] + b.shape[d] <= a.begin[d]) return false;
    }
    return true;
  }
  const AffineRegion one = affine(a), other = affine(b);
  std::vector<DimensionSteps> steps;
  const auto add = [&](const AffineRegion& region, bool isNegative) {
    for (std::size_t d = 0; d < region.extent.size(); ++d) {
      const std::int64_t most = region.extent[d] - 1;
      if (most == 0) continue;
      const auto same = std::ranges::find(steps, region.stride[d], &DimensionSteps::length);
      DimensionSteps& added =
          same == steps.end() ? steps.emplace_back(DimensionSteps{region.stride[d], 0, 0}) : *same;
      (isNegative ? added.least : added.most) += isNegative ? -most : most;
    }
  };
  add(one, false);
  add(other, true);
  std::ranges::sort(steps, std::ranges::greater(), &DimensionSteps::length);
  return reaches(steps, 0, other.first - one.first);
}

bool isInside(const StreamRegion& region) {
  const Shape& shape = region.stream->shape;
  if (!isBox(region)) return region.shape.size() == 0 || affine(region).last() < shape.size();
  bool inside = region.shape.rank() == shape.rank();
  for (int d = 0; inside && d < shape.rank(); ++d) {
    inside = region.begin[d] + region.shape[d] <= shape[d];
  }
  return inside;
}

StreamRegion detail::partOf(const StreamRegion& region, const Index& begin, const Index& end) {
  checkExists(region, "domain");
  const int rank = region.shape.rank();
  bool isPart = begin.rank() == rank && end.rank() == rank;
  for (int d = 0; isPart && d < rank; ++d) {
    isPart = begin[d] >= 0 && begin[d] <= end[d] && end[d] <= region.shape[d];
  }
  if (!isPart) {
    throw Error(
        fmt::format(
            "domain: {} (inclusive) to {} (exclusive) is no box inside shape {}; give each a position "
            "in every dimension, rows first",
            toString(begin), toString(end), toString(region.shape)),
        Error::Kind::Shape);
  }
  StreamRegion part = region;
  part.placement = {};
  for (int d = 0; d < rank; ++d) {
    if (isBox(region)) {
      part.begin[d] += begin[d];
    } else {
      part.first += begin[d] * region.stride[d];
    }
    part.shape = part.shape.with(d, end[d] - begin[d]);
  }
  return part;
}

StreamRegion detail::placed(const StreamRegion& region, const Placement& placement) {
  checkExists(region, "placed");
  const Shape& whole = placement.whole;
  const int rank = region.shape.rank();
  if (whole.rank() != rank || placement.origin.rank() != rank) {
    throw Error(
        fmt::format("placed: a part of shape {} at {} of a whole of shape {}; give the origin and the "
                    "whole as many dimensions as the part",
                    toString(region.shape), toString(placement.origin), toString(whole)),
        Error::Kind::Shape);
  }
  bool isTrivial = true;
  for (int d = 0; d < rank; ++d) {
    const std::int64_t origin = placement.origin[d];
    if (whole[d] > mostExtent) {
      throw Error(
          fmt::format("placed: the whole of shape {} has an extent above {}, where indices end; give it "
                      "another shape, with more dimensions",
                      toString(whole), mostExtent),
          Error::Kind::Shape);
    }
    if (origin >= whole[d] || origin <= -region.shape[d] || origin + region.shape[d] > 2 * mostExtent) {
      throw Error(
          fmt::format("placed: a part of shape {} at {} has no element of a whole of shape {}; the origin is "
                      "the index in the whole of the part's first element",
                      toString(region.shape), toString(placement.origin), toString(whole)),
          Error::Kind::Shape);
    }
    isTrivial = isTrivial && origin == 0 && whole[d] == region.shape[d];
  }
  StreamRegion result = region;
  result.placement = isTrivial ? Placement{} : placement;
  return result;
}

StreamRegion detail::strided(const StreamRegion& region, const Index& steps, const Index& given) {
  checkExists(region, "stride");
  const int rank = region.shape.rank();
  const Index offsets = given.rank() == 0 ? Index::origin(rank) : given;
  bool isPossible = steps.rank() == rank && offsets.rank() == rank;
  for (int d = 0; isPossible && d < rank; ++d) {
    isPossible = steps[d] > 0 && offsets[d] >= 0 && offsets[d] <= region.shape[d];
  }
  if (!isPossible) {
    throw Error(
        fmt::format("stride: steps {} from {} do not go through shape {}; give each dimension, rows first, a "
                    "step of at least 1 and an offset from 0 to its extent",
                    toString(steps), toString(offsets), toString(region.shape)),
        Error::Kind::Shape);
  }
  StreamRegion part = asStrides(partOf(region, offsets, [&] {
    Index end = offsets;
    for (int d = 0; d < rank; ++d) end[d] = region.shape[d];
    return end;
  }()));
  for (int d = 0; d < rank; ++d) {
    const std::int64_t rest = part.shape[d];
    part.shape = part.shape.with(d, rest == 0 ? 0 : (rest - 1) / steps[d] + 1);
    if (part.shape[d] > 1) part.stride[d] *= steps[d];
  }
  return asBox(part);
}

StreamRegion detail::reshaped(const StreamRegion& region, const Shape& shape) {
  checkExists(region, "reshape");
  if (shape == region.shape) return region;
  if (shape.rank() == 0 || shape.size() != region.shape.size()) {
    throw Error(fmt::format("reshape: {} has {} element(s), but shape {} has {}; give a shape of as many",
                            toString(region.shape), region.shape.size(), toString(shape), shape.size()),
                Error::Kind::Shape);
  }
  const StreamRegion strides = asStrides(region);
  StreamRegion result{region.stream, {}, shape, Index::origin(shape.rank()), strides.first};
  if (shape.size() == 0) {
    for (int d = 0; d < shape.rank(); ++d) result.stride[d] = 1;
    return result;
  }
  if (!divide(joined(strides), shape, result.stride)) {
    throw Error(
        fmt::format("reshape: the elements of this view of shape {} do not lie at regular distances in shape "
                    "{}; copy them to a stream of their shape (copyTo) and reshape that",
                    toString(region.shape), toString(shape)),
        Error::Kind::Shape);
  }
  return asBox(result);
}

}  // namespace sk
