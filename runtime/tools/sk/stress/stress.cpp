// SPDX-License-Identifier: MIT
//
// sk stress: runs a program with what its kernels are given at the ends, and with other sizes, beside its shadow.
#include "commands.hpp"

#include <algorithm>
#include <charconv>
#include <chrono>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <memory>
#include <set>
#include <stdexcept>
#include <string_view>
#include <system_error>

#include <CLI/CLI.hpp>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <nlohmann/json.hpp>

#include "accuracy/child_process.hpp"
#include "accuracy/progress.hpp"
#include "application/program_options.hpp"
#include "shadow/options.hpp"
#include "stress/report.hpp"
#include "support/process_name.hpp"
#include "text/real_option.hpp"

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
    const std::string name = fmt::format("{:03}", count_++);
    const std::string page = sk::withoutProcess(folder_.string()) + "/" + name + "-%p.html";
    std::string shadow = sk::shadow::asOption(page) + ",given=list";
    for (const std::string& setting : of.settings) shadow += ",set=" + sk::shadow::asOption(setting);
    Run run{.of = of};
    run.process = runLimited(wordsOf(of), {{"SK_SHADOW", shadow}, {"SK_RESULTS", std::nullopt}}, limit);
    const std::filesystem::path report = onlyReport(name);
    run.seen = observationOf(report);
    for (const char* const ending : {".json", ".html"}) {  // without the number of the process
      std::filesystem::path from = report;
      std::error_code error;  // a program without a device has no report
      std::filesystem::rename(from.replace_extension(ending), folder_ / (name + ending), error);
    }
    return run;
  }

  /// Runs the program as ever, so that it leaves the files that it always leaves.
  void runPlainly(std::chrono::duration<double> limit) const { runLimited(wordsOf({}), {}, limit); }

 private:
  std::vector<std::string> wordsOf(const Case& of) const {
    std::vector<std::string> words = options_.words;
    for (std::size_t i = 1; i < words.size(); ++i) words[i] = withSize(words[i], of.size);
    return words;
  }

  /// The report that a run has written; an empty path if there is none. Throws std::runtime_error if several processes have.
  std::filesystem::path onlyReport(const std::string& name) const {
    std::vector<std::filesystem::path> files;
    for (const auto& entry : std::filesystem::directory_iterator(folder_)) {
      const std::string file = entry.path().filename().string();
      if (file.starts_with(name + "-") && file.ends_with(".json")) files.push_back(entry.path());
    }
    if (files.size() > 1)
      throw std::runtime_error(
          fmt::format("'{}' starts {} processes with devices of StreamKernel; stress each of them by itself",
                      options_.words.front(), files.size()));
    return files.empty() ? std::filesystem::path() : files.front();
  }

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
    throw std::runtime_error(
        fmt::format("{} leaves no report of a shadow: it opens no device of StreamKernel, opens the "
                    "reference alone, or was built "
                    "with an older version of it",
                    name));
  }
  if (plain.seen->calls == 0) {
    throw std::runtime_error(
        plain.seen->hasEnded
            ? fmt::format("{} calls no kernel", name)
            : fmt::format("{} has not ended its device, as exit() does: it ends by _exit(), exec "
                          "or quick_exit, or forks and calls kernels in the child alone",
                          name));
  }
  if (plain.seen->results.empty())
    throw std::runtime_error(
        fmt::format("{} reads no result from its streams, so that nothing tells whether it works; the "
                    "elements that it draws "
                    "from textures do not count",
                    name));
}

std::vector<Case> sizeCases(const Options& options) {
  std::vector<Case> cases;
  if (std::none_of(options.words.begin() + 1, options.words.end(), hasSize)) return cases;
  std::set<std::int64_t> sizes(options.sizes.begin(), options.sizes.end());
  for (const std::int64_t size : sizes) {
    cases.push_back(
        {.kind = Case::Kind::Size, .text = fmt::format("size {}", size), .size = size, .mustHold = true});
  }
  return cases;
}

/// What is not told by the cases.
void addNotes(Report& report, const Options& options, std::size_t values) {
  const std::vector<Given>& given = report.runs.front().seen->given;
  if (values == 0) report.notes.emplace_back("the host gives its kernels nothing that has other extremes");
  for (const std::string& name : emptyRanges(given)) {
    report.notes.push_back(fmt::format(
        "{} stays as it is: the stream goes to parameters whose ranges have no number in common", name));
  }
  if (std::none_of(options.words.begin() + 1, options.words.end(), hasSize)) {
    report.notes.emplace_back(
        "the size is not changed; put one in braces, --size={256}, to try others in its place");
  }
}

void checkOnly(const Options& options, const std::vector<Given>& given, std::size_t values) {
  if (options.only.empty() || values > 0) return;
  std::vector<std::string> names;
  for (const Given& each : given) names.push_back(fmt::format("{}.{}", each.kernel, each.parameter));
  throw std::runtime_error(
      fmt::format("--only {} matches nothing that the host gives; it gives {}", fmt::join(options.only, ", "),
                  names.empty() ? "nothing" : fmt::format("{}", fmt::join(names, ", "))));
}

/// SK_CHECK=written runs calls several times, beside which there is no shadow.
void checkEnvironment() {
  const char* const checks = std::getenv("SK_CHECK");
  if (checks != nullptr && std::string_view(checks).find("written") != std::string_view::npos)
    throw std::runtime_error("SK_CHECK=written is set, beside which nothing is compared; unset it");
}

/// The folder for pages, without those of an earlier search.
void clearFolder(const std::filesystem::path& folder) {
  std::filesystem::create_directories(folder);
  for (const auto& entry : std::filesystem::directory_iterator(folder)) {
    const std::string name = entry.path().stem().string(), ending = entry.path().extension().string();
    const bool isNumber = name.size() == 3 && name.find_first_not_of("0123456789") == std::string::npos;
    if (isNumber && (ending == ".html" || ending == ".json")) std::filesystem::remove(entry.path());
  }
}

void runStress(const Options& options) {
  checkEnvironment();
  if (!options.json.empty()) checkWritable(options.json);
  std::optional<TemporaryFolder> temporary;
  if (options.keep.empty()) {
    temporary.emplace();
  } else {
    clearFolder(options.keep);
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
  for (const std::string& word : options.words) words.push_back(words.empty() ? word : withSize(word, 0));
  report.command = fmt::format("{}", fmt::join(words, " "));
  report.device = plain.seen->device;
  report.runs.push_back(plain);
  report.runs.front().findings = findingsIn(report.runs.front(), report.runs.front());
  std::vector<Case> cases = valueCases(plain.seen->given, options.only);
  const std::size_t values = cases.size();
  checkOnly(options, plain.seen->given, values);
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
        fmt::format("the program breaks in {} of {} cases", report.broken(), report.listed()));
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
      ->check(CLI::Range(std::int64_t{1}, std::int64_t{1} << 40));
  command
      ->add_option(
          "--limit", options->limit,
          "the most seconds of a run (default: ten times those of the program as it is, and 15 more)")
      ->check(sk::text::realFrom(1e-3, 1e7), "0.001 to 1e7");
  command->add_option("--json", options->json, "also write all runs as JSON")->type_name("FILE");
  command->add_option("--keep", options->keep, "keep the page of each run's shadow in this folder")
      ->type_name("FOLDER");
  command->add_flag("--all", options->isAll,
                    "list the cases that hold, too, and all that is wrong with the others");
  addProgram(*command, options->words, options->anyStatus);
  command->callback([options] { stress::runStress(*options); });
}

}  // namespace sk_tool
