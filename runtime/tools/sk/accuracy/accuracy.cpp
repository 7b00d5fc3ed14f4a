// SPDX-License-Identifier: MIT
//
// Parses the options of `sk accuracy`, runs the programs and writes their results.
#include "commands.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <fstream>
#include <map>
#include <memory>
#include <optional>
#include <sstream>
#include <stdexcept>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include "accuracy/chart.hpp"
#include "accuracy/child_process.hpp"
#include "accuracy/experiment.hpp"
#include "accuracy/file/bounds.hpp"
#include "accuracy/file/measure.hpp"
#include "accuracy/functions/functions.hpp"
#include "accuracy/programs.hpp"
#include "accuracy/progress.hpp"
#include "info/device_info.hpp"
#include "text/real_option.hpp"

namespace sk_tool {

namespace {

// Formats experiments as a table for people.

std::string boundText(double value) { return std::isinf(value) ? "none" : fmt::format("{:.2g}", value); }

std::string timeOf(const Ratios& time) {
  return fmt::format("{:5.2f} [{:.2f} {:.2f}]", time.median, time.lower, time.upper);
}

/// The width of a metric's column.
std::size_t widthOf(const Metric& metric) { return std::max<std::size_t>(11, metric.name.size() + 2); }

/// Widths of the first columns, which hold the longest names and times of an experiment.
struct Widths {
  std::size_t mode = 17, time = 20;
};

Widths widthsOf(const Experiment& experiment) {
  Widths widths;
  for (const Row& row : experiment.rows) {
    widths.mode = std::max(widths.mode, row.mode.size() + 1);
    if (!row.isRefused()) widths.time = std::max(widths.time, timeOf(row.time).size() + 1);
  }
  return widths;
}

std::string lineOf(const Row& row, const Widths& widths, bool hasBounds) {
  std::string line = fmt::format("  {:<{}}{:<{}}", row.mode, widths.mode, timeOf(row.time), widths.time);
  for (const Metric& metric : row.grade.metrics)
    line += fmt::format("{:>{}}", boundText(metric.value), widthOf(metric));
  if (hasBounds) {
    const char* verdict = !row.grade.bound ? "-" : row.grade.isWithinBound ? "yes" : "NO";
    line += fmt::format("{:>11}  {:<3}", row.grade.bound ? boundText(*row.grade.bound) : "-", verdict);
  }
  if (row.isPareto) line += "  PARETO";
  line.erase(line.find_last_not_of(' ') + 1);
  return line;
}

std::string headsOf(const Experiment& experiment) {
  const Widths widths = widthsOf(experiment);
  std::string line = fmt::format("  {:<{}}{:<{}}", "mode", widths.mode, " time [quartiles]", widths.time);
  for (const Metric& metric : experiment.rows.front().grade.metrics)
    line += fmt::format("{:>{}}", metric.name, widthOf(metric));
  if (!experiment.bounded.empty()) line += fmt::format("{:>11}  ok", "bound");
  return line + '\n';
}

/// "0.5 (0x1p-1)": as few digits as identify a float or a double, and its bits; integers and what has no digits once.
std::string numberText(const Json& number) {
  const std::string hex = number["hex"].get<std::string>();
  if (number["value"].is_null() || hex.find("0x") == std::string::npos) return hex;
  const double value = number["value"].get<double>();
  return fmt::format(
      "{} ({})",
      number.contains("bits") ? fmt::format("{}", static_cast<float>(value)) : fmt::format("{}", value), hex);
}

/// For example "x = 0.5 (0x1p-1): r is 0 (0x0p+0), not 1 (0x1p+0)"; only a few of many inputs.
std::string caseText(const Json& one) {
  constexpr std::size_t most = 6;
  std::vector<std::string> inputs;
  if (one.contains("inputs")) {
    for (const auto& [name, value] : one["inputs"].items()) {
      const bool isIndex = value.contains("index");
      inputs.push_back(fmt::format("{} {} {}", name, isIndex ? "at" : "=",
                                   isIndex ? value["index"].get<std::string>() : numberText(value)));
    }
  }
  if (inputs.empty() && one.contains("index")) {
    inputs.push_back(fmt::format("element {}", one["index"].get<std::string>()));
  }
  if (inputs.size() > most) {
    inputs.resize(most);
    inputs.emplace_back("...");
  }
  std::string text =
      fmt::format("{}{}{} is {}, not {}", fmt::join(inputs, ", "), inputs.empty() ? "" : ": ",
                  one["result"].get<std::string>(), numberText(one["got"]), numberText(one["wanted"]));
  if (one.value("reference_differs", false))
    text += fmt::format("; but MPFR has {}: the reference is wrong here", numberText(one["by_mpfr"]));
  return text;
}

/// The largest errors of a file's kernels.
std::string worstOf(const Experiment& experiment) {
  std::string text;
  for (const Row& row : experiment.rows) {
    const bool hasWorst = !row.isRefused() && row.grade.worst.contains("result") && row.grade.error() > 0;
    if (hasWorst) text += fmt::format("    {:<18} {}\n", row.mode, caseText(row.grade.worst));
  }
  return text.empty() ? "" : "  the largest error\n" + text;
}

/// The errors of each scalar of the results, if there are several.
std::string outputsOf(const Experiment& experiment) {
  std::string text;
  for (const Row& row : experiment.rows) {
    for (const OutputErrors& output : row.grade.outputs) {
      if (row.isRefused()) continue;
      if (text.empty()) {
        text = fmt::format("  of each result\n    {:<18} {:<18}", "", "");
        for (const Metric& metric : output.metrics)
          text += fmt::format("{:>{}}", metric.name, widthOf(metric));
        text += '\n';
      }
      text += fmt::format("    {:<18} {:<18}", row.mode, output.name);
      for (const Metric& metric : output.metrics)
        text += fmt::format("{:>{}}", boundText(metric.value), widthOf(metric));
      text += '\n';
    }
  }
  return text;
}

std::string extremesOf(const Experiment& experiment) {
  std::string text;
  for (const Row& row : experiment.rows) {
    if (!row.grade.extremes) continue;
    const ExtremeCounts& counts = *row.grade.extremes;
    if (text.empty()) {
      text = fmt::format("  of {} results of extreme inputs\n    {:<18} {:>14}{:>14}\n", counts.tried, "",
                         "another class", "> 1 % off");
    }
    text += fmt::format("    {:<18} {:>14}{:>14}", row.mode, counts.otherClass, counts.otherValue);
    if (!counts.example.is_null()) text += fmt::format("   {}", caseText(counts.example));
    text += '\n';
  }
  return text;
}

std::string verdictOf(const Experiment& experiment, double tolerance) {
  const Row* cheapest = cheapestWithin(experiment, tolerance);
  if (cheapest == nullptr) return fmt::format("  no mode is within {:g}\n", tolerance);
  return fmt::format("  the cheapest within {:g}: {}\n", tolerance, cheapest->mode);
}

/// Returns several lines, with column heads if `hasHeads`, and names the cheapest mode within `tolerance`.
std::string tableOf(const Experiment& experiment, bool hasHeads, std::optional<double> tolerance) {
  std::string text = fmt::format("{}, {}: {}\n", experiment.program, experiment.data, experiment.about);
  if (hasHeads) text += headsOf(experiment);
  const Widths widths = widthsOf(experiment);
  for (const Row& row : experiment.rows) {
    text += row.isRefused() ? fmt::format("  {:<{}}refused: {}", row.mode, widths.mode, row.refused)
                            : lineOf(row, widths, !experiment.bounded.empty());
    text += '\n';
  }
  text += outputsOf(experiment) + worstOf(experiment) + extremesOf(experiment);
  if (tolerance) text += verdictOf(experiment, *tolerance);
  return text + '\n';
}

constexpr int schema = 1;  ///< version of the JSON format

struct Options {
  std::vector<std::string> programs;
  std::string device;
  std::string profile;
  std::string size;  ///< as in --size
  Measurement measurement{.size = std::size_t{1} << 20, .rounds = 15};
  FileOptions file;
  FunctionOptions functions;
  std::optional<double> tolerance;
  std::string jsonFile;
  std::string chartFile;
};

std::string listOfPrograms() {
  std::string list;
  for (const Program& program : programs())
    list += fmt::format("{}{}", list.empty() ? "" : ", ", program.name);
  return list;
}

/// The named programs, in the order of the list; all programs if none is named.
std::vector<const Program*> chosenPrograms(const std::vector<std::string>& names) {
  std::vector<const Program*> chosen;
  for (const Program& program : programs()) {
    const bool isNamed = std::find(names.begin(), names.end(), program.name) != names.end();
    if (isNamed || names.empty()) chosen.push_back(&program);
  }
  for (const std::string& name : names) {
    const auto isIt = [&](const Program* program) { return program->name == name; };
    if (std::none_of(chosen.begin(), chosen.end(), isIt)) {
      throw std::runtime_error(
          fmt::format("there is no program '{}': it is one of {}", name, listOfPrograms()));
    }
  }
  return chosen;
}

bool isFile(const std::string& program) { return program.ends_with(".sk"); }

/// Parses "N" or "HxW", up to four extents; empty if the text has another form.
std::vector<std::int64_t> extentsIn(const std::string& text) {
  std::vector<std::int64_t> extents;
  std::istringstream words(text);
  for (std::string word; std::getline(words, word, 'x');) {
    std::int64_t extent = 0;
    const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), extent);
    if (error != std::errc{} || end != word.data() + word.size() || extent < 1) return {};
    extents.push_back(extent);
  }
  return extents.size() > 4 || text.ends_with('x') ? std::vector<std::int64_t>{} : extents;
}

/// An error message for an invalid size, or "".
std::string checkSize(const std::string& text) {
  constexpr std::int64_t least = 16, most = std::int64_t{1} << 26;
  std::int64_t size = 1;
  for (const std::int64_t extent : extentsIn(text))
    size = extent > most ? most + 1 : std::min(size * extent, most + 1);
  if (!extentsIn(text).empty() && size >= least && size <= most) return {};
  return fmt::format("'{}' is no size; give {} to {} elements, or HxW of them", text, least, most);
}

void writeJson(const Options& options, const sk::Device& device, const std::vector<Experiment>& experiments) {
  Json json = {{"schema", schema},           {"streamkernel", SK_VERSION},
               {"device", describe(device)}, {"size", options.measurement.size},
               {"seed", inputSeed},          {"rounds", options.measurement.rounds}};
  if (isFile(options.programs.empty() ? "" : options.programs.front()))
    json["file"] = options.programs.front();
  json["records"] = Json::array();
  for (const Experiment& experiment : experiments) addRecords(json["records"], experiment);
  std::ofstream out(options.jsonFile);
  out << json.dump(2) << '\n';
  out.close();
  if (!out) throw std::runtime_error(fmt::format("cannot write '{}'", options.jsonFile));
}

void printHead(const Options& options, const sk::Device& device) {
  fmt::print("{}; times over those of each first mode, {} rounds\n\n", device.name(),
             options.measurement.rounds);
}

void writeFiles(const Options& options, const sk::Device& device, const std::vector<Experiment>& all) {
  if (!options.jsonFile.empty()) writeJson(options, device, all);
  if (!options.chartFile.empty()) drawChart(options.chartFile, device.name(), all);
}

void runFile(const Options& options) {
  if (options.programs.size() > 1) {
    throw std::runtime_error(
        fmt::format("a .sk file is measured by itself; leave out '{}'", options.programs[1]));
  }
  if (options.measurement.data)
    throw std::runtime_error("--data is of the built-in sums; draw from --range here");
  FileMeasurement measurement = options.file.measurement(extentsIn(options.size), options.measurement.rounds);
  const KernelLibrary library(options.programs.front(), options.file.build);  // must outlive the device
  sk::Device device(sk::DeviceOptions{.device = options.device, .profile = options.profile});
  printHead(options, device);
  const FileBounds bounds(options.programs.front(), options.file.build, measurement.ranges,
                          device.shadingLanguage().empty());
  measurement.addBounds = [&](Experiment& experiment, const Subject& subject) {
    bounds.addTo(experiment, subject);
  };
  const auto [all, skipped] =
      measureFile(device, library.list(), library.precise(), measurement, [&](const Experiment& experiment) {
        fmt::print("{}", tableOf(experiment, true, options.tolerance));
        std::fflush(stdout);
      });
  if (!skipped.empty()) fmt::print("not measured\n  {}\n", fmt::join(skipped, "\n  "));
  writeFiles(options, device, all);
}

void runPrograms(const Options& options) {
  const std::vector<const Program*> chosen = chosenPrograms(options.programs);
  if (!options.file.used().empty()) {
    throw std::runtime_error(fmt::format("{} is for a .sk file; name one", options.file.used()));
  }
  sk::Device device(sk::DeviceOptions{.device = options.device, .profile = options.profile});
  printHead(options, device);
  std::vector<Experiment> all;
  for (std::size_t p = 0; p < chosen.size(); ++p) {
    std::vector<Experiment> experiments;
    {
      Progress progress(std::string(chosen[p]->name));
      progress.show(static_cast<double>(p) / static_cast<double>(chosen.size()));
      experiments = chosen[p]->measure(device, options.measurement);
    }
    for (Experiment& experiment : experiments) {
      fmt::print("{}", tableOf(experiment, &experiment == &experiments.front(), options.tolerance));
      all.push_back(std::move(experiment));
    }
    std::fflush(stdout);
  }
  writeFiles(options, device, all);
}

void runFunctions(const Options& options) {
  if (!options.programs.empty() || !options.file.used().empty())
    throw std::runtime_error("--exhaustive tries functions, no programs or files; leave them out");
  const Json records = measureFunctions(options.functions, options.device, options.profile);
  if (options.jsonFile.empty()) return;
  const Json json = {{"schema", schema}, {"streamkernel", SK_VERSION}, {"records", records}};
  std::ofstream out(options.jsonFile);
  out << json.dump(2) << '\n';
  out.close();
  if (!out) throw std::runtime_error(fmt::format("cannot write '{}'", options.jsonFile));
}

void runAccuracy(Options& options) {
  if (!options.size.empty()) {
    options.measurement.size = 1;
    for (const std::int64_t extent : extentsIn(options.size))
      options.measurement.size *= static_cast<std::size_t>(extent);
  }
  if (!options.chartFile.empty()) checkChart(options.chartFile);
  if (!options.jsonFile.empty()) checkWritable(options.jsonFile);
  if (!options.functions.functions.empty()) {
    runFunctions(options);
    return;
  }
  const bool hasFile = std::any_of(options.programs.begin(), options.programs.end(), isFile);
  hasFile ? runFile(options) : runPrograms(options);
}

std::map<std::string, SumData> dataByName() {
  std::map<std::string, SumData> names;
  for (const SumDataName& kind : sumDataNames) names.emplace(kind.name, kind.data);
  return names;
}

}  // namespace

void addAccuracy(CLI::App& app) {
  CLI::App* command =
      app.add_subcommand("accuracy", "What each choice of accuracy costs, and how exact it is");
  auto options = std::make_shared<Options>();
  Measurement& measurement = options->measurement;
  command
      ->add_option("program", options->programs,
                   listOfPrograms() + " (default: all), or one FILE.sk, whose kernels get random inputs")
      ->type_name("");
  command
      ->add_option("--device", options->device,
                   "native, gpu, gpu:N, software, gl, or a part of a renderer's name (default: the best)")
      ->type_name("NAME");
  command
      ->add_option("--profile", options->profile,
                   "glsl330 or essl300: run fragment programs, glsl430 or essl310: compute programs "
                   "(default: the faster)")
      ->type_name("NAME");
  command->add_option("--size", options->size, "Elements (default: 2^20); for a .sk file also HxW")
      ->type_name("N")
      ->check(checkSize, "");
  command->add_option("--rounds", measurement.rounds, "How often each mode is timed, in turns (default: 15)")
      ->type_name("N")
      ->check(CLI::Range(1, 10'000));
  command
      ->add_option("--data", measurement.data,
                   "What sums add: uniform, signed, wide, illconditioned, tiny (default: each of them)")
      ->type_name("KIND")
      ->transform(CLI::CheckedTransformer(dataByName()).description(""));
  command
      ->add_option("--tolerance", options->tolerance,
                   "Name the cheapest mode with a relative error of this or less")
      ->type_name("T")
      ->check(sk::text::zeroOrAbove(), "0 or above");
  command->add_option("--json", options->jsonFile, "Also write JSON, one record a program, mode and data")
      ->type_name("FILE");
  command->add_option("--chart", options->chartFile, "Also draw error over time, by gnuplot, as .svg or .png")
      ->type_name("FILE");
  options->file.addTo(*command);
  options->functions.addTo(*command);
  command->callback([options] { runAccuracy(*options); });
}

}  // namespace sk_tool
