// SPDX-License-Identifier: MIT
//
// Formats events as text. Times are microseconds with three decimals, as the format requires.
#include "trace/trace.hpp"

#include <algorithm>
#include <chrono>
#include <exception>

#include <unistd.h>

#include <fmt/format.h>

#include "sk/error.hpp"

namespace sk {

namespace {

/// Events are written before the end of the outermost slice if they exceed this many bytes.
constexpr std::size_t mostWaiting = std::size_t{64} << 10;

std::string microseconds(Trace::Time nanoseconds) {
  return fmt::format("{}.{:03}", nanoseconds / 1000, nanoseconds % 1000);
}

std::string nameOf(const PassRecord& pass) {
  return pass.step.empty() ? pass.kernel : fmt::format("{}: {}", pass.kernel, pass.step);
}

/// The arguments of both slices of a pass.
std::string argumentsOf(const PassRecord& pass) {
  return fmt::format(R"(,"kernel":{},"pass":"{}","domain":{},"bytes read":{},"bytes written":{})",
                     jsonString(pass.kernel), pass.kind, jsonString(pass.domain), pass.bytesRead,
                     pass.bytesWritten);
}

}  // namespace

void PassRecord::addTo(PassCount& count) const {
  ++count.passes;
  count.bytesRead += bytesRead;
  count.bytesWritten += bytesWritten;
}

Trace::Time Trace::now() {
  const auto since = std::chrono::steady_clock::now().time_since_epoch();
  return std::chrono::duration_cast<std::chrono::nanoseconds>(since).count();
}

Trace::Trace(const std::string& file, std::string_view device)
    : file_(file), deviceTrack_(file_.openTrack(device)) {
  counter_ = jsonString(fmt::format("bytes, {} ({})", device, deviceTrack_));
}

Trace::~Trace() { write(); }

void Trace::hostPass(const PassRecord& pass, Time begin, Time end) {
  addSlice(hostTrack(), "pass", nameOf(pass), begin, end, argumentsOf(pass));
}

void Trace::devicePass(const PassRecord& pass, Time begin, Time end, std::string_view clock) {
  std::string arguments = argumentsOf(pass) + fmt::format(R"(,"clock":"{}")", clock);
  if (end > begin) {
    const double rate =
        static_cast<double>(pass.bytesRead + pass.bytesWritten) / static_cast<double>(end - begin);
    arguments += fmt::format(R"(,"GB/s":{:.4g})", rate);
    if (bandwidth_ > 0) arguments += fmt::format(R"(,"of copy bandwidth":{:.4g})", rate / bandwidth_);
  }
  addSlice(deviceTrack_, "pass", nameOf(pass), begin, end, arguments);
}

void Trace::countBytes(std::int64_t used, std::int64_t kept) noexcept {
  try {
    addEvent(fmt::format(R"({{"name":{},"ph":"C","pid":{},"ts":{},"args":{{"in use":{},"kept":{}}}}})",
                         counter_, ::getpid(), microseconds(now()), used, kept));
  } catch (const std::exception&) {
    return;  // out of memory: one value is lost
  }
  if (open_.empty()) write();
}

void Trace::throwFailure() {
  if (!file_.failure().empty() && !isReported_) {
    isReported_ = true;
    throw Error(file_.failure(), Error::Kind::File);
  }
}

void Trace::open(std::string_view category, std::string_view name) {
  throwFailure();
  open_.push_back({category, std::string(name), {}, now(), std::uncaught_exceptions()});
}

void Trace::close() noexcept {
  try {
    Open& slice = open_.back();
    if (std::uncaught_exceptions() > slice.exceptions) slice.arguments += R"(,"threw":true)";
    addSlice(hostTrack(), slice.category, slice.name, slice.begin, now(), slice.arguments);
  } catch (const std::exception&) {
    events_.clear();  // out of memory
  }
  open_.pop_back();
  if (open_.empty()) write();
}

void Trace::addSlice(std::int64_t track, std::string_view category, std::string_view name, Time begin,
                     Time end, std::string_view arguments) {
  if (!arguments.empty()) arguments.remove_prefix(1);
  addEvent(
      fmt::format(R"({{"name":{},"cat":"{}","ph":"X","pid":{},"tid":{},"ts":{},"dur":{},"args":{{{}}}}})",
                  jsonString(name), category, ::getpid(), track, microseconds(begin),
                  microseconds(end - begin), arguments));
}

void Trace::addEvent(std::string_view event) {
  events_.reserve(events_.size() + event.size() + 2);  // appends either the whole event or nothing
  if (!events_.empty()) events_ += ",\n";
  events_ += event;
  if (events_.size() > mostWaiting) write();
}

/// The calling thread's track, which is named on first use.
std::int64_t Trace::hostTrack() {
  const std::int64_t thread = ::gettid();
  if (std::ranges::find(threads_, thread) == threads_.end()) {
    threads_.push_back(thread);
    addEvent(fmt::format(
        R"({{"name":"thread_name","ph":"M","pid":{},"tid":{},"args":{{"name":"host thread {}"}}}})",
        ::getpid(), thread, thread));
  }
  return thread;
}

void Trace::write() noexcept {
  file_.append(events_);
  events_.clear();
}

void TraceScope::addText(std::string_view name, std::string_view text) const {
  trace_->open_.back().arguments += fmt::format(",{}:{}", jsonString(name), jsonString(text));
}

void TraceScope::addNumber(std::string_view name, std::int64_t number) const {
  trace_->open_.back().arguments += fmt::format(",{}:{}", jsonString(name), number);
}

}  // namespace sk
