// SPDX-License-Identifier: MIT
#include "stress/report.hpp"

#include <algorithm>
#include <cmath>
#include <fstream>
#include <stdexcept>

#include <fmt/format.h>

#include <nlohmann/json.hpp>

namespace sk_tool::stress {

namespace {

void printRun(const Run& run, bool isShort) {
  fmt::print("  {}\n", run.of.text);
  for (const Finding& finding : run.findings) {
    std::string text = finding.text;
    for (std::size_t at = text.find('\n'); at != std::string::npos; at = text.find('\n', at + 1))
      text.insert(at + 1, "    ");
    const std::size_t others = run.findings.size() - 1;
    if (isShort && others > 0) text += fmt::format("; and {} more", others);
    fmt::print("      {}\n", text);
    if (isShort) return;
  }
}

/// Prints the runs that a condition chooses, below a line; nothing if there are none.
template <class Condition>
void printRuns(const Report& report, const std::string& title, bool isShort, const Condition& isChosen) {
  const auto count = std::ranges::count_if(report.runs, isChosen);
  if (count == 0) return;
  fmt::print("\n{}\n", title);
  for (const Run& run : report.runs) {
    if (isChosen(run)) printRun(run, isShort);
  }
}

std::string cases(std::size_t count) { return fmt::format("{} case{}", count, count == 1 ? "" : "s"); }

void printPlain(const Report& report) {
  const Run& plain = report.runs.front();
  fmt::print("{} on {}\n", report.command, report.device);
  fmt::print("as it is: {:.2g} s beside its shadow, {} call{}", plain.process.wall, plain.seen->calls,
             plain.seen->calls == 1 ? "" : "s");
  if (const Result* const worst = plain.seen->worst()) {
    const std::string digits =
        worst->error > 0 ? fmt::format("at least {:.1f} digits", digitsOf(worst->error)) : "all digits";
    fmt::print("; {} of '{}' survive", digits, worst->name);
  }
  fmt::print("\n");
}

}  // namespace

std::size_t Report::broken() const {
  return static_cast<std::size_t>(std::ranges::count_if(runs, [](const Run& run) { return run.isBroken(); }));
}

std::size_t Report::listed() const {
  return static_cast<std::size_t>(std::ranges::count_if(
      runs, [](const Run& run) { return run.of.kind != Case::Kind::AsItIs || !run.findings.empty(); }));
}

void print(const Report& report, bool isAll) {
  printPlain(report);
  printRuns(report, fmt::format("breaks in {}:", cases(report.broken())), false,
            [](const Run& run) { return run.isBroken(); });
  printRuns(report,
            "changes where no range is declared ([[range(low, high)]] on a parameter says which values must "
            "work), or where the program may refuse a size:",
            !isAll, [](const Run& run) { return !run.isBroken() && !run.findings.empty(); });
  const auto holds = [](const Run& run) { return run.findings.empty() && run.of.kind != Case::Kind::AsItIs; };
  const auto count = static_cast<std::size_t>(std::ranges::count_if(report.runs, holds));
  if (isAll) {
    printRuns(report, fmt::format("holds in {}:", cases(count)), false, holds);
  } else {
    fmt::print("\nholds in {}{}\n", cases(count), count == 0 ? "" : " (--all lists them)");
  }
  for (const std::string& note : report.notes) fmt::print("\nnote: {}\n", note);
}

namespace {

using Json = nlohmann::ordered_json;

Json numberOf(double value) {
  if (std::isfinite(value)) return value;
  return std::isnan(value) ? "nan" : value > 0 ? "inf" : "-inf";
}

Json jsonOf(const Run& run) {
  Json findings = Json::array();
  for (const Finding& finding : run.findings)
    findings.push_back({{"kind", nameOf(finding.kind)}, {"text", finding.text}});
  Json results = Json::array();
  if (run.seen) {
    for (const Result& result : run.seen->results) {
      results.push_back({{"name", result.name},
                         {"elements", result.elements},
                         {"numbers", result.numbers},
                         {"withoutValue", result.withoutValue},
                         {"error", numberOf(result.error)}});
    }
  }
  constexpr const char* kinds[] = {"asItIs", "value", "size"};
  return {{"kind", kinds[static_cast<std::size_t>(run.of.kind)]},
          {"text", run.of.text},
          {"settings", run.of.settings},
          {"size", run.of.size},
          {"mustHold", run.of.mustHold},
          {"breaks", run.isBroken()},
          {"seconds", run.process.wall},
          {"calls", run.seen ? run.seen->calls : 0},
          {"findings", findings},
          {"results", results}};
}

}  // namespace

void writeJson(const Report& report, const std::string& file) {
  Json runs = Json::array();
  for (const Run& run : report.runs) runs.push_back(jsonOf(run));
  const Json all = {{"format", "streamkernel-stress"},
                    {"version", 1},
                    {"command", report.command},
                    {"device", report.device},
                    {"broken", report.broken()},
                    {"runs", runs},
                    {"notes", report.notes}};
  std::ofstream out(file);
  out << all.dump(1) << '\n' << std::flush;
  if (!out) throw std::runtime_error(fmt::format("cannot write '{}'", file));
}

}  // namespace sk_tool::stress
