// SPDX-License-Identifier: MIT
//
// Divides the elements of a domain among threads: rows in pieces of neighbours.
#pragma once

#include <algorithm>
#include <cstdint>

#include "native/call.hpp"
#include "sk/native/code.hpp"
#include "sk/native/parallel.hpp"

namespace sk {

/// The rows of a domain, divided into pieces of neighbours along x.
class DomainPieces {
 public:
  /// If the times of elements may differ widely, pieces are short.
  DomainPieces(const native::Extents& domain, bool areUneven)
      : domain_(domain),
        longest_(areUneven ? 1 << 6 : 1 << 13),
        perRow_((domain[0] + longest_ - 1) / longest_) {}

  std::int64_t count() const { return perRow_ * domain_[1] * domain_[2] * domain_[3]; }
  std::int64_t elementsOfOne() const { return std::min(domain_[0], longest_); }

  /// Calls visit(first, count, rows) for the elements of these pieces in order. It joins pieces in one row,
  /// and also whole rows below each other, at most `mostRows` of them.
  template <class Visit>
  void forEachRun(native::Range pieces, std::int64_t mostRows, Visit&& visit) const {
    native::Extents at = firstOf(pieces.begin);
    for (std::int64_t left = pieces.end - pieces.begin; left > 0;) {
      std::int64_t end = domain_[0], rows = 1;
      if (at[0] == 0 && left >= perRow_) {
        rows = std::min({left / perRow_, mostRows, domain_[1] - at[1]});
        left -= rows * perRow_;
      } else {
        end = std::min(end, at[0] + left * longest_);
        left -= (end - at[0] + longest_ - 1) / longest_;
      }
      visit(at, end - at[0], static_cast<std::size_t>(rows));
      at[0] = 0;
      at[1] += rows - 1;
      for (std::size_t d = 1; d < 4 && ++at[d] == domain_[d]; ++d) at[d] = 0;
    }
  }

 private:
  native::Extents firstOf(std::int64_t piece) const {
    const std::int64_t row = piece / perRow_;
    return {piece % perRow_ * longest_, row % domain_[1], row / domain_[1] % domain_[2],
            row / domain_[1] / domain_[2]};
  }

  native::Extents domain_;
  std::int64_t longest_;
  std::int64_t perRow_;
};

/// The rows of a domain in blocks of several rows, divided into pieces along x. The order is down the
/// columns, so that what the rows of successive blocks read stays in the cache.
class RowBlocks {
 public:
  RowBlocks(const native::Extents& domain, std::int64_t rows)
      : domain_(domain),
        rows_(rows),
        perColumn_((domain[1] + rows - 1) / rows),
        perRow_((domain[0] + width - 1) / width) {}

  std::int64_t count() const { return perColumn_ * perRow_ * domain_[2] * domain_[3]; }
  std::int64_t elementsOfOne() const { return std::min(domain_[0], width) * rows_; }

  /// Calls visit(first, count, rows) for each of these blocks: `count` elements in each of `rows` rows.
  template <class Visit>
  void forEach(native::Range blocks, Visit&& visit) const {
    for (std::int64_t block = blocks.begin; block < blocks.end; ++block) {
      const std::int64_t y = block % perColumn_ * rows_;
      const std::int64_t x = block / perColumn_ % perRow_ * width;
      const std::int64_t plane = block / perColumn_ / perRow_;
      const native::Extents first = {x, y, plane % domain_[2], plane / domain_[2]};
      visit(first, std::min(domain_[0] - x, width), std::min(domain_[1] - y, rows_));
    }
  }

 private:
  static constexpr std::int64_t width = native::mostLanes;

  native::Extents domain_;
  std::int64_t rows_;
  std::int64_t perColumn_, perRow_;
};

}  // namespace sk
