// SPDX-License-Identifier: MIT
#include "rounds.hpp"

#include <algorithm>
#include <chrono>
#include <map>
#include <thread>

#include <benchmark/benchmark.h>

namespace race {
namespace {

using Clock = std::chrono::steady_clock;

double secondsSince(Clock::time_point start) {
  return std::chrono::duration<double>(Clock::now() - start).count();
}

/// Keeps what Google Benchmark would print.
class Collector final : public benchmark::BenchmarkReporter {
 public:
  bool ReportContext(const Context&) override { return true; }
  void ReportRuns(const std::vector<Run>& runs) override {
    for (const Run& run : runs) runs_[run.run_name.function_name] = run;
  }
  const Run& of(const Runner& runner) const { return runs_.at(runner.name); }

 private:
  std::map<std::string, Run> runs_;
};

/// Threads of the one before may still spin in wait for more work.
constexpr auto pause = std::chrono::milliseconds(2);

/// Of work for a GPU before each sample, and before the first: it has something to do for about half of the time.
constexpr double wakingSeconds = 0.02;
constexpr double firstWakingSeconds = 0.5;

/// All iterations at once: the runner waits for its device but once.
void timed(benchmark::State& state, Task& task, const Awake& awake) {
  awake.work(wakingSeconds);
  std::this_thread::sleep_for(pause);
  while (state.KeepRunningBatch(state.max_iterations)) {
    const auto start = Clock::now();
    task.run(static_cast<int>(state.max_iterations));
    state.SetIterationTime(secondsSince(start));
  }
}

/// Runs all of them, beginning with number `first`. `iterations`: none where it is yet to be found how many there must be.
Collector round(const std::vector<Runner>& runners, std::size_t first, double sampleSeconds,
                const std::vector<std::int64_t>& iterations, const Awake& awake) {
  benchmark::ClearRegisteredBenchmarks();
  for (std::size_t i = 0; i < runners.size(); ++i) {
    const std::size_t number = (first + i) % runners.size();
    Task* task = runners[number].task;
    auto* registered =
        benchmark::RegisterBenchmark(runners[number].name.c_str(),
                                     [task, &awake](benchmark::State& state) { timed(state, *task, awake); });
    registered->UseManualTime();
    if (iterations.empty()) {
      registered->MinTime(sampleSeconds);
    } else {
      registered->Iterations(iterations[number]);
    }
  }
  Collector collector;
  benchmark::RunSpecifiedBenchmarks(&collector, "all");
  return collector;
}

}  // namespace

std::vector<std::vector<double>> race(const std::vector<Runner>& runners, const Patience& patience,
                                      const Awake& awake) {
  std::vector<std::vector<double>> seconds(runners.size());
  if (runners.empty()) return seconds;
  std::vector<std::int64_t> iterations;
  awake.work(firstWakingSeconds);
  const Collector trial = round(runners, 0, patience.sampleSeconds, {}, awake);
  for (const Runner& runner : runners) iterations.push_back(trial.of(runner).iterations);

  const auto start = Clock::now();
  for (int number = 0; number < patience.rounds; ++number) {
    if (number >= 3 && secondsSince(start) > patience.groupSeconds) break;
    const Collector results = round(runners, static_cast<std::size_t>(number), 0, iterations, awake);
    for (std::size_t i = 0; i < runners.size(); ++i) {
      const auto& run = results.of(runners[i]);
      seconds[i].push_back(run.real_accumulated_time / static_cast<double>(run.iterations));
    }
  }
  return seconds;
}

}  // namespace race
