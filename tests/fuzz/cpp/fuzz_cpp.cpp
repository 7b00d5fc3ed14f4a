// SPDX-License-Identifier: MIT
//
// fuzz_cpp: generates programs that are both C++ and .sk, and compares what skc makes of them, on any target, with what Clang
// makes of them. Program N of a seed is always the same. A program with a finding is reduced. With files, it runs these and
// compares with the results that are stored beside them, for which it needs no Clang. The exit status is 1 after a finding.
#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <optional>
#include <set>

#include <fmt/format.h>
#include <unistd.h>

#include <CLI/CLI.hpp>

#include "browser_page.hpp"
#include "command.hpp"
#include "cpp/browser.hpp"
#include "cpp/generator.hpp"
#include "cpp/lanes.hpp"
#include "cpp/oracle.hpp"
#include "cpp/reducer.hpp"
#include "cpp/targets.hpp"
#include "cpp/unit.hpp"
#include "driver/big_stack.hpp"
#include "driver/compile.hpp"
#include "kernels/native_code.hpp"
#include "web/offered.hpp"

namespace {

namespace fs = std::filesystem;
using fuzz::cpp::Node;
using fuzz::cpp::Outputs;
using fuzz::cpp::Targets;

struct Options : fuzz::SlicedCommand {
  Options() { count = 100, seconds = 60; }
  std::vector<std::string> targets{"native"}, without, files;
  int budget = 400;
  bool isStoring = false;
};

std::set<std::string> setOf(const std::vector<std::string>& names) { return {names.begin(), names.end()}; }

fuzz::cpp::Program programOf(const Options& options, std::uint64_t number) {
  return fuzz::cpp::generate(options.seed, number, setOf(options.without));
}

/// Without the kernels that no browser takes, which their modules say, and those with parameters of their own, which pages are not given.
std::vector<Outputs> inBrowsers(const skc::ir::Module& module, std::vector<Outputs> outputs) {
  std::erase_if(outputs, [&](const Outputs& one) {
    return fuzz::cpp::nameOf(one).hasOwnParameters ||
           std::ranges::any_of(module.kernels, [&](const skc::ir::Kernel& kernel) {
             return kernel.name == one.kernel && !skc::web::whyNestsTooDeep(module, kernel).empty();
           });
  });
  return outputs;
}

/// What is wrong with a program, or "". What the browser shall run is added to its batch.
std::string check(const Node& root, Targets& targets, const fuzz::cpp::BrowserBatch& batch,
                  std::uint64_t number) {
  const std::string text = print(root);
  const auto [module, messages] = skc::driver::translateText({}, "random.sk", text);
  if (!module) {
    const fuzz::cpp::Oracle oracle(text, {}, {});  // it must be C++
    const std::size_t error = messages.find("error: ");  // behind warnings
    return "refused: " +
           (error == std::string::npos ? messages : messages.substr(messages.rfind('\n', error) + 1));
  }
  fuzz::cpp::NativeObject native;
  if (targets.has("native")) {
    static const std::vector<std::string> levels = fuzz::supportedLevels();
    native = fuzz::cpp::compileNative(*module, levels[number % levels.size()]);
  }
  const fuzz::cpp::Oracle oracle(text, native.object, native.symbols);
  const std::vector<Outputs> wanted = oracle.run();
  std::vector<skc::ir::KernelId> ids;
  for (const std::string& symbol : native.symbols)
    ids.push_back(static_cast<skc::ir::KernelId>(std::stoul(symbol.substr(8))));
  const auto codeOf = [&](skc::ir::KernelId id) -> const sk::native::Code* {
    const auto found = std::ranges::find(ids, id);
    return found == ids.end() ? nullptr : oracle.code(static_cast<std::size_t>(found - ids.begin()));
  };
  std::string wrong = targets.difference(*module, codeOf, wanted);
  if (wrong.empty() && targets.has("lanes")) wrong = fuzz::cpp::differenceOfLanes(*module, wanted);
  if (wrong.empty() && targets.has("webgl2")) batch.add(number, text, inBrowsers(*module, wanted));
  return wrong;
}

fuzz::Verdict verdictOf(Targets& targets, const std::function<std::string()>& finding) {
  fuzz::Verdict verdict;
  skc::driver::withBigStack([&] {
    try {
      verdict.finding = finding();
    } catch (const std::exception& error) {
      verdict.finding = std::string("throws ") + error.what();
    }
    targets.release();  // the next program runs on another thread
    return 0;
  });
  verdict.tally = verdict.finding.empty() ? "agree" : "do not";
  return verdict;
}

/// What two findings about one mistake have in common: the target, or the message without its numbers and names.
std::string kindOf(const std::string& finding) {
  if (!finding.starts_with("refused") && !finding.starts_with("throws"))
    return finding.substr(0, finding.find(':'));
  std::string kind = finding.substr(0, 8);
  const std::size_t at = finding.find("error: ");
  bool isQuoted = false;
  for (const char c : finding.substr(at == std::string::npos ? 0 : at)) {
    if (c == '\n') break;
    if (c == '\'') isQuoted = !isQuoted;
    if (!isQuoted && std::isdigit(static_cast<unsigned char>(c)) == 0) kind += c;
  }
  return kind;
}

class Campaigns {
 public:
  explicit Campaigns(const Options& options) : options_(options) {}

  int run() {
    constexpr std::uint64_t slice = 25;
    options_.forSlices(slice, [&](std::uint64_t first, std::uint64_t count) {
      runSlice(first, count);
      if (isatty(STDERR_FILENO) != 0) std::cerr << inputs_ << " programs, " << findings_ << " findings\r";
      return findings_;
    });
    std::cout << inputs_ << " programs of " << functions_ << " functions, " << findings_ << " findings";
    if (lost_ > 0) std::cout << "; " << lost_ << " programs did not run, because a page hung";
    std::cout << "\n";
    fuzz::conclude(kinds_);
    return findings_ == 0 && lost_ == 0 ? 0 : 1;
  }

 private:
  void runSlice(std::uint64_t first, std::uint64_t count) {
    Targets targets(setOf(options_.targets));
    const fuzz::cpp::BrowserBatch batch;
    fuzz::Campaign campaign{.first = first, .count = count, .batch = count, .seconds = options_.seconds};
    campaign.check = [&](std::uint64_t number) {
      const fuzz::cpp::Program program = programOf(options_, number);
      return verdictOf(targets, [&] { return check(*program.root, targets, batch, number); });
    };
    campaign.onFinding = [&](const fuzz::Finding& finding) { keep(finding); };
    inputs_ += fuzz::run(campaign).inputs;
    if (targets.has("webgl2")) runInBrowser(batch, first, count);
    for (std::uint64_t i = 0; i < count; ++i)
      functions_ += static_cast<std::uint64_t>(programOf(options_, first + i).functions);
  }

  /// A page that hangs costs its slice; the next slice has another.
  void runInBrowser(const fuzz::cpp::BrowserBatch& batch, std::uint64_t first, std::uint64_t count) {
    try {
      for (const auto& [number, wrong] : batch.run()) keep({.number = number, .what = wrong, .log = {}});
    } catch (const fuzz::HungPage& error) {
      lost_ += count;
      std::cout << "programs " << first << " to " << first + count - 1 << ": " << error.what() << "\n"
                << std::flush;
    }
  }

  /// The finding about a program, or nothing.
  std::optional<fuzz::Finding> findingOf(const Node& root, std::uint64_t number) const {
    Targets targets(setOf(options_.targets));
    const fuzz::cpp::BrowserBatch batch;
    std::optional<fuzz::Finding> found;
    fuzz::Campaign campaign{.first = number, .count = 1, .batch = 1, .seconds = options_.seconds};
    campaign.check = [&](std::uint64_t) {
      return verdictOf(targets, [&] { return check(root, targets, batch, number); });
    };
    campaign.onFinding = [&](const fuzz::Finding& finding) { found = finding; };
    fuzz::run(campaign);
    if (found || !targets.has("webgl2")) return found;
    try {
      for (const auto& [at, wrong] : batch.run()) found = {.number = at, .what = wrong, .log = {}};
    } catch (const fuzz::HungPage&) {
      return std::nullopt;  // not the same mistake
    }
    return found;
  }

  void keep(const fuzz::Finding& finding) {
    ++findings_;
    const std::string kind = kindOf(finding.what);
    const bool isNew = ++kinds_[kind] <= 3;  // of each kind, some are reduced
    fuzz::Finding last = finding;
    fuzz::cpp::Program program = programOf(options_, finding.number);
    if (isNew && options_.budget > 0) {
      program.root = fuzz::cpp::reduced(
          std::move(program.root),
          [&](const Node& root) {
            const std::optional<fuzz::Finding> found = findingOf(root, finding.number);
            if (!found || kindOf(found->what) != kind) return false;
            last = *found;
            return true;
          },
          options_.budget);
    }
    const fs::path file = options_.keep("cpp", finding, print(*program.root));
    fuzz::tell("program", last,
               "fuzz_cpp --seed " + std::to_string(options_.seed) + " --first " +
                   std::to_string(finding.number) + " --count 1   (" + file.string() + ")");
    if (isNew) std::cout << print(*program.root) << "\n" << std::flush;
  }

  const Options& options_;
  std::uint64_t inputs_ = 0, functions_ = 0, findings_ = 0;
  std::uint64_t lost_ = 0;  ///< programs whose page hung
  fuzz::Kinds kinds_;
};

/// Writes what Clang computes for a stored program, in the file that runStored() compares with.
void storeResults(const fs::path& file) {
  const fuzz::cpp::Oracle oracle(fuzz::textOf(file), {}, {});
  std::ofstream(fs::path(file).replace_extension(".expected")) << written(oracle.run());
}

/// Writes programs with their results, or the results of programs that exist.
void store(const Options& options) {
  for (const std::string& file : options.files) storeResults(file);
  if (!options.files.empty()) return;
  fs::create_directories(options.out);
  for (std::uint64_t number = options.first; number < options.first + options.count; ++number) {
    const fs::path file = fs::path(options.out) / fmt::format("random-{}-{}.sk", options.seed, number);
    std::ofstream(file) << print(*programOf(options, number).root);
    storeResults(file);
  }
}

/// Compares stored programs with their stored results.
int runStored(const Options& options) {
  Targets targets(setOf(options.targets));
  const fuzz::cpp::BrowserBatch batch;
  int findings = 0;
  const auto report = [&](const std::string& file, const std::string& finding) {
    std::cout << file << ": " << finding << "\n";
    ++findings;
  };
  for (std::size_t number = 0; number < options.files.size(); ++number) {
    const std::string& file = options.files[number];
    const fuzz::Verdict verdict = verdictOf(targets, [&]() -> std::string {
      const auto [module, messages] = skc::driver::translateText({}, file, fuzz::textOf(file));
      if (!module) return "refused: " + messages;
      skc::emit::Program program(*module);
      std::optional<skc::emit::Program> withCode;
      if (targets.has("native")) withCode = fuzz::withNativeCode(*module, "");
      const auto codeOf = [&](skc::ir::KernelId id) -> const sk::native::Code* {
        if (!withCode) return nullptr;
        for (const skc::emit::Unit& unit : withCode->units()) {
          if (unit.id == id) return unit.kernel.code;
        }
        return nullptr;
      };
      const std::vector<Outputs> wanted =
          fuzz::cpp::parsed(fuzz::textOf(fs::path(file).replace_extension(".expected")));
      if (targets.has("webgl2")) batch.add(number, fuzz::textOf(file), inBrowsers(*module, wanted));
      std::string wrong = targets.difference(*module, codeOf, wanted);
      if (wrong.empty() && targets.has("lanes")) wrong = fuzz::cpp::differenceOfLanes(*module, wanted);
      return wrong;
    });
    if (!verdict.finding.empty()) report(file, verdict.finding);
  }
  if (targets.has("webgl2")) {
    for (const auto& [number, wrong] : batch.run()) report(options.files[number], wrong);
  }
  std::cout << options.files.size() << " stored programs, " << findings << " findings\n";
  return findings == 0 ? 0 : 1;
}

int fuzzCpp(const Options& options) {
  if (options.show) {
    for (std::uint64_t i = 0; i < options.count; ++i)
      std::cout << print(*programOf(options, options.first + i).root) << "\n";
    return 0;
  }
  if (options.isStoring) {
    store(options);
    return 0;
  }
  return options.files.empty() ? Campaigns(options).run() : runStored(options);
}

}  // namespace

int main(int argc, char** argv) {
  Options options;
  CLI::App app{"fuzz_cpp: compares random programs with what they mean in C++", "fuzz_cpp"};
  options.addTo(app, "program");
  app.add_option("--targets", options.targets,
                 "What to run: native, lanes, glsl330, glsl430, essl300, essl310, webgl2")
      ->delimiter(',')
      ->allow_extra_args(false)
      ->check(CLI::IsMember({"native", "lanes", "glsl330", "glsl430", "essl300", "essl310", "webgl2"}));
  app.add_option("--without", options.without, "Constructs to leave out")
      ->delimiter(',')
      ->allow_extra_args(false)
      ->check(CLI::IsMember(fuzz::cpp::constructs));
  app.add_option("--budget", options.budget, "How many smaller programs are tried for a finding");
  app.add_flag("--store", options.isStoring,
               "Write programs with their results to --out, or the results of the files");
  app.add_option("files", options.files, "Stored programs to run");
  CLI11_PARSE(app, argc, argv);
  return fuzz::guarded("fuzz_cpp", [&] { return fuzzCpp(options); });
}
