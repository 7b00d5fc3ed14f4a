// SPDX-License-Identifier: MIT
#include "stress/observation.hpp"

#include <algorithm>

namespace sk_tool::stress {

const Result* Observation::worst() const {
  const auto found = std::ranges::max_element(results, {}, &Result::error);
  return found == results.end() ? nullptr : &*found;
}

const Result* Observation::resultNamed(const std::string& name) const {
  const auto found = std::ranges::find(results, name, &Result::name);
  return found == results.end() ? nullptr : &*found;
}

namespace {

Given givenIn(const Entry& entry) {
  Given given{.kernel = entry["kernel"].text(),
              .parameter = entry["parameter"].text(),
              .scalar = entry["scalar"].text(),
              .isStream = entry["kind"].text() == "stream",
              .low = entry["low"].number(),
              .high = entry["high"].number(),
              .elements = entry["elements"].integer()};
  const Entry range = entry["range"];
  if (!range.isNull()) given.range = Range{range.at(0).number(), range.at(1).number()};
  return given;
}

}  // namespace

Observation observationIn(const Entry& report) {
  Observation seen;
  seen.device = report["device"].text();
  seen.hasEnded = report["ended"].text() == "normally";
  seen.calls = report["calls"].integer();
  forEach(report["given"], [&](const Entry& each) { seen.given.push_back(givenIn(each)); });
  forEach(report["results"], [&](const Entry& each) {
    seen.results.push_back({each["name"].text(), each["elements"].integer(), each["withoutValue"].integer(),
                            each["error"]["largest"].number()});
  });
  forEach(report["kernels"],
          [&](const Entry& each) { seen.kernels.push_back({each["name"].text(), each["calls"].integer()}); });
  forEach(report["loops"], [&](const Entry& each) {
    seen.loops.push_back({each["condition"].text(), each["unfinished"].integer(), each["longest"].integer()});
  });
  forEach(report["exceptions"], [&](const Entry& each) {
    const std::string kind = each["kind"].text();
    if (kind == "flush" || (seen.origin && seen.origin->call <= each["call"].integer())) return;
    seen.origin = Origin{kind == "nan", each["kernel"].text(), each["output"].text(), each["call"].integer(),
                         each["isInReference"].flag()};
  });
  forEach(report["verdicts"], [&](const Entry& each) {
    if (each["kind"].text() == "unstable") seen.unstable = each["text"].text();
  });
  return seen;
}

}  // namespace sk_tool::stress
