// SPDX-License-Identifier: MIT
//
// Concludes from the records of a program which kernel is to blame for what.
#include "shadow/report.hpp"

#include <algorithm>
#include <functional>
#include <numeric>
#include <optional>
#include <span>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "assemble/nearest_word.hpp"

namespace sk::shadow {

namespace {

/// The larger errors of two calls, of which the second comes later.
Series::Point largest(const Series::Point& a, const Series::Point& b) {
  return {b.call,
          std::fmax(a.own, b.own),
          std::fmax(a.inherited, b.inherited),
          std::fmax(a.total, b.total),
          std::fmax(a.absolute, b.absolute),
          a.isTurned || b.isTurned};
}

}  // namespace

void Series::add(const Point& point) {
  constexpr std::size_t most = 1024;
  if (inLast_ > 0 && inLast_ < step_) {
    Point& last = points_.back();
    last = largest(last, point);
    ++inLast_;
    return;
  }
  if (points_.size() == most) {
    for (std::size_t i = 0; i < most / 2; ++i) {
      points_[i] = largest(points_[2 * i], points_[2 * i + 1]);
    }
    points_.resize(most / 2);
    step_ *= 2;
  }
  points_.push_back(point);
  inLast_ = 1;
}

void Series::raise(const Series& other) {
  for (std::size_t i = 0; i < std::min(points_.size(), other.points_.size()); ++i) {
    points_[i] = largest(other.points_[i], points_[i]);
  }
}

std::string_view Report::nameOf(int kernel) const {
  if (kernel == notCompared) return "(calls that were not compared)";
  if (kernel < 0) return "(written by the host)";
  return kernels[static_cast<std::size_t>(kernel)].name;
}

namespace {

std::string digitsOf(double error) {
  if (!(error > 0)) return "all digits";
  const double digits = std::clamp(-std::log10(error), 0.0, 16.0) + 0.0;  // not -0
  return fmt::format("{:.1f} digits", digits);
}

std::string where(const std::vector<std::int64_t>& index) {
  std::string text;
  for (const std::int64_t i : index) text += fmt::format("[{}]", i);
  return text;
}

const ResultRecord* worstResult(const Report& report) {
  const auto worst = std::ranges::max_element(report.results, {}, &ResultRecord::largest);
  return worst == report.results.end() ? nullptr : &*worst;
}

/// The kernels' shares of the errors of all results: a result counts as much as its error.
void shareErrors(Report& report) {
  double all = 0;
  const auto weightOf = [](const ResultRecord& result) { return std::fmin(1, result.largest); };
  for (const ResultRecord& result : report.results) all += weightOf(result);
  for (const ResultRecord& result : report.results) {
    if (!(all > 0)) break;
    for (const auto& [kernel, share] : result.shares.all()) {
      if (kernel >= 0)
        report.kernels[static_cast<std::size_t>(kernel)].share += share * weightOf(result) / all;
    }
  }
}

void addExceptions(Report& report, bool areInReference) {
  using Kind = ExceptionRecord::Kind;
  for (const ExceptionRecord& each : report.exceptions) {
    if (each.isInReference != areInReference || each.kind == Kind::Flush) continue;
    if (areInReference && each.kind == Kind::Infinity) continue;  // programs mean those
    const bool isNan = each.kind == Kind::Nan;
    const std::string kernel(report.nameOf(each.kernel));
    report.verdicts.push_back(
        {isNan ? "nan" : "infinity", kernel,
         fmt::format("{} computes the first {} in call {}, at {}{}, {}", kernel, isNan ? "NaN" : "infinity",
                     each.first.call, each.first.output, where(each.first.index),
                     areInReference ? "and does so in double as well"
                                    : fmt::format("where double gives {:.6g}", each.first.reference)),
         each.first.call});
  }
}

/// Whether the results are worse than rounding explains.
bool isGrave(const ResultRecord* result, double limit) {
  return result != nullptr && (result->largest > limit || result->differs > 0);
}

Verdict decisionVerdict(const Report& report, const DecisionRecord& each) {
  const std::string kernel(report.nameOf(each.kernel));
  const std::string elements = each.elements == 1 ? "one element" : fmt::format("{} elements", each.elements);
  return {"decision", kernel,
          fmt::format("{} decides differently than in double for {} in call {}{}: {}{} is {:.9g}, not {:.9g}",
                      kernel, elements, each.first.call, each.isInherited ? ", as its inputs differ" : "",
                      each.first.output, where(each.first.index), each.first.device, each.first.reference),
          each.first.call};
}

/// Whether errors of results may follow from a decision: its kernel has some share in them. A pixel of a picture that nothing reads has
/// none.
bool mayCauseErrors(const Report& report, const DecisionRecord& decision) {
  constexpr double some = 0.1;
  const bool areShared =
      std::ranges::any_of(report.kernels, [](double share) { return share > 0; }, &KernelRecord::share);
  return !areShared || decision.kernel < 0 ||
         report.kernels[static_cast<std::size_t>(decision.kernel)].share >= some;
}

/// `areInherited`: those that differ since the inputs of the call do.
template <class IsAdded>
void addDecisions(Report& report, bool areInherited, IsAdded&& isAdded) {
  for (const DecisionRecord& each : report.decisions) {
    if (each.isInherited == areInherited && isAdded(each))
      report.verdicts.push_back(decisionVerdict(report, each));
  }
}

/// Keys that are as right as floats are may ask for another order, and all differences after it are those of another history: the
/// first such order, if no call has made a decision of its own before.
void addOrder(Report& report) {
  constexpr double rounding = 1e-5;
  const auto first = std::ranges::min_element(report.decisions, {}, [](const DecisionRecord& each) {
    return std::pair(each.first.call, each.isInherited);
  });
  if (first == report.decisions.end() || !(first->ofKeys < rounding) || !first->ofKeys) return;
  report.verdicts.push_back(decisionVerdict(report, *first));
}

/// How the error of an output grows from call to call, if it does so exponentially and not as rounding errors add up.
struct Growth {
  double factor = 1;  ///< with each call of the program
  double calls = 0;  ///< of the program, over which it grew so
  bool isOfSolution = false;  ///< what is computed grows as fast, and keeps its sign
};

/// The points of a series until nothing is right any more. Absolute errors say how errors grow: where a step is unstable, the
/// exact values may grow, too.
std::vector<Series::Point> beforeLoss(const Series& series) {
  constexpr double lost = 0.05;
  std::vector<Series::Point> points;
  for (const Series::Point& point : series.points()) {
    if (point.total > lost || !std::isfinite(point.absolute)) break;
    if (point.absolute > 0) points.push_back(point);
  }
  return points;
}

/// A step that is too long overshoots: the largest waves change their signs with each call. A model that grows so is a rarity.
bool overshoots(std::span<const Series::Point> points) {
  const auto turned = std::ranges::count_if(points, &Series::Point::isTurned);
  return 2 * turned > std::ssize(points);
}

Growth growthOver(std::span<const Series::Point> points) {
  const Series::Point &from = points.front(), &to = points.back();
  const double error = std::log(to.absolute / from.absolute);
  const double relative = from.total > 0 && to.total > 0 ? std::log(to.total / from.total) : error;
  const auto calls = static_cast<double>(to.call - from.call);
  constexpr double most = 0.7;
  return {std::exp(error / calls), calls, error - relative > most * error && !overshoots(points)};
}

/// Many points: each quarter of them adds as many digits to the error as the one before.
Growth longGrowth(const std::vector<Series::Point>& points) {
  constexpr double much = 100, steady = 0.75;
  constexpr std::size_t quarters = 4;
  double logarithms[quarters + 1], steps[quarters];
  for (std::size_t q = 0; q <= quarters; ++q)
    logarithms[q] = std::log(points[(points.size() - 1) * q / quarters].absolute);
  for (std::size_t q = 0; q < quarters; ++q) steps[q] = logarithms[q + 1] - logarithms[q];
  // sums of rounding errors grow by a factor of 2 or less from the second quarter to the fourth
  const double grown = steps[1] + steps[2] + steps[3];
  if (grown < std::log(much) || steps[2] < steady * steps[1] || steps[3] < steady * steps[2]) return {};
  return growthOver(std::span(points).subspan((points.size() - 1) / quarters));
}

/// Few points, since nothing is right after them: each has a larger error than the one before, by far, and other signs.
Growth shortGrowth(const std::vector<Series::Point>& points) {
  constexpr double much = 100, far = 1.4;
  const std::size_t first = points.size() / 4;
  for (std::size_t i = first + 1; i < points.size(); ++i) {
    if (points[i].absolute < far * points[i - 1].absolute) return {};
  }
  if (points.back().absolute < much * points[first].absolute) return {};
  const auto last = std::span(points).subspan(first);
  return overshoots(last) ? growthOver(last) : Growth{};
}

Growth growthOf(const Series& series) {
  constexpr std::size_t many = 24, few = 4;
  const std::vector<Series::Point> points = beforeLoss(series);
  if (points.size() >= many) return longGrowth(points);
  return points.size() >= few ? shortGrowth(points) : Growth{};
}

/// Whether a kernel's outputs reach its own inputs, directly or through other kernels: errors grow in such a cycle, and what only
/// looks at them, as a total does, shows it.
bool readsItself(const Report& report, int kernel) {
  std::vector<bool> isReached(report.kernels.size());
  std::vector<int> open{kernel};
  while (!open.empty()) {
    const auto from = static_cast<std::size_t>(open.back());
    open.pop_back();
    for (const int source : report.kernels[from].readFrom) {
      if (source == kernel) return true;
      if (source < 0 || isReached[static_cast<std::size_t>(source)]) continue;
      isReached[static_cast<std::size_t>(source)] = true;
      open.push_back(source);
    }
  }
  return false;
}

struct Growing {
  const KernelRecord* kernel = nullptr;
  Growth growth;
};

/// The kernel with the fastest growth among kernels, if errors grow in most of what these compute over and over again: an
/// instability shows in most of it.
template <class Counts>
Growing fastestAmong(const Report& report, Counts&& counts) {
  constexpr std::int64_t often = 4;
  Growing fastest;
  int growing = 0, steady = 0;
  for (std::size_t i = 0; i < report.kernels.size(); ++i) {
    const KernelRecord& kernel = report.kernels[i];
    if (kernel.amplification.count() < often || !counts(static_cast<int>(i))) continue;
    for (const OutputRecord& output : kernel.outputs) {
      if (output.points.points().empty()) continue;
      const Growth growth = growthOf(output.points);
      (growth.factor > 1 ? growing : steady) += 1;
      if (growth.factor > fastest.growth.factor) fastest = {&kernel, growth};
    }
  }
  return growing < steady ? Growing{} : fastest;
}

/// Feedback may pass through the host, which nobody sees: then all kernels count.
std::optional<Verdict> unstableVerdict(const Report& report) {
  Growing found = fastestAmong(report, [&](int kernel) { return readsItself(report, kernel); });
  if (found.kernel == nullptr) found = fastestAmong(report, [](int) { return true; });
  const auto& [worst, fastest] = found;
  if (worst == nullptr) return std::nullopt;
  const double others = static_cast<double>(report.calls) / static_cast<double>(worst->calls);
  const std::string growth =
      fmt::format("the error grows by a factor of {:.4g} with each call of {}, for {:.0f} calls",
                  std::pow(fastest.factor, others), worst->name, fastest.calls / others);
  if (!fastest.isOfSolution)
    return Verdict{"unstable", worst->name,
                   fmt::format("unstable time step: {}; or the model is chaotic", growth), 0};
  return Verdict{
      "growth", worst->name,
      fmt::format("{}, and so does what it computes: an unstable time step, or a model that grows", growth),
      0};
}

/// Whether the first value that is not finite is an infinity, which growth may have led to.
bool overflowsFirst(const Report& report) {
  const ExceptionRecord* first = nullptr;
  for (const ExceptionRecord& each : report.exceptions) {
    if (each.kind != ExceptionRecord::Kind::Flush &&
        (first == nullptr || each.first.call < first->first.call))
      first = &each;
  }
  return first != nullptr && first->kind == ExceptionRecord::Kind::Infinity;
}

const KernelRecord* worstByShare(const Report& report) {
  const auto worst = std::ranges::max_element(report.kernels, {}, &KernelRecord::share);
  return worst == report.kernels.end() || !(worst->share > 0) ? nullptr : &*worst;
}

double shareOf(const ResultRecord& result, int kernel) {
  const auto found = std::ranges::find(result.shares.all(), kernel, &Share::kernel);
  return found == result.shares.all().end() ? 0 : found->share;
}

/// Whose errors nobody knows: those of kernels of which no call was compared, and what has passed through them.
std::string unknownText(const Report& report, const ResultRecord& result, double share,
                        const std::string& survivors) {
  constexpr double some = 0.1;
  constexpr std::size_t most = 4;
  std::vector<std::string> names;
  for (const auto& [kernel, part] : result.shares.through()) {
    if (kernel >= 0 && part >= some && names.size() < most) names.emplace_back(report.nameOf(kernel));
  }
  if (names.empty()) {
    return fmt::format(
        "calls that were not compared (every=, kernels=) add {:.0f} % of the error of what the program "
        "reads: {}",
        100 * share, survivors);
  }
  const bool isOne = names.size() == 1;
  return fmt::format(
      "{:.0f} % of the error of what the program reads arises in, or is magnified by, {}, which {} not "
      "compared: {}; compare {}, too: kernels={}",
      100 * share, fmt::join(names, " or "), isOne ? "is" : "are", survivors, isOne ? "it" : "them",
      fmt::join(names, ",kernels="));
}

void addShares(Report& report, const ResultRecord* result) {
  const KernelRecord* worst = worstByShare(report);
  if (result == nullptr || !(result->largest > 0)) return;
  const double ofHost = shareOf(*result, writtenByHost), unknown = shareOf(*result, notCompared),
               ofWorst = worst == nullptr ? 0 : worst->share;
  const std::string survivors = fmt::format("{} of '{}' survive", digitsOf(result->largest), result->name);
  const auto add = [&](const std::string& whose) {
    report.verdicts.push_back(
        {"error", "", fmt::format("{} of the error of what the program reads: {}", whose, survivors), 0});
  };
  if (unknown > std::max(ofHost, ofWorst))
    return report.verdicts.push_back({"error", "", unknownText(report, *result, unknown, survivors), 0});
  if (ofHost > ofWorst || worst == nullptr)
    return add(fmt::format("what the host has written or copied brings {:.0f} %", 100 * ofHost));
  if (worst->followed == 0)
    return add(fmt::format("{}, which is not compared, adds {:.0f} %", worst->name, 100 * worst->share));
  const std::string choices = worst->choices.empty() ? "" : fmt::format(" ({})", worst->choices);
  const std::string whose = fmt::format("{}{} adds {:.0f} % of the error of what the program reads",
                                        worst->name, choices, 100 * worst->share);
  const std::int64_t call = worst->worst ? worst->worst->call : 0;
  if (!worst->isStored())
    return report.verdicts.push_back({"error", worst->name, fmt::format("{}: {}", whose, survivors), call});
  report.verdicts.push_back({"storage", worst->name,
                             fmt::format("{}, mostly by storing {}: {}; store it in {}", whose, worst->stored,
                                         survivors, worst->storedBetter),
                             call});
}

void addFlushes(Report& report) {
  for (const ExceptionRecord& each : report.exceptions) {
    if (each.kind != ExceptionRecord::Kind::Flush) continue;
    const std::string kernel(report.nameOf(each.kernel));
    report.verdicts.push_back(
        {"flush", kernel,
         fmt::format(
             "{} flushes numbers below 1.2e-38 to zero, first in call {} at {}{}, where double gives {:.3g}",
             kernel, each.first.call, each.first.output, where(each.first.index), each.first.reference),
         each.first.call});
  }
}

/// Results that are no numbers, in double as well.
void addLost(Report& report) {
  for (const ResultRecord& result : report.results) {
    if (result.withoutValue == 0) continue;
    report.verdicts.push_back({"infinity", "",
                               fmt::format("{} of {} numbers of '{}' are NaN or infinite, in double as well",
                                           result.withoutValue, result.numbers, result.name),
                               0});
  }
}

void addRest(Report& report, const ResultRecord* result) {
  // the program may have done more after a report that is not its last
  const std::string_view until = report.ended.starts_with("early") ? " up to this report" : "";
  const auto addNothing = [&](std::string_view text, std::string_view why = "") {
    report.verdicts.push_back({"nothing", "", fmt::format("{}{}{}", text, until, why), 0});
  };
  if (report.calls == 0 && report.notes.empty()) {
    addNothing("the program has called no kernel");
  } else if (report.followed == 0) {
    addNothing("no call was compared", "; the notes say why");
  } else if (report.results.empty()) {
    addNothing("the program has read no result");
  } else if (!isGrave(result, 1e-5) && report.verdicts.empty()) {
    const std::string digits =
        (result->largest > 0 ? "at least " : "") + fmt::format("{} survive", digitsOf(result->largest));
    // with these options, the reference runs all calls, too
    const bool isWhole =
        report.followed == report.calls || report.options.every > 1 || !report.options.kernels.empty();
    report.verdicts.push_back(
        {"fine", "",
         isWhole ? fmt::format("every result{} is right: {}", until, digits)
                 : fmt::format("every result that was compared{} is right: {}; {} of {} calls were compared",
                               until, digits, report.followed, report.calls),
         0});
  }
}

}  // namespace

std::vector<std::string> unmatchedPatterns(const Report& report) {
  std::vector<std::string> names, all;
  for (const KernelRecord& kernel : report.kernels) names.push_back(kernel.name);
  if (names.empty()) return all;
  const auto add = [&](std::string_view option, const std::vector<std::string>& patterns) {
    for (const std::string& pattern : patterns) {
      if (std::ranges::any_of(names, [&](const std::string& name) { return matchesAny({pattern}, name); }))
        continue;
      std::string word = pattern;
      std::erase(word, '*');
      const std::string_view near = assemble::nearestWord(word, names);
      all.push_back(fmt::format("{}={} matches no kernel that the program has called{}", option, pattern,
                                near.empty() ? "" : fmt::format("; did you mean '{}'?", near)));
    }
  };
  add("kernels", report.options.kernels);
  add("quad", report.options.quad);
  return all;
}

void conclude(Report& report) {
  shareErrors(report);
  const ResultRecord* result = worstResult(report);
  const std::optional<Verdict> unstable = unstableVerdict(report);
  const bool isHarmless = unstable && unstable->kind == "growth" && !isGrave(result, 1e-5);
  const bool isCause = unstable && unstable->kind == "unstable" && overflowsFirst(report);
  if (isCause) report.verdicts.push_back(*unstable);
  addExceptions(report, false);
  const bool hasDecided = isGrave(result, 1e-4);
  if (hasDecided) addOrder(report);
  const auto comesFirst = [&](const DecisionRecord& each) {
    return hasDecided && mayCauseErrors(report, each);
  };
  addDecisions(report, false, comesFirst);
  if (unstable && !isHarmless && !isCause) report.verdicts.push_back(*unstable);
  addExceptions(report, true);
  if (isGrave(result, 2e-7)) addShares(report, result);
  addDecisions(report, false, std::not_fn(comesFirst));
  if (report.verdicts.empty()) addDecisions(report, true, [](const DecisionRecord&) { return true; });
  addFlushes(report);
  if (report.verdicts.empty()) addLost(report);
  addRest(report, result);
  if (isHarmless) report.verdicts.push_back(*unstable);
}

}  // namespace sk::shadow
