// SPDX-License-Identifier: MIT
//
// The main function of parse_NAME without libFuzzer: runs the parser on every file of the corpus, then on mutants of them.
// Mutant N of a seed is always the same. The exit status is 1 after a finding.
#include <algorithm>
#include <exception>
#include <fstream>
#include <iostream>
#include <iterator>
#include <stdexcept>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>

#include "command.hpp"
#include "isolation.hpp"
#include "parsers/byte_mutation.hpp"
#include "parsers/entry.hpp"

namespace {

namespace fs = std::filesystem;

struct Options : fuzz::Command {
  std::vector<std::string> corpus;  ///< files, and folders of files
};

std::string textOf(const fs::path& file) {
  std::ifstream in(file, std::ios::binary);
  if (!in) throw std::runtime_error("'" + file.string() + "' cannot be read");
  return {std::istreambuf_iterator<char>(in), std::istreambuf_iterator<char>()};
}

/// The files, sorted by their names, so that their order does not depend on the file system or on the folders' places.
std::vector<fs::path> filesOf(const std::vector<std::string>& corpus) {
  std::vector<fs::path> files;
  for (const fs::path place : corpus) {
    if (!fs::is_directory(place)) {
      files.push_back(place);
      continue;
    }
    for (const fs::directory_entry& entry : fs::directory_iterator(place)) {
      if (entry.is_regular_file()) files.push_back(entry.path());
    }
  }
  if (files.empty()) throw std::runtime_error("no file to start from");
  std::ranges::sort(files, {}, [](const fs::path& file) { return file.filename(); });
  return files;
}

fuzz::Verdict verdictOf(const std::string& input) {
  try {
    LLVMFuzzerTestOneInput(reinterpret_cast<const std::uint8_t*>(input.data()), input.size());
    return {};
  } catch (const std::exception& error) {
    return {.finding = std::string("an error of the wrong kind: ") + error.what(), .tally = {}};
  }
}

/// Limits memory, so that a parser that trusts a size in its file is a finding.
fuzz::Campaign campaignOf(const Options& options, std::uint64_t count) {
  fuzz::Campaign campaign = options.campaign();
  campaign.count = count;
  campaign.memory = 1024;
  return campaign;
}

std::uint64_t findingsIn(const fuzz::Campaign& campaign) {
  const fuzz::Summary summary = fuzz::run(campaign);
  fuzz::conclude(summary);
  return summary.findings;
}

int replay(const Options& options, const std::string& program) {
  const std::vector<fs::path> files = filesOf(options.corpus);
  std::vector<std::string> seeds;
  std::ranges::transform(files, std::back_inserter(seeds), textOf);
  const auto make = [&](std::uint64_t number) {
    fuzz::Random random(options.seed, number);
    return fuzz::mutatedBytes(seeds, random);
  };
  if (options.show) {
    for (std::uint64_t i = 0; i < options.count; ++i) std::cout << make(options.first + i) << "\n";
    return 0;
  }
  fuzz::Campaign corpus = campaignOf(options, seeds.size());
  corpus.first = 0;
  corpus.check = [&](std::uint64_t number) { return verdictOf(seeds[number]); };
  corpus.onFinding = [&](const fuzz::Finding& finding) {
    fuzz::tell("file", finding, program + " --count 0 " + files[finding.number].string());
  };
  fuzz::Campaign mutants = campaignOf(options, options.count);
  mutants.check = [&](std::uint64_t number) { return verdictOf(make(number)); };
  mutants.onFinding = [&](const fuzz::Finding& finding) {
    const fs::path file = options.keep(fs::path(program).filename(), finding, make(finding.number), ".bin");
    fuzz::tell("mutant", finding, program + " --count 0 " + file.string());
  };
  return findingsIn(corpus) + findingsIn(mutants) == 0 ? 0 : 1;
}

}  // namespace

int main(int argc, char** argv) {
  Options options;
  CLI::App app{"Shows a parser the files of a corpus, then mutants of them"};
  app.add_option("CORPUS", options.corpus, "Files, and folders of files, to start from")->required();
  options.addTo(app, "mutant");
  CLI11_PARSE(app, argc, argv);
  return fuzz::guarded(argv[0], [&] { return replay(options, argv[0]); });
}
