// SPDX-License-Identifier: MIT
//
// Writes a report as JSON, version 1 (docs/json.md). Numbers that are not finite are the strings "nan", "inf" and "-inf".
#include <cmath>
#include <iterator>
#include <string_view>

#include <fmt/format.h>

#include "shadow/report.hpp"
#include "trace/trace_file.hpp"

namespace sk::shadow {

namespace {

std::string number(double value) {
  if (std::isnan(value)) return "\"nan\"";
  if (std::isinf(value)) return value > 0 ? "\"inf\"" : "\"-inf\"";
  return fmt::format("{:.9g}", value);
}

/// A value in decimal and, if it is real, in hexadecimal.
std::string value(double given, bool isReal) {
  if (!isReal) return fmt::format(R"({{"value":{:.17g},"hex":"{:.17g}"}})", given, given);
  const std::string decimal = std::isfinite(given) ? fmt::format("{:.17g}", given) : number(given);
  return fmt::format(R"({{"value":{},"hex":"{:a}"}})", decimal, given);
}

/// Calls write(element) for each element of a list, with commas between what that returns.
template <class List, class Write>
std::string list(const List& all, Write&& write) {
  std::string text = "[";
  for (const auto& each : all) {
    if (text.size() > 1) text += ",";
    text += write(each);
  }
  return text + "]";
}

std::string indexText(const std::vector<std::int64_t>& index) {
  return list(index, [](std::int64_t i) { return std::to_string(i); });
}

std::string texts(const std::vector<std::string>& all) {
  return list(all, [](const std::string& text) { return jsonString(text); });
}

std::string inputs(const std::vector<Input>& all) {
  return list(all, [](const Input& input) {
    const std::string text = value(input.value, input.isReal);
    const std::string at = input.at.empty() ? "" : fmt::format(R"("at":{},)", indexText(input.at));
    return fmt::format(R"({{"parameter":{},{}{},"reference":null}})", jsonString(input.parameter), at,
                       std::string_view(text).substr(1, text.size() - 2));
  });
}

/// The members of an element, without braces.
std::string element(const ElementRecord& record) {
  const std::string source =
      record.source.empty() ? "" : fmt::format(R"(,"source":{})", jsonString(record.source));
  return fmt::format(R"("call":{},"output":{},"element":{},"device":{},"reference":{},"inputs":{}{})",
                     record.call, jsonString(record.output), indexText(record.index),
                     value(record.device, record.isReal), value(record.reference, record.isReal),
                     inputs(record.inputs), source);
}

std::string spread(const Spread& errors) {
  return fmt::format(R"({{"largest":{},"typical":{}}})", number(errors.largest()), number(errors.typical()));
}

double survivingDigits(double error) {
  return error > 0 ? std::fmin(16, std::fmax(0, -std::log10(error))) : 16;
}

std::string kernel(const KernelRecord& record) {
  const std::string outputs = list(record.outputs, [](const OutputRecord& output) {
    const std::string points = list(output.points.points(), [](const Series::Point& point) {
      return fmt::format("[{},{},{},{}]", point.call, number(point.own), number(point.inherited),
                         number(point.total));
    });
    return fmt::format(R"({{"name":{},"type":{},"points":{}}})", jsonString(output.name),
                       jsonString(output.type), points);
  });
  return fmt::format(
      R"({{"name":{},"calls":{},"followed":{},"seconds":{:.6f},"choices":{},"own":{},"storage":{},"inherited":{},)"
      R"("total":{},"amplification":{},"digits":{:.2f},"share":{},"worst":{},"nans":{},"infinities":{},)"
      R"("flushed":{},"decisions":{},"compensates":{},"outputs":{}}})",
      jsonString(record.name), record.calls, record.followed, record.seconds, jsonString(record.choices),
      spread(record.own), record.storage.isEmpty() ? "null" : spread(record.storage),
      spread(record.inherited), spread(record.total),
      record.amplification.isEmpty() ? "null" : spread(record.amplification),
      survivingDigits(record.total.largest()), number(record.share),
      record.worst ? "{" + element(*record.worst) + "}" : "null", record.nans, record.infinities,
      record.flushed, record.decisions, record.compensates, outputs);
}

std::string stream(const StreamRecord& record) {
  const std::string points = list(record.points.points(), [](const Series::Point& point) {
    return fmt::format("[{},{}]", point.call, number(point.total));
  });
  return fmt::format(R"({{"name":{},"type":{},"shape":{},"resyncs":{},"points":{}}})",
                     jsonString(record.name), jsonString(record.type), indexText(record.shape),
                     record.resyncs, points);
}

std::string result(const Report& report, const ResultRecord& record) {
  const std::string shares = list(record.shares.all(), [&](const Share& share) {
    return fmt::format(R"({{"kernel":{},"share":{}}})", jsonString(report.nameOf(share.kernel)),
                       number(share.share));
  });
  return fmt::format(
      R"({{"name":{},"kind":"{}","reads":{},"elements":{},"error":{{"largest":{},"last":{}}},"digits":{:.2f},)"
      R"("differs":{},"numbers":{},"notFinite":{},"withoutValue":{},"exception":{},"shares":{}}})",
      jsonString(record.name), record.isValue ? "value" : "read", record.reads, record.elements,
      number(record.largest), number(record.last), survivingDigits(record.largest), record.differs,
      record.numbers, record.notFinite, record.withoutValue,
      record.exception < 0 ? "null" : std::to_string(record.exception), shares);
}

std::string_view kindOf(ExceptionRecord::Kind kind) {
  switch (kind) {
    case ExceptionRecord::Kind::Nan: return "nan";
    case ExceptionRecord::Kind::Infinity: return "infinity";
    case ExceptionRecord::Kind::Flush: break;
  }
  return "flush";
}

std::string exception(const Report& report, const ExceptionRecord& record) {
  const std::string path = list(record.path, [&](const Path& step) {
    return fmt::format(R"({{"call":{},"kernel":{},"output":{},"elements":{}}})", step.call,
                       jsonString(report.nameOf(step.kernel)), jsonString(step.output), step.elements);
  });
  return fmt::format(R"({{"kind":"{}","kernel":{},"elements":{},"isInReference":{},{},"path":{}}})",
                     kindOf(record.kind), jsonString(report.nameOf(record.kernel)), record.elements,
                     record.isInReference, element(record.first), path);
}

std::string decision(const Report& report, const DecisionRecord& record) {
  return fmt::format(R"({{"kernel":{},"elements":{},"isInherited":{},{}}})",
                     jsonString(report.nameOf(record.kernel)), record.elements, record.isInherited,
                     element(record.first));
}

/// With all digits, so that it can be given again.
std::string exactNumber(double value) {
  return std::isfinite(value) ? fmt::format("{:.17g}", value) : number(value);
}

std::string given(const Report& report, const GivenRecord& record) {
  const std::string range =
      record.hasRange ? fmt::format("[{},{}]", exactNumber(record.rangeLow), exactNumber(record.rangeHigh))
                      : "null";
  return fmt::format(
      R"({{"kernel":{},"parameter":{},"type":{},"scalar":"{}","kind":"{}","stream":{},"low":{},"high":{},)"
      R"("range":{},"elements":{},"times":{}}})",
      jsonString(report.nameOf(record.kernel)), jsonString(record.parameter), jsonString(record.type),
      record.scalar, record.isStream ? "stream" : "value", jsonString(record.stream), exactNumber(record.low),
      exactNumber(record.high), range, record.elements, record.times);
}

std::string loop(const LoopRecord& record) {
  return fmt::format(R"({{"condition":{},"runs":{},"unfinished":{},"longest":{}}})",
                     jsonString(record.condition), record.runs, record.unfinished, record.longest);
}

struct Unread {
  std::string kernel, output;
  std::int64_t calls;
  double seconds;
};

/// What the results did not need.
std::string account(const Report& report) {
  std::vector<Unread> unread;
  std::vector<const KernelRecord*> precise;
  double all = 0, shares = 0;
  for (const KernelRecord& record : report.kernels) {
    all += record.seconds;
    shares += record.share;
    for (const OutputRecord& output : record.outputs) {
      if (output.unreadCalls > 0)
        unread.push_back({record.name, output.name, output.unreadCalls, output.unreadSeconds});
    }
  }
  constexpr double hardly = 0.01, noticeable = 0.02;
  for (const KernelRecord& record : report.kernels) {
    const bool isPrecise = shares > 0 && record.share < hardly && !record.compensates &&
                           record.seconds > noticeable * all && !record.own.isEmpty() &&
                           record.choices.find("half") == std::string::npos;
    if (isPrecise) precise.push_back(&record);
  }
  std::vector<const StreamRecord*> partly;
  for (const StreamRecord& record : report.streams) {
    if (record.written > 0 && record.unread / record.written > 0.05) partly.push_back(&record);
  }
  const std::string outputs = list(unread, [](const Unread& each) {
    return fmt::format(R"({{"kernel":{},"output":{},"calls":{},"seconds":{:.6f}}})", jsonString(each.kernel),
                       jsonString(each.output), each.calls, each.seconds);
  });
  const std::string regions = list(partly, [](const StreamRecord* each) {
    return fmt::format(R"({{"stream":{},"read":{},"seconds":{:.6f}}})", jsonString(each->name),
                       number(1 - each->unread / each->written), each->unreadSeconds);
  });
  const std::string precision = list(precise, [](const KernelRecord* each) {
    return fmt::format(R"({{"kernel":{},"share":{},"seconds":{:.6f},"text":{}}})", jsonString(each->name),
                       number(each->share), each->seconds,
                       jsonString(fmt::format(
                           "its errors are {:.2g} of those of the results: sk tune tells what less precision "
                           "or storage would save",
                           each->share)));
  });
  return fmt::format(R"({{"unread":{},"partly":{},"precision":{}}})", outputs, regions, precision);
}

}  // namespace

std::string toJson(const Report& report) {
  const Options& options = report.options;
  const std::string verdicts = list(report.verdicts, [](const Verdict& verdict) {
    return fmt::format(R"({{"kind":"{}","kernel":{},"call":{},"text":{}}})", verdict.kind,
                       jsonString(verdict.kernel), verdict.call, jsonString(verdict.text));
  });
  return fmt::format(
      R"({{"format":"streamkernel-shadow","version":1,"program":{},"device":{},"reference":{},"ended":{},)"
      R"("options":{{"every":{},"kernels":{},"decisions":"{}","quad":{}}},)"
      R"("seconds":{{"program":{:.6f},"device":{:.6f},"reference":{:.6f},"comparison":{:.6f}}},)"
      R"("calls":{},"followed":{},"ranks":{},"verdicts":{},"kernels":{},"streams":{},"results":{},)"
      R"("exceptions":{},"decisions":{},"account":{},"given":{},"loops":{},"notes":{}}})",
      jsonString(report.program), jsonString(report.device), jsonString(report.reference),
      jsonString(report.ended), options.every,
      texts(options.kernels.empty() ? std::vector<std::string>{"*"} : options.kernels),
      options.followsDecisions ? "follow" : "own", texts(options.quad), report.programSeconds,
      report.deviceSeconds, report.referenceSeconds, report.comparisonSeconds, report.calls, report.followed,
      report.ranks, verdicts, list(report.kernels, kernel), list(report.streams, stream),
      list(report.results, [&](const ResultRecord& each) { return result(report, each); }),
      list(report.exceptions, [&](const ExceptionRecord& each) { return exception(report, each); }),
      list(report.decisions, [&](const DecisionRecord& each) { return decision(report, each); }),
      account(report), list(report.given, [&](const GivenRecord& each) { return given(report, each); }),
      list(report.loops, loop), texts(report.notes));
}

}  // namespace sk::shadow
