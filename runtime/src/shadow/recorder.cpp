// SPDX-License-Identifier: MIT
#include "shadow/recorder.hpp"

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <iterator>
#include <new>
#include <utility>

#include <unistd.h>

#include <fmt/format.h>

#include "shadow/archive.hpp"
#include "shadow/files.hpp"
#include "shadow/report_page.hpp"
#include "sk/error.hpp"
#include "support/process_name.hpp"

namespace sk::shadow {

namespace {

// One report for all devices of a process, so that this is a fact of the process. It lives until the process ends.
constinit std::mutex processMutex;
constinit Recorder* ofThisProcess = nullptr;
constinit bool hasFailed = false;

void say(const std::string& text) { std::fprintf(stderr, "SK_SHADOW: %s\n", text.c_str()); }

/// The program and its arguments, separated by spaces.
std::string commandLine() {
  std::ifstream in("/proc/self/cmdline");
  std::string line(std::istreambuf_iterator<char>(in), {});
  while (!line.empty() && line.back() == '\0') line.pop_back();
  std::ranges::replace(line, '\0', ' ');
  const std::size_t slash = line.substr(0, line.find(' ')).rfind('/');
  return slash == std::string::npos ? line : line.substr(slash + 1);
}

void writeReportAtExit() {
  if (ofThisProcess != nullptr) ofThisProcess->writeAtExit();
}

}  // namespace

Recorder* Recorder::ofProcess(std::string_view option, const std::string& device) {
  const std::lock_guard lock(processMutex);
  if (ofThisProcess != nullptr || hasFailed) return ofThisProcess;
  hasFailed = true;
  try {
    Options options = parseOptions(option);
    const std::string process = rankOfProcess().ranks > 1 ? "ranks" : std::to_string(::getpid());
    for (std::string* const file : {&options.report, &options.inputs}) *file = withProcess(*file, process);
    auto* const made = new Recorder(std::move(options), device);
    const bool isFirst = made->report_.rank == 0;
    if (isFirst) ::unlink((made->options().json() + ".ranks").c_str());  // of a run that was cut off
    const std::string problem = isFirst ? replaceFile(made->options().report, "") : "";
    if (!problem.empty()) {
      say(problem + "; the program runs without a shadow");
      delete made;
      return nullptr;
    }
    made->write(false);
    std::atexit(writeReportAtExit);
    hasFailed = false;
    ofThisProcess = made;
  } catch (const Error& error) {
    std::string_view text = error.what();
    constexpr std::string_view prefix = "SK_SHADOW: ";
    if (text.starts_with(prefix)) text.remove_prefix(prefix.size());
    say(fmt::format("{}; the program runs without a shadow", text));
  }
  return ofThisProcess;
}

Recorder::Recorder(Options options, const std::string& device) : process_(::getpid()) {
  report_.options = std::move(options);
  applied_.resize(report_.options.settings.size());
  report_.program = commandLine();
  report_.device = device;
  const RankOfProcess process = rankOfProcess();
  report_.rank = process.rank;
  report_.ranks = process.ranks;
}

bool Recorder::isInOwnProcess() const { return ::getpid() == process_; }

int Recorder::kernel(Report& report, std::string_view name) {
  const auto found = std::ranges::find(report.kernels, name, &KernelRecord::name);
  if (found != report.kernels.end()) return static_cast<int>(found - report.kernels.begin());
  report.kernels.emplace_back().name = name;
  return static_cast<int>(report.kernels.size() - 1);
}

std::size_t Recorder::output(KernelRecord& kernel, std::string_view name, std::string_view type) {
  const auto found = std::ranges::find(kernel.outputs, name, &OutputRecord::name);
  if (found != kernel.outputs.end()) return static_cast<std::size_t>(found - kernel.outputs.begin());
  OutputRecord& record = kernel.outputs.emplace_back();
  record.name = name;
  record.type = type;
  return kernel.outputs.size() - 1;
}

std::size_t Recorder::result(Report& report, const std::string& name, bool isValue) {
  for (std::size_t i = 0; i < report.results.size(); ++i) {
    if (report.results[i].name == name && report.results[i].isValue == isValue) return i;
  }
  ResultRecord& record = report.results.emplace_back();
  record.name = name;
  record.isValue = isValue;
  return report.results.size() - 1;
}

std::string Recorder::nameOfKernel(int kernel) {
  const std::lock_guard lock(mutex_);
  return std::string(report_.nameOf(kernel));
}

void Recorder::keepInputs(const std::string& kernel, RecordedInputs inputs) {
  const std::lock_guard lock(mutex_);
  inputs_.insert_or_assign(kernel, std::move(inputs));
}

void Recorder::noteApplied(std::size_t setting) {
  const std::lock_guard lock(mutex_);
  applied_[setting] = true;
}

void Recorder::note(const std::string& text) {
  const std::lock_guard lock(mutex_);
  constexpr std::size_t most = 100;
  std::vector<std::string>& notes = report_.notes;
  if (notes.size() >= most || std::ranges::find(notes, text) != notes.end()) return;
  notes.push_back(notes.size() + 1 == most ? "further notes are left out" : text);
}

void Recorder::writeSometimes() {
  // Soon at first, so that a program that hangs or is killed early leaves a report; the report costs little beside the interval.
  using Clock = std::chrono::steady_clock;
  constexpr Clock::duration longest = std::chrono::seconds(10), shortest = std::chrono::milliseconds(20);
  const auto now = Clock::now();
  {
    const std::lock_guard lock(mutex_);
    if (now - lastWrite_ < std::clamp(lastWrite_ - start_, shortest, longest)) return;
    lastWrite_ = now;
  }
  write(false);
}

void Recorder::write(bool hasEnded) {
  if (!isInOwnProcess()) return;
  const std::lock_guard lock(mutex_);
  try {
    Report report = report_;
    report.programSeconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count();
    report.ended =
        hasEnded ? "normally" : fmt::format("early: the program had not ended after {} calls", report.calls);
    for (std::size_t i = 0; hasEnded && i < applied_.size(); ++i) {
      if (applied_[i]) continue;
      const Setting& setting = report.options.settings[i];
      report.notes.push_back(fmt::format("set={}.{} has changed nothing: the host gives no such number",
                                         setting.kernel, setting.parameter));
    }
    if (hasEnded && !report.options.inputs.empty() && report.rank == 0) {
      const std::string problem = writeInputs(report.options.inputs, inputs_);
      if (!problem.empty()) say(problem);
    }
    if (report.ranks > 1) {
      if (!hasEnded) return;
      addToRanks(report.options.json() + ".ranks", report, [&](std::vector<Report> reports) {
        const std::size_t count = reports.size();
        Report all = merged(std::move(reports));
        all.options = report.options;
        all.ended = count == static_cast<std::size_t>(report.ranks)
                        ? "normally"
                        : fmt::format("early: {} of {} ranks have ended", count, report.ranks);
        conclude(all);
        writeFiles(all);
      });
      return;
    }
    conclude(report);
    writeFiles(report);
  } catch (const std::exception& error) {
    say(fmt::format("the report could not be written: {}", error.what()));
  }
}

void Recorder::writeFiles(const Report& report) {
  const std::string json = toJson(report);
  const auto replace = [&](std::string& file, std::string& mark, std::string_view text) {
    const std::string now = fileMark(file);
    const bool isOfOthers = report.ranks == 1 && !mark.empty() && !now.empty() && now != mark;
    if (isOfOthers) {
      const std::string other = otherName(file);
      say(fmt::format("the program has written '{}' itself; the report goes to '{}'", file, other));
      file = other;
    }
    const std::string problem = replaceFile(file, text);
    if (!problem.empty()) say(problem);
    mark = fileMark(file);
  };
  if (jsonFile_.empty()) jsonFile_ = report_.options.json();
  if (report_.options.report != jsonFile_) replace(report_.options.report, lastPage_, reportPage(json));
  replace(jsonFile_, lastJson_, json);
}

/// A program that ends by exit() leaves its devices as they are; and each rank adds its report to those of the others once.
void Recorder::writeAtExit() {
  bool isDue = false;
  {
    const std::lock_guard lock(mutex_);
    isDue = devices_ > 0 || report_.ranks > 1;
  }
  if (isDue) write(true);
}

void Recorder::deviceEnds() {
  bool isLast = false;
  {
    const std::lock_guard lock(mutex_);
    isLast = --devices_ == 0 && report_.ranks == 1;
  }
  if (isLast) write(true);
}

}  // namespace sk::shadow
