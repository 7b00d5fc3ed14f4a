// SPDX-License-Identifier: MIT
#include "stress/judge.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

namespace sk_tool::stress {

std::string_view nameOf(Finding::Kind kind) {
  using enum Finding::Kind;
  switch (kind) {
    case Crash: return "crash";
    case Unended: return "unended";
    case Status: return "status";
    case NotFinite: return "notFinite";
    case Spread: return "spread";
    case Unconverged: return "unconverged";
    case Unstable: return "unstable";
    case Inexact: break;
  }
  return "inexact";
}

bool Run::isBroken() const {
  using enum Finding::Kind;
  return std::ranges::any_of(findings, [&](const Finding& finding) {
    if (finding.kind == Crash) return true;
    if (finding.kind == Spread) return false;
    // a program may refuse a size
    if (finding.kind == Status) return of.kind == Case::Kind::Value && of.mustHold;
    return of.mustHold || of.kind != Case::Kind::Value;
  });
}

double digitsOf(double error) {
  if (!(error > 0)) return std::isnan(error) ? 0 : 16;
  return std::clamp(-std::log10(error), 0.0, 16.0);
}

namespace {

std::string quantity(std::int64_t count, std::string_view one, std::string_view many) {
  return fmt::format("{} {}", count, count == 1 ? one : many);
}

class Judge {
 public:
  Judge(const Run& run, const Run& plain) : run_(run), plain_(plain), isPlain_(&run == &plain) {}

  std::vector<Finding> judge() {
    addEnd();
    if (!run_.seen) return std::move(findings_);
    addResults();
    addLoops();
    addCalls();
    addUnstable();
    addErrors();
    return std::move(findings_);
  }

 private:
  void add(Finding::Kind kind, std::string text) { findings_.push_back({kind, std::move(text)}); }

  void addEnd() {
    const EndedProcess& process = run_.process;
    if (process.failure().empty()) return;
    if (process.isSignalled()) return add(Finding::Kind::Crash, process.failure());
    if (process.status) {
      if (!isPlain_) add(Finding::Kind::Status, process.failure());
      return;
    }
    std::string text = process.failure();
    if (!isPlain_) text += fmt::format(", and takes {:.2g} s as it is", plain_.process.wall);
    if (run_.seen) text += fmt::format("; it had made {}", quantity(run_.seen->calls, "call", "calls"));
    add(Finding::Kind::Unended, text);
  }

  void addResults() {
    bool isFirst = true;
    for (const Result& result : run_.seen->results) {
      const Result* const before = isPlain_ || !plain_.seen ? nullptr : plain_.seen->resultNamed(result.name);
      if (result.withoutValue <= (before == nullptr ? 0 : before->withoutValue)) continue;
      std::string text = run_.of.hasNan
                             ? fmt::format("the NaN spreads to {} of {} of '{}'", result.withoutValue,
                                           quantity(result.elements, "element", "elements"), result.name)
                             : fmt::format("{} of {} of '{}' {} NaN or infinite", result.withoutValue,
                                           quantity(result.elements, "element", "elements"), result.name,
                                           result.withoutValue == 1 ? "is" : "are");
      if (isFirst && run_.seen->origin && !run_.of.hasNan) text += originText(*run_.seen->origin);
      isFirst = false;
      add(run_.of.hasNan ? Finding::Kind::Spread : Finding::Kind::NotFinite, text);
    }
  }

  static std::string originText(const Origin& origin) {
    return fmt::format("; the first {} comes from {}, call {}, output '{}'{}",
                       origin.isNan ? "NaN" : "infinity", origin.kernel, origin.call, origin.output,
                       origin.isInReference ? ", in double as well" : ", where double has a number");
  }

  void addLoops() {
    for (const LoopEnd& loop : run_.seen->loops) {
      if (loop.unfinished == 0) continue;
      std::string before;
      if (!isPlain_ && plain_.seen) {
        const auto found = std::ranges::find(plain_.seen->loops, loop.condition, &LoopEnd::condition);
        if (found != plain_.seen->loops.end() && found->unfinished > 0) continue;
        if (found != plain_.seen->loops.end()) before = fmt::format(", {} as it is", found->longest);
      }
      add(Finding::Kind::Unconverged,
          fmt::format("the loop until '{}' stops at its limit: {}{}", loop.condition,
                      quantity(loop.longest, "iteration", "iterations"), before));
    }
  }

  /// Loops of the program itself, which no runtime sees, show in the calls that they make.
  void addCalls() {
    constexpr double many = 2;
    if (isPlain_ || run_.of.kind == Case::Kind::Size || !plain_.seen) return;
    const Calls* most = nullptr;
    std::int64_t before = 0;
    double largest = many;
    for (const Calls& each : run_.seen->kernels) {
      const auto found = std::ranges::find(plain_.seen->kernels, each.kernel, &Calls::kernel);
      if (found == plain_.seen->kernels.end() || found->calls == 0) continue;
      const double ratio = static_cast<double>(each.calls) / static_cast<double>(found->calls);
      if (ratio <= largest) continue;
      largest = ratio;
      most = &each;
      before = found->calls;
    }
    if (most == nullptr) return;
    add(Finding::Kind::Unconverged,
        fmt::format("calls {} {} times, {} as it is: what it waits for comes late or never", most->kernel,
                    most->calls, before));
  }

  void addUnstable() {
    const bool wasUnstable = !isPlain_ && plain_.seen && !plain_.seen->unstable.empty();
    if (!run_.seen->unstable.empty() && !wasUnstable) add(Finding::Kind::Unstable, run_.seen->unstable);
  }

  void addErrors() {
    constexpr double large = 1e-2, usual = 1e-3;
    const bool isElsewhere = std::ranges::any_of(findings_, [](const Finding& finding) {
      return finding.kind == Finding::Kind::NotFinite || finding.kind == Finding::Kind::Spread;
    });
    const Result* const worst = run_.seen->worst();
    if (worst == nullptr || isElsewhere || !(worst->error > large)) return;
    if (isPlain_) {
      return add(Finding::Kind::Inexact,
                 fmt::format("{:.1f} digits of '{}' survive", digitsOf(worst->error), worst->name));
    }
    const Result* const before = plain_.seen ? plain_.seen->resultNamed(worst->name) : nullptr;
    if (before != nullptr && before->error > usual) return;
    const std::string usually =
        before == nullptr ? "" : fmt::format(", {:.1f} as it is", digitsOf(before->error));
    add(Finding::Kind::Inexact,
        fmt::format("{:.1f} digits of '{}' survive{}", digitsOf(worst->error), worst->name, usually));
  }

  const Run &run_, &plain_;
  const bool isPlain_;
  std::vector<Finding> findings_;
};

}  // namespace

std::vector<Finding> findingsIn(const Run& run, const Run& plain) { return Judge(run, plain).judge(); }

}  // namespace sk_tool::stress
