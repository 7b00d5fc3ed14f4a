// SPDX-License-Identifier: MIT
#include "tune/trials.hpp"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <limits>
#include <stdexcept>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "accuracy/child_process.hpp"

namespace sk_tool::tune {

namespace {

using nlohmann::json;

/// JSON has no infinity.
json numberOf(double value) { return std::isfinite(value) ? json(value) : json(nullptr); }
double doubleOf(const json& value) {
  return value.is_null() ? std::numeric_limits<double>::infinity() : value.get<double>();
}

json jsonOf(const Trial& trial) {
  json setting = json::array(), errors = json::array();
  for (const auto& [unit, value] : trial.setting)
    setting.push_back({unit.section, unit.name, unit.key, value});
  for (const ResultError& error : trial.verdict.errors) {
    errors.push_back({error.name, nameOf(error.metric), numberOf(error.error), numberOf(error.overTolerance),
                      numberOf(error.ofRounding)});
  }
  return {{"setting", setting},
          {"failure", trial.failure},
          {"errors", errors},
          {"score", numberOf(trial.verdict.score)},
          {"decision", trial.verdict.decision},
          {"seconds", trial.seconds},
          {"kernels", trial.kernels}};
}

Trial trialOf(const json& value) {
  Trial trial;
  for (const json& unit : value.at("setting"))
    trial.setting[{unit.at(0), unit.at(1), unit.at(2)}] = unit.at(3).get<std::string>();
  trial.failure = value.at("failure");
  trial.verdict.score = doubleOf(value.at("score"));
  trial.verdict.decision = value.at("decision");
  for (const json& error : value.at("errors")) {
    trial.verdict.errors.push_back({error.at(0), metricOf(error.at(1)), doubleOf(error.at(2)),
                                    doubleOf(error.at(3)), error.size() > 4 ? doubleOf(error.at(4)) : 0});
  }
  trial.seconds = value.at("seconds").get<std::vector<double>>();
  trial.kernels = value.at("kernels").get<std::map<std::string, double>>();
  return trial;
}

}  // namespace

double medianOf(std::vector<double> numbers) {
  if (numbers.empty()) return 0;
  std::ranges::sort(numbers);
  const std::size_t middle = numbers.size() / 2;
  return numbers.size() % 2 == 1 ? numbers[middle] : (numbers[middle - 1] + numbers[middle]) / 2;
}

double Trial::median() const { return medianOf(seconds); }
double Trial::least() const { return seconds.empty() ? 0 : *std::ranges::min_element(seconds); }

Trials::Trials(const Application& application, const BaseFile& base, ProgramFacts facts, const Judge& judge,
               Options options)
    : application_(application),
      base_(base),
      facts_(std::move(facts)),
      judge_(judge),
      options_(std::move(options)) {}

void Trials::load() {
  std::ifstream in(options_.stateFile);
  if (!in) {
    throw std::runtime_error(fmt::format(
        "there is no state '{}' to continue from; run once without --continue", options_.stateFile));
  }
  const json state = json::parse(in, nullptr, /*allow_exceptions=*/false);
  try {
    if (state.is_discarded() || state.at("version") != 1) throw std::runtime_error("");
    if (state.at("key") != options_.key) {
      throw std::invalid_argument(
          fmt::format("the state '{}' is of another program, other arguments, or other results that count; "
                      "run without --continue",
                      options_.stateFile));
    }
    for (const json& each : state.at("trials")) {
      Trial trial = trialOf(each);
      order_.push_back(trial.setting);
      trials_[trial.setting] = std::move(trial);
    }
  } catch (const std::invalid_argument&) {
    throw;
  } catch (const std::exception&) {
    throw std::runtime_error(
        fmt::format("the state '{}' is damaged; run without --continue", options_.stateFile));
  }
}

void Trials::save() const {
  if (options_.stateFile.empty()) return;
  json all = json::array();
  for (const Setting& setting : order_) all.push_back(jsonOf(trials_.at(setting)));
  const std::string temporary = options_.stateFile + ".new";
  std::ofstream(temporary) << json{{"version", 1}, {"key", options_.key}, {"trials", all}} << '\n';
  std::error_code ignored;
  std::filesystem::rename(temporary, options_.stateFile, ignored);
}

void Trials::runOnce(Trial& trial) {
  const double spent = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin_).count();
  progress_.show(std::min(1.0, spent / options_.budget.count()));
  if (hasBudget_ && spent + longest_ > options_.budget.count()) throw OutOfBudget();
  const TemporaryFolder folder;
  const std::string file = (folder.path() / "trial.toml").string();
  std::ofstream(file) << fileOf(trial.setting);
  const RunResult result = application_.run(
      {.environment = {{"SK_CONFIG", file}}, .measures = options_.measures, .limit = options_.limit});
  ++runs_;
  if (!result.isTooSlow) longest_ = std::max(longest_, result.wall);
  if (!result.failure.empty()) {
    trial.failure = result.failure;
    return;
  }
  if (trial.seconds.empty()) trial.verdict = judge_.judge(result.process);
  trial.seconds.push_back(result.seconds());
  trial.lastKernels.clear();
  for (const sk::results::Kernel& kernel : result.process.kernels) {
    if (!result.process.hasTimes) break;
    const auto [found, isNew] = trial.kernels.try_emplace(kernel.name, kernel.seconds);
    found->second = std::min(found->second, kernel.seconds);
    trial.lastKernels[kernel.name] = kernel.seconds;
  }
}

const Trial& Trials::run(const Setting& setting) {
  if (const auto found = trials_.find(setting); found != trials_.end()) return found->second;
  Trial trial{.setting = setting};
  runOnce(trial);
  order_.push_back(setting);
  const Trial& kept = trials_[setting] = std::move(trial);
  save();
  return kept;
}

bool Trials::isAllowed(const Trial& trial) const {
  return trial.failure.empty() && (options_.allowsDecisions || trial.verdict.decision.empty());
}

bool Trials::holds(const Trial& trial) const { return isAllowed(trial) && trial.verdict.isExact(); }

Comparison Trials::compare(const Setting& first, const Setting& second, int rounds,
                           const std::string& kernel) {
  Trial& a = trials_.at(first);
  Trial& b = trials_.at(second);
  const auto lastOf = [&](const Trial& trial) {
    const auto found = trial.lastKernels.find(kernel);
    return std::max(found == trial.lastKernels.end() ? trial.seconds.back() : found->second, 1e-9);
  };
  std::vector<double> ofFirst, ofSecond;
  Comparison result{.rounds = rounds};
  for (int round = 0; round < rounds; ++round) {
    for (Trial* each : {round % 2 == 0 ? &a : &b, round % 2 == 0 ? &b : &a}) runOnce(*each);
    if (!a.failure.empty() || !b.failure.empty()) return result;
    ofFirst.push_back(lastOf(a));
    ofSecond.push_back(lastOf(b));
    result.wins += ofSecond.back() < ofFirst.back() ? 1 : 0;
  }
  result.first = medianOf(ofFirst);
  result.second = medianOf(ofSecond);
  save();
  return result;
}

void Trials::time(const Setting& setting, std::size_t count) {
  run(setting);
  Trial& trial = trials_.at(setting);
  while (trial.failure.empty() && trial.seconds.size() < count) runOnce(trial);
  save();
}

std::vector<const Trial*> Trials::all() const {
  std::vector<const Trial*> trials;
  for (const Setting& setting : order_) trials.push_back(&trials_.at(setting));
  return trials;
}

}  // namespace sk_tool::tune
