// SPDX-License-Identifier: MIT
//
// fuzz_mutate: compiles programs of the corpus with random changes to every output. skc must give a result or an error for
// any input. Mutant N of a seed is always the same. The exit status is 1 after a finding.
#include <fstream>
#include <iostream>
#include <iterator>

#include <CLI/CLI.hpp>

#include "command.hpp"
#include "corpus.hpp"
#include "isolation.hpp"
#include "judge.hpp"
#include "mutation.hpp"
#include "reduction.hpp"

namespace {

namespace fs = std::filesystem;

struct Options : fuzz::Command {
  std::vector<std::string> corpus = {SK_SOURCE_FOLDER "/tests", SK_SOURCE_FOLDER "/examples",
                                     SK_SOURCE_FOLDER "/docs"};
  std::vector<std::string> files;  ///< files to judge instead of mutants
  std::string reduce;  ///< a file to shrink
  bool withGlslang = false;
};

fuzz::Program programOf(const std::string& file) {
  std::ifstream in(file, std::ios::binary);
  if (!in) throw std::runtime_error("'" + file + "' cannot be read");
  return {file, {std::istreambuf_iterator<char>(in), std::istreambuf_iterator<char>()}};
}

int statusOf(const fuzz::Campaign& campaign) {
  const fuzz::Summary summary = fuzz::run(campaign);
  fuzz::conclude(summary);
  return summary.findings == 0 ? 0 : 1;
}

int mutate(const Options& options, const char* program) {
  const fuzz::Corpus corpus({options.corpus.begin(), options.corpus.end()});
  const auto make = [&](std::uint64_t number) {
    fuzz::Random random(options.seed, number);
    return fuzz::mutant(corpus, random);
  };
  if (options.show) {
    for (std::uint64_t i = 0; i < options.count; ++i) std::cout << make(options.first + i).text << "\n";
    return 0;
  }
  fuzz::Campaign campaign = options.campaign();
  campaign.check = [&](std::uint64_t number) { return fuzz::judge(make(number), options.withGlslang); };
  campaign.onFinding = [&](const fuzz::Finding& finding) {
    const fuzz::Program mutant = make(finding.number);
    const fs::path file = options.keep("mutate", finding, mutant.text);
    fuzz::tell("mutant", finding,
               std::string(program) + " " + file.string() + "   (from " + mutant.path + ")");
  };
  std::cout << corpus.programs().size() << " programs to start from\n";
  return statusOf(campaign);
}

int judgeFiles(const Options& options, const char* program) {
  fuzz::Campaign campaign{.count = options.files.size(), .batch = 1, .seconds = options.seconds};
  campaign.check = [&](std::uint64_t i) {
    return fuzz::judge(programOf(options.files[i]), options.withGlslang);
  };
  campaign.onFinding = [&](const fuzz::Finding& finding) {
    fuzz::tell("file", finding, std::string(program) + " " + options.files[finding.number]);
  };
  return statusOf(campaign);
}

/// Two findings are of the same kind if their texts begin alike.
std::string kindOf(const std::string& what) { return what.substr(0, 24); }

int reduce(const Options& options) {
  const fuzz::Program program = programOf(options.reduce);
  const auto finding = [&](const std::string& text) {
    std::string kind;
    fuzz::Campaign campaign{.count = 1, .seconds = options.seconds};
    campaign.check = [&](std::uint64_t) { return fuzz::judge({program.path, text}, options.withGlslang); };
    campaign.onFinding = [&](const fuzz::Finding& one) { kind = kindOf(one.what); };
    fuzz::run(campaign);
    return kind;
  };
  const std::string kind = finding(program.text);
  if (kind.empty()) throw std::runtime_error("nothing is wrong with '" + options.reduce + "'");
  std::cout << fuzz::reduced(program.text, [&](const std::string& text) { return finding(text) == kind; });
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  Options options;
  CLI::App app{"fuzz_mutate: shows skc mutated programs; FILEs are judged as they are", "fuzz_mutate"};
  app.add_option("FILE", options.files, "Judge these programs instead of mutants");
  options.addTo(app, "mutant");
  app.add_option("--corpus", options.corpus, "Folders with .sk and .md files to start from");
  app.add_option("--reduce", options.reduce, "Make this program smaller as long as it fails, and print it");
  app.add_flag("--glslang", options.withGlslang, "Show what skc accepts to glslang, too");
  CLI11_PARSE(app, argc, argv);
  return fuzz::guarded("fuzz_mutate", [&] {
    if (!options.reduce.empty()) return reduce(options);
    return options.files.empty() ? mutate(options, argv[0]) : judgeFiles(options, argv[0]);
  });
}
