// SPDX-License-Identifier: MIT
#include "session.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <exception>
#include <fstream>
#include <limits>
#include <memory>
#include <regex>

#include <fmt/format.h>

#include "check.hpp"
#include "load.hpp"

namespace race {
namespace {

/// From what takes less, nothing is concluded for larger problems.
constexpr double tellingSeconds = 0.02;

double sizeOf(int log2) { return std::ldexp(1.0, log2); }

/// How the time grows with the size: as the operations do, or the bytes.
double growthOf(const Program& program, int log2) {
  const Work work = program.work(sizeOf(log2));
  return std::max(work.operations, work.bytes);
}

/// Bytes that may be allocated without a page going to disk; a great many where the system does not tell.
double availableMemory() {
  std::ifstream file("/proc/meminfo");
  for (std::string word; file >> word;) {
    double kibibytes = 0;
    if (word == "MemAvailable:" && file >> kibibytes) return kibibytes * 1024;
  }
  return std::numeric_limits<double>::max();
}

/// Seconds of one run: the shortest of a few, where they are short.
double shortestOf(Task& task) {
  double shortest = std::numeric_limits<double>::max();
  for (int run = 0; run < 3 && (run == 0 || shortest < 5 * tellingSeconds); ++run) {
    const auto start = std::chrono::steady_clock::now();
    task.run(1);
    const std::chrono::duration<double> taken = std::chrono::steady_clock::now() - start;
    shortest = std::min(shortest, taken.count());
  }
  return shortest;
}

double medianOf(std::vector<double> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

}  // namespace

void Session::runAll(const std::function<void()>& keep) {
  const std::regex wanted(settings_.filter);
  for (const Program& program : programs()) {
    if (!std::regex_search(program.name, wanted)) continue;
    runProgram(program);
    keep();
  }
}

void Session::runProgram(const Program& program) {
  if (!settings_.sizes.empty()) {
    for (const int log2 : settings_.sizes) runProblem(program, log2, settings_.withPeers);
    return;
  }
  for (const int log2 : program.sizes) runProblem(program, log2, settings_.withPeers);
  for (const int log2 : program.ownSizes) runProblem(program, log2, false);
}

std::vector<Session::Entry> Session::entriesOf(const Program& program, bool withPeers) const {
  std::vector<Entry> entries;
  const auto addWith = [&](const Ours& ours, const std::string& name, MakeOurs make,
                           const sk::CallOptions& options) {
    entries.push_back(
        {{program.name, name,
          [&ours, make, options](const Problem& problem) { return make(*ours.device, options, problem); }},
         true});
  };
  const auto add = [&](const Ours& ours, const std::string& name, MakeOurs make) {
    addWith(ours, name, make, ours.options);
  };
  for (const Ours& ours : devices_.contenders()) {
    add(ours, ours.name, program.ours);
    if (program.variant != nullptr)
      add(ours, fmt::format("{} {}", ours.name, program.variantName), program.variant);
    if (program.isContractionRaced && ours.isNative) {
      sk::CallOptions contracted = ours.options;
      contracted.contraction = sk::Contraction::Fast;
      addWith(ours, fmt::format("{} contracted", ours.name), program.ours, contracted);
    }
  }
  for (const Contender& peer : peers_) {
    if (withPeers && peer.program == program.name) entries.push_back({peer, false});
  }
  const std::regex wanted(settings_.only);
  std::erase_if(entries,
                [&](const Entry& entry) { return !std::regex_search(entry.contender.name, wanted); });
  return entries;
}

void Session::leaveOut(const Program& program, int log2, const Contender& contender, std::string why,
                       bool isWrong) {
  fmt::print("  {} is left out: {}\n", contender.name, why);
  absences_.push_back({program.name, log2, contender.name, std::move(why), isWrong});
}

std::unique_ptr<Task> Session::checkedTask(const Program& program, int log2, const Contender& contender,
                                           const Problem& problem, const Check& check) {
  double& secondsPerWork = secondsPerWork_[{program.name, contender.name}];
  const double expected = secondsPerWork * growthOf(program, log2);
  if (expected > settings_.longestSeconds) {
    leaveOut(program, log2, contender, fmt::format("would take about {:.0f} s", expected), false);
    return nullptr;
  }
  try {
    std::unique_ptr<Task> task = contender.make(problem);
    task->run(1);  // compiles, and touches memory
    const double once = shortestOf(*task);
    // Of short runs, most may be what does not grow.
    secondsPerWork = once < tellingSeconds ? 0 : once / growthOf(program, log2);
    if (const auto fault = faultOf(task->result(), check)) {
      leaveOut(program, log2, contender, *fault, true);
      return nullptr;
    }
    return task;
  } catch (const std::exception& error) {
    leaveOut(program, log2, contender, error.what(), false);
    return nullptr;
  }
}

void Session::runProblem(const Program& program, int log2, bool withPeers) {
  const std::vector<Entry> entries = entriesOf(program, withPeers);
  fmt::print("{}, 2^{} {}\n", program.name, log2, program.element);
  std::fflush(stdout);
  // Everybody has arrays of his own, and there are the problem's and those that go to a check.
  const Work expected = program.work(sizeOf(log2));
  const double needed = expected.bytes / expected.passes * static_cast<double>(entries.size() + 2);
  if (needed > availableMemory()) {
    fmt::print("  left out: {:.3g} GB of memory are needed, more than there is\n", needed / 1e9);
    return;
  }
  const Problem problem = program.problem(log2);
  const Check check = program.check(problem);
  std::vector<std::unique_ptr<Task>> tasks;
  std::vector<Runner> runners;
  std::vector<Run> runs;
  for (const Entry& entry : entries) {
    if (auto task = checkedTask(program, log2, entry.contender, problem, check)) {
      runners.push_back({entry.contender.name, task.get()});
      runs.push_back({&program, log2, entry.contender.name, entry.isOurs, {}});
      tasks.push_back(std::move(task));
    }
  }
  tell(runs, race(runners, settings_.patience, awake_));
  if (settings_.busyProcesses == 0) return;
  const Load load(settings_.busyProcesses);
  for (Run& run : runs) run.contender += " beside load";
  tell(runs, race(runners, settings_.patience, awake_));
}

void Session::tell(const std::vector<Run>& runs, const std::vector<std::vector<double>>& seconds) {
  for (std::size_t i = 0; i < runs.size(); ++i) {
    runs_.push_back(runs[i]);
    runs_.back().seconds = seconds[i];
    const Work work = runs[i].program->work(sizeOf(runs[i].log2));
    const double median = medianOf(seconds[i]);
    fmt::print("  {:<22} {:>10.4g} ms {:>9.3g} GB/s", runs[i].contender, 1e3 * median,
               work.bytes / median / 1e9);
    if (work.operations > 0) fmt::print(" {:>9.3g} Gop/s", work.operations / median / 1e9);
    fmt::print("\n");
  }
  std::fflush(stdout);
}

}  // namespace race
