// SPDX-License-Identifier: MIT
//
// Warms a foil by a beam until it loses as much heat as it gains, and draws up that balance in doubles.
#include <algorithm>
#include <cmath>
#include <filesystem>
#include <numbers>
#include <vector>

#include <fmt/format.h>
#include <sk/sk.hpp>

#include "classics/support/classic.hpp"
#include "drift.sk.hpp"
#include "support/application.hpp"
#include "support/stopwatch.hpp"

namespace {

// SI units: aluminium, 2 um thick and black on both sides, in cells of 1 mm, in air that hardly moves
constexpr double cell = 1e-3, thickness = 2e-6, room = 298.15, dt = 2e-3;
constexpr double area = 2 * cell * cell, capacity = 2.43e6 * thickness * cell * cell,
                 conductance = 237 * thickness;
constexpr double perSquareMetre = 0.0153, airing = 1, stefanBoltzmann = 5.670374e-8;
/// The part of its final warmth that the foil still lacks decays at this rate, per second.
constexpr double rate = area * (4 * stefanBoltzmann * room * room * room + airing) / capacity;
static_assert(conductance * dt / capacity < 0.25, "explicit steps are stable");

struct Balance {
  double gained = 0, radiated = 0, aired = 0, warmth = 0;
  double surplus() const { return (radiated + aired - gained) / gained; }
};

/// What the foil gains and loses in one second, by the laws of physics in double.
Balance balanceOf(const std::vector<float>& gained, const std::vector<float>& u) {
  Balance balance;
  for (std::size_t i = 0; i < u.size(); ++i) {
    const double t = room + double{u[i]};
    balance.gained += gained[i];
    balance.radiated += area * stefanBoltzmann * (t * t * t * t - room * room * room * room);
    balance.aired += area * airing * u[i];
    balance.warmth += u[i];
  }
  return balance;
}

struct Settings {
  int size = 128, steps = 3000;
  bool mended = false;
  std::filesystem::path picture = "drift.png";
};

void warm(examples::Application& app, const Settings& settings) {
  sk::Device device(app.device());
  const int n = settings.size;
  drift::DriftStreams s(device, n, n);
  s.u.fill(0);
  const auto power = static_cast<float>(perSquareMetre * n * n * cell * cell);
  const examples::Stopwatch stopwatch;
  for (int i = 0; i < settings.steps; ++i) {
    const double angle = 2 * std::numbers::pi * i / 1000;
    const sk::float2 centre{static_cast<float>(n * (0.5 + 0.12 * std::cos(angle))),
                            static_cast<float>(n * (0.5 + 0.12 * std::sin(angle)))};
    drift::absorb(power, centre, 0.08f * static_cast<float>(n), s.gained);
    drift::conduct(static_cast<float>(conductance), s.u, s.flown);
    drift::ventilate(static_cast<float>(area), static_cast<float>(airing), s.u, s.aired);
    drift::radiate(settings.mended, static_cast<float>(area), static_cast<float>(room), s.u, s.radiated);
    drift::advance(static_cast<float>(dt / capacity), s.gained, s.flown, s.aired, s.radiated, s.u, s.u);
  }
  device.finish();
  app.report(fmt::format("a foil of {0} x {0} cells, {1} steps", n, settings.steps), device.name(),
             stopwatch.milliseconds());

  const std::vector<float> last = s.u.read();
  const Balance balance = balanceOf(s.gained.read(), last);
  fmt::print("the beam brings {:.5f} mW; the foil radiates {:.5f} mW and gives {:.5f} mW to the air\n",
             1e3 * balance.gained, 1e3 * balance.radiated, 1e3 * balance.aired);
  fmt::print("energy balance: it loses {:.5f} % {} than it gains\n", 100 * std::abs(balance.surplus()),
             balance.surplus() > 0 ? "more" : "less");
  examples::savePng(settings.picture,
                    classics::fieldPicture(last, n, n, 0, std::ranges::max(last), "ember", 3));
  fmt::print("picture: {}\n", settings.picture.string());

  const double lacking = 1.01 * std::exp(-rate * dt * settings.steps);
  examples::Verification heat(
      "heat lost, relative to heat gained", lacking + (settings.mended ? 1e-5 : 2.5e-2),
      settings.mended ? "roundings of steps, the beam's tails, and warmth that is still to come"
                      : "6 roundings of fourth powers that are 68,000 times their difference");
  heat.compare(0, balance.radiated + balance.aired, balance.gained, balance.gained);
  examples::Verification total("sum of temperatures, relative to a loop", examples::sumBound(last.size()),
                               "rounded once");
  total.compare(0, drift::warmth(s.u), balance.warmth, balance.warmth);
  app.verified(std::vector{heat, total});
}

}  // namespace

int main(int argc, char** argv) {
  examples::Application app("drift", "Warms a foil by a beam until it loses as much heat as it gains.");
  Settings settings;
  app.options().add_flag("--mended", settings.mended, "compute the difference of fourth powers as a product");
  app.options()
      .add_option("--size", settings.size, "cells along a side (default: 128)")
      ->check(CLI::Range(16, 4096));
  app.options()
      .add_option("--steps", settings.steps,
                  "steps of 2 ms (default: 3000, 17 times what the foil takes to adapt)")
      ->check(CLI::Range(1, 10'000'000));
  app.options().add_option("-o,--output", settings.picture, "the picture (default: drift.png)");
  return app.run(argc, argv, [&] { warm(app, settings); });
}
