// SPDX-License-Identifier: MIT
#include "cpp/browser.hpp"

#include <filesystem>
#include <fstream>
#include <sstream>
#include <stdexcept>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "browser_page.hpp"
#include "driver/compile.hpp"

namespace fuzz::cpp {

namespace fs = std::filesystem;

void BrowserBatch::add(std::uint64_t number, const std::string& text,
                       const std::vector<Outputs>& wanted) const {
  const std::string stem = (folder_.path() / std::to_string(number)).string();
  std::ofstream(stem + ".sk") << text;
  skc::driver::Options options;
  options.emit = skc::driver::Emit::Js;
  options.profile = "webgl2";
  options.warnings = {"no-everything"};
  options.outputDirectory = folder_.path().string();
  if (skc::driver::compile(options, stem + ".sk") != 0)
    throw std::runtime_error("skc --emit=js refuses the program");
  std::ofstream json(stem + ".json");
  json << R"({"number": )" << number << R"(, "kernels": [)";
  for (std::size_t k = 0; k < wanted.size(); ++k) {
    json << fmt::format(R"({}{{"name": "{}", "r0": [{}], "r1": [{}], "r2": [{}]}})", k == 0 ? "" : ", ",
                        wanted[k].kernel, fmt::join(wanted[k].r0, ", "), fmt::join(wanted[k].r1, ", "),
                        fmt::join(wanted[k].r2, ", "));
  }
  json << "]}";
}

std::map<std::uint64_t, std::string> BrowserBatch::run() const {
  std::string programs;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder_.path())) {
    if (entry.path().extension() != ".json" || entry.path().stem() == "samples") continue;
    std::ostringstream text;
    text << std::ifstream(entry.path()).rdbuf();
    programs += (programs.empty() ? "" : ", ") + text.str();
  }
  std::ofstream(folder_.path() / "samples.json")
      << fmt::format(R"({{"a": [{}], "b": [{}], "c": [{}], "programs": [{}]}})", fmt::join(inputs().a, ", "),
                     fmt::join(inputs().b, ", "), fmt::join(inputs().c, ", "), programs);
  std::map<std::uint64_t, std::string> differences = reportsOf(folder_.path(), "cpp/programs.mjs");
  for (auto& [number, difference] : differences) difference.insert(0, "webgl2: ");
  return differences;
}

}  // namespace fuzz::cpp
