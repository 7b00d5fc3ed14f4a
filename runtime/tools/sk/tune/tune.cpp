// SPDX-License-Identifier: MIT
//
// sk tune: finds the cheapest configuration file with which a program's results are as exact as asked, and proves it on other inputs.
#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdlib>
#include <fstream>
#include <memory>
#include <stdexcept>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <CLI/CLI.hpp>

#include "accuracy/child_process.hpp"
#include "application/program_options.hpp"
#include "assemble/nearest_word.hpp"
#include "commands.hpp"
#include "support/cache_folder.hpp"
#include "text/real_option.hpp"
#include "tune/baseline.hpp"
#include "tune/report.hpp"
#include "tune/truth.hpp"
#include "tune/verify.hpp"

namespace sk_tool {

namespace tune {
namespace {

using sk::results::Process;

struct Options {
  std::vector<std::string> words;
  double tolerance = 0;
  std::string metric = "l2";
  std::vector<std::string> results, files, json, verify;
  double psnr = 0;
  std::string output = "tuned.toml", chart, report, budget = "5m";
  bool allowsDecisions = false, anyStatus = false, continues = false, isFresh = false;
};

/// "90", "90s", "5m", "1.5h".
double secondsOf(const std::string& text) {
  double number = 0;
  const auto parsed = std::from_chars(text.data(), text.data() + text.size(), number);
  const std::string unit(parsed.ptr, text.data() + text.size());
  const double seconds = unit.empty() || unit == "s" ? 1 : unit == "m" ? 60 : unit == "h" ? 3600 : 0;
  if (parsed.ec != std::errc() || seconds == 0 || !(number > 0) || !std::isfinite(number))
    throw std::runtime_error(fmt::format("'{}' is no budget; give seconds, or 90s, 5m or 1h", text));
  return number * seconds;
}

std::vector<ResultFile> filesOf(const Options& options) {
  std::vector<ResultFile> files;
  for (const std::string& file : options.files) files.push_back({file});
  for (const std::string& text : options.json) {
    const std::size_t colon = text.rfind(':');
    files.push_back(colon == std::string::npos ? ResultFile{text}
                                               : ResultFile{text.substr(0, colon), text.substr(colon + 1)});
    if (files.back().path.empty())
      throw std::runtime_error(
          fmt::format("'{}' names no number in a file; give FILE:NAME, run.json:energy", text));
  }
  return files;
}

std::vector<Wanted> wantedOf(const Options& options, const std::vector<ResultFile>& files) {
  const Metric metric = metricOf(options.metric);
  std::vector<Wanted> wanted;
  for (const std::string& text : options.results)
    wanted.push_back(parseWanted(text, metric, options.tolerance));
  for (const ResultFile& file : files) {
    Wanted each{file.name(), metric, options.tolerance, file.isPicture()};
    if (options.psnr > 0 && file.isPicture()) each.metric = Metric::Psnr, each.tolerance = options.psnr;
    wanted.push_back(each);
  }
  for (const Wanted& each : wanted) {
    if (each.tolerance > 0) continue;
    throw std::runtime_error(fmt::format("there is no tolerance for '{}'; give --tolerance{}", each.name,
                                         each.isPicture ? " or --psnr" : ""));
  }
  if (wanted.empty() && !(options.tolerance > 0))
    throw std::runtime_error("--tolerance is required: a number above 0, 1e-5");
  return wanted;
}

std::string commandOf(const std::vector<std::string>& words) {
  return fmt::format("{}", fmt::join(words, " "));
}

std::string deviceOf(const Process& process) {
  std::vector<std::string> names;
  for (const sk::results::Device& device : process.devices) {
    if (std::ranges::find(names, device.name) == names.end()) names.push_back(device.name);
  }
  return fmt::format("{}", fmt::join(names, ", "));
}

/// What all trials depend on.
std::string keyOf(const Options& options, const Judge& judge, const BaseFile& base, const Process& process) {
  std::string key = commandOf(options.words) + '\n' + base.text({}, {}) + deviceOf(process) + '\n';
  for (const Wanted& each : judge.wanted()) {
    key += fmt::format("{} {} {}\n", each.name, nameOf(each.metric), each.tolerance);
    if (const auto* series = seriesNamed(process, each.name)) key += fmt::format("{}\n", series->hash);
  }
  return fmt::format("{:016x}", sk::hashOf(key));
}

/// Runs what --verify names before the search.
std::vector<OtherInputs> otherInputsOf(const Options& options, const std::vector<ResultFile>& files,
                                       const std::vector<Wanted>& wanted, const Baseline& base) {
  const Criteria criteria{.wanted = wanted,
                          .metric = metricOf(options.metric),
                          .tolerance = options.tolerance,
                          .allowsDecisions = options.allowsDecisions};
  std::vector<OtherInputs> others;
  others.reserve(options.verify.size());
  for (const std::string& command : options.verify) {
    others.emplace_back(command, Application({"/bin/sh", "-c", command}, files, options.anyStatus), base,
                        criteria, options.isFresh);
  }
  return others;
}

/// Results whose tolerance no choice can reach, because the program gets them as floats.
std::string textOfFloats(const Report& report) {
  std::string text;
  for (const ResultError& error : report.tuned->verdict.errors) {
    const auto wanted = std::ranges::find(report.wanted, error.name, &Wanted::name);
    if (!(error.ofRounding > 1) || wanted == report.wanted.end()) continue;
    const std::string least =
        error.metric == Metric::Psnr
            ? fmt::format("{:.1f} dB at most", wanted->tolerance - 20 * std::log10(error.ofRounding))
            : fmt::format("an error of {:.2g}", wanted->tolerance * error.ofRounding);
    text += fmt::format(
        "\n'{}' is read as floats: the right numbers have {} ({}) when they are rounded to floats",
        error.name, least, nameOf(error.metric));
  }
  return text;
}

[[noreturn]] void failUnreached(const Report& report) {
  const Found& found = *report.found;
  std::string text =
      fmt::format("{}: the best is {}, with {}",
                  found.isComplete ? "nothing reaches the tolerance"
                                   : "the budget has ended the search before anything reached the tolerance",
                  describe(report.tuned->verdict), describe(report.tuned->setting));
  text += textOfFloats(report);
  for (const std::string& failed : found.failed) text += "\nnot possible: " + failed;
  for (const std::string& note : report.notes) text += "\nnote: " + note;
  if (!found.isComplete) text += "\na larger --budget, or --continue, may find more";
  throw std::runtime_error(text);
}

void write(const std::string& text, const std::string& file) {
  std::ofstream out(file);
  out << text;
  out.close();
  if (!out) throw std::runtime_error(fmt::format("cannot write '{}'", file));
}

/// Writes all that is asked for. Returns whether the setting holds on all inputs.
bool finish(Report& report, const Options& options, const std::vector<OtherInputs>& others) {
  if (!others.empty()) {
    const TemporaryFolder folder;
    const std::string file = (folder.path() / "tuned.toml").string();
    write(report.trials->fileOf(report.tuned->setting), file);
    for (const OtherInputs& each : others) report.verifications.push_back(each.verify(file));
  }
  const bool holds = std::ranges::all_of(report.verifications,
                                         [](const Verification& each) { return each.failure.empty(); });
  const std::string file = holds ? options.output : options.output + ".rejected";
  write(fileOf(report), file);
  print(report);
  if (!options.report.empty()) writeJson(report, options.report);
  if (!options.chart.empty()) drawTrials(report, options.chart);
  if (holds) fmt::print("written: {}; SK_CONFIG={} runs the program with it\n", file, file);
  return holds;
}

void finishSearch(Trials& trials, const Found& found, Report& report) {
  report.base = &trials.run({});
  report.tuned = &trials.run(found.setting);
}

/// Whether all of the setting was chosen, and timed, at once.
bool isOneChoice(const Found& found) {
  const bool isRaised = found.raised.size() == 1 && std::ranges::all_of(found.setting, [&](const auto& each) {
                          return each.first.name == found.raised.front();
                        });
  return found.setting.size() == 1 || isRaised;
}

/// Searches in the direction that the program needs, and times what was found against the program as it is.
void search(Trials& trials, const Choices& choices, Found& found, Report& report) {
  try {
    trials.time({}, 3);
    report.wasRaised = !trials.holds(trials.run({}));
    if (report.wasRaised) searchExact(trials, choices, found);
    if (found.isReached && found.isComplete) searchCheaper(trials, choices, found);
  } catch (const OutOfBudget&) {
    found.isComplete = false;
  }
  trials.liftBudget();
  if (found.isReached && !found.setting.empty()) {
    trials.run(found.setting);
    report.times = trials.compare({}, found.setting, 5);
    if (!report.wasRaised && report.times.ratio() > 1 - leastGain / 2) {  // what its parts saved was chance
      found.setting.clear();
      found.evidence.clear();
      report.times.second = report.times.first;
    }
    if (isOneChoice(found)) {  // which has one ratio, not another one of the kernel alone
      for (auto& [unit, evidence] : found.evidence) evidence.saved = 1 - report.times.ratio();
    }
  } else {
    report.times.first = report.times.second = trials.run({}).median();
  }
  finishSearch(trials, found, report);
}

void checkBudget(const Options& options, const Application& application, double wall) {
  constexpr double leastRuns = 4, someRuns = 20;
  if (secondsOf(options.budget) >= leastRuns * wall) return;
  throw std::runtime_error(fmt::format(
      "the budget of {} is too small: a run of {} takes {:.2g} s, and a search needs several; give "
      "--budget {:.0f}s or more",
      options.budget, application.name(), wall, std::ceil(someRuns * wall)));
}

void checkFloats(const Application& application, const Verdict& verdict) {
  if (!verdict.errors.empty()) return;
  throw std::runtime_error(fmt::format(
      "{} reads only integers, which have no error; name a file that it writes: --result-file, --result-json",
      application.name()));
}

BaseFile baseFile() {
  const char* const name = std::getenv("SK_CONFIG");
  return name != nullptr && *name != '\0' ? BaseFile(name) : BaseFile();
}

void tune(const Options& options) {
  const double budget = secondsOf(options.budget);
  checkWritable(options.output);
  if (!options.report.empty()) checkWritable(options.report);
  if (!options.chart.empty()) checkChart(options.chart);
  const std::vector<ResultFile> files = filesOf(options);
  const std::vector<Wanted> wanted = wantedOf(options, files);
  const BaseFile file = baseFile();
  const Application application(options.words, files, options.anyStatus);
  const Baseline base = measure(application);
  checkBaseline(application, base, file);
  checkRepeats(application, base, wanted);
  checkBudget(options, application, base.wall);
  const Truth truth = truthOf(application, options.isFresh);
  const Judge judge(base.process, truth.process, wanted, metricOf(options.metric), options.tolerance,
                    base.differing);
  checkFloats(application, judge.judge(base.process));
  const std::vector<OtherInputs> others = otherInputsOf(options, files, wanted, base);
  const Choices choices = choicesOf(base.times);
  Trials trials(application, file, choices.facts, judge,
                {.budget = std::chrono::duration<double>(budget),
                 .limit = std::chrono::duration<double>(10 + 10 * base.wall),
                 .allowsDecisions = options.allowsDecisions,
                 .measures = base.queues(),
                 .stateFile = options.output + ".state",
                 .key = keyOf(options, judge, file, base.process)});
  if (options.continues) trials.load();
  Found found;
  Report report{.command = commandOf(options.words),
                .device = deviceOf(base.process),
                .wanted = judge.wanted(),
                .ignored = base.differing,
                .notes = base.process.notes};
  report.found = &found;
  report.choices = &choices;
  report.trials = &trials;
  search(trials, choices, found, report);
  if (!found.isReached) failUnreached(report);
  if (finish(report, options, others)) return;
  throw std::runtime_error(fmt::format(
      "the configuration does not hold on other inputs; it is kept as '{}.rejected'", options.output));
}

}  // namespace
}  // namespace tune

void addTune(CLI::App& app) {
  const auto options = std::make_shared<tune::Options>();
  CLI::App* command = app.add_subcommand("tune",
                                         "Finds the cheapest configuration file (SK_CONFIG) with which the "
                                         "results of a program are as exact as asked.");
  command->add_option("--tolerance", options->tolerance, "the largest error of each result, by the metric")
      ->check(sk::text::aboveZero(), "above 0");
  command->add_option("--metric", options->metric,
                      "relative, absolute, ulp, l2 (default: the norm of the difference over that of the "
                      "right result) or psnr");
  command->add_option("--result", options->results,
                      "a stream or reduce whose reads count, NAME[=METRIC[:TOLERANCE]]; any number of times "
                      "(default: all reads)");
  command->add_option("--result-file", options->files,
                      "a picture or .npy file that the program writes, and that counts");
  command->add_option("--psnr", options->psnr, "the least PSNR of pictures, in dB")
      ->check(sk::text::aboveZero(), "above 0");
  command->add_option("--result-json", options->json,
                      "numbers in a JSON file that the program writes: FILE:NAME, run.json:energy");
  command->add_option("--verify", options->verify,
                      "a command line of the program with other inputs; any number of times");
  command->add_option("--budget", options->budget, "how long to search: 90s, 5m, 1h")->capture_default_str();
  command->add_option("-o,--output", options->output, "the configuration file")->capture_default_str();
  command->add_option("--json", options->report, "all trials and the evidence, as JSON");
  command->add_option("--chart", options->chart, "a chart of all trials, FILE.svg or FILE.png");
  command->add_flag("--allow-decisions", options->allowsDecisions,
                    "integer results, and how often something is read, may change");
  command->add_flag("--continue", options->continues,
                    "goes on where an earlier search of the same program was ended");
  command->add_flag("--fresh", options->isFresh, "computes the right results anew");
  addProgram(*command, options->words, options->anyStatus);
  command->callback([options] { tune::tune(*options); });
}

}  // namespace sk_tool
