// SPDX-License-Identifier: MIT
#include "tune/verify.hpp"

#include <algorithm>
#include <stdexcept>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace sk_tool::tune {

namespace {

using sk::results::Process;

/// Why a run with other inputs says nothing of the program: it calls none of its kernels, or lacks what it reads; "" if it serves.
std::string mismatchOf(const Process& other, const Baseline& base, std::span<const Wanted> wanted) {
  const Process& program = base.process;
  const auto isCalled = [&](const sk::results::Kernel& kernel) {
    return std::ranges::find(other.kernels, kernel.name, &sk::results::Kernel::name) != other.kernels.end();
  };
  if (std::ranges::none_of(program.kernels, isCalled))
    return fmt::format("calls no kernel of the program, such as {}", program.kernels.front().name);
  std::vector<std::string> names;
  for (const Wanted& each : wanted) names.push_back(each.name);
  for (const sk::results::Series& series : program.series) {
    const bool isIgnored = std::ranges::find(base.differing, series.name) != base.differing.end();
    if (wanted.empty() && !isIgnored) names.push_back(series.name);
  }
  std::erase_if(names, [&](const std::string& name) { return seriesNamed(other, name) != nullptr; });
  if (names.empty()) return {};
  std::vector<std::string> read;
  for (const sk::results::Series& series : other.series) read.push_back(series.name);
  return fmt::format("reads no '{}', as the program does; it reads {}", fmt::join(names, "', '"),
                     read.empty() ? "nothing" : fmt::format("{}", fmt::join(read, ", ")));
}

}  // namespace

OtherInputs::OtherInputs(const std::string& command, Application application, const Baseline& base,
                         Criteria criteria, bool isFresh)
    : command_(command),
      application_(std::move(application)),
      criteria_(std::move(criteria)),
      ignored_(base.differing) {
  const auto refuse = [&](const std::string& why) {
    throw std::runtime_error(fmt::format("--verify '{}' {}", command_, why));
  };
  RunResult run = application_.run({});
  if (!run.failure.empty()) refuse(run.failure);
  if (const std::string why = mismatchOf(run.process, base, criteria_.wanted); !why.empty()) refuse(why);
  asItIs_ = std::move(run.process);
  try {
    truth_ = truthOf(application_, isFresh).process;
  } catch (const std::runtime_error& error) {
    refuse(fmt::format("cannot be judged: {}", error.what()));
  }
}

std::string OtherInputs::failureOf(Verification& verification, const std::string& configuration) const {
  const Judge judge(asItIs_, truth_, criteria_.wanted, criteria_.metric, criteria_.tolerance, ignored_);
  verification.asItIs = judge.judge(asItIs_);
  const RunResult tuned = application_.run({.environment = {{"SK_CONFIG", configuration}}});
  if (!tuned.failure.empty()) return "the program " + tuned.failure;
  verification.tuned = judge.judge(tuned.process);
  if (!verification.tuned.isExact())
    return fmt::format("{}; as it is: {}", describe(verification.tuned), describe(verification.asItIs));
  if (!criteria_.allowsDecisions && !verification.tuned.decision.empty())
    return verification.tuned.decision + " (--allow-decisions lets it)";
  return {};
}

Verification OtherInputs::verify(const std::string& configuration) const {
  Verification verification{.command = command_, .asItIs = {}, .tuned = {}};
  try {
    verification.failure = failureOf(verification, configuration);
  } catch (const std::runtime_error& error) {
    verification.failure = error.what();
  }
  return verification;
}

}  // namespace sk_tool::tune
