// SPDX-License-Identifier: MIT
//
// Options, and where results go.
#include "accuracy/accuracy.hpp"

#include <algorithm>
#include <cstdio>
#include <fstream>
#include <map>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>

#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include "accuracy/chart.hpp"
#include "accuracy/programs.hpp"
#include "accuracy/table.hpp"
#include "info/device_info.hpp"

namespace sk_tool {

namespace {

constexpr int schema = 1;  ///< of the JSON

struct Options {
  std::vector<std::string> programs;
  std::string device;
  Measurement measurement{.size = std::size_t{1} << 20, .rounds = 15};
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

/// Those that are named, in the order of the list; all where none is.
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

void checkWritable(const std::string& file) {
  if (!std::ofstream(file, std::ios::app)) throw std::runtime_error(fmt::format("cannot write '{}'", file));
}

void writeJson(const Options& options, const sk::Device& device, const std::vector<Experiment>& experiments) {
  Json json = {{"schema", schema},           {"streamkernel", SK_VERSION},
               {"device", describe(device)}, {"size", options.measurement.size},
               {"seed", inputSeed},          {"rounds", options.measurement.rounds},
               {"records", Json::array()}};
  for (const Experiment& experiment : experiments) addRecords(json["records"], experiment);
  std::ofstream out(options.jsonFile);
  out << json.dump(2) << '\n';
  out.close();
  if (!out) throw std::runtime_error(fmt::format("cannot write '{}'", options.jsonFile));
}

void runAccuracy(const Options& options) {
  const std::vector<const Program*> chosen = chosenPrograms(options.programs);
  if (!options.chartFile.empty()) checkChartName(options.chartFile);
  if (!options.jsonFile.empty()) checkWritable(options.jsonFile);
  sk::Device device(options.device);
  fmt::print("{}; times over those of each first mode, {} rounds\n\n", device.name(),
             options.measurement.rounds);
  std::vector<Experiment> all;
  for (const Program* program : chosen) {
    std::vector<Experiment> experiments = program->measure(device, options.measurement);
    for (Experiment& experiment : experiments) {
      fmt::print("{}", tableOf(experiment, &experiment == &experiments.front(), options.tolerance));
      all.push_back(std::move(experiment));
    }
    std::fflush(stdout);
  }
  if (!options.jsonFile.empty()) writeJson(options, device, all);
  if (!options.chartFile.empty()) drawChart(options.chartFile, device.name(), all);
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
  command->add_option("program", options->programs, listOfPrograms() + " (default: all)")->type_name("");
  command
      ->add_option("--device", options->device,
                   "native, gpu, gpu:N, software, or a part of a renderer's name (default: the best)")
      ->type_name("NAME");
  command->add_option("--size", measurement.size, "Elements (default: 2^20)")
      ->type_name("N")
      ->check(CLI::Range(std::size_t{16}, std::size_t{1} << 26));
  command->add_option("--rounds", measurement.rounds, "How often each mode is timed, in turns (default: 15)")
      ->type_name("N")
      ->check(CLI::Range(1, 10'000));
  command
      ->add_option("--data", measurement.data,
                   "What sums add: uniform, signed, wide, illconditioned (default: each of them)")
      ->type_name("KIND")
      ->transform(CLI::CheckedTransformer(dataByName()).description(""));
  command
      ->add_option("--tolerance", options->tolerance,
                   "Tell the cheapest mode with a relative error of this or less")
      ->type_name("T")
      ->check(CLI::NonNegativeNumber);
  command->add_option("--json", options->jsonFile, "Also write JSON, one record a program, mode and data")
      ->type_name("FILE");
  command->add_option("--chart", options->chartFile, "Also draw error over time, by gnuplot, as .svg or .png")
      ->type_name("FILE");
  command->callback([options] { runAccuracy(*options); });
}

}  // namespace sk_tool
