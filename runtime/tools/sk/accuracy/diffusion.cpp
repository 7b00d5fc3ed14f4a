// SPDX-License-Identifier: MIT
//
// Diffusion on a torus, in which each step starts from the rounded result of the previous one: shows how the
// precision of arithmetic and of storage affects a simulation. The sum should be constant; its change is
// reported as drift.
#include <cmath>
#include <memory>
#include <numeric>

#include <fmt/format.h>

#include "accuracy/accuracy.sk.hpp"
#include "accuracy/experiment.hpp"
#include "accuracy/programs.hpp"
#include "info/numbers.hpp"

namespace sk_tool {

namespace {

using sk::Precision;
using sk::Storage;

constexpr float rate = 0.2F;
constexpr int steps = 200;
constexpr int timedSteps = 4;  ///< both even, so that results are in the first stream

struct DiffusionMode {
  const char* name;
  Precision precision;
  Storage storage;
  sk::Contraction contraction = sk::Contraction::Exact;
};

constexpr DiffusionMode modes[] = {
    {"single", Precision::Single, Storage::Single},
    {"contracted", Precision::Single, Storage::Single, sk::Contraction::Fast},
    {"half storage", Precision::Single, Storage::Half},
    {"half", Precision::Half, Storage::Half},
    {"extended", Precision::Extended, Storage::Single},
    {"extended storage", Precision::Extended, Storage::Extended},
    {"double", Precision::Double, Storage::Single},
    {"double storage", Precision::Double, Storage::Double},
};

/// A field in two streams that alternate.
class Field {
 public:
  Field(sk::Device& device, const sk::Shape& shape, const DiffusionMode& mode,
        const std::vector<float>& start)
      : mode_(mode),
        now_(device.stream<float>(shape, mode.storage)),
        next_(device.stream<float>(shape, mode.storage)) {
    now_.write(start);
  }

  void advance(int count) {
    const auto step =
        accuracy::diffuse.with({.precision = mode_.precision, .contraction = mode_.contraction});
    for (int i = 0; i < count; i += 2) {
      step(rate, now_, next_);
      step(rate, next_, now_);
    }
  }

  std::vector<double> values() const { return now_.readReals(); }

 private:
  DiffusionMode mode_;
  sk::Stream<float> now_, next_;
};

double massOf(const std::vector<double>& field) {
  return static_cast<double>(std::accumulate(field.begin(), field.end(), 0.0L));
}

/// The steps in long double on the host, so that doubles are not judged by doubles.
std::vector<long double> rightField(const std::vector<float>& start, std::size_t side) {
  std::vector<long double> now(start.begin(), start.end()), next(start.size());
  for (int step = 0; step < steps; ++step) {
    for (std::size_t y = 0; y < side; ++y) {
      const long double* const here = now.data() + y * side;
      const long double* const above = now.data() + (y + side - 1) % side * side;
      const long double* const below = now.data() + (y + 1) % side * side;
      for (std::size_t x = 0; x < side; ++x) {
        const long double sides = here[(x + 1) % side] + here[(x + side - 1) % side] + above[x] + below[x];
        next[y * side + x] = here[x] + rate * (sides - 4 * here[x]);
      }
    }
    now.swap(next);
  }
  return now;
}

Grade gradeField(const std::vector<double>& field, const std::vector<long double>& right, double mass) {
  long double difference = 0, norm = 0;
  for (std::size_t i = 0; i < field.size(); ++i) {
    difference += (field[i] - right[i]) * (field[i] - right[i]);
    norm += right[i] * right[i];
  }
  const auto relative = static_cast<double>(std::sqrt(difference / norm));
  return {.metrics = {{"rel err", std::isfinite(relative) ? relative : HUGE_VAL},
                      {"mass drift", (massOf(field) - mass) / mass}}};
}

/// Multiples of 1/1024, which halves represent exactly, so that only the steps contribute errors.
std::vector<float> startField(std::size_t count) {
  Numbers numbers(inputSeed);
  std::vector<float> field(count);
  for (float& value : field) value = static_cast<float>(std::floor(numbers.unit() * 1024) / 1024);
  return field;
}

}  // namespace

std::vector<Experiment> measureDiffusion(sk::Device& device, const Measurement& measurement) {
  const auto side = static_cast<std::int64_t>(std::ceil(std::sqrt(static_cast<double>(measurement.size))));
  const sk::Shape shape{side, side};
  const std::vector<float> start = startField(static_cast<std::size_t>(shape.size()));
  const double mass = std::accumulate(start.begin(), start.end(), 0.0);

  const std::vector<long double> right = rightField(start, static_cast<std::size_t>(side));

  std::vector<Mode> candidates;
  for (const DiffusionMode& mode : modes) {
    const bool isContracted = mode.contraction == sk::Contraction::Fast;
    if (isContracted && !device.shadingLanguage().empty()) continue;  // GL devices ignore the option
    candidates.push_back({mode.name, [&] {
                            auto field = std::make_shared<Field>(device, shape, mode, start);
                            return Trial{[field] { field->advance(timedSteps); },
                                         [field, &right, mass] {
                                           field->advance(steps - timedSteps);
                                           return gradeField(field->values(), right, mass);
                                         }};
                          }});
  }
  return {{.program = "diffusion",
           .data = "random",
           .about = fmt::format("{} steps of {} x {} cells", steps, side, side),
           .bounded = "",
           .rows = compareModes(device, candidates, measurement.rounds)}};
}

}  // namespace sk_tool
