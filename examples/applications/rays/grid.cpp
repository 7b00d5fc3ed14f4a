// SPDX-License-Identifier: MIT
#include "grid.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include "bvh.hpp"

namespace rays {
namespace {

constexpr std::size_t mostEntries = std::size_t{1} << 26;

/// A shape that a cell lists.
struct Entry {
  std::uint32_t cell;
  std::uint32_t shape;
};

struct Cells {
  Corner low{}, extent{};
  std::array<int, 3> size{};

  std::uint32_t number(const std::array<int, 3>& at) const {
    return static_cast<std::uint32_t>((at[2] * size[1] + at[1]) * size[0] + at[0]);
  }
};

/// The largest cubes of which there are `wanted` at most. An axis along which the scene is thinner than that has one cell.
Cells cellsOf(const Bounds& bounds, double wanted) {
  Cells cells;
  cells.low = cornerOf(bounds.least);
  const Corner high = cornerOf(bounds.most);
  Corner extent;
  for (std::size_t i = 0; i < 3; ++i) extent[i] = high[i] - cells.low[i];
  const double longest = std::max({extent[0], extent[1], extent[2]});
  double small = longest / mostCells, large = longest;
  const auto along = [&](std::size_t axis, double side) {
    return std::max(1.0, std::floor(extent[axis] / side));
  };
  for (int i = 0; i < 50; ++i) {
    const double side = std::sqrt(small * large);
    (along(0, side) * along(1, side) * along(2, side) > wanted ? small : large) = side;
  }
  for (std::size_t i = 0; i < 3; ++i) {
    cells.size[i] = std::min(static_cast<int>(along(i, large)), mostCells);
    // As kernels have it, in float.
    cells.extent[i] = static_cast<float>(extent[i] / cells.size[i]);
  }
  return cells;
}

class GridBuilder {
 public:
  GridBuilder(const Model& model, const Cells& cells, double margin)
      : model_(model), cells_(cells), margin_(margin) {
    for (std::size_t i = 0; i < 3; ++i) half_[i] = 0.5 * cells.extent[i] + margin;
  }

  /// None where they are too many.
  std::optional<std::vector<Entry>> entries() {
    std::uint32_t shape = 0;
    for (const Triangle& t : model_.triangles) {
      const std::array<Corner, 3> corners = {cornerOf(t.a), cornerOf(t.b), cornerOf(t.c)};
      Corner least, most;
      for (std::size_t i = 0; i < 3; ++i) {
        least[i] = std::min({corners[0][i], corners[1][i], corners[2][i]});
        most[i] = std::max({corners[0][i], corners[1][i], corners[2][i]});
      }
      if (!add(shape++, least, most, [&](const Corner& centre) { return meets(corners, centre, half_); }))
        return {};
    }
    for (const Sphere& s : model_.spheres) {
      const Corner middle = cornerOf(s.centre);
      const double radius = s.radius, reach = radius * (1 + 0x1p-20);
      Corner least, most;
      for (std::size_t i = 0; i < 3; ++i) {
        least[i] = middle[i] - reach;
        most[i] = middle[i] + reach;
      }
      if (!add(shape++, least, most,
               [&](const Corner& centre) { return meets(middle, radius, centre, half_); }))
        return {};
    }
    return std::move(entries_);
  }

 private:
  int cellAt(double x, std::size_t axis) const {
    return std::clamp(static_cast<int>(std::floor((x - cells_.low[axis]) / cells_.extent[axis])), 0,
                      cells_.size[axis] - 1);
  }

  /// Adds the shape to each cell between two corners for which `isMet` holds. Returns false if there are too many entries.
  template <class IsMet>
  bool add(std::uint32_t shape, const Corner& least, const Corner& most, const IsMet& isMet) {
    std::array<int, 3> first{}, last{};
    for (std::size_t i = 0; i < 3; ++i) {
      first[i] = cellAt(least[i] - margin_, i);
      last[i] = cellAt(most[i] + margin_, i);
    }
    std::array<int, 3> at{};
    for (at[2] = first[2]; at[2] <= last[2]; ++at[2]) {
      for (at[1] = first[1]; at[1] <= last[1]; ++at[1]) {
        for (at[0] = first[0]; at[0] <= last[0]; ++at[0]) {
          Corner centre;
          for (std::size_t i = 0; i < 3; ++i) centre[i] = cells_.low[i] + (at[i] + 0.5) * cells_.extent[i];
          if (isMet(centre)) entries_.push_back({cells_.number(at), shape});
        }
      }
    }
    return entries_.size() <= mostEntries;
  }

  const Model& model_;
  const Cells& cells_;
  double margin_;
  Corner half_{};
  std::vector<Entry> entries_;
};

/// Sorts entries by cell, which keeps the order of shapes.
void makeLists(const std::vector<Entry>& entries, UniformGrid& grid) {
  const auto cells = static_cast<std::size_t>(std::int64_t{grid.size.x} * grid.size.y * grid.size.z);
  std::vector<int> counts(cells);
  for (const Entry& e : entries) ++counts[e.cell];
  grid.starts.assign(cells, -1);
  int next = 0;
  for (std::size_t i = 0; i < cells; ++i) {
    if (counts[i] == 0) continue;
    grid.starts[i] = next;
    next += counts[i] + 1;
    grid.longest = std::max(grid.longest, counts[i]);
    ++grid.occupied;
  }
  grid.lists.assign(static_cast<std::size_t>(next), -1);
  std::vector<int> at = grid.starts;
  for (const Entry& e : entries)
    grid.lists[static_cast<std::size_t>(at[e.cell]++)] = static_cast<int>(e.shape);
  grid.entries = static_cast<std::int64_t>(entries.size());
}

}  // namespace

double gridMargin(const Bounds& b) {
  double longest = 0, largest = 0;
  for (const auto& [low, high] :
       {std::array{b.least.x, b.most.x}, {b.least.y, b.most.y}, {b.least.z, b.most.z}}) {
    longest = std::max(longest, double(high) - low);
    largest = std::max({largest, std::abs(double(high)), std::abs(double(low))});
  }
  return 0x1p-14 * longest + 0x1p-20 * largest;
}

UniformGrid buildGrid(const Model& model, const GridSettings& settings) {
  UniformGrid grid;
  const std::size_t shapes = model.triangles.size() + model.spheres.size();
  if (shapes == 0) return grid;
  for (const Triangle& t : model.triangles) grid.bounds.grow(boundsOf(t));
  for (const Sphere& s : model.spheres) grid.bounds.grow(boundsOf(s));
  const double margin = gridMargin(grid.bounds);
  const auto by = static_cast<float>(margin);
  grid.bounds.least = {grid.bounds.least.x - by, grid.bounds.least.y - by, grid.bounds.least.z - by};
  grid.bounds.most = {grid.bounds.most.x + by, grid.bounds.most.y + by, grid.bounds.most.z + by};
  for (double wanted = settings.density * double(shapes);; wanted /= 8) {
    const Cells cells = cellsOf(grid.bounds, std::clamp(wanted, 1.0, 0x1p24));
    grid.size = {cells.size[0], cells.size[1], cells.size[2]};
    grid.cell = {static_cast<float>(cells.extent[0]), static_cast<float>(cells.extent[1]),
                 static_cast<float>(cells.extent[2])};
    const std::optional<std::vector<Entry>> entries = GridBuilder(model, cells, margin).entries();
    if (!entries && wanted > 1) continue;
    if (entries) makeLists(*entries, grid);
    return grid;
  }
}

}  // namespace rays
