// SPDX-License-Identifier: MIT
#include "shadow/recorder.hpp"

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <new>
#include <optional>
#include <system_error>
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

constinit std::terminate_handler earlierHandler = nullptr;

/// An exception that nothing catches ends the program without its devices' destructors and without exit().
[[noreturn]] void writeReportAndTerminate() {
  if (ofThisProcess != nullptr) ofThisProcess->writeAtTermination();
  if (earlierHandler != nullptr) earlierHandler();
  std::abort();
}

/// The same file whatever folder the program changes to later.
void makeAbsolute(std::string& file) {
  std::error_code error;
  const std::filesystem::path absolute = std::filesystem::absolute(file, error);
  if (!file.empty() && !error) file = absolute.string();
}

}  // namespace

Recorder* Recorder::ofProcess(std::string_view option) {
  const std::lock_guard lock(processMutex);
  if (ofThisProcess != nullptr || hasFailed) return ofThisProcess;
  hasFailed = true;
  try {
    Options options = parseOptions(option);
    const std::string process = rankOfProcess().ranks > 1 ? "ranks" : std::to_string(::getpid());
    for (std::string* const file : {&options.report, &options.inputs}) *file = withProcess(*file, process);
    auto* const made = new Recorder(std::move(options));
    const bool isFirst = made->report_.rank == 0;
    if (isFirst) ::unlink((made->options().json() + ".ranks").c_str());  // of a run that was cut off
    const std::string problem = isFirst ? replaceFile(made->options().report, "") : "";
    if (!problem.empty()) {
      say(problem + "; the program runs without a shadow");
      delete made;
      return nullptr;
    }
    for (std::string* const file : {&made->report_.options.report, &made->report_.options.inputs})
      makeAbsolute(*file);
    made->write(Ending::None);
    std::atexit(writeReportAtExit);
    earlierHandler = std::set_terminate(writeReportAndTerminate);
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

Recorder::Recorder(Options options) : process_(::getpid()) {
  report_.options = std::move(options);
  applied_.resize(report_.options.settings.size());
  report_.program = commandLine();
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
    const std::int64_t calls = report_.calls;
    const bool isFirst =
        now - start_ < shortest && (calls & (calls - 1)) == 0;  // the first, second, fourth ...
    if (!isFirst && now - lastWrite_ < std::clamp(lastWrite_ - start_, shortest, longest)) return;
    lastWrite_ = now;
  }
  write(Ending::None);
}

void Recorder::write(Ending ending) {
  if (!isInOwnProcess()) return;
  const std::lock_guard lock(mutex_);
  writeLocked(ending);
}

namespace {

std::string endedText(Recorder::Ending ending, std::int64_t calls) {
  const std::string_view word = calls == 1 ? "call" : "calls";
  switch (ending) {
    case Recorder::Ending::Normal: return "normally";
    case Recorder::Ending::Exception: return fmt::format("early: an exception after {} {}", calls, word);
    case Recorder::Ending::None: break;
  }
  return fmt::format("early: the program had not ended after {} {}", calls, word);
}

}  // namespace

void Recorder::writeLocked(Ending ending) {
  const bool hasEnded = ending != Ending::None;
  try {
    Report report = report_;
    report.programSeconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count();
    report.ended = endedText(ending, report.calls);
    if (!hasDevice_ && !whyAlone_.empty()) report.notes.insert(report.notes.begin(), whyAlone_);
    for (std::size_t i = 0; ending == Ending::Normal && i < applied_.size(); ++i) {
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
        const bool isLast = count == static_cast<std::size_t>(report.ranks);
        all.ended =
            isLast ? "normally" : fmt::format("early: {} of {} ranks have ended", count, report.ranks);
        finish(all, isLast);
      });
      return;
    }
    finish(report, ending == Ending::Normal);
  } catch (const std::exception& error) {
    say(fmt::format("the report could not be written: {}", error.what()));
  }
}

void Recorder::finish(Report& report, bool isLast) {
  if (isLast) {
    for (const std::string& text : unmatchedPatterns(report)) {
      report.notes.push_back(text);
      if (std::ranges::find(said_, text) != said_.end()) continue;
      said_.push_back(text);
      say(text);
    }
  }
  conclude(report);
  writeFiles(report);
}

void Recorder::writeFiles(const Report& report) {
  const std::string json = toJson(report);
  if (jsonFile_.empty()) jsonFile_ = report_.options.json();
  const bool hasPage = report_.options.report != jsonFile_;
  const auto isOfOthers = [&](const std::string& file, const std::string& mark) {
    const std::string now = fileMark(file);
    return report.ranks == 1 && !mark.empty() && !now.empty() && now != mark;
  };
  // the page and its JSON keep names that go together
  for (const auto& [file, mark] :
       {std::pair{&report_.options.report, &lastPage_}, std::pair{&jsonFile_, &lastJson_}}) {
    if (!isOfOthers(*file, *mark)) continue;
    for (const auto& [each, ours] :
         {std::pair{report_.options.report, lastPage_}, std::pair{jsonFile_, lastJson_}}) {
      if (fileMark(each) == ours) ::unlink(each.c_str());  // an earlier report, without its other half
    }
    const std::string before = *file,
                      ending = report_.options.report.substr(report_.options.report.rfind('.'));
    const std::string other = otherName(jsonFile_.substr(0, jsonFile_.rfind('.')), {".json", ending});
    report_.options.report = other + ending;
    jsonFile_ = other + ".json";
    say(fmt::format("the program, or another one, has written '{}' itself; the report goes to '{}'", before,
                    report_.options.report));
    break;
  }
  const auto replace = [&](const std::string& file, std::string& mark, std::string_view text) {
    const std::string problem = replaceFile(file, text);
    if (!problem.empty()) say(problem);
    mark = fileMark(file);
  };
  if (hasPage) replace(report_.options.report, lastPage_, reportPage(json));
  replace(jsonFile_, lastJson_, json);
}

/// A program that ends by exit() leaves its devices as they are; and each rank adds its report to those of the others once.
void Recorder::writeAtExit() {
  bool isDue = false;
  {
    const std::lock_guard lock(mutex_);
    isDue = devices_ > 0 || report_.ranks > 1;
  }
  if (isDue) write(Ending::Normal);
  if (!hasDevice_ && isInOwnProcess() && !whyAlone_.empty()) say(whyAlone_);
}

void Recorder::writeAtTermination() {
  if (!isInOwnProcess()) return;
  const std::unique_lock lock(mutex_, std::try_to_lock);
  if (lock.owns_lock())
    writeLocked(Ending::Exception);  // else the exception has left a function of the recorder
}

void Recorder::deviceBegins(const std::string& name) {
  const std::lock_guard lock(mutex_);
  ++devices_;
  if (!std::exchange(hasDevice_, true)) report_.device = name;
}

void Recorder::deviceStaysAlone(const std::string& name, const std::string& why) {
  {
    const std::lock_guard lock(mutex_);
    if (hasDevice_) return;
    report_.device = name;
    whyAlone_ = why;
    if (report_.ranks > 1) return;
  }
  write(Ending::Normal);
}

void Recorder::deviceEnds() {
  bool isLast = false;
  {
    const std::lock_guard lock(mutex_);
    isLast = --devices_ == 0 && report_.ranks == 1;
  }
  if (isLast) write(Ending::Normal);
}

}  // namespace sk::shadow
