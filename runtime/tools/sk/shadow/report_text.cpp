// SPDX-License-Identifier: MIT
#include "shadow/report_text.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <stdexcept>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "assemble/nearest_word.hpp"
#include "quantile.hpp"
#include "seconds_text.hpp"
#include "shadow/text_table.hpp"

namespace sk_tool {

namespace {

std::string errorText(double error) {
  if (std::isnan(error)) return "NaN";
  return fmt::format("{:.2g}", error);
}

std::string errorText(const Entry& error) { return error.isNull() ? "-" : errorText(error.number()); }

std::string digitsText(const Entry& digits) {
  if (digits.isNull()) return "-";
  const double number = digits.number();
  if (std::isinf(number) && number > 0) return "all";
  return number > 0 ? fmt::format("{:.1f}", number) : "none";
}

std::string shareText(const Entry& share) {
  if (share.isNull()) return "-";
  const double percent = 100 * share.number();
  if (percent > 0 && percent < 0.1) return "<0.1 %";
  return percent < 10 && percent != 0 ? fmt::format("{:.1f} %", percent) : fmt::format("{:.0f} %", percent);
}

std::string counted(long long count, std::string_view noun) {
  return fmt::format("{} {}{}", count, noun, count == 1 ? "" : "s");
}

std::string elementText(const Entry& event) {
  std::string text = event["output"].text();
  forEach(event["element"], [&](const Entry& index) { text += fmt::format("[{}]", index.integer()); });
  return text;
}

/// A value in decimal, and its bits in hexadecimal where they say more.
std::string sampleText(const Entry& sample) {
  if (sample.isNull()) return "-";
  const std::string value = sample["value"].asWritten(), hex = sample["hex"].text();
  return hex.empty() || hex == value ? value : fmt::format("{} ({})", value, hex);
}

/// How many calls ran beside the reference.
std::string followedText(const Entry& of) {
  const long long calls = of["calls"].integer(), followed = of["followed"].integer();
  return counted(calls, "call") + (calls == 0          ? ""
                                   : calls == followed ? ", all followed"
                                                       : fmt::format(", {} followed", followed));
}

/// "3 NaN, 12 flushed".
std::string exceptionsText(const Entry& kernel) {
  std::string text;
  for (const auto& [name, what] : {std::pair{"nans", "NaN"}, {"infinities", "inf"}, {"flushed", "flushed"}}) {
    const long long count = kernel[name].integer();
    if (count > 0) fmt::format_to(std::back_inserter(text), "{}{} {}", text.empty() ? "" : ", ", count, what);
  }
  return text.empty() ? "0" : text;
}

/// Orders a list by a number, largest first; NaN counts as the largest.
template <class Number>
std::vector<Entry> byNumber(const Entry& list, Number number) {
  std::vector<Entry> all;
  forEach(list, [&](const Entry& entry) { all.push_back(entry); });
  const auto key = [&](const Entry& entry) {
    const Entry value = number(entry);
    const double size = value.isNull() ? -HUGE_VAL : value.number();
    return std::isnan(size) ? HUGE_VAL : size;
  };
  std::ranges::stable_sort(all, std::greater<>(), key);
  return all;
}

std::string sharesText(const Entry& shares) {
  std::vector<Entry> sorted = byNumber(shares, [](const Entry& one) { return one["share"]; });
  std::string text;
  for (std::size_t i = 0; i < std::min<std::size_t>(3, sorted.size()); ++i) {
    fmt::format_to(std::back_inserter(text), "{}{} {}", i > 0 ? ", " : "", shareText(sorted[i]["share"]),
                   sorted[i]["kernel"].text());
  }
  return sorted.size() > 3
             ? fmt::format("{}, {}", text, counted(static_cast<long long>(sorted.size()) - 3, "other"))
             : text;
}

/// Errors that make those of others smaller have no share above 0, and yet they count.
std::string shareOfKernel(const Entry& kernel) {
  const bool compensates = kernel.has("compensates") && kernel["compensates"].flag();
  return compensates && !(kernel["share"].number() > 0) ? "<0 %" : shareText(kernel["share"]);
}

TextTable inputsTable(const Entry& inputs) {
  TextTable table({"  input", "<device", "<reference"});
  forEach(inputs, [&](const Entry& input) {
    std::string name = "  " + input["parameter"].text();
    if (input.has("at"))
      forEach(input["at"], [&](const Entry& index) { name += fmt::format("[{}]", index.integer()); });
    table.add({name, sampleText(input), sampleText(input["reference"])});
  });
  return table;
}

/// What an element was computed from.
std::string sourcesText(const Entry& element) {
  const Entry inputs = element["inputs"];
  return (inputs.size() > 0 ? inputsTable(inputs).text(inputs.size()) : "") +
         (element.has("source") ? fmt::format("    {}\n", element["source"].text()) : "");
}

/// A part of the report: a title, and lines.
std::string part(std::string_view title, const std::string& text) {
  return text.empty() ? "" : fmt::format("\n{}\n{}", title, text);
}

std::string headOf(const Entry& report) {
  const std::string program = report["program"].text();
  std::string text = fmt::format("{} on {}, beside {}: {}", program.empty() ? "a program" : program,
                                 report["device"].text(), report["reference"].text(), followedText(report));
  if (report["ranks"].integer() > 1) text += ", " + counted(report["ranks"].integer(), "rank");
  text += "\n";
  if (report["ended"].text() != "normally") text += fmt::format("ended {}\n", report["ended"].text());
  return text;
}

std::string verdictsOf(const Entry& report, std::size_t most) {
  std::string text;
  const Entry verdicts = report["verdicts"];
  for (std::size_t i = 0; i < std::min(most, verdicts.size()); ++i) {
    fmt::format_to(std::back_inserter(text), "  {:<10}{}\n", verdicts.at(i)["kind"].text(),
                   verdicts.at(i)["text"].text());
  }
  if (verdicts.size() > most)
    fmt::format_to(std::back_inserter(text), "  and {} more; --all shows them\n", verdicts.size() - most);
  return "\n" + text;
}

std::string resultsOf(const Entry& report, std::size_t most) {
  TextTable table({"result", "digits", "largest", "last", "reads", "elements", "differ", "<error of"});
  for (const Entry& result :
       byNumber(report["results"], [](const Entry& one) { return one["error"]["largest"]; })) {
    table.add({result["name"].text(), digitsText(result["digits"]), errorText(result["error"]["largest"]),
               errorText(result["error"]["last"]), std::to_string(result["reads"].integer()),
               std::to_string(result["elements"].integer()), std::to_string(result["differs"].integer()),
               sharesText(result["shares"])});
  }
  return part("what the program read", table.isEmpty() ? "  nothing\n" : table.text(most));
}

std::string kernelsOf(const Entry& report, std::size_t most) {
  TextTable table({"kernel", "share", "digits", "own", "inherited", "amplification", "calls", "time",
                   "exceptions", "decisions"});
  for (const Entry& kernel : byNumber(report["kernels"], [](const Entry& one) { return one["share"]; })) {
    const Entry amplification = kernel["amplification"];
    table.add({kernel["name"].text(), shareOfKernel(kernel), digitsText(kernel["digits"]),
               errorText(kernel["own"]["largest"]), errorText(kernel["inherited"]["largest"]),
               amplification.isNull() ? "-" : errorText(amplification["largest"]),
               std::to_string(kernel["calls"].integer()), secondsText(kernel["seconds"].number()),
               exceptionsText(kernel), std::to_string(kernel["decisions"].integer())});
  }
  const char* nothing = report["calls"].integer() > 0 ? "  no call was followed\n" : "  none were called\n";
  return part("kernels, by their share of the results' errors", table.isEmpty() ? nothing : table.text(most));
}

std::string exceptionText(const Entry& event) {
  const long long elements = event["elements"].integer();
  std::string text = fmt::format(
      "  {} in call {}: {} of {} is {}, not {}{}\n", event["kind"].text(), event["call"].integer(),
      elementText(event), event["kernel"].text(), sampleText(event["device"]), sampleText(event["reference"]),
      elements > 1 ? fmt::format(", like {} of this call", counted(elements - 1, "other element")) : "");
  text += sourcesText(event);
  constexpr std::size_t few = 8;
  const Entry path = event["path"];
  for (std::size_t i = 0; i < path.size(); ++i) {
    if (i == few && path.size() > few + 1) {
      fmt::format_to(std::back_inserter(text), "    ... {} more calls\n", path.size() - few - 1);
      i = path.size() - 1;
    }
    const Entry step = path.at(i);
    fmt::format_to(std::back_inserter(text), "    then call {}: {} of {} ({})\n", step["call"].integer(),
                   step["output"].text(), step["kernel"].text(),
                   counted(step["elements"].integer(), "element"));
  }
  return text;
}

/// The events of one kernel, or of all if `kernel` is empty.
std::vector<Entry> eventsOf(const Entry& list, const std::string& kernel) {
  std::vector<Entry> events;
  forEach(list, [&](const Entry& event) {
    if (kernel.empty() || event["kernel"].text() == kernel) events.push_back(event);
  });
  return events;
}

std::string exceptionsOf(const Entry& report, const std::string& kernel, std::size_t most) {
  const std::vector<Entry> events = eventsOf(report["exceptions"], kernel);
  std::string text;
  for (std::size_t i = 0; i < std::min(most, events.size()); ++i) text += exceptionText(events[i]);
  if (events.size() > most) text += fmt::format("  and {} more; --all shows them\n", events.size() - most);
  return part("exceptional values, of the device alone or of both", text);
}

std::string decisionsOf(const Entry& report, const std::string& kernel, std::size_t most) {
  TextTable table({"call", "<kernel", "<element", "elements", "device", "reference", "<cause"});
  for (const Entry& one : eventsOf(report["decisions"], kernel)) {
    table.add({std::to_string(one["call"].integer()), one["kernel"].text(), elementText(one),
               std::to_string(one["elements"].integer()), one["device"]["value"].asWritten(),
               one["reference"]["value"].asWritten(),
               one["isInherited"].flag() ? "its inputs differ" : "its own"});
  }
  return part("decisions that differ", table.isEmpty() ? "" : table.text(most));
}

std::string accountOf(const Entry& account, std::size_t most) {
  TextTable unread({"kernel", "<output", "calls", "time"}), partly({"stream", "read", "time"}),
      precision({"kernel", "share", "time", "<advice"});
  forEach(account["unread"], [&](const Entry& one) {
    unread.add({one["kernel"].text(), one["output"].text(), std::to_string(one["calls"].integer()),
                secondsText(one["seconds"].number())});
  });
  forEach(account["partly"], [&](const Entry& one) {
    partly.add({one["stream"].text(), shareText(one["read"]), secondsText(one["seconds"].number())});
  });
  forEach(account["precision"], [&](const Entry& one) {
    precision.add({one["kernel"].text(), shareText(one["share"]), secondsText(one["seconds"].number()),
                   one["text"].text()});
  });
  const auto partOf = [&](std::string_view title, const TextTable& table) {
    return part(title, table.isEmpty() ? "" : table.text(most));
  };
  return partOf("outputs that nothing read", unread) +
         partOf("streams of which only a part was read", partly) +
         partOf("precision that no result needed", precision);
}

std::string runOf(const Entry& report, std::size_t most) {
  const Entry options = report["options"], seconds = report["seconds"];
  std::string kernels;
  forEach(options["kernels"],
          [&](const Entry& one) { kernels += (kernels.empty() ? "" : ", ") + one.text(); });
  const long long every = options["every"].integer();
  std::string text = fmt::format(
      "  followed        {} of {}; {}\n", every == 1 ? "every call" : fmt::format("one of {} calls", every),
      kernels == "*" ? "all kernels" : kernels,
      options["decisions"].text() == "follow" ? "the reference takes the device's decisions"
                                              : "the reference makes its own decisions");
  const double program = seconds["program"].number(), reference = seconds["reference"].number(),
               comparison = seconds["comparison"].number(), alone = program - reference - comparison;
  fmt::format_to(std::back_inserter(text),
                 "  time            {}: the device {}, the reference {}, comparing {}", secondsText(program),
                 secondsText(seconds["device"].number()), secondsText(reference), secondsText(comparison));
  if (alone > 0 && alone < program)
    fmt::format_to(std::back_inserter(text), "; {:.2g} times as long as without the shadow", program / alone);
  text += "\n";
  if (report.has("perRank")) {
    TextTable ranks({"rank", "<device", "calls"});
    forEach(report["perRank"], [&](const Entry& rank) {
      ranks.add({std::to_string(rank["rank"].integer()), rank["device"].text(),
                 std::to_string(rank["calls"].integer())});
    });
    text += ranks.text(most);
  }
  const Entry notes = report["notes"];
  for (std::size_t i = 0; i < std::min(most, notes.size()); ++i)
    text += fmt::format("  note            {}\n", notes.at(i).text());
  if (notes.size() > most) text += fmt::format("  and {} more; --all shows them\n", notes.size() - most);
  return part("how it was run", text);
}

std::string errorsOf(const Entry& kernel) {
  TextTable table({"error", "largest", "typical"});
  for (const auto& [name, title] : {std::pair{"own", "own"},
                                    {"storage", "of it, storing"},
                                    {"inherited", "inherited"},
                                    {"total", "total"},
                                    {"amplification", "amplification"}}) {
    const Entry sizes = kernel[name];
    if (!sizes.isNull()) table.add({title, errorText(sizes["largest"]), errorText(sizes["typical"])});
  }
  return table.text(5);
}

/// The errors of a point: its column of [call, own, inherited, total].
std::vector<double> columnOf(const Entry& points, std::size_t column) {
  std::vector<double> values;
  forEach(points, [&](const Entry& point) { values.push_back(point.at(column).number()); });
  return values;
}

/// NaN, which has no order, counts as infinity.
double medianOf(std::vector<double> values) {
  for (double& value : values) value = std::isnan(value) ? HUGE_VAL : value;
  return median(std::move(values));
}

std::string outputsOf(const Entry& kernel, std::size_t most) {
  TextTable table({"output", "<type", "calls", "<error", "first", "median", "last", "largest", "in call"});
  forEach(kernel["outputs"], [&](const Entry& output) {
    const Entry points = output["points"];
    if (points.size() == 0) return;
    std::string name = output["name"].text(), type = output["type"].text(),
                calls = fmt::format("{} to {}", points.at(0).at(0).integer(),
                                    points.at(points.size() - 1).at(0).integer());
    for (const auto& [column, kind] : {std::pair{1, "own"}, {2, "inherited"}, {3, "total"}}) {
      const std::vector<double> values = columnOf(points, static_cast<std::size_t>(column));
      const auto isLess = [](double a, double b) { return !std::isnan(a) && (std::isnan(b) || a < b); };
      const auto largest = std::ranges::max_element(values, isLess);
      const auto call = points.at(static_cast<std::size_t>(largest - values.begin())).at(0).integer();
      table.add({std::exchange(name, ""), std::exchange(type, ""), std::exchange(calls, ""), kind,
                 errorText(values.front()), errorText(medianOf(values)), errorText(values.back()),
                 errorText(*largest), std::to_string(call)});
    }
  });
  return table.isEmpty() ? "" : table.text(most);
}

std::string worstOf(const Entry& worst) {
  if (worst.isNull()) return "  no element differs from the reference\n";
  return fmt::format("  {} of call {} is {}, not {}\n", elementText(worst), worst["call"].integer(),
                     sampleText(worst["device"]), sampleText(worst["reference"])) +
         sourcesText(worst);
}

std::string kernelOf(const Entry& report, const Entry& kernel, std::size_t most) {
  const std::string name = kernel["name"].text();
  std::string text =
      fmt::format("{}: {}, {}\n", name, followedText(kernel), secondsText(kernel["seconds"].number()));
  fmt::format_to(std::back_inserter(text), "  share           {} of the results' errors\n",
                 shareOfKernel(kernel));
  fmt::format_to(std::back_inserter(text), "  digits          {}\n", digitsText(kernel["digits"]));
  fmt::format_to(std::back_inserter(text), "  exceptions      {}\n  decisions       {}\n",
                 exceptionsText(kernel), kernel["decisions"].integer());
  return text + part("error of its calls", errorsOf(kernel)) +
         part("its worst element", worstOf(kernel["worst"])) +
         part("error over its calls", outputsOf(kernel, 3 * most)) + exceptionsOf(report, name, most) +
         decisionsOf(report, name, most);
}

}  // namespace

std::string shadowText(const Entry& report, std::size_t most) {
  return headOf(report) + verdictsOf(report, most) + resultsOf(report, most) + kernelsOf(report, most) +
         exceptionsOf(report, "", most) + decisionsOf(report, "", most) + accountOf(report["account"], most) +
         runOf(report, most);
}

std::string shadowKernelText(const Entry& report, const std::string& name, std::size_t most) {
  std::string text;
  std::vector<std::string> known;
  forEach(report["kernels"], [&](const Entry& kernel) {
    known.push_back(kernel["name"].text());
    if (known.back() != name && !known.back().ends_with("::" + name)) return;
    text += (text.empty() ? "" : "\n") + kernelOf(report, kernel, most);
  });
  if (!text.empty()) return text;
  const std::string_view nearest = sk::assemble::nearestWord(name, known);
  constexpr std::size_t few = 12;
  const std::string names = fmt::format(
      "{}", fmt::join(known.begin(), known.begin() + std::ptrdiff_t(std::min(few, known.size())), ", "));
  throw std::runtime_error(fmt::format("the report has no kernel '{}'; {}", name,
                                       !nearest.empty() ? fmt::format("did you mean '{}'?", nearest)
                                       : known.empty()  ? "it has none"
                                       : known.size() > few
                                           ? fmt::format("it has {} and {} more", names, known.size() - few)
                                           : "it has " + names));
}

}  // namespace sk_tool
