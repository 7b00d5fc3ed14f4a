// SPDX-License-Identifier: MIT
#include "run.hpp"

#include <algorithm>
#include <stdexcept>

#include <fmt/format.h>

#include "support/progress.hpp"

namespace examples {
namespace {

[[noreturn]] void failBroken(const Simulation& simulation, const Scene& scene, const Census& census) {
  const std::int64_t step = simulation.step();
  const std::int64_t first = simulation.state().firstBroken(simulation.features().verlet);
  throw std::runtime_error(fmt::format(
      "step {}: the point in column {}, row {} has flown off, or is no number any more ({} of {} points); "
      "take a smaller "
      "dt, stiffness or relaxation",
      step, first % scene.cloth.columns, first / scene.cloth.columns, census.broken, scene.points()));
}

/// Goes from the last sound state step by step to the first that is not.
[[noreturn]] void findBreak(Simulation& simulation, const Scene& scene, const State& sound, std::int64_t end,
                            const Census& atEnd) {
  simulation.restore(sound);
  while (simulation.step() < end) {
    simulation.advance(1);
    if (const Census census = simulation.census(); census.broken > 0) failBroken(simulation, scene, census);
  }
  failBroken(simulation, scene, atEnd);
}

}  // namespace

Outcome run(Simulation& simulation, const Scene& scene, const std::function<void(int)>& onFrame) {
  const std::int64_t steps = scene.run.steps;
  Progress progress(scene.title, steps);
  Outcome outcome;
  State sound = simulation.state();
  if (const Census census = simulation.census(); census.broken > 0) failBroken(simulation, scene, census);
  onFrame(0);
  const int gaps = std::max(1, scene.record.frames - 1);
  for (int frame = 1; outcome.steps < steps && !outcome.settled;) {
    const std::int64_t nextFrame =
        std::max(outcome.steps + 1, steps / gaps * frame + steps % gaps * frame / gaps);
    const std::int64_t end = std::min({outcome.steps + scene.run.checkEvery, nextFrame, steps});
    simulation.advance(end - outcome.steps);
    simulation.finish();
    outcome.steps = end;
    const Census census = simulation.census();
    if (census.broken > 0) findBreak(simulation, scene, sound, end, census);
    sound = simulation.state();
    outcome.fastest = census.fastest;
    outcome.settled = scene.run.untilSettled && census.fastest <= *scene.run.untilSettled;
    if (end == nextFrame || outcome.settled) {
      progress.clear();
      onFrame(frame++);
    }
    if (simulation.space().isFirst()) progress.update(end);
  }
  return outcome;
}

}  // namespace examples
