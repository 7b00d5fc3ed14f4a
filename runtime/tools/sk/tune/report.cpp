// SPDX-License-Identifier: MIT
#include "tune/report.hpp"

#include <algorithm>
#include <cmath>
#include <fstream>
#include <iterator>
#include <stdexcept>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "accuracy/child_process.hpp"

namespace sk_tool::tune {

namespace {

using nlohmann::json;

std::string textOf(const ResultError& error) {
  return error.metric == Metric::Psnr ? fmt::format("{:.1f} dB", error.error)
                                      : fmt::format("{:.2g}", error.error);
}

std::string toleranceOf(const Wanted& wanted) {
  return wanted.metric == Metric::Psnr ? fmt::format("{:g} dB", wanted.tolerance)
                                       : fmt::format("{} {:g}", nameOf(wanted.metric), wanted.tolerance);
}

/// Results with one tolerance, together: "a, b (l2 1e-05); picture.png (60 dB)".
std::string textOf(const std::vector<Wanted>& wanted) {
  std::string text;
  for (std::size_t i = 0; i < wanted.size(); ++i) {
    const std::string tolerance = toleranceOf(wanted[i]);
    const bool isLast = i + 1 == wanted.size() || toleranceOf(wanted[i + 1]) != tolerance;
    text += wanted[i].name + (isLast ? fmt::format(" ({})", tolerance) : "");
    if (i + 1 < wanted.size()) text += isLast ? "; " : ", ";
  }
  return text;
}

std::string percent(double part) {
  return fmt::format("{:.{}f} %", 100 * part, std::fabs(part) < 0.1 ? 1 : 0);
}

std::string textOf(const Evidence& evidence, double score) {
  std::string text;
  if (evidence.isTimed) {
    text = evidence.saved >= 0 ? fmt::format("saves {} of the time; ", percent(evidence.saved))
                               : fmt::format("costs {} of the time; ", percent(-evidence.saved));
  }
  if (!std::isfinite(evidence.scoreWithout))
    return text + "without it, the program does not run or reads other numbers";
  return text + fmt::format("{:.2g} of the tolerance, {:.2g} without it", score, evidence.scoreWithout);
}

/// The text as comment lines.
std::string commented(const std::string& text) {
  std::string result = "# ";
  for (const char c : text) result += c == '\n' ? std::string("\n# ") : std::string(1, c);
  return result + '\n';
}

std::string summaryOf(const Report& report) {
  std::string text = fmt::format("results that count: {}", textOf(report.wanted));
  for (const std::string& name : report.ignored)
    text += fmt::format("\n  {} differs from run to run and does not count", name);
  text += fmt::format("\nas it is: {:.3g} s, {}", report.times.first, describe(report.base->verdict));
  text += fmt::format("\ntuned: {:.3g} s, {:.2f} of the time, {}", report.times.second, report.times.ratio(),
                      describe(report.tuned->verdict));
  return text;
}

std::string rowsOf(const Report& report) {
  std::string rows;
  for (const auto& [unit, value] : report.tuned->setting) {
    const auto evidence = report.found->evidence.find(unit);
    rows += fmt::format("  {:<44}{}\n", describe(unit, value),
                        evidence == report.found->evidence.end()
                            ? ""
                            : textOf(evidence->second, report.tuned->verdict.score));
  }
  return rows;
}

std::string nothingFoundIn(const Report& report) {
  return report.found->isComplete ? "nothing else is faster within the tolerance"
                                  : "nothing faster was found before the budget ended";
}

json numberIn(double value) { return std::isfinite(value) ? json(value) : json(nullptr); }

json jsonIn(const Verdict& verdict) {
  json errors = json::array();
  for (const ResultError& error : verdict.errors) {
    errors.push_back({{"result", error.name},
                      {"metric", nameOf(error.metric)},
                      {"error", numberIn(error.error)},
                      {"ofTolerance", numberIn(error.overTolerance)}});
  }
  return {{"errors", errors}, {"ofTolerance", numberIn(verdict.score)}, {"otherDecision", verdict.decision}};
}

json jsonIn(const Setting& setting) {
  json list = json::array();
  for (const auto& [unit, value] : setting)
    list.push_back({{"section", unit.section}, {"name", unit.name}, {"key", unit.key}, {"value", value}});
  return list;
}

json jsonIn(const Trial& trial) {
  json result = trial.failure.empty() ? jsonIn(trial.verdict) : json{{"failure", trial.failure}};
  result["setting"] = jsonIn(trial.setting);
  result["seconds"] = trial.seconds;
  return result;
}

/// Trials that no other one beats in both time and error.
bool isPareto(const Trial& trial, const std::vector<const Trial*>& all) {
  return std::ranges::none_of(all, [&](const Trial* other) {
    const bool isNoWorse = other->median() <= trial.median() && other->verdict.score <= trial.verdict.score;
    return isNoWorse && (other->median() < trial.median() || other->verdict.score < trial.verdict.score);
  });
}

}  // namespace

std::string describe(const Verdict& verdict) {
  const ResultError* worst = verdict.worst();
  if (worst == nullptr) return "no error";
  return fmt::format("error {} ({:.2g} of the tolerance; {})", textOf(*worst), worst->overTolerance,
                     worst->name);
}

std::string fileOf(const Report& report) {
  FileTexts texts;
  texts.head = commented(
      fmt::format("Found by sk tune for: {}\non {}\n{}", report.command, report.device, summaryOf(report)));
  for (const Verification& each : report.verifications) {
    texts.head +=
        commented(each.failure.empty() ? fmt::format("verified: {}: {}", each.command, describe(each.tuned))
                                       : fmt::format("rejected: {}: {}", each.command, each.failure));
  }
  if (report.tuned->setting.empty()) texts.head += commented(nothingFoundIn(report));
  texts.comment = [&](const Unit& unit) -> std::string {
    if (!report.tuned->setting.contains(unit)) return {};
    const auto evidence = report.found->evidence.find(unit);
    return evidence == report.found->evidence.end() ? ""
                                                    : textOf(evidence->second, report.tuned->verdict.score);
  };
  return report.trials->fileOf(report.tuned->setting, texts);
}

void print(const Report& report) {
  fmt::print("{} on {}\n{}\n{}", report.command, report.device, summaryOf(report), rowsOf(report));
  if (report.wasRaised) {
    std::string names;
    for (const std::string& name : report.found->raised)
      names += (names.empty() ? "" : ", ") + (name == "*" ? "streams without a name" : name);
    fmt::print("raised, and none of them can be left out: {}\n", names);
  }
  if (report.tuned->setting.empty()) fmt::print("{}\n", nothingFoundIn(report));
  for (const std::string& note : report.notes) fmt::print("note: {}\n", note);
  for (const std::string& failed : report.found->failed) fmt::print("not possible: {}\n", failed);
  for (const std::string& untried : report.choices->untried) fmt::print("not tried: {}\n", untried);
  for (const Verification& each : report.verifications) {
    fmt::print("{}: {}: {}\n", each.failure.empty() ? "verified" : "rejected", each.command,
               each.failure.empty() ? describe(each.tuned) : each.failure);
  }
  fmt::print("{} runs{}\n", report.trials->runs(),
             report.found->isComplete ? "" : "; the budget has ended the search, --continue goes on");
}

void writeJson(const Report& report, const std::string& file) {
  json wanted = json::array(), trials = json::array(), verifications = json::array(),
       evidence = json::array();
  for (const Wanted& each : report.wanted) {
    wanted.push_back({{"name", each.name}, {"metric", nameOf(each.metric)}, {"tolerance", each.tolerance}});
  }
  for (const Trial* each : report.trials->all()) trials.push_back(jsonIn(*each));
  for (const Verification& each : report.verifications) {
    verifications.push_back({{"command", each.command},
                             {"asItIs", jsonIn(each.asItIs)},
                             {"tuned", jsonIn(each.tuned)},
                             {"holds", each.failure.empty()},
                             {"failure", each.failure}});
  }
  for (const auto& [unit, each] : report.found->evidence) {
    json row = {{"name", unit.name}, {"key", unit.key}, {"ofToleranceWithout", numberIn(each.scoreWithout)}};
    row["saved"] = each.isTimed ? numberIn(each.saved) : json(nullptr);
    evidence.push_back(row);
  }
  const json all = {{"command", report.command},
                    {"device", report.device},
                    {"results", wanted},
                    {"ignored", report.ignored},
                    {"asItIs", jsonIn(*report.base)},
                    {"tuned", jsonIn(*report.tuned)},
                    {"timeRatio", report.times.ratio()},
                    {"raised", report.found->raised},
                    {"evidence", evidence},
                    {"complete", report.found->isComplete},
                    {"notPossible", report.found->failed},
                    {"notTried", report.choices->untried},
                    {"verified", verifications},
                    {"trials", trials}};
  std::ofstream out(file);
  out << all.dump(2) << '\n';
  out.close();
  if (!out) throw std::runtime_error(fmt::format("cannot write '{}'", file));
}

void drawTrials(const Report& report, const std::string& file) {
  std::vector<const Trial*> trials;
  for (const Trial* each : report.trials->all()) {
    if (each->failure.empty() && std::isfinite(each->verdict.score)) trials.push_back(each);
  }
  double least = 0.1;
  for (const Trial* each : trials)
    least = each->verdict.score > 0 ? std::min(least, each->verdict.score) : least;
  const double base = report.base->median();
  std::string script = terminalOf(file, 640, 440);
  script += fmt::format(
      "set key off\nset grid lt 1 lc rgb '#dddddd'\nset border 3\nset tics nomirror\nset title {} "
      "noenhanced\n"
      "set xlabel 'time over that of the program as it is'\nset ylabel 'log10 of the error over the "
      "tolerance'\n"
      "set offsets graph 0.08, graph 0.15, graph 0.08, graph 0.08\n$trials << END\n",
      quoted("sk tune on " + report.device));
  for (const Trial* each : trials) {
    const bool isEnd = each == report.base || each == report.tuned;
    const char* const colour = isEnd ? "0xb5421b" : isPareto(*each, trials) ? "0x1b5e9b" : "0x999999";
    fmt::format_to(std::back_inserter(script), "{} {} {} {}\n",
                   each == report.tuned ? report.times.ratio() : each->median() / base,
                   std::log10(std::max(each->verdict.score, least / 10)), colour,
                   each == report.base    ? "\"as it is\""
                   : each == report.tuned ? "\"tuned\""
                                          : "\"\"");
  }
  script +=
      "END\nplot 0 lc rgb '#b5421b' dt 2, $trials using 1:2:3 with points pt 7 ps 0.7 lc rgb variable, "
      "$trials using 1:2:4 with labels left offset 0.7,0.5 noenhanced\n";
  runGnuplot(file, script);
}

}  // namespace sk_tool::tune
