// SPDX-License-Identifier: MIT
//
// Boils water over a row of burners, and measures what tables of tanh cost in accuracy and save in time.
#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <vector>

#include "boiling.sk.hpp"
#include "classics/support/classic.hpp"

namespace {

constexpr classics::Classic about{
    "boiling", "Harris, Coombe, Scheuermann, Lastra 2002", "cells along the plate", 480, 64, 1024};

constexpr boiling::Water water{.Tc = 10, .diffusion = 0.3f, .sigma = 0.02f, .alpha = 8, .eta = 0.02f};
constexpr boiling::Plate plate{.hot = 11, .cold = 9.7f, .burner = 16, .share = 0.1f};
constexpr int stepsOfABurner = 40;
constexpr double u = 0x1p-24;  ///< half a unit in the last place of a float, relative

using Field = std::vector<double>;
using Neighbors = std::array<std::size_t, 4>;  ///< to the west, to the east, below, above

/// f(cell, neighbors) of the cells between the plate and the surface, which keep their values.
Field map(Field values, int width, const std::function<double(std::size_t, const Neighbors&)>& f) {
  const auto w = static_cast<std::size_t>(width);
  for (std::size_t i = w; i < values.size() - w; ++i) {
    const std::size_t row = i / w * w, x = i % w;
    values[i] = f(i, {row + (x + w - 1) % w, row + (x + 1) % w, i - w, i + w});
  }
  return values;
}

// The operators in double.
Field diffusion(const Field& t, int width) {
  return map(t, width, [&](std::size_t i, const Neighbors& n) {
    return t[i] + water.diffusion * ((t[n[0]] + t[n[1]] + t[n[2]] + t[n[3]]) / 4 - t[i]);
  });
}
Field buoyancy(const Field& t, int width) {
  const auto rho = [&](std::size_t i) { return std::tanh(water.alpha * (t[i] - water.Tc)); };
  return map(t, width, [&](std::size_t i, const Neighbors& n) {
    return t[i] * (1 - water.sigma / 2 * (rho(n[3]) - rho(n[2])));
  });
}
Field latentHeat(const Field& before, const Field& t, int width) {
  const auto boils = [](double x) { return x > water.Tc ? 1 : 0; };
  const auto change = [&](std::size_t i) { return boils(t[i]) - boils(before[i]); };
  return map(t, width, [&](std::size_t i, const Neighbors& n) {
    return t[i] - double{water.eta} * (change(n[0]) + change(n[1]) + change(n[2]) + change(n[3]));
  });
}

std::function<void()> repeat(int times, const std::function<void()>& body) {
  return [times, body] {
    for (int i = 0; i < times; ++i) body();
  };
}

/// Compares a table with the tanh of the C library. Returns the bound that the device states for it.
double checkTable(classics::Run& run, bool cubics, const std::string& what) {
  std::vector<float> x(1 << 18);
  for (std::size_t i = 0; i < x.size(); ++i) x[i] = static_cast<float>(i) * 0x1p-13f - 16;
  Field exact(x.size());
  std::ranges::transform(x, exact.begin(), [](double value) { return std::tanh(value); });
  auto in = run.device().stream<float>({1 << 18}), out = run.device().stream<float>({1 << 18});
  in.write(x);
  boiling::tabulate(cubics, in, out);
  double bound = 4 * u;  // of a device that computes
  for (const sk::TableReport& table : run.device().tables()) {
    if (table.function == (cubics ? "boiling::tanhByCubics" : "boiling::tanhByChords"))
      bound = table.predicted;
  }
  run.check(what, classics::largestDifference(out.read(), exact), bound, "as the device states");
  return bound;
}

void boil(classics::Run& run) {
  const int width = run.size(), height = width * 5 / 8, steps = 2 * width, cells = width * height;
  const auto lattice = [&] { return run.device().stream<float>({height, width}); };
  auto t = lattice(), next = lattice(), spare = lattice();
  t.fill(plate.cold);
  int time = 0;
  const auto heat = [&] {
    boiling::heating(plate, static_cast<unsigned>(time++ / stepsOfABurner), t.domain({0, 0}, {1, width}));
  };
  const auto step = [&](const auto& put) {  // put(stream, compute) makes a result the stream's elements
    heat();
    put(next, [&](auto& result) { boiling::diffusion(water, t, result); });
    put(next, [&](auto& result) { boiling::buoyancy(false, water, next, result); });
    put(t, [&](auto& result) { boiling::latentHeat(water, t, next, result); });
  };
  const auto inPlace = [&] { step([](auto& target, const auto& compute) { compute(target); }); };
  const auto copying = [&] {
    step([&](auto& target, const auto& compute) {
      compute(spare);
      spare.copyTo(target);
    });
  };
  inPlace();
  const double took = run.timed(repeat(steps - 1, inPlace));
  const std::vector<float> picture = t.read();
  run.say("{} steps of {} x {} cells: {:.3g} million cells a second; {:.1f} % of the cells boil", steps,
          width, height, cells / took * (steps - 1) / 1e3, 100.0 * boiling::vapour(water, t) / cells);
  run.device().countPasses(true);
  inPlace();
  const sk::PassCount count = run.device().passCount();
  run.device().countPasses(false);
  run.say("a step takes {} passes, which write {:.2f} numbers for each cell", count.passes,
          static_cast<double>(count.bytesWritten) / 4 / cells);
  run.ratio("10 steps that copy their results / steps in place", repeat(10, copying), repeat(10, inPlace));

  heat();
  const Field before = t.readReals();
  auto longPlate = run.device().stream<float>({1 << 18});
  boiling::heating(plate, 0, longPlate);
  const Field burners = longPlate.readReals();
  const auto partOf = [&](float T) { return 0x1p-18 * double(std::ranges::count(burners, T)); };
  run.check("heating", 1 - partOf(plate.hot) - partOf(plate.cold), 0, "burners are hot or cold");
  run.check("share of hot", std::abs(partOf(plate.hot) - plate.share), 0.012, "5 sigma of 16384 burners");
  const double hottest = classics::largestOf(before);
  for (const bool cubics : {false, true}) {
    const char* name = cubics ? "256 cubics" : "256 chords";
    const auto lookUp = [&] { boiling::buoyancy(cubics, water, t, next); };
    const auto compute = [&] { boiling::buoyancy.with({.tables = sk::Tables::Off})(cubics, water, t, next); };
    run.ratio(fmt::format("buoyancy, tanh computed / {}", name), repeat(10, compute), repeat(10, lookUp));
    const double tableBound = checkTable(run, cubics, fmt::format("tanh from {}", name));
    boiling::diffusion(water, t, next);
    boiling::buoyancy(cubics, water, next, next);
    run.check(fmt::format("diffusion and buoyancy, {}", name),
              classics::largestDifference(next.read(), buoyancy(diffusion(before, width), width)),
              hottest * (u * (9 + 3 * water.sigma * water.alpha * hottest) + water.sigma * tableBound),
              "roundings of T, and the table");
  }
  boiling::latentHeat(water, t, next, t);
  const Field after = next.readReals();
  int changed = 0;
  for (std::size_t i = 0; i < after.size(); ++i) changed += (after[i] > water.Tc) != (before[i] > water.Tc);
  const double wrong = classics::largestDifference(t.read(), latentHeat(before, after, width));
  run.check(fmt::format("latent heat, {} cells change phase", changed), changed > 0 ? wrong : 1,
            2 * u * hottest, "two roundings");
  run.picture("boiling.png", classics::fieldPicture(picture, height, width, 9.4f, 10.4f, "lagoon",
                                                    std::max(1, 960 / width), true));
}

}  // namespace

int main(int argc, char** argv) { return classics::run(argc, argv, about, boil); }
