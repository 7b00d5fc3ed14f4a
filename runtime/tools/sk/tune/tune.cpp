// SPDX-License-Identifier: MIT
//
// sk tune: finds the cheapest configuration file with which a program's results are as exact as asked, and proves it on other inputs.
#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdlib>
#include <fstream>
#include <stdexcept>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <CLI/CLI.hpp>

#include "accuracy/child_process.hpp"
#include "assemble/nearest_word.hpp"
#include "commands.hpp"
#include "support/cache_folder.hpp"
#include "tune/report.hpp"
#include "tune/truth.hpp"

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
  bool allowsDecisions = false, continues = false, isFresh = false;
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

[[noreturn]] void failRun(const Application& application, const std::string& failure) {
  throw std::runtime_error(fmt::format("{} {}", application.name(), failure));
}

/// The program as it is: with its times, and what it reads twice.
struct Baseline {
  Process times;  ///< of a run that waits around each kernel, on devices that queue calls
  Process process;
  std::vector<std::string> differing;  ///< names of reads that are not the same in two runs
  double wall = 0;  ///< seconds of the longest run
};

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
  base.times = std::move(measured.process);
  return base;
}

void checkBase(const Application& application, const Baseline& base, const BaseFile& file) {
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

/// Reads that do not repeat cannot be judged. Throws if nothing else is left, or if they are asked for.
std::vector<std::string> checkRepeats(const Application& application, const Baseline& base,
                                      const std::vector<Wanted>& wanted) {
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
  return base.differing;
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

Verification verify(const std::string& command, const Options& options, const std::vector<ResultFile>& files,
                    const std::vector<Wanted>& wanted, const std::string& configuration) {
  const Application application({"/bin/sh", "-c", command}, files);
  Verification result{.command = command, .asItIs = {}, .tuned = {}};
  RunResult asItIs = application.run({});
  if (!asItIs.failure.empty()) {
    result.failure = "as it is, the program " + asItIs.failure;
    return result;
  }
  const Truth truth = truthOf(application, options.isFresh);
  const Judge judge(asItIs.process, truth.process, wanted, Metric::L2, 0, {});
  result.asItIs = judge.judge(asItIs.process);
  const RunResult tuned = application.run({.environment = {{"SK_CONFIG", configuration}}});
  if (!tuned.failure.empty()) {
    result.failure = "the program " + tuned.failure;
    return result;
  }
  result.tuned = judge.judge(tuned.process);
  if (!result.tuned.isExact()) {
    result.failure = describe(result.tuned) + "; as it is: " + describe(result.asItIs);
  } else if (!options.allowsDecisions && !result.tuned.decision.empty()) {
    result.failure = result.tuned.decision + " (--allow-decisions lets it)";
  }
  return result;
}

[[noreturn]] void failUnreached(const Report& report) {
  const Found& found = *report.found;
  std::string text = fmt::format("nothing reaches the tolerance: the best is {}, with {}",
                                 describe(report.tuned->verdict), describe(report.tuned->setting));
  for (const std::string& failed : found.failed) text += "\nnot possible: " + failed;
  if (!found.isComplete)
    text += "\nthe budget has ended the search; a larger --budget, or --continue, may find more";
  throw std::runtime_error(text);
}

void write(const std::string& text, const std::string& file) {
  std::ofstream out(file);
  out << text;
  out.close();
  if (!out) throw std::runtime_error(fmt::format("cannot write '{}'", file));
}

/// Writes all that is asked for. Returns whether the setting holds on all inputs.
bool finish(Report& report, const Options& options, const std::vector<ResultFile>& files) {
  if (!options.verify.empty()) {
    const TemporaryFolder folder;
    const std::string file = (folder.path() / "tuned.toml").string();
    write(report.trials->fileOf(report.tuned->setting), file);
    for (const std::string& command : options.verify)
      report.verifications.push_back(verify(command, options, files, report.wanted, file));
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

void tune(const Options& options) {
  const double budget = secondsOf(options.budget);
  if (!options.chart.empty()) checkChartName(options.chart);
  const std::vector<ResultFile> files = filesOf(options);
  const std::vector<Wanted> wanted = wantedOf(options, files);
  const char* const configuration = std::getenv("SK_CONFIG");
  const bool hasBase = configuration != nullptr && *configuration != '\0';
  const BaseFile baseFile = hasBase ? BaseFile(configuration) : BaseFile();
  const Application application(options.words, files);
  const Baseline base = measure(application);
  checkBase(application, base, baseFile);
  const std::vector<std::string> ignored = checkRepeats(application, base, wanted);
  constexpr double leastRuns = 4;
  if (budget < leastRuns * base.wall) {
    throw std::runtime_error(fmt::format(
        "the budget of {} is too small: a run of {} takes {:.2g} s, and a search needs several; give "
        "--budget {:.0f}s or more",
        options.budget, application.name(), base.wall, std::ceil(20 * base.wall)));
  }
  const Truth truth = truthOf(application, options.isFresh);
  const Judge judge(base.process, truth.process, wanted, metricOf(options.metric), options.tolerance,
                    ignored);
  if (judge.judge(base.process).errors.empty()) {
    failRun(
        application,
        "reads only integers, which have no error; name a file that it writes: --result-file, --result-json");
  }
  const Choices choices = choicesOf(base.times);
  Trials trials(application, baseFile, choices.facts, judge,
                {.budget = std::chrono::duration<double>(budget),
                 .limit = std::chrono::duration<double>(10 + 10 * base.wall),
                 .allowsDecisions = options.allowsDecisions,
                 .stateFile = options.output + ".state",
                 .key = keyOf(options, judge, baseFile, base.process)});
  if (options.continues) trials.load();

  Found found;
  Report report{.command = commandOf(options.words),
                .device = deviceOf(base.process),
                .wanted = judge.wanted(),
                .ignored = ignored,
                .notes = base.process.notes};
  report.found = &found;
  report.choices = &choices;
  report.trials = &trials;
  try {
    trials.time({}, 3);
    report.base = &trials.run({});
    if (!report.base->failure.empty()) failRun(application, report.base->failure);
    report.wasRaised = !trials.holds(*report.base);
    if (report.wasRaised) searchExact(trials, choices, found);
    if (found.isReached && found.isComplete) searchCheaper(trials, choices, found);
    report.tuned = &trials.run(found.setting);
    if (found.isReached && !found.setting.empty()) report.ratio = trials.compare({}, found.setting, 5);
  } catch (const OutOfBudget&) {
    found.isComplete = false;
  }
  report.base = &trials.run({});
  report.tuned = &trials.run(found.setting);
  if (!found.isReached) failUnreached(report);
  if (report.ratio == 1) report.ratio = report.tuned->median() / std::max(report.base->median(), 1e-9);
  if (!finish(report, options, files))
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
      ->check(CLI::PositiveNumber);
  command->add_option("--metric", options->metric,
                      "relative, absolute, ulp, l2 (default: the norm of the difference over that of the "
                      "right result) or psnr");
  command->add_option("--result", options->results,
                      "a stream or reduce whose reads count, NAME[=METRIC[:TOLERANCE]]; any number of times "
                      "(default: all reads)");
  command->add_option("--result-file", options->files,
                      "a picture or .npy file that the program writes, and that counts");
  command->add_option("--psnr", options->psnr, "the least PSNR of pictures, in dB")
      ->check(CLI::PositiveNumber);
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
  command->add_option("program", options->words, "after --, the program and its arguments")->required();
  for (CLI::Option* option : command->get_options()) {
    if (option->get_lnames().empty() || option->get_expected_max() <= 1) continue;
    option->allow_extra_args(false);  // one value each time
  }
  command->callback([options] { tune::tune(*options); });
}

}  // namespace sk_tool
