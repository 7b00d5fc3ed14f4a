// SPDX-License-Identifier: MIT
#include "tune/choices.hpp"

#include <algorithm>
#include <functional>
#include <numeric>
#include <optional>
#include <string_view>

#include <fmt/format.h>

namespace sk_tool::tune {

namespace {

using sk::results::Kernel;
using sk::results::Process;
using sk::results::Stream;

/// The values of a key in "precision double" and the like.
std::vector<std::string> valuesOfKey(const std::vector<std::string>& choices, const std::string& key) {
  std::vector<std::string> values;
  for (const std::string& choice : choices) {
    if (choice.starts_with(key + " ")) values.push_back(choice.substr(key.size() + 1));
  }
  return values;
}

/// Builds the steps of one kernel.
class KernelSteps {
 public:
  KernelSteps(const Kernel& kernel, Choices& choices) : kernel_(kernel), choices_(choices) {}

  void addOthers() {
    addPrecisions();
    if (kernel_.compensates && uses("precision", "single", "single")) {  // others fold as they compute
      for (const std::string_view value : {"tree", "compensated", "extended"})
        add("accumulate", value, "compensated");
      if (kernel_.sumsExactly) add("accumulate", "exact", "compensated");
    }
    if (kernel_.mayContract) addEither("contraction", "exact", "fast");
    if (kernel_.hasFastFunctions) addEither("intrinsics", "accurate", "fast");
    if (!kernel_.tables.empty()) addEither("tables", "on", "off");
  }

  void addLowered() {
    if (!kernel_.hasFloats || !isWide()) return;
    choices_.lowered.push_back({.changes = {{{"kernels", kernel_.name, "precision"}, "single"}},
                                .of = kernel_.name,
                                .seconds = kernel_.seconds});
  }

  void addRaised() {
    Setting changes;
    const auto raise = [&](const std::string& key, std::string_view value, std::string_view byDefault) {
      if (!uses(key, value, byDefault)) changes[{"kernels", kernel_.name, key}] = value;
    };
    if (kernel_.hasFloats && kernel_.whyNotWide.empty()) {
      raise("precision", "double", "single");
    } else {
      if (kernel_.sumsExactly) raise("accumulate", "exact", "compensated");
      if (!kernel_.tables.empty()) raise("tables", "off", "on");
    }
    if (kernel_.hasFastFunctions) raise("intrinsics", "accurate", "accurate");
    if (kernel_.mayContract) raise("contraction", "exact", "exact");
    if (!changes.empty())
      choices_.raised.push_back({.changes = changes, .of = kernel_.name, .seconds = kernel_.seconds});
  }

 private:
  void addPrecisions() {
    if (!kernel_.hasFloats) return leaveOut("precision", "it declares no floats, but doubles or integers");
    add("precision", "single", "single");
    if (kernel_.whyNotHalf.empty() && !kernel_.compensates) add("precision", "half", "single");
    if (kernel_.whyNotHalf.empty() && kernel_.compensates)
      leaveOut("precision half", "it sums, and would lose the sum");
    if (!kernel_.whyNotHalf.empty()) leaveOut("precision half", kernel_.whyNotHalf);
    if (!kernel_.whyNotWide.empty()) return leaveOut("precisions extended and double", kernel_.whyNotWide);
    if (!kernel_.isNative) add("precision", "extended", "single");
    add("precision", "double", "single");
  }

  void addEither(const std::string& key, std::string_view byDefault, std::string_view other) {
    add(key, byDefault, byDefault);
    add(key, other, byDefault);
  }

  void add(const std::string& key, std::string_view value, std::string_view byDefault) {
    if (uses(key, value, byDefault)) return;
    choices_.others.push_back({.changes = {{{"kernels", kernel_.name, key}, std::string(value)}},
                               .of = kernel_.name,
                               .seconds = kernel_.seconds,
                               .isUnlikely = key == "precision" && value != "single"});
  }

  /// Whether all calls have this value already.
  bool uses(const std::string& key, std::string_view value, std::string_view byDefault) const {
    const std::vector<std::string> values = valuesOfKey(kernel_.used, key);
    return std::ranges::all_of(
        values, [&](const std::string& each) { return (each == "default" ? byDefault : each) == value; });
  }

  /// Whether some calls compute in more bits than float's.
  bool isWide() const {
    return std::ranges::any_of(valuesOfKey(kernel_.used, "precision"), [](const std::string& value) {
      return value == "double" || value == "extended";
    });
  }

  void leaveOut(std::string_view what, std::string_view why) {
    choices_.untried.push_back(fmt::format("{}: {}: {}", kernel_.name, what, why));
  }

  const Kernel& kernel_;
  Choices& choices_;
};

void addStreams(const Process& run, double seconds, Choices& choices) {
  const double bytes = std::accumulate(
      run.streams.begin(), run.streams.end(), 0.0,
      [](double sum, const Stream& stream) { return sum + static_cast<double>(stream.bytes); });
  const bool isNative = std::ranges::all_of(run.devices, &sk::results::Device::isNative);
  for (const Stream& stream : run.streams) {
    const std::string name = stream.name.empty() ? "*" : stream.name;
    Step step{.changes = {}, .of = name, .isKernel = false};
    step.seconds = bytes == 0 ? 0 : seconds * static_cast<double>(stream.bytes) / bytes;
    const bool isWide = stream.storage == "double" || stream.storage == "extended";
    if (static_cast<double>(stream.bytes) < leastShare * bytes) {
      choices.untried.push_back(fmt::format("{}: {:.1f} % of the bytes of all streams",
                                            stream.name.empty() ? "streams without a name" : name,
                                            100 * static_cast<double>(stream.bytes) / bytes));
    } else {
      for (const std::string_view storage : {"half", "single"}) {
        if (storage == stream.storage) continue;
        step.changes = {{{"streams", name, "storage"}, std::string(storage)}};
        step.isUnlikely = storage == "half" && isNative;
        choices.others.push_back(step);
        if (isWide && storage == "single") choices.lowered.push_back(step);
      }
    }
    if (!isWide) {
      step.changes = {{{"streams", name, "storage"}, "double"}};
      choices.raised.push_back(step);
    }
    if (!stream.name.empty()) choices.facts.streams[stream.name] = stream.storage;
  }
}

/// What the calls of a kernel choose themselves, and precisions where a declaration's choice excludes some.
std::vector<std::string> ownChoices(const Kernel& kernel) {
  std::vector<std::string> choices = kernel.called;
  for (const std::string_view floats : {"accumulate exact", "accumulate compensated", "tables on"}) {
    if (std::ranges::find(kernel.used, floats) != kernel.used.end())
      choices.emplace_back("precision of floats");
  }
  return choices;
}

}  // namespace

Choices choicesOf(const Process& run) {
  const double seconds =
      std::accumulate(run.kernels.begin(), run.kernels.end(), 0.0,
                      [](double sum, const Kernel& kernel) { return sum + kernel.seconds; });
  Choices choices;
  for (const Kernel& kernel : run.kernels) {
    if (const std::vector<std::string> own = ownChoices(kernel); !own.empty())
      choices.facts.called[kernel.name] = own;
    KernelSteps steps(kernel, choices);
    steps.addRaised();
    if (kernel.seconds < leastShare * seconds) {
      choices.untried.push_back(fmt::format("{}: takes {:.1f} % of the kernels' time", kernel.name,
                                            seconds == 0 ? 0 : 100 * kernel.seconds / seconds));
    } else {
      steps.addOthers();
      steps.addLowered();
    }
  }
  addStreams(run, seconds, choices);
  if (std::ranges::any_of(run.kernels, &Kernel::isNative))
    choices.untried.emplace_back(
        "intrinsics, and precision extended: natively, there is one form of functions, and extended is "
        "double");
  choices.untried.emplace_back("order = \"any\": results would differ from run to run");
  choices.untried.emplace_back("target: results are the same, and the device takes the faster one");
  std::ranges::stable_sort(choices.others, std::greater(), &Step::seconds);
  std::ranges::stable_partition(choices.others, std::logical_not(), &Step::isUnlikely);
  std::ranges::stable_sort(choices.raised, std::less(), &Step::seconds);
  return choices;
}

}  // namespace sk_tool::tune
