// SPDX-License-Identifier: MIT
//
// What a report concludes from errors that grow: tests/shadow/growth.json, which the test of the browser's shadow reads as well
// (tests/web/node/growth.test.mjs).
#include "shadow/report.hpp"

#include <cmath>
#include <cstdint>
#include <fstream>
#include <limits>
#include <string>
#include <vector>

#include <catch2/catch.hpp>
#include <nlohmann/json.hpp>

using nlohmann::json;
using namespace sk::shadow;

namespace {

/// [a, f, p] after n calls: a * f^n * n^p.
double after(const json& errors, std::int64_t n) {
  const auto calls = static_cast<double>(n);
  return errors[0].get<double>() * std::pow(errors[1].get<double>(), calls) *
         std::pow(calls, errors[2].get<double>());
}

KernelRecord kernelOf(const json& given) {
  KernelRecord kernel;
  kernel.name = "step";
  kernel.calls = given["calls"];
  kernel.outputs.resize(1 + given.value("steady", std::size_t{0}));
  for (std::int64_t n = 1; n <= kernel.calls; ++n) {
    const std::int64_t call = n * given.value("stride", 1);
    kernel.amplification.add(1);
    kernel.outputs[0].points.add({call, 0, 0, after(given["relative"], n), after(given["absolute"], n),
                                  n <= given.value("turned", 0)});
    for (std::size_t i = 1; i < kernel.outputs.size(); ++i)
      kernel.outputs[i].points.add({call, 0, 0, 1e-7, 1e-7, false});
  }
  return kernel;
}

/// Reads what `step` has computed, and computes what has the square of its error.
KernelRecord lookingKernel(const KernelRecord& step) {
  KernelRecord kernel;
  kernel.name = "look";
  kernel.calls = step.calls;
  kernel.readFrom = {0};
  OutputRecord& output = kernel.outputs.emplace_back();
  for (Series::Point point : step.outputs[0].points.points()) {
    kernel.amplification.add(1);
    point.absolute *= point.absolute;
    output.points.add(point);
  }
  return kernel;
}

ExceptionRecord exceptionOf(const json& given) {
  ExceptionRecord exception{};
  exception.kind = given[0] == "nan" ? ExceptionRecord::Kind::Nan : ExceptionRecord::Kind::Infinity;
  exception.first.call = given[1];
  exception.isInReference = given[2];
  return exception;
}

Report reportOf(const json& given) {
  Report report;
  report.kernels.push_back(kernelOf(given));
  report.followed = report.kernels[0].calls;
  if (given.value("watched", false)) {
    report.kernels[0].readFrom = {0};
    report.kernels.push_back(lookingKernel(report.kernels[0]));
  }
  report.calls = report.followed * given.value("stride", 1);
  const json& error = given["result"];
  ResultRecord result;
  result.name = "v";
  result.largest = result.last =
      error == "inf" ? std::numeric_limits<double>::infinity() : error.get<double>();
  const double decided = given.value("decision", 0.0);
  result.shares.add(0, 1 - decided);
  result.shares.add(1, decided);
  report.results.push_back(result);
  if (decided > 0) {
    report.kernels.emplace_back().name = "draw";
    report.decisions.push_back({1, 1, false, {}});
  }
  for (const json& each : given["exceptions"]) report.exceptions.push_back(exceptionOf(each));
  return report;
}

}  // namespace

TEST_CASE("no advice of less precision is given where errors make others smaller") {
  Report report;
  for (const char* const name : {"main", "correction"}) {
    KernelRecord& kernel = report.kernels.emplace_back();
    kernel.name = name;
    kernel.calls = kernel.followed = 1;
    kernel.seconds = 1;
    kernel.own.add(1e-7);
  }
  report.calls = report.followed = 2;
  ResultRecord& result = report.results.emplace_back();
  result.name = "v";
  result.largest = result.last = 1e-6;
  result.shares.add(0, 1);
  const auto adviceFor = [&] {
    Report concluded = report;
    conclude(concluded);
    std::vector<std::string> kernels;
    const json all = json::parse(toJson(concluded));
    for (const json& each : all["account"]["precision"]) kernels.push_back(each["kernel"]);
    return kernels;
  };
  CHECK(adviceFor() == std::vector<std::string>{"correction"});
  report.kernels[1].compensates = true;
  CHECK(adviceFor().empty());
}

TEST_CASE("a pattern that matches no kernel is named") {
  Report report;
  report.kernels.emplace_back().name = "heat::diffuse";
  report.options.kernels = {"heat::*", "heat::difuse", "other::*"};
  CHECK(
      unmatchedPatterns(report) ==
      std::vector<std::string>{
          "kernels=heat::difuse matches no kernel that the program has called; did you mean 'heat::diffuse'?",
          "kernels=other::* matches no kernel that the program has called"});
}

TEST_CASE("errors that grow are unstable, or grow as the solution does, or add up") {
  std::ifstream file(SK_GROWTH_CASES);
  const json cases = json::parse(file)["cases"];
  REQUIRE(cases.size() > 20);
  for (const json& given : cases) {
    INFO(given["name"].get<std::string>());
    Report report = reportOf(given);
    conclude(report);
    std::vector<std::string> kinds;
    json text;
    for (const Verdict& verdict : report.verdicts) {
      kinds.push_back(verdict.kind);
      if (verdict.kind == "unstable" || verdict.kind == "growth") text = verdict.text;
    }
    CHECK(kinds == given["verdicts"].get<std::vector<std::string>>());
    CHECK(text == given["text"]);
  }
}
