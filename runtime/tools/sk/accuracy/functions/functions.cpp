// SPDX-License-Identifier: MIT
#include "accuracy/functions/functions.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <functional>
#include <optional>
#include <sstream>
#include <stdexcept>
#include <vector>

#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include "accuracy/file/ranges.hpp"
#include "accuracy/functions/sweep.hpp"
#include "accuracy/functions/truth.hpp"
#include "accuracy/progress.hpp"
#include "info/device_info.hpp"
#include "sk/error_bounds.hpp"

namespace sk_tool {

namespace {

using sk::BoundedCode;
using sk::BoundedType;
using sk::program::Scalar;

std::vector<std::string> wordsIn(const std::string& text) {
  std::vector<std::string> words;
  std::istringstream in(text);
  for (std::string word; std::getline(in, word, ',');) words.push_back(word);
  return words;
}

std::vector<std::string> chosenFunctions(const FunctionOptions& options, bool hasAllFloats) {
  std::vector<std::string> known;
  for (const UnaryFunction& function : unaryFunctions()) known.emplace_back(function.name);
  if (!hasAllFloats) {
    for (const BinaryFunction& function : binaryFunctions()) known.emplace_back(function.name);
  }
  if (options.functions == "all") return known;
  std::vector<std::string> chosen = wordsIn(options.functions);
  for (const std::string& name : chosen) {
    if (std::ranges::find(known, name) == known.end()) {
      throw std::runtime_error(fmt::format("there is no function '{}' to try: it is one of all, {}", name,
                                           fmt::join(known, ", ")));
    }
  }
  return chosen;
}

std::vector<sk::Device> chosenDevices(const std::string& devices, const std::string& profiles) {
  std::vector<sk::Device> chosen;
  std::vector<std::string> names = wordsIn(devices), ofGl = wordsIn(profiles);
  if (names.empty()) names.emplace_back();
  if (ofGl.empty()) ofGl.emplace_back();
  for (const std::string& name : names) {
    for (const std::string& profile : name == "native" ? std::vector<std::string>{""} : ofGl)
      chosen.emplace_back(sk::DeviceOptions{.device = name, .profile = profile});
  }
  return chosen;
}

/// Null if there is none, as for kernels of floats that native code computes in doubles: they call the C library.
const sk::ErrorBound* boundOf(const std::string& function, sk::Precision precision,
                              const sk::Device& device) {
  const bool isSingle = precision == sk::Precision::Single;
  if (isNative(device))
    return isSingle ? sk::errorBoundOf(function, BoundedType::Float, BoundedCode::Native) : nullptr;
  const BoundedType type = isSingle                               ? BoundedType::Float
                           : precision == sk::Precision::Extended ? BoundedType::Pair
                                                                  : BoundedType::Double;
  return sk::errorBoundOf(function, type, BoundedCode::Glsl);
}

/// A number in decimal and in hexadecimal.
std::string both(double value) { return fmt::format("{:.9g} ({})", value, hexOf(Scalar::Double, value)); }

struct Line {
  std::string function;
  const sk::Device& device;
  const sk::ErrorBound* bound;
  std::uint64_t arguments;
  double largest;
  std::string rest;

  bool isWithin() const { return bound == nullptr || largest <= bound->bound; }

  void print() const {
    const std::string known = bound == nullptr ? "-" : fmt::format("{:.4g}", bound->bound);
    fmt::print("  {:<12}{:<9}{:>11}{:>14.6g}{:>8}  {:<4}{}\n", function, device.profile(), arguments, largest,
               known,
               bound == nullptr ? "-"
               : isWithin()     ? "yes"
                                : "NO",
               rest);
    std::fflush(stdout);
  }

  Json record(const char* precision) const {
    Json json = {
        {"function", function},    {"precision", precision},
        {"device", device.name()}, {"profile", device.profile()},
        {"arguments", arguments},  {"largest", std::isfinite(largest) ? Json(largest) : Json("infinite")}};
    if (bound != nullptr) json["bound"] = bound->bound;
    json["within_bound"] = isWithin();
    return json;
  }
};

void printHead() {
  fmt::print("  {:<12}{:<9}{:>11}{:>14}{:>8}  {:<4}{}\n", "function", "profile", "arguments", "largest error",
             "bound", "ok", "the largest one");
}

/// All floats, or every k-th.
void sweepFloats(const FunctionOptions& options, std::vector<sk::Device>& devices, Json& records) {
  for (const std::string& name : chosenFunctions(options, true)) {
    const auto isIt = [&](const UnaryFunction& one) { return one.name == name; };
    const UnaryFunction& function = *std::ranges::find_if(unaryFunctions(), isIt);
    std::vector<FunctionErrors> found;
    {
      Progress progress(name);
      found = sweep(devices, function, options.every, [&](double done) { progress.show(done); });
    }
    for (std::size_t d = 0; d < devices.size(); ++d) {
      const FunctionErrors& errors = found[d];
      std::string rest = "no result but the nearest";
      Json worst = Json::array();
      if (!errors.worst.empty()) {
        const SweptCase& one = errors.worst.front();
        rest = fmt::format("x = {}: {}, not {}; {} results are not the nearest", both(one.x), both(one.got),
                           both(one.wanted), errors.notNearest);
      }
      for (const SweptCase& one : errors.worst) {
        worst.push_back({{"x", jsonOf(Scalar::Float, one.x)},
                         {"got", jsonOf(Scalar::Float, one.got)},
                         {"wanted", jsonOf(Scalar::Double, one.wanted)},
                         {"error", std::isfinite(one.error) ? Json(one.error) : Json("infinite")}});
      }
      const Line line{
          name,           devices[d], boundOf(name, sk::Precision::Single, devices[d]), errors.arguments,
          errors.largest, rest};
      line.print();
      Json record = line.record("single");
      record["every"] = options.every;
      record["not_nearest"] = errors.notNearest;
      record["worst"] = worst;
      records.push_back(record);
    }
  }
}

SampledErrors sampleOf(const std::string& name, sk::Device& device, sk::Precision precision,
                       std::uint64_t draws) {
  Progress progress(name);
  const auto show = [&](double done) { progress.show(done); };
  for (const UnaryFunction& one : unaryFunctions()) {
    if (one.name == name) return sample(device, one, precision, draws, show);
  }
  const auto isIt = [&](const BinaryFunction& one) { return one.name == name; };
  return sample(device, *std::ranges::find_if(binaryFunctions(), isIt), precision, draws, show);
}

void sampleFunctions(const FunctionOptions& options, sk::Precision precision,
                     std::vector<sk::Device>& devices, Json& records) {
  for (const std::string& name : chosenFunctions(options, false)) {
    const bool isBinary =
        std::ranges::any_of(binaryFunctions(), [&](const BinaryFunction& one) { return one.name == name; });
    for (sk::Device& device : devices) {
      const SampledErrors errors = sampleOf(name, device, precision, options.draws);
      std::string rest = "no error";
      Json worst = Json::array();
      if (!errors.worst.empty()) {
        const SampledCase& one = errors.worst.front();
        rest = fmt::format("x = {}{}: {}, not {}", both(one.x), isBinary ? ", y = " + both(one.y) : "",
                           both(one.got), both(one.wanted));
      }
      for (const SampledCase& one : errors.worst) {
        Json json = {{"x", jsonOf(Scalar::Double, one.x)}};
        if (isBinary) json["y"] = jsonOf(Scalar::Double, one.y);
        json["got"] = jsonOf(Scalar::Double, one.got);
        json["wanted"] = jsonOf(Scalar::Double, one.wanted);
        json["error"] = std::isfinite(one.error) ? Json(one.error) : Json("infinite");
        worst.push_back(json);
      }
      const Line line{name, device, boundOf(name, precision, device), errors.arguments, errors.largest(),
                      rest};
      line.print();
      Json record = line.record(options.precision.c_str());
      record["worst"] = worst;
      records.push_back(record);
    }
  }
}

}  // namespace

void FunctionOptions::addTo(CLI::App& command) {
  const auto add = [&command](const char* name, auto& variable, const char* help, const char* type) {
    return command.add_option(name, variable, help)->type_name(type)->group("Options for functions");
  };
  add("--exhaustive", functions,
      "Try all 2^32 floats as arguments of these functions, or of all, and compare the largest error with "
      "its bound; "
      "--device and --profile may be several, separated by commas",
      "FUNCTION[,...]");
  add("--every", every, "Only every K-th float", "K")
      ->check(CLI::Range(std::uint64_t{1}, std::uint64_t{1} << 31));
  add("--precision", precision,
      "Of these functions: double and extended (pairs of floats) have too many arguments to try all, so that "
      "--draws of them are "
      "drawn; so have pow, atan2 and hypot (default: single)",
      "NAME")
      ->check(CLI::IsMember({"single", "double", "extended"}));
  add("--draws", draws, "How many arguments to draw (default: 2^24)", "N")
      ->check(CLI::Range(std::uint64_t{1}, std::uint64_t{1} << 40));
}

Json measureFunctions(const FunctionOptions& options, const std::string& deviceNames,
                      const std::string& profiles) {
  const bool isOfTwo = std::ranges::find(binaryFunctions(), options.functions, &BinaryFunction::name) !=
                       binaryFunctions().end();
  const bool hasAllFloats = options.precision == "single" && !isOfTwo;
  chosenFunctions(options, hasAllFloats);  // before devices are opened
  std::vector<sk::Device> devices = chosenDevices(deviceNames, profiles);
  for (const sk::Device& device : devices) fmt::print("{}: {}\n", device.profile(), device.name());
  fmt::print("\n");
  printHead();
  Json records = Json::array();
  if (hasAllFloats) {
    sweepFloats(options, devices, records);
  } else {
    const sk::Precision precision = options.precision == "double"     ? sk::Precision::Double
                                    : options.precision == "extended" ? sk::Precision::Extended
                                                                      : sk::Precision::Single;
    sampleFunctions(options, precision, devices, records);
  }
  return records;
}

}  // namespace sk_tool
