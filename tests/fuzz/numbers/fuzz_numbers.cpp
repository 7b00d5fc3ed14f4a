// SPDX-License-Identifier: MIT
//
// fuzz_numbers: calls the kernels of adversary.sk with numbers made to hurt, on any target, and compares the results with exact
// ones and with the bounds of docs/accuracy.md. Case N of a seed is always the same. A case with a finding is made smaller. With
// files, it runs the cases that they hold. The exit status is 1 after a finding.
#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <map>
#include <sstream>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <CLI/CLI.hpp>

#include "browser_page.hpp"
#include "command.hpp"
#include "numbers/browser.hpp"
#include "numbers/devices.hpp"
#include "numbers/generator.hpp"
#include "numbers/operations.hpp"
#include "numbers/shrink.hpp"
#include "numbers/verdict.hpp"
#include "sk/error.hpp"

namespace {

namespace fs = std::filesystem;
using fuzz::numbers::Case;
using fuzz::numbers::Devices;

struct Options : fuzz::SlicedCommand {
  Options() { count = 1000, seconds = 120, mostFindings = 40; }
  std::vector<std::string> targets{"native"}, operations, files;
  bool hasBrowser() const { return std::ranges::count(targets, "webgl2") > 0; }
  int budget = 400;
};

Case caseOf(const Options& options, std::uint64_t number) {
  return fuzz::numbers::generate(options.seed, number, options.operations);
}

std::string mistakeOn(Devices& devices, const std::string& target, const Case& one) {
  try {
    return mistakeOf(one, devices.run(target, one), devices.arithmetic(target, one));
  } catch (const sk::Error& error) {
    return std::string("throws ") + error.what();
  }
}

/// What is wrong with each of some cases in a browser, or "".
std::vector<std::string> mistakesInBrowser(std::span<const Case> cases) {
  std::vector<std::string> mistakes(cases.size(), "gives no result");
  for (const auto& [number, result] : fuzz::numbers::runInBrowser(cases)) {
    const auto* values = std::get_if<std::vector<fuzz::numbers::Values>>(&result);
    mistakes[number] = values == nullptr
                           ? std::get<std::string>(result)
                           : mistakeOf(cases[number], *values, arithmeticOf("webgl2", cases[number]));
  }
  return mistakes;
}

/// Whether a case that was made smaller has a mistake like the first one's.
bool areAlike(const std::string& mistake, const std::string& first) {
  return !mistake.empty() && mistake.starts_with("throws") == first.starts_with("throws");
}

/// What findings about one mistake have in common.
std::string kindOf(const std::string& target, const Case& one, const std::string& what) {
  const std::size_t place = what.starts_with("output") ? 8 : 0;
  return fmt::format("{} {} {} {} {}", target, one.operation, static_cast<int>(one.options.accumulate),
                     static_cast<int>(one.options.precision),
                     what.starts_with("throws") ? what : what.substr(0, place));
}

std::string report(const std::string& target, const Case& one, const std::string& what) {
  std::string text = fmt::format("{}: {}\n  {}\n", target, described(one), what);
  for (std::size_t k = 0; k < one.inputs.size(); ++k) {
    std::vector<std::string> numbers;
    for (std::size_t i = 0; i < std::min<std::size_t>(one.inputs[k].size(), 48); ++i)
      numbers.push_back(fuzz::numbers::shown(one.inputs[k][i]));
    text += fmt::format("  input {} has {} numbers: {}\n", k, one.inputs[k].size(), fmt::join(numbers, ", "));
  }
  return text;
}

class Campaigns {
 public:
  explicit Campaigns(const Options& options) : options_(options) {}

  int run() {
    options_.forSlices(options_.minutes > 0 ? 2000 : options_.count,
                       [&](std::uint64_t first, std::uint64_t count) {
                         runSlice(first, count);
                         return findings_;
                       });
    for (const auto& [name, count] : tallies_) std::cout << name << ": " << count << "\n";
    std::cout << cases_ << " cases, " << findings_ << " findings";
    if (lost_ > 0) std::cout << "; " << lost_ << " cases did not run, because a page hung";
    std::cout << "\n";
    fuzz::conclude(kinds_);
    return findings_ == 0 && lost_ == 0 ? 0 : 1;
  }

 private:
  void runSlice(std::uint64_t first, std::uint64_t count) {
    if (options_.targets != std::vector<std::string>{"webgl2"}) runOnDevices(first, count);
    constexpr std::uint64_t most = 1000;  // in one page
    for (std::uint64_t done = 0; options_.hasBrowser() && done < count; done += most) {
      const std::uint64_t begin = first + done, size = std::min(most, count - done);
      try {
        runInBrowser(begin, size);
      } catch (const fuzz::HungPage& error) {  // the next cases have another page
        lost_ += size;
        std::cout << "cases " << begin << " to " << begin + size - 1 << ": " << error.what() << "\n"
                  << std::flush;
      }
    }
  }

  void runOnDevices(std::uint64_t first, std::uint64_t count) {
    fuzz::Campaign campaign{.first = first, .count = count, .batch = 4000, .seconds = options_.seconds};
    fuzz::Kinds kinds;  // of the child
    std::optional<Devices> devices;
    campaign.begin = [&] { devices.emplace(); };
    campaign.check = [&](std::uint64_t number) { return check(*devices, kinds, number); };
    campaign.onFinding = [&](const fuzz::Finding& finding) { keep(finding); };
    const fuzz::Summary summary = fuzz::run(campaign);
    cases_ += summary.inputs;
    for (const auto& [tally, cases] : summary.tallies) {
      std::istringstream names(tally);
      for (std::string name; names >> name;) tallies_[name] += cases;
    }
  }

  /// Runs a case on all targets, in a child process.
  fuzz::Verdict check(Devices& devices, fuzz::Kinds& kinds, std::uint64_t number) const {
    const Case one = caseOf(options_, number);
    fuzz::Verdict verdict;
    for (const std::string& target : options_.targets) {
      if (target == "webgl2" || !canRun(target, one)) continue;
      verdict.tally += target + " ";
      const std::string wrong = mistakeOn(devices, target, one);
      if (wrong.empty() || !verdict.finding.empty()) continue;
      const auto find = [&](std::span<const Case> cases) -> std::optional<fuzz::numbers::Failure> {
        for (std::size_t i = 0; i < cases.size(); ++i) {
          if (!canRun(target, cases[i])) continue;
          const std::string what = mistakeOn(devices, target, cases[i]);
          if (areAlike(what, wrong)) return fuzz::numbers::Failure{i, what};
        }
        return std::nullopt;
      };
      verdict.finding = findingOf(target, one, wrong, find, 1, kinds);
    }
    return verdict;
  }

  /// The kind of a finding, a report for people, and the smallest case, if it is one of the first of its kind.
  std::string findingOf(const std::string& target, const Case& one, const std::string& wrong,
                        const fuzz::numbers::FindFailure& find, std::size_t together,
                        fuzz::Kinds& kinds) const {
    const std::string kind = kindOf(target, one, wrong);
    fuzz::numbers::Shrunk best{one, wrong};
    if (++kinds[kind] <= 2) best = fuzz::numbers::shrunk(one, wrong, find, options_.budget, together);
    return kind + "\n" + report(target, best.smallest, best.what) + "\f" + written(best.smallest);
  }

  void runInBrowser(std::uint64_t first, std::uint64_t count) {
    std::vector<Case> cases;
    std::vector<std::uint64_t> numbers;
    for (std::uint64_t i = 0; i < count; ++i) {
      Case one = caseOf(options_, first + i);
      if (!canRun("webgl2", one)) continue;
      cases.push_back(std::move(one));
      numbers.push_back(first + i);
    }
    tallies_["webgl2"] += cases.size();
    if (options_.targets.size() == 1) cases_ += count;
    const std::vector<std::string> mistakes = mistakesInBrowser(cases);
    for (std::size_t i = 0; i < cases.size(); ++i) {
      if (mistakes[i].empty()) continue;
      const auto find = [&](std::span<const Case> candidates) -> std::optional<fuzz::numbers::Failure> {
        std::vector<Case> possible;
        std::vector<std::size_t> places;
        for (std::size_t k = 0; k < candidates.size(); ++k) {
          if (!canRun("webgl2", candidates[k])) continue;
          possible.push_back(candidates[k]);
          places.push_back(k);
        }
        const std::vector<std::string> found = mistakesInBrowser(possible);
        for (std::size_t k = 0; k < found.size(); ++k) {
          if (areAlike(found[k], mistakes[i])) return fuzz::numbers::Failure{places[k], found[k]};
        }
        return std::nullopt;
      };
      keep({.number = numbers[i],
            .what = findingOf("webgl2", cases[i], mistakes[i], find, 100, browserKinds_),
            .log = {}});
    }
  }

  void keep(const fuzz::Finding& finding) {
    ++findings_;
    // What a child says is the kind, a report for people, and the smallest case.
    const std::size_t line = finding.what.find('\n'), page = finding.what.find('\f');
    const bool isWhole = page != std::string::npos;
    const std::string kind = finding.what.substr(0, line);
    const bool isNew = ++kinds_[kind] <= 2;
    const std::string text =
        isWhole ? finding.what.substr(page + 1) : written(caseOf(options_, finding.number));
    const fs::path file = options_.keep("numbers", finding, text, ".json");
    if (!isNew) return;
    fuzz::Finding shown = finding;
    if (isWhole) shown.what = finding.what.substr(line + 1, page - line - 1);
    fuzz::tell(
        "case", shown,
        "fuzz_numbers --targets " + fmt::format("{} {}", fmt::join(options_.targets, ","), file.string()));
  }

  const Options& options_;
  std::uint64_t cases_ = 0, findings_ = 0;
  std::uint64_t lost_ = 0;  ///< cases whose page hung
  fuzz::Kinds kinds_, browserKinds_;
  std::map<std::string, std::uint64_t> tallies_;
};

int runFiles(const Options& options) {
  Devices devices;
  int findings = 0;
  for (const std::string& file : options.files) {
    const Case one = fuzz::numbers::parsed(fuzz::textOf(file));
    for (const std::string& target : options.targets) {
      if (!canRun(target, one)) continue;
      const std::string wrong = target == "webgl2" ? mistakesInBrowser(std::span(&one, 1)).front()
                                                   : mistakeOn(devices, target, one);
      if (wrong.empty()) continue;
      ++findings;
      std::cout << file << "\n" << report(target, one, wrong);
    }
  }
  std::cout << options.files.size() << " cases, " << findings << " findings\n";
  return findings == 0 ? 0 : 1;
}

int fuzzNumbers(const Options& options) {
  if (!options.files.empty()) return runFiles(options);
  if (!options.show) return Campaigns(options).run();
  for (std::uint64_t i = 0; i < options.count; ++i)
    std::cout << written(caseOf(options, options.first + i)) << "\n";
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  Options options;
  CLI::App app{
      "fuzz_numbers: compares what kernels make of numbers that hurt with what docs/accuracy.md promises",
      "fuzz_numbers"};
  options.addTo(app, "case");
  app.add_option("--targets", options.targets,
                 "What to run: " + fmt::format("{}", fmt::join(fuzz::numbers::targetNames, ", ")))
      ->delimiter(',')
      ->allow_extra_args(false)
      ->check(CLI::IsMember(fuzz::numbers::targetNames));
  std::vector<std::string> names;
  for (const fuzz::numbers::Operation& one : fuzz::numbers::operations()) names.emplace_back(one.name);
  app.add_option("--operations", options.operations,
                 "What to call, of the kernels of adversary.sk: by default, all")
      ->delimiter(',')
      ->allow_extra_args(false)
      ->check(CLI::IsMember(names));
  app.add_option("--budget", options.budget, "How many smaller cases are tried for a finding");
  app.add_option("files", options.files, "Cases to run");
  CLI11_PARSE(app, argc, argv);
  return fuzz::guarded("fuzz_numbers", [&] { return fuzzNumbers(options); });
}
