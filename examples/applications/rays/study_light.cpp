// SPDX-License-Identifier: MIT
//
// Pictures with a known radiance by each way to reach lights: how far from it their means are, in standard errors.
#include "study.hpp"

#include <array>
#include <cmath>

#include <fmt/format.h>

#include "known_pictures.hpp"
#include "support/table.hpp"

namespace rays {
namespace {

constexpr std::array strategies = {Strategy::Both, Strategy::Lights, Strategy::Surfaces};

std::string cellOf(const Estimate& e, double known) {
  return fmt::format("{:.5f} ({:.1f})", e.mean, deviation(e, known));
}

/// Close to each other, edges of a furnace send light that points on lamps have with a variance that is not finite: means of any number of
/// samples say nothing of their error.
bool isBounded(const KnownPicture& picture, Strategy strategy) {
  return strategy != Strategy::Lights || !picture.lastSegmentAlone || picture.depth == 2;
}

}  // namespace

Findings studyLight(sk::Device& device, bool isSmall) {
  const Effort effort = isSmall ? Effort{.side = 32, .samples = 32} : Effort{};
  examples::Table table({"picture", "known", "both", "lights alone", "surfaces alone"});
  examples::Verification known("standard errors between a mean and what is known", 4.0,
                               "one in 16,000 is larger by chance, and the numbers are fixed");
  examples::Verification alike("standard errors between two strategies", 4.0,
                               "one in 16,000 is larger by chance, and the numbers are fixed");
  std::int64_t place = 0;
  for (const KnownPicture& picture : knownPictures()) {
    ++place;
    const bool isKnown = !std::isnan(picture.radiance);
    std::vector<std::string> cells = {picture.name, isKnown ? fmt::format("{:.5f}", picture.radiance) : "-"};
    std::optional<Estimate> both;
    for (const Strategy strategy : strategies) {
      if (!isBounded(picture, strategy)) {
        cells.emplace_back("-");
        continue;
      }
      const Estimate e = estimate(device, picture, effort, strategy, Sampling::Random);
      if (isKnown) known.note(place, deviation(e, picture.radiance));
      if (both) alike.note(place, deviation({e.mean, std::hypot(e.error, both->error)}, both->mean));
      cells.push_back(cellOf(e, isKnown ? picture.radiance : both ? both->mean : e.mean));
      if (!both) both = e;
    }
    table.add(cells);
  }
  return {table.markdown(), {known, alike}};
}

}  // namespace rays
