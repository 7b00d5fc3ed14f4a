// SPDX-License-Identifier: MIT
#include "scale/report.hpp"

#include <array>
#include <iterator>

#include <fmt/format.h>

#include "accuracy/child_process.hpp"
#include "seconds_text.hpp"

namespace sk_tool {

namespace {

std::string extentsText(const Extents& extents) { return fmt::format("{}", fmt::join(extents, " x ")); }

std::string bytesText(double bytes) {
  constexpr std::array<const char*, 6> units = {"B", "kB", "MB", "GB", "TB", "PB"};
  std::size_t unit = 0;
  for (; bytes >= 999.5 && unit + 1 < units.size(); ++unit) bytes /= 1000;
  return fmt::format("{:.3g} {}", bytes, units[unit]);
}

/// For example "u: y 1+1, x 2+0".
std::string haloText(const StepCall& call) {
  std::string text;
  for (const ExchangedGather& gather : call.gathers) {
    std::string inside;
    const std::size_t rank = gather.stream.halo.size();
    for (std::size_t d = 0; d < rank; ++d) {
      if (gather.stream.halo[d].both() == 0) continue;
      inside += fmt::format("{}{} {}+{}", inside.empty() ? "" : ", ", "xyzw"[rank - 1 - d],
                            gather.stream.halo[d].below, gather.stream.halo[d].above);
    }
    if (!inside.empty()) text += fmt::format("{}{}: {}", text.empty() ? "" : "; ", gather.name, inside);
  }
  return text.empty() ? "none" : text;
}

std::string efficiencyText(const std::optional<Distribution>& one) {
  return one ? fmt::format("{:.3f}", one->efficiency) : "-";
}

std::string headOf(const ScaleReport& report) {
  const Network& network = report.cluster.network;
  std::string text = fmt::format("{}, {}{}{}\n\n", report.file, extentsText(report.step.grid),
                                 report.step.isPerDevice ? " elements per GPU" : " elements",
                                 report.device.empty() ? "" : "; measured on " + report.device);
  for (std::size_t i = 0; i < report.step.calls.size(); ++i) {
    const StepCall& call = report.step.calls[i];
    fmt::format_to(std::back_inserter(text), "  {:<16} {:.3g} elements/s and {} a call ({}); halo {}{}\n",
                   call.name, 1 / call.perElement, secondsText(call.perCall), report.rates[i].source,
                   haloText(call),
                   call.reducedBytes > 0 ? fmt::format("; {} bytes combined", call.reducedBytes) : "");
    if (call.boxes.factor > 1)
      fmt::format_to(std::back_inserter(text),
                     "  {:<16} {:.3g} times as long for an element, {} for a border\n", "  in boxes",
                     call.boxes.factor, secondsText(call.boxes.borderTime));
  }
  fmt::format_to(std::back_inserter(text), "  {:<16} {}/s, latency {}, overhead {}, gap {}\n", "network",
                 bytesText(1 / network.gapPerByte), secondsText(network.latency),
                 secondsText(network.overhead), secondsText(network.gap));
  const Staging& staging = report.cluster.staging;
  if (staging.isNeeded()) {
    fmt::format_to(std::back_inserter(text), "  {:<16} read {} and {}/s, write {} and {}/s\n",
                   "copies to host", secondsText(staging.readTime), bytesText(staging.readBandwidth),
                   secondsText(staging.writeTime), bytesText(staging.writeBandwidth));
  } else {
    fmt::format_to(std::back_inserter(text), "  {:<16} none\n", "copies to host");
  }
  return text;
}

std::string lineOf(const BestOf& row) {
  if (!row.best) return fmt::format("{:>8}  every block is thinner than its halo\n", row.devices);
  const Distribution& best = *row.best;
  return fmt::format(
      "{:>8}  {:<16} {:<24} {:>5} {:>10} {:>10} {:>10} {:>10} {:>7.3f} {:>7} {:>7} {:>7} {:>8}{}\n",
      row.devices, extentsText(best.parts), extentsText(best.block), best.exchangeEvery,
      secondsText(best.time), secondsText(best.compute), secondsText(best.exchange),
      secondsText(best.waiting), best.efficiency, efficiencyText(row.byDimensions[0]),
      efficiencyText(row.byDimensions[1]), efficiencyText(row.byDimensions[2]), bytesText(best.memory),
      row.fits ? "" : ", too much");
}

std::string distributionText(const Distribution& one) {
  const std::string exchange = one.exchangeEvery == 1
                                   ? "an exchange for every call"
                                   : fmt::format("an exchange every {} calls", one.exchangeEvery);
  return one.devices == 1 ? "not split" : fmt::format("split {}, {}", extentsText(one.parts), exchange);
}

std::string verdictOf(const ScaleReport& report) {
  const PayingRows rows = payingRows(report);
  if (rows.last < 0) return fmt::format("No number of GPUs reaches an efficiency of {:g}.\n", report.bar);
  const BestOf& last = report.rows[static_cast<std::size_t>(rows.last)];
  std::string text = fmt::format("{} GPU(s) pay, {}: efficiency {:.3f}.\n", last.devices,
                                 distributionText(*last.best), last.best->efficiency);
  if (rows.first < 0) return text;
  const BestOf& first = report.rows[static_cast<std::size_t>(rows.first)];
  if (!first.best) return text + fmt::format("{} are more than the grid can be split into.\n", first.devices);
  return text +
         fmt::format("{} do not: {:.3f} is below {:g}.\n", first.devices, first.best->efficiency, report.bar);
}

Json jsonOf(const Distribution& one) {
  return {{"devices", one.devices},
          {"parts", one.parts},
          {"block", one.block},
          {"exchangeEvery", one.exchangeEvery},
          {"time", one.time},
          {"compute", one.compute},
          {"exchange", one.exchange},
          {"waiting", one.waiting},
          {"efficiency", one.efficiency},
          {"messages", one.messages},
          {"bytes", one.bytes},
          {"memory", one.memory}};
}

Json jsonOf(const std::optional<Distribution>& one) { return one ? jsonOf(*one) : Json(nullptr); }

Json jsonOf(const StepCall& call, const Rate& rate) {
  Json gathers = Json::array();
  for (const ExchangedGather& gather : call.gathers) {
    Json halo = Json::array();
    for (const Halo& one : gather.stream.halo) halo.push_back({one.below, one.above});
    gathers.push_back({{"name", gather.name}, {"bytes", gather.stream.bytes}, {"halo", halo}});
  }
  return {{"name", call.name},
          {"perCall", call.perCall},
          {"perElement", call.perElement},
          {"source", rate.source},
          {"gathers", gathers},
          {"reducedBytes", call.reducedBytes},
          {"boxFactor", call.boxes.factor},
          {"perBorder", call.boxes.borderTime}};
}

}  // namespace

PayingRows payingRows(const ScaleReport& report) {
  PayingRows rows;
  for (std::size_t i = 0; i < report.rows.size(); ++i) {
    const std::optional<Distribution>& best = report.rows[i].best;
    if (!best || best->efficiency < report.bar) continue;
    rows.last = static_cast<int>(i);
  }
  if (rows.last >= 0 && rows.last + 1 < static_cast<int>(report.rows.size())) rows.first = rows.last + 1;
  return rows;
}

std::string textOf(const ScaleReport& report) {
  std::string text = headOf(report);
  fmt::format_to(std::back_inserter(text),
                 "\n{:>8}  {:<16} {:<24} {:>5} {:>10} {:>10} {:>10} {:>10} {:>7} {:>7} {:>7} {:>7} {:>8}\n",
                 "GPUs", "split", "block", "every", "step", "compute", "exchange", "waiting", "effic.", "1-D",
                 "2-D", "3-D", "memory");
  for (const BestOf& row : report.rows) text += lineOf(row);
  return text + '\n' + verdictOf(report);
}

Json jsonOf(const ScaleReport& report) {
  constexpr int schema = 1;  // version of the format
  const Network& network = report.cluster.network;
  const Staging& staging = report.cluster.staging;
  Json json = {{"schema", schema},
               {"streamkernel", SK_VERSION},
               {"file", report.file},
               {"device", report.device.empty() ? Json(nullptr) : Json(report.device)},
               {"grid", report.step.grid},
               {"perDevice", report.step.isPerDevice},
               {"periodic", report.step.periodic},
               {"network",
                {{"latency", network.latency},
                 {"overhead", network.overhead},
                 {"gap", network.gap},
                 {"bandwidth", 1 / network.gapPerByte}}},
               {"staging", staging.isNeeded() ? Json{{"readTime", staging.readTime},
                                                     {"readBandwidth", staging.readBandwidth},
                                                     {"writeTime", staging.writeTime},
                                                     {"writeBandwidth", staging.writeBandwidth}}
                                              : Json(nullptr)},
               {"overlap", report.cluster.hasOverlap},
               {"calls", Json::array()},
               {"rows", Json::array()}};
  for (std::size_t i = 0; i < report.step.calls.size(); ++i)
    json["calls"].push_back(jsonOf(report.step.calls[i], report.rates[i]));
  for (const BestOf& row : report.rows) {
    Json byDimensions = Json::array();
    for (const std::optional<Distribution>& one : row.byDimensions) byDimensions.push_back(jsonOf(one));
    json["rows"].push_back({{"devices", row.devices},
                            {"best", jsonOf(row.best)},
                            {"byDimensions", byDimensions},
                            {"fits", row.fits}});
  }
  const PayingRows paying = payingRows(report);
  json["bar"] = report.bar;
  json["pays"] =
      paying.last < 0 ? Json(nullptr) : Json(report.rows[static_cast<std::size_t>(paying.last)].devices);
  return json;
}

void drawScaleChart(const std::string& file, const ScaleReport& report) {
  constexpr std::array<const char*, 3> colors = {"#b5651d", "#1b5e9b", "#2e7d32"};
  std::string script = terminalOf(file, 640, 420);
  fmt::format_to(
      std::back_inserter(script),
      "set title {} noenhanced\nset key left bottom\nset grid lt 1 lc rgb '#dddddd'\nset border 3\nset tics "
      "nomirror\nset logscale x 2\nset xlabel 'GPUs'\nset ylabel 'efficiency'\nset yrange [0:1.05]\nset "
      "xrange [{}:{}]\nset datafile missing '-'\n$rows << END\n",
      quoted(fmt::format("{}, {}{}", report.file, extentsText(report.step.grid),
                         report.step.isPerDevice ? " per GPU" : "")),
      0.8 * static_cast<double>(report.rows.front().devices),
      1.2 * static_cast<double>(report.rows.back().devices));
  for (const BestOf& row : report.rows) {
    fmt::format_to(std::back_inserter(script), "{} {} {} {}\n", row.devices,
                   efficiencyText(row.byDimensions[0]), efficiencyText(row.byDimensions[1]),
                   efficiencyText(row.byDimensions[2]));
  }
  script += fmt::format("END\nplot {} with lines dt 2 lc rgb '#888888' title 'bar'", report.bar);
  const std::size_t dimensions = std::min<std::size_t>(report.step.grid.size(), 3);
  for (std::size_t d = 0; d < dimensions; ++d) {
    fmt::format_to(
        std::back_inserter(script),
        ", $rows using 1:{} with linespoints pt 7 ps 0.6 lw 2 lc rgb '{}' title 'split in {} dimension{}'",
        d + 2, colors[d], d + 1, d == 0 ? "" : "s");
  }
  runGnuplot(file, script + '\n');
}

}  // namespace sk_tool
