// SPDX-License-Identifier: MIT
#include "account.hpp"

#include <algorithm>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "support/stopwatch.hpp"
#include "support/table.hpp"

namespace examples {
namespace {

constexpr int rounds = 7;

/// One of the two models, on the same device, from the same state.
class Contender {
 public:
  Contender(sk::Device& device, const Model& model, const State& state)
      : device_(device), lattice_(device, model) {
    for (const Field field : fieldsOf(model)) {
      const auto values = state.find(field);
      if (values != state.end())
        lattice_.write(field, values->second);
      else if (field == Field::U)
        lattice_.write(field, std::vector<double>(static_cast<std::size_t>(model.grid.cells()), 1.0));
    }
    cost_.operators = fmt::format("{}", fmt::join(operatorsOf(model), ", "));
    const sk::PassCount count = passesOf(device_, [&] { lattice_.advance(1); });
    cost_.streams = lattice_.streams();
    cost_.passes = static_cast<double>(count.passes);
    cost_.bytes = static_cast<double>(count.bytesRead + count.bytesWritten);
  }

  /// How many steps take some ten milliseconds.
  int stepsForRound() { return std::clamp(static_cast<int>(30.0 / std::max(timeOf(3), 1e-3)), 1, 200); }
  void round(int steps) { times_.push_back(timeOf(steps) / steps); }
  Cost cost() {
    cost_.milliseconds = median(times_);
    return cost_;
  }
  Lattice& lattice() { return lattice_; }

 private:
  double timeOf(int steps) {
    return millisecondsOf(device_, [&] { lattice_.advance(steps); });
  }

  sk::Device& device_;
  Lattice lattice_;
  Cost cost_;
  std::vector<double> times_;
};

std::string bytes(double n) {
  if (n >= 1e6) return fmt::format("{:.1f} MB", n / 1e6);
  return fmt::format("{:.1f} kB", n / 1e3);
}

}  // namespace

Account accountFor(sk::Device& device, const Scene& scene, const State& state) {
  Contender own(device, scene.model, state);
  Contender full(device, fullModel(scene.model), state);
  // After one step from the same state: later, fields that are chaotic differ by more than roundings.
  Verification agreement("the full model's step against the scene's", 8 * roundoff,
                         "8 roundings of the largest number: neutral operators change nothing");
  for (const auto& [field, before] : state) {
    const std::vector<double> a = own.lattice().read(field), b = full.lattice().read(field);
    double largest = 1e-30;
    for (const double value : a) largest = std::max(largest, std::abs(value));
    for (std::size_t i = 0; i < a.size(); ++i)
      agreement.compare(static_cast<std::int64_t>(i), b[i], a[i], largest);
  }
  const int steps = full.stepsForRound();
  own.round(steps);
  for (int i = 0; i < rounds; ++i) {
    own.round(steps);
    full.round(steps);
  }
  return {own.cost(), full.cost(), agreement};
}

std::string Account::text() const {
  Table table({"", "operators", "streams", "passes a step", "bytes a step", "ms a step"});
  const auto add = [&](const char* name, const Cost& c) {
    table.add({name, c.operators, fmt::format("{}", c.streams), fmt::format("{:.0f}", c.passes),
               bytes(c.bytes), fmt::format("{:.3g}", c.milliseconds)});
  };
  add("this scene", scene);
  add("all operators", full);
  table.add({"ratio", "", fmt::format("{:.2f}", static_cast<double>(full.streams) / scene.streams),
             fmt::format("{:.2f}", full.passes / scene.passes),
             fmt::format("{:.2f}", full.bytes / scene.bytes),
             fmt::format("{:.2f}", full.milliseconds / scene.milliseconds)});
  return table.text();
}

}  // namespace examples
