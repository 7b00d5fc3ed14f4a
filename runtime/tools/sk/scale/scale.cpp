// SPDX-License-Identifier: MIT
//
// Parses the options of `sk scale`, measures what they do not give, and writes the predictions.
#include "scale/scale.hpp"

#include <algorithm>
#include <fstream>
#include <memory>
#include <optional>
#include <stdexcept>

#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include "accuracy/child_process.hpp"
#include "accuracy/file/kernel_library.hpp"
#include "scale/model.hpp"
#include "scale/quantities.hpp"
#include "scale/rates.hpp"
#include "scale/report.hpp"
#include "scale/step.hpp"
#include "sk/device.hpp"

namespace sk_tool {

namespace {

struct ScaleOptions {
  std::string file, grid, gpus = "1..4096", network = "25GB/s,2us";
  std::string staging, boxes, memory, device, profile;
  std::vector<std::string> kernels, rates, constants, values;
  std::int64_t size = 0, exchangeEvery = 0;
  double bar = 0.7;
  bool isPerDevice = false, hasNoOverlap = false;
  BuildOptions build;
  std::string jsonFile, chartFile;
};

/// Finds the rate that an option gives for a call; nullptr if there is none.
const Rate* givenRate(const std::vector<GivenRate>& given, const Subject& subject) {
  const auto found = std::ranges::find_if(given, [&](const GivenRate& one) {
    return subject.name() == one.kernel || subject.name().ends_with("::" + one.kernel);
  });
  return found == given.end() ? nullptr : &found->rate;
}

std::vector<GivenRate> givenRates(const ScaleOptions& options, const std::vector<Subject>& subjects) {
  std::vector<GivenRate> given;
  for (const std::string& text : options.rates) {
    given.push_back(GivenRate::parse(text));
    const bool isUsed = std::ranges::any_of(
        subjects, [&](const Subject& subject) { return givenRate({given.back()}, subject) != nullptr; });
    if (!isUsed)
      throw std::runtime_error(
          fmt::format("the step has no kernel '{}', whose rate is given", given.back().kernel));
  }
  return given;
}

/// The memory that streams can use: a device's own.
std::optional<double> memoryOf(const sk::Device& device) {
  const std::optional<std::int64_t> bytes = device.limits().memory;
  return bytes ? std::optional(static_cast<double>(*bytes)) : std::nullopt;
}

/// Sets the rates, and what else a device tells if one is opened.
void setRates(const ScaleOptions& options, const StepOfFile& step, const Ranges& ranges,
              ScaleReport& report) {
  constexpr std::int64_t onCores = 1 << 22, onGpus = 1 << 24;  // beyond caches, and long enough to fill a GPU
  const std::vector<GivenRate> given = givenRates(options, step.subjects);
  std::optional<sk::Device> device;
  const auto open = [&]() -> sk::Device& {
    if (!device) device.emplace(sk::DeviceOptions{.device = options.device, .profile = options.profile});
    return *device;
  };
  for (std::size_t i = 0; i < step.subjects.size(); ++i) {
    const Subject& subject = step.subjects[i];
    if (const Rate* rate = givenRate(given, subject)) {
      report.rates.push_back(*rate);
    } else {
      if (const std::string obstacle = obstacleToMeasuring(subject); !obstacle.empty())
        throw std::runtime_error(obstacle);
      const std::int64_t usual = open().isSoftware() || open().shadingLanguage().empty() ? onCores : onGpus;
      report.rates.push_back(measureRate(open(), subject, ranges, static_cast<int>(report.step.grid.size()),
                                         options.size > 0 ? options.size : usual));
    }
    if (!options.boxes.empty()) report.rates.back().boxes = Boxes::parse(options.boxes);
    report.step.calls[i].boxes = report.rates.back().boxes;
    report.step.calls[i].perCall = report.rates.back().perCall;
    report.step.calls[i].perElement = report.rates.back().perElement;
  }
  Cluster& cluster = report.cluster;
  if (!options.staging.empty()) {
    cluster.staging = Staging::parse(options.staging);
  } else if (device) {
    cluster.staging = measureStaging(*device);
  }
  if (!options.memory.empty()) {
    cluster.memory = parseBytes(options.memory);
  } else if (device) {
    cluster.memory = memoryOf(*device);
  }
  if (device) report.device = device->name();
}

void writeFiles(const ScaleOptions& options, const ScaleReport& report) {
  if (!options.jsonFile.empty()) {
    std::ofstream out(options.jsonFile);
    out << jsonOf(report).dump(2) << '\n';
    out.close();
    if (!out) throw std::runtime_error(fmt::format("cannot write '{}'", options.jsonFile));
  }
  if (!options.chartFile.empty()) drawScaleChart(options.chartFile, report);
}

void runScale(const ScaleOptions& options) {
  ScaleReport report{.file = options.file, .device = {}, .step = {}, .cluster = {}, .rates = {}, .rows = {}};
  const Extents grid = parseGrid(options.grid);
  const std::vector<std::int64_t> counts = parseCounts(options.gpus);
  report.cluster.network = Network::parse(options.network);
  report.cluster.hasOverlap = !options.hasNoOverlap;
  report.bar = options.bar;
  if (!options.chartFile.empty()) checkChartName(options.chartFile);
  StepOptions choices{.kernels = options.kernels, .constants = options.constants, .ranges = {}};
  for (const std::string& value : options.values) choices.ranges.addValues(value);
  const KernelLibrary library(options.file, options.build);  // must outlive the device
  const StepOfFile step = stepOf(library.list(), grid, choices);
  report.step = step.step;
  report.step.isPerDevice = options.isPerDevice;
  setRates(options, step, choices.ranges, report);
  const std::optional<std::int64_t> every =
      options.exchangeEvery > 0 ? std::optional(options.exchangeEvery) : std::nullopt;
  for (const std::int64_t count : counts)
    report.rows.push_back(bestOf(report.step, report.cluster, count, every));
  fmt::print("{}", textOf(report));
  if (!step.leftOut.empty()) fmt::print("\nnot part of the step\n  {}\n", fmt::join(step.leftOut, "\n  "));
  writeFiles(options, report);
}

}  // namespace

void addScale(CLI::App& app) {
  CLI::App* command = app.add_subcommand("scale", "Predict how a file's kernels scale over many GPUs");
  auto options = std::make_shared<ScaleOptions>();
  const auto add = [command](const char* name, auto& variable, const char* help, const char* type) {
    return command->add_option(name, variable, help)->type_name(type);
  };
  add("file", options->file, "The .sk file whose kernels make up a step", "FILE.sk")
      ->required()
      ->check(CLI::ExistingFile);
  add("--grid", options->grid, "The extents of the whole grid, rows first, as in 1e4x1e4x500", "HxW")
      ->required();
  command->add_flag("--per-gpu", options->isPerDevice,
                    "The grid is each GPU's own block: the whole grows with their number");
  add("--gpus", options->gpus, "How many: a range whose numbers double, or a list 1,2,6 (default: 1..4096)",
      "A..B");
  add("--network", options->network,
      "Bytes per second of a GPU's link, and the time of a short message from one program to the other; "
      "optionally LogGP's "
      "overhead and gap (default: 25GB/s,2us; overhead: a quarter of the latency; gap: the overhead)",
      "BANDWIDTH,LATENCY[,OVERHEAD[,GAP]]");
  add("--staging", options->staging,
      "Copies of halos between a GPU and host memory, or none (default: measured if a device is; native "
      "devices have none)",
      "READ_BANDWIDTH,READ_TIME,WRITE_BANDWIDTH,WRITE_TIME");
  add("--boxes", options->boxes,
      "How many times as long an element takes in a call for a part of what a GPU holds, and the time of a "
      "call "
      "for a border (default: measured if a device is; else 1 and the time of a call)",
      "FACTOR,TIME");
  add("--memory", options->memory, "Bytes of a GPU (default: what the measured device has)", "BYTES");
  add("--kernel", options->kernels,
      "A kernel or reduce of the step, in its order; may be repeated (default: each of the file, once)",
      "NAME")
      ->allow_extra_args(false);
  add("--rate", options->rates,
      "A kernel's speed on one GPU, and the time that a call takes at least (default: measured here)",
      "KERNEL=ELEMENTS/s[,TIME]")
      ->allow_extra_args(false);
  add("--constant", options->constants, "A gather that no step changes: its halo is exchanged once",
      "[KERNEL.]PARAM")
      ->allow_extra_args(false);
  add("--set", options->values, "Give a parameter this value (default of spec parameters: 1)",
      "PARAM=V[,V...]")
      ->allow_extra_args(false);
  add("--every", options->exchangeEvery,
      "Exchange halos every N-th call that reads neighbours (default: the best of 1, 2, 4 ... 32)", "N")
      ->check(CLI::Range(1, 1024));
  command->add_flag("--no-overlap", options->hasNoOverlap, "Kernels wait for every exchange");
  add("--efficiency", options->bar, "Below this, more GPUs do not pay (default: 0.7)", "E")
      ->check(CLI::Range(0.0, 1.0));
  add("--size", options->size, "Elements of a measurement (default: 2^24 on a GPU, 2^22 on cores)", "N")
      ->check(CLI::Range(std::int64_t{1} << 14, std::int64_t{1} << 28));
  add("--device", options->device, "The device to measure on (as in 'sk accuracy')", "NAME");
  add("--profile", options->profile, "Its programs (as in 'sk accuracy')", "NAME");
  add("--json", options->jsonFile, "Also write JSON", "FILE");
  add("--chart", options->chartFile, "Also draw efficiency over GPUs, by gnuplot, as .svg or .png", "FILE");
  add("-I", options->build.includes, "Look for #include files in this directory", "DIR")
      ->allow_extra_args(false);
  add("-D", options->build.definitions, "Define a macro", "NAME[=VALUE]")->allow_extra_args(false);
  add("--skc", options->build.skc, "The compiler skc (default: SK_SKC, the one beside sk, the one on PATH)",
      "FILE");
  command->callback([options] { runScale(*options); });
}

}  // namespace sk_tool
