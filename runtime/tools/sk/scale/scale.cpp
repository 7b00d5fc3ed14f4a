// SPDX-License-Identifier: MIT
//
// Parses the options of `sk scale`, measures what they do not give, and writes the predictions.
#include "commands.hpp"

#include <algorithm>
#include <cmath>
#include <fstream>
#include <map>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include "accuracy/child_process.hpp"
#include "accuracy/file/kernel_library.hpp"
#include "accuracy/file/ranges.hpp"
#include "scale/model.hpp"
#include "scale/quantities.hpp"
#include "scale/rates.hpp"
#include "scale/report.hpp"
#include "sk/device.hpp"
#include "sk/library.hpp"
#include "text/real_option.hpp"

namespace sk_tool {

namespace {

// Turns kernels of a .sk file into the calls of a step: what their descriptors say of gathers, in the terms of model.hpp. It
// sets no rates.

struct StepOptions {
  std::vector<std::string> kernels;  ///< in the order of the step; empty: each that can be distributed, once
  std::vector<std::string> constants;  ///< gathers that no step changes, as PARAM or KERNEL.PARAM
  Ranges ranges;  ///< has the values of spec parameters
};

struct StepOfFile {
  ScaledStep step;
  std::vector<Subject> subjects;  ///< one for each call
  std::vector<std::string> leftOut;  ///< why, for kernels that nobody named
};

using sk::program::Parameter;
using sk::program::Reach;
using sk::program::Role;

/// The farthest that a gather is read in one dimension.
struct FarthestReach {
  Halo halo;
  bool isUnbounded = false;
};

bool isNamed(const std::string& whole, const std::string& name) {
  return whole == name || whole.ends_with("::" + name);
}

/// Reads one kernel or reduction.
class CallReader {
 public:
  CallReader(const Subject& subject, const Extents& grid, const StepOptions& options)
      : subject_(subject), grid_(grid), options_(options) {
    for (const Parameter& parameter : subject.parameters()) {
      if (parameter.role == Role::Spec)
        specs_.push_back(options.ranges.of(parameter).front().value_or(Range{1, 1}).low);
    }
  }

  /// Why the kernel cannot be distributed; empty if it can.
  std::string obstacle() const {
    std::size_t nearRank = 0;
    std::string nearest;
    for (const Parameter& parameter : subject_.parameters()) {
      if (parameter.role == Role::VariableOutput || parameter.role == Role::Scatter) {
        return fmt::format(
            "'{}' is a {} output, which cannot be split over devices; compute the same into 'out T r<>'",
            parameter.name, parameter.role == Role::Scatter ? "scatter" : "variable");
      }
      if (parameter.role != Role::Gather || isTable(parameter)) continue;
      for (std::size_t d = 0; d < parameter.rank; ++d) {
        if (parameter.rank != grid_.size() || isConstant(parameter) || !reachOf(parameter, d).isUnbounded)
          continue;
        return fmt::format(
            "'{}' is read along {} at indices that are not near the element's; promise how far with "
            "[[halo(N)]], or "
            "pass --constant {} "
            "if no step changes it, so that every device can have a copy",
            parameter.name, "xyzw"[d], parameter.name);
      }
      if (parameter.rank > nearRank) {
        nearRank = parameter.rank;
        nearest = parameter.name;
      }
    }
    if (nearRank == 0 || nearRank == grid_.size()) return {};
    return fmt::format("'{}' has {} dimension(s), but --grid has {}", nearest, nearRank, grid_.size());
  }

  StepCall call(std::vector<bool>& periodic) const {
    StepCall call{.name = subject_.name(), .gathers = {}};
    for (const Parameter& parameter : subject_.parameters()) {
      if (parameter.role == Role::Accumulator) call.reducedBytes += parameter.element->size;
      if (parameter.role != Role::Gather || parameter.rank != grid_.size() || isTable(parameter)) continue;
      ExchangedGather gather{.name = std::string(parameter.name),
                             .stream = {.bytes = sk::program::heldBy(parameter).size, .halo = {}}};
      std::vector<Halo>& halo = gather.stream.halo;
      for (std::size_t d = parameter.rank; d-- > 0;) halo.push_back(reachOf(parameter, d).halo);
      for (std::size_t d = 0; d < periodic.size(); ++d) {
        if (parameter.boundary == sk::program::Boundary::Wrap && halo[d].both() > 0) periodic[d] = true;
      }
      if (!isConstant(parameter)) call.gathers.push_back(std::move(gather));
    }
    return call;
  }

  /// The bytes per element of the grid's streams, by parameter name.
  void addStreams(std::map<std::string, double>& bytes) const {
    for (const Parameter& parameter : subject_.parameters()) {
      const bool isElement = parameter.role == Role::Input || parameter.role == Role::Output;
      const bool isGather =
          parameter.role == Role::Gather && parameter.rank == grid_.size() && !isTable(parameter);
      if (isElement || isGather) bytes[std::string(parameter.name)] = sk::program::heldBy(parameter).size;
    }
  }

 private:
  /// Whether no index depends on the element: every device has a copy.
  static bool isTable(const Parameter& parameter) {
    const auto isWhole = [](const Reach& reach) { return reach.kind == Reach::Kind::Whole; };
    return !parameter.halo.empty() && std::ranges::all_of(parameter.halo, isWhole);
  }

  bool isConstant(const Parameter& parameter) const {
    return std::ranges::any_of(options_.constants, [&](const std::string& name) {
      return name == parameter.name || isNamed(subject_.name() + "." + std::string(parameter.name), name);
    });
  }

  std::int64_t valueOf(const sk::program::Distance& distance) const {
    auto value = static_cast<double>(distance.constant);
    for (std::size_t s = 0; s < specs_.size(); ++s) value += distance.perSpec[s] * specs_[s];
    return static_cast<std::int64_t>(std::clamp(value, 0.0, 0x1p40));
  }

  /// Dimension 0 is x.
  FarthestReach reachOf(const Parameter& gather, std::size_t dimension) const {
    FarthestReach farthest{.halo = {}, .isUnbounded = gather.halo.empty()};
    for (const Reach& reach : gather.halo) {
      if (reach.dimension != dimension) continue;
      if (reach.kind != Reach::Kind::Near) {
        farthest.isUnbounded = true;
        continue;
      }
      farthest.halo.below = std::max(farthest.halo.below, valueOf(reach.below));
      farthest.halo.above = std::max(farthest.halo.above, valueOf(reach.above));
    }
    if (farthest.isUnbounded) farthest.halo = {};
    return farthest;
  }

  const Subject& subject_;
  const Extents& grid_;
  const StepOptions& options_;
  std::vector<double> specs_;
};

std::vector<Subject> subjectsOf(const sk::program::Library& library) {
  std::vector<Subject> all;
  for (const sk::program::Kernel* kernel : library.kernels) all.push_back({.kernel = kernel});
  for (const sk::program::Reduction* reduction : library.reductions) all.push_back({.reduction = reduction});
  return all;
}

Subject subjectNamed(const std::vector<Subject>& all, const std::string& name) {
  std::string known;
  for (const Subject& subject : all) {
    if (isNamed(subject.name(), name)) return subject;
    known += (known.empty() ? "" : ", ") + subject.name();
  }
  throw std::runtime_error(
      fmt::format("the file has no kernel '{}'; it has {}", name, known.empty() ? "none" : known));
}

void checkConstants(const std::vector<Subject>& subjects, const std::vector<std::string>& constants) {
  for (const std::string& constant : constants) {
    const bool isKnown = std::ranges::any_of(subjects, [&](const Subject& subject) {
      return std::ranges::any_of(subject.parameters(), [&](const Parameter& parameter) {
        return parameter.role == Role::Gather &&
               (constant == parameter.name ||
                isNamed(subject.name() + "." + std::string(parameter.name), constant));
      });
    });
    if (!isKnown) throw std::runtime_error(fmt::format("no kernel of the step has a gather '{}'", constant));
  }
}

/// Throws std::runtime_error if a named kernel does not exist or cannot be distributed, or if no kernel can be.
StepOfFile stepOf(const sk::program::Library& library, const Extents& grid, const StepOptions& options) {
  const std::vector<Subject> all = subjectsOf(library);
  StepOfFile result;
  std::vector<Subject> chosen = options.kernels.empty() ? all : std::vector<Subject>{};
  for (const std::string& name : options.kernels) chosen.push_back(subjectNamed(all, name));
  options.ranges.check(chosen);
  checkConstants(chosen, options.constants);
  result.step.grid = grid;
  result.step.periodic.resize(grid.size());
  std::map<std::string, double> streams;
  for (const Subject& subject : chosen) {
    const CallReader reader(subject, grid, options);
    if (const std::string obstacle = reader.obstacle(); !obstacle.empty()) {
      result.leftOut.push_back(fmt::format("{}: {}", subject.name(), obstacle));
      continue;
    }
    result.step.calls.push_back(reader.call(result.step.periodic));
    result.subjects.push_back(subject);
    reader.addStreams(streams);
  }
  if (result.subjects.empty() && result.leftOut.empty()) throw std::runtime_error("the file has no kernel");
  if (result.subjects.empty() || (!options.kernels.empty() && !result.leftOut.empty())) {
    throw std::runtime_error(
        fmt::format("the step cannot be distributed\n  {}", fmt::join(result.leftOut, "\n  ")));
  }
  for (const auto& [name, bytes] : streams) result.step.bytesPerElement += bytes;
  return result;
}

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
  if (!options.jsonFile.empty()) checkWritable(options.jsonFile);
  if (!options.chartFile.empty()) checkChart(options.chartFile);
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
      ->check(sk::text::realFrom(0, 1), "0 to 1");
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
