// SPDX-License-Identifier: MIT
//
// sk stress: runs a program with what its kernels are given at the ends, and with other sizes, beside its shadow.
#include "commands.hpp"

#include <algorithm>
#include <charconv>
#include <chrono>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <memory>
#include <stdexcept>

#include <CLI/CLI.hpp>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <nlohmann/json.hpp>

#include "accuracy/child_process.hpp"
#include "accuracy/progress.hpp"
#include "stress/report.hpp"

namespace sk_tool {

namespace stress {
namespace {

struct Options {
  std::vector<std::string> words, only;
  std::vector<std::int64_t> sizes = {1, 2, 3, 5, 17, 97, 130};
  std::string json, keep;
  double limit = 0;
  bool isAll = false, anyStatus = false;
};

class Application {
 public:
  Application(const Options& options, std::filesystem::path folder)
      : options_(options), folder_(std::move(folder)) {}

  Run run(const Case& of, std::chrono::duration<double> limit) {
    std::vector<std::string> words;
    for (const std::string& word : options_.words) words.push_back(withSize(word, of.size));
    const std::filesystem::path page = folder_ / fmt::format("{:03}.html", count_++);
    std::filesystem::path file = page;
    file.replace_extension(".json");
    std::string shadow = page.string() + ",given=list";
    for (const std::string& setting : of.settings) shadow += ",set=" + setting;
    Run run{.of = of};
    run.process = runLimited(words, {{"SK_SHADOW", shadow}, {"SK_RESULTS", std::nullopt}}, limit);
    run.seen = observationOf(file);
    return run;
  }

  /// Runs the program as ever, so that it leaves the files that it always leaves.
  void runPlainly(std::chrono::duration<double> limit) const {
    std::vector<std::string> words;
    for (const std::string& word : options_.words) words.push_back(withSize(word, 0));
    runLimited(words, {}, limit);
  }

 private:
  /// Nullopt if the program has written no report, or if it was ended while it did.
  static std::optional<Observation> observationOf(const std::filesystem::path& file) {
    std::ifstream stream(file, std::ios::binary);
    const std::string text(std::istreambuf_iterator<char>(stream), {});
    const auto report = nlohmann::ordered_json::parse(text, nullptr, /*allow_exceptions=*/false);
    if (report.is_discarded()) return std::nullopt;
    return observationIn(Entry(report));
  }

  const Options& options_;
  const std::filesystem::path folder_;
  int count_ = 0;
};

void checkPlain(const Options& options, const Run& plain) {
  const std::string name = "'" + options.words.front() + "'";
  const std::string failure = plain.process.failure();
  const bool isStatusAllowed = options.anyStatus && plain.process.status && !plain.process.isSignalled();
  if (!failure.empty() && !isStatusAllowed)
    throw std::runtime_error(fmt::format("as it is, {} {}", name, failure));
  if (!plain.seen) {
    throw std::runtime_error(fmt::format(
        "{} opens no device of StreamKernel, was built with an older version of it, or ends by _exit()",
        name));
  }
  if (plain.seen->calls == 0) throw std::runtime_error(fmt::format("{} calls no kernel", name));
  if (plain.seen->results.empty())
    throw std::runtime_error(
        fmt::format("{} reads no result from its streams, so that nothing tells whether it works; the "
                    "elements that it draws "
                    "from textures do not count",
                    name));
}

std::vector<Case> sizeCases(const Options& options) {
  std::vector<Case> cases;
  if (std::ranges::none_of(options.words, hasSize)) return cases;
  for (const std::int64_t size : options.sizes) {
    cases.push_back(
        {.kind = Case::Kind::Size, .text = fmt::format("size {}", size), .size = size, .mustHold = true});
  }
  return cases;
}

/// What nobody can know from the report itself.
void addNotes(Report& report, const Options& options, std::size_t values) {
  const std::vector<Given>& given = report.runs.front().seen->given;
  if (values == 0) {
    report.notes.emplace_back(
        given.empty() ? "the host gives its kernels no numbers"
        : options.only.empty()
            ? "the host gives its kernels only what the extremes are"
            : fmt::format("--only {} matches nothing that the host gives", fmt::join(options.only, ", ")));
  }
  if (std::ranges::none_of(options.words, hasSize)) {
    report.notes.emplace_back(
        "the size is not changed; put one in braces, --size={256}, to try others in its place");
  }
}

void runStress(const Options& options) {
  std::optional<TemporaryFolder> temporary;
  if (options.keep.empty()) {
    temporary.emplace();
  } else {
    std::filesystem::create_directories(options.keep);
  }
  const std::filesystem::path folder =
      temporary ? temporary->path() : std::filesystem::absolute(options.keep);
  Application application(options, folder);
  using Seconds = std::chrono::duration<double>;
  const Seconds unlimited = std::chrono::hours(24);
  Report report;
  const Run plain =
      application.run({.text = "as it is"}, options.limit > 0 ? Seconds(options.limit) : unlimited);
  checkPlain(options, plain);
  const Seconds limit(options.limit > 0 ? options.limit : 15 + 10 * plain.process.wall);
  std::vector<std::string> words;
  for (const std::string& word : options.words) words.push_back(withSize(word, 0));
  report.command = fmt::format("{}", fmt::join(words, " "));
  report.device = plain.seen->device;
  report.runs.push_back(plain);
  report.runs.front().findings = findingsIn(report.runs.front(), report.runs.front());
  std::vector<Case> cases = valueCases(plain.seen->given, options.only);
  const std::size_t values = cases.size();
  std::ranges::move(sizeCases(options), std::back_inserter(cases));
  {
    Progress progress(fmt::format("{} cases", cases.size()));
    for (std::size_t i = 0; i < cases.size(); ++i) {
      progress.show(static_cast<double>(i) / static_cast<double>(cases.size()));
      Run run = application.run(cases[i], limit);
      if (options.anyStatus && run.process.status && !run.process.isSignalled()) run.process.status = 0;
      run.findings = findingsIn(run, plain);
      report.runs.push_back(std::move(run));
    }
    application.runPlainly(limit);
  }
  addNotes(report, options, values);
  print(report, options.isAll);
  if (!options.json.empty()) writeJson(report, options.json);
  if (report.broken() > 0)
    throw std::runtime_error(
        fmt::format("the program breaks in {} of {} cases", report.broken(), report.runs.size()));
}

}  // namespace
}  // namespace stress

void addStress(CLI::App& app) {
  const auto options = std::make_shared<stress::Options>();
  CLI::App* command = app.add_subcommand("stress",
                                         "Runs a program with what its kernels are given at the ends: of "
                                         "declared ranges, else zero, tiny, huge and NaN; "
                                         "and with other sizes. Fails if it breaks where it must not.");
  command->add_option(
      "--only", options->only,
      "what to change, a pattern of kernels or parameters, heat::* or heat::step.dt; any number of times");
  command
      ->add_option("--sizes", options->sizes,
                   "the sizes to put in the place of those in braces, 1,17,64 (default: 1,2,3,5,17,97,130)")
      ->delimiter(',')
      ->check(CLI::PositiveNumber);
  command
      ->add_option(
          "--limit", options->limit,
          "the most seconds of a run (default: ten times those of the program as it is, and 15 more)")
      ->check(CLI::PositiveNumber);
  command->add_option("--json", options->json, "also write all runs as JSON")->type_name("FILE");
  command->add_option("--keep", options->keep, "keep the page of each run's shadow in this folder")
      ->type_name("FOLDER");
  command->add_flag("--all", options->isAll, "list the cases that hold, too, and all that is wrong with the others");
  command->add_flag("--any-status", options->anyStatus,
                    "the exit status of the program does not count, because it checks its own results");
  command->add_option("program", options->words, "after --, the program and its arguments")->required();
  for (CLI::Option* option : command->get_options()) {
    if (option->get_lnames().empty() || option->get_expected_max() <= 1) continue;
    option->allow_extra_args(false);  // one value each time
  }
  command->callback([options] { stress::runStress(*options); });
}

}  // namespace sk_tool
