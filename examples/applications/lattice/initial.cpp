// SPDX-License-Identifier: MIT
#include "run.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>

namespace examples {
namespace {

class Noise {
 public:
  explicit Noise(std::uint32_t seed) : random_(seed) {}
  /// Even in [-1, 1).
  double symmetric() { return random_() / 2147483648.0 - 1.0; }
  std::int64_t below(std::int64_t n) {
    return static_cast<std::int64_t>(random_() % static_cast<std::uint32_t>(n));
  }

 private:
  std::mt19937 random_;
};

/// The temperature that conduction makes between the walls that face each other, at a cell.
double conducted(const Model& model, std::int64_t x, std::int64_t y) {
  const auto& [edges, t, closedZ] = model.boundary;
  const auto between = [](double low, double high, std::int64_t i, std::int64_t n) {
    return low + (high - low) * (static_cast<double>(i) + 0.5) / static_cast<double>(n);
  };
  if (edges[Boundary::Bottom] == Edge::Wall && edges[Boundary::Top] == Edge::Wall)
    return between(t[Boundary::Bottom], t[Boundary::Top], y, model.grid.height);
  return between(t[Boundary::Left], t[Boundary::Right], x, model.grid.width);
}

/// Anywhere in the lower three quarters; they wrap round at the sides.
void addBlobs(const Grid& g, const Initial& initial, Noise& noise, std::vector<double>& values) {
  for (int blob = 0; blob < initial.blobs; ++blob) {
    const double radius = initial.blobRadius * (1.5 + 0.5 * noise.symmetric());
    const std::int64_t x0 = noise.below(g.width), y0 = noise.below(3 * g.height / 4 + 1),
                       z0 = noise.below(g.depth);
    const auto reach = static_cast<std::int64_t>(std::ceil(radius));
    const std::int64_t deep = g.isSpace() ? reach : 0;
    for (std::int64_t dz = -deep; dz <= deep; ++dz) {
      for (std::int64_t dy = std::max(-reach, -y0); dy <= std::min(reach, g.height - 1 - y0); ++dy) {
        for (std::int64_t dx = -reach; dx <= reach; ++dx) {
          if (static_cast<double>(dx * dx + dy * dy + dz * dz) > radius * radius) continue;
          const std::int64_t x = ((x0 + dx) % g.width + g.width) % g.width,
                             z = ((z0 + dz) % g.depth + g.depth) % g.depth;
          values[static_cast<std::size_t>((z * g.height + y0 + dy) * g.width + x)] = initial.blobTemperature;
        }
      }
    }
  }
}

std::vector<double> firstTemperature(const Model& model, const Initial& initial, Noise& noise) {
  const Grid& g = model.grid;
  std::vector<double> values;
  values.reserve(static_cast<std::size_t>(g.cells()));
  for (std::int64_t z = 0; z < g.depth; ++z) {
    for (std::int64_t y = 0; y < g.height; ++y) {
      for (std::int64_t x = 0; x < g.width; ++x) {
        const double still =
            initial.profile == Profile::Conduction ? conducted(model, x, y) : initial.temperature;
        const double across = (static_cast<double>(x) + 0.5) / static_cast<double>(g.width);
        const double up = (static_cast<double>(y) + 0.5) / static_cast<double>(g.height);
        const auto wave = [&] {
          return std::cos(2.0 * std::numbers::pi * initial.rolls * across) * std::sin(std::numbers::pi * up);
        };
        values.push_back(still + initial.noise * (initial.rolls > 0.0 ? wave() : noise.symmetric()));
      }
    }
  }
  addBlobs(g, initial, noise, values);
  return values;
}

/// u = 1, v = 0 with squares of others, disturbed by 1 %: Pearson's first state, or many of it.
void writeSeeds(const Model& model, const Initial& initial, Noise& noise, Lattice& lattice) {
  const Grid& g = model.grid;
  if (!lattice.space().isFirst()) {
    lattice.write(Field::U, {});
    lattice.write(Field::V, {});
    return;
  }
  const auto cells = static_cast<std::size_t>(g.cells());
  std::vector<double> u(cells, 1.0), v(cells, 0.0);
  const std::int64_t side = initial.seedSide;
  for (int seed = 0; seed < initial.seeds; ++seed) {
    const bool one = initial.seeds == 1;
    const std::int64_t left = one ? g.width / 2 - side / 2 + side * g.width : noise.below(g.width);
    const std::int64_t low = one ? g.height / 2 - side / 2 + side * g.height : noise.below(g.height);
    for (std::int64_t y = low; y < low + side; ++y) {
      for (std::int64_t x = left; x < left + side; ++x) {
        const auto i = static_cast<std::size_t>((y % g.height) * g.width + x % g.width);
        u[i] = initial.u * (1.0 + 0.01 * noise.symmetric());
        v[i] = initial.v * (1.0 + 0.01 * noise.symmetric());
      }
    }
  }
  lattice.write(Field::U, u);
  lattice.write(Field::V, v);
}

}  // namespace

void writeInitial(const Model& model, const Initial& initial, Lattice& lattice) {
  Noise noise(initial.random);
  const bool isFirst = lattice.space().isFirst();
  if (model.hasTemperature())
    lattice.write(Field::Temperature,
                  isFirst ? firstTemperature(model, initial, noise) : std::vector<double>());
  if (model.reaction) writeSeeds(model, initial, noise, lattice);
  const auto writeFile = [&](Field field, const std::vector<double>& values) {
    if (!values.empty()) lattice.write(field, isFirst ? values : std::vector<double>());
  };
  writeFile(Field::Temperature, initial.temperatureField);
  writeFile(Field::U, initial.uField);
  writeFile(Field::V, initial.vField);
}

}  // namespace examples
