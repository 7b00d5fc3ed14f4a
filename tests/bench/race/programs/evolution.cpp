// SPDX-License-Identifier: MIT
#include "programs/evolution.hpp"

#include <utility>

#include "problems.hpp"

namespace race {
namespace {

// Blocks are longer than tiles of a loop usually are, so that some of them have a border between tiles inside.
constexpr std::int64_t blocks = 12, blockRows = 64, blockColumns = 16;

/// A part of a grid, which evolves by itself.
struct Window {
  std::int64_t top, left, rows, columns;
};

/// What lies within `reach` of a block, without what is outside of the grid unless that wraps.
Window around(const Problem& p, std::int64_t top, std::int64_t left, std::int64_t reach, Edge edge) {
  Window w{top - reach, left - reach, blockRows + 2 * reach, blockColumns + 2 * reach};
  if (edge == Edge::Wrap) return w;
  const std::int64_t bottom = std::min(w.top + w.rows, p.rows);
  const std::int64_t right = std::min(w.left + w.columns, p.columns);
  w.top = std::max<std::int64_t>(w.top, 0);
  w.left = std::max<std::int64_t>(w.left, 0);
  w.rows = bottom - w.top;
  w.columns = right - w.left;
  return w;
}

/// The fields of a window after all steps. Beyond the grid's own borders, those of the window are wrong, and what depends on them.
Lattice evolved(const Problem& p, const Window& w, const Evolution& evolution) {
  Lattice now{w.rows, w.columns};
  for (const std::vector<float>& start : p.floats) {
    std::vector<double>& field = now.fields.emplace_back();
    field.reserve(static_cast<std::size_t>(w.rows * w.columns + 1));
    for (std::int64_t y = w.top; y < w.top + w.rows; ++y) {
      for (std::int64_t x = w.left; x < w.left + w.columns; ++x) {
        const std::int64_t row = (y + p.rows) % p.rows, column = (x + p.columns) % p.columns;
        field.push_back(start[static_cast<std::size_t>(row * p.columns + column)]);
      }
    }
    field.push_back(0);
  }
  Lattice next = now;
  for (int n = 0; n < evolution.steps; ++n) {
    evolution.step(now, next);
    std::swap(now, next);
  }
  return now;
}

}  // namespace

Check evolutionCheck(const Problem& p, const Evolution& evolution, double tolerance, std::int64_t mostWhole) {
  Check check{{}, {}, tolerance};
  const auto add = [&](const Lattice& lattice, const Window& w, std::int64_t y, std::int64_t x) {
    for (std::size_t f = 0; f < lattice.fields.size(); ++f) {
      check.places.push_back(static_cast<std::int64_t>(f) * p.size() + y * p.columns + x);
      check.values.push_back(
          lattice.fields[f][static_cast<std::size_t>((y - w.top) * w.columns + x - w.left)]);
    }
  };
  if (p.size() <= mostWhole) {
    const Window whole{0, 0, p.rows, p.columns};
    const Lattice lattice = evolved(p, whole, evolution);
    for (const std::int64_t place : somePlaces(p.size()))
      add(lattice, whole, place / p.columns, place % p.columns);
    return check;
  }
  for (std::int64_t k = 0; k < blocks; ++k) {
    const std::int64_t other = 7 * k % blocks;  // each once, so that some block lies at each border
    const std::int64_t top = k * (p.rows - blockRows) / (blocks - 1);
    const std::int64_t left = other * (p.columns - blockColumns) / (blocks - 1);
    const Window w = around(p, top, left, evolution.steps, evolution.edge);
    const Lattice lattice = evolved(p, w, evolution);
    for (std::int64_t y = top; y < top + blockRows; ++y) {
      for (std::int64_t x = left; x < left + blockColumns; ++x) add(lattice, w, y, x);
    }
  }
  return check;
}

}  // namespace race
