// SPDX-License-Identifier: MIT
#include "tune/baseline.hpp"

#include <algorithm>
#include <stdexcept>

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace sk_tool::tune {

namespace {

[[noreturn]] void failRun(const Application& application, const std::string& failure) {
  throw std::runtime_error(fmt::format("{} {}", application.name(), failure));
}

}  // namespace

Baseline measure(const Application& application) {
  Baseline base;
  RunResult first = application.run({}), second = application.run({});
  for (const RunResult* each : {&first, &second}) {
    if (!each->failure.empty()) failRun(application, each->failure);
    base.wall = std::max(base.wall, each->wall);
  }
  base.differing = differences(first.process, second.process);
  base.times = first.process;
  base.process = std::move(first.process);
  if (base.times.hasTimes) return base;
  RunResult measured = application.run({.measures = true});
  if (!measured.failure.empty()) failRun(application, measured.failure);
  base.wall = std::max(base.wall, measured.wall);
  base.times = std::move(measured.process);
  return base;
}

void checkBaseline(const Application& application, const Baseline& base, const BaseFile& file) {
  if (base.process.kernels.empty())
    failRun(application, "calls no kernels, so that there is nothing to choose");
  if (base.process.series.empty()) {
    failRun(application,
            "reads nothing from its devices, so that its results are unknown; name a file that it writes: "
            "--result-file picture.png, --result-json run.json:energy");
  }
  for (const std::string& name : file.namesIn("kernels")) {
    const std::vector<std::string>& known = base.process.linkedKernels;
    if (std::ranges::find(known, name) != known.end()) continue;
    throw std::runtime_error(fmt::format(
        "the configuration '{}' (SK_CONFIG) has a kernel '{}', but {} has {}; is it of another program?",
        file.name(), name, application.name(), fmt::join(known, ", ")));
  }
}

void checkRepeats(const Application& application, const Baseline& base, std::span<const Wanted> wanted) {
  for (const Wanted& each : wanted) {
    if (std::ranges::find(base.differing, each.name) == base.differing.end()) continue;
    failRun(application,
            fmt::format(
                "reads other numbers of '{}' in each run, so that no error can be told from chance; fix its "
                "seeds, or order = \"kept\"",
                each.name));
  }
  if (base.differing.size() >= base.process.series.size()) {
    failRun(
        application,
        fmt::format("reads other numbers in each run ({}), so that no error can be told from chance; fix its "
                    "seeds, or order = \"kept\"",
                    fmt::join(base.differing, ", ")));
  }
}

}  // namespace sk_tool::tune
