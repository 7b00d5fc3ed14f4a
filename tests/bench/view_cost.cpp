// SPDX-License-Identifier: MIT
#include "view_cost.hpp"

#include <cstdint>
#include <string>

#include <fmt/format.h>

#include "bench.sk.hpp"
#include "rounds.hpp"
#include "side_by_side.hpp"

namespace bench {
namespace {

constexpr std::int64_t viewSide = 1024;

/// Streams of the shape of every second column, and larger ones that have such columns and planes.
struct Streams {
  explicit Streams(sk::Device& device)
      : x(device.stream<float>({viewSide, viewSide / 2})),
        y(device.stream<float>({viewSide, viewSide / 2})),
        small(device.stream<float>({viewSide / 2, viewSide / 2})),
        wide(device.stream<float>({viewSide, viewSide})),
        volume(device.stream<float>({3, viewSide / 2, viewSide})) {
    for (sk::Stream<float>* stream : {&x, &y, &small, &wide, &volume})
      stream->write(ramp(stream->size(), 0.37f));
  }
  sk::View<float> columns() { return sk::stride(wide, {1, 2}); }
  sk::View<float> quarter(int row, int column) { return sk::stride(wide, {2, 2}, {row, column}); }
  sk::View<float> plane() {
    return volume.domain({1, 0, 0}, {2, viewSide / 2, viewSide}).reshape({viewSide, viewSide / 2});
  }

  sk::Stream<float> x, y, small, wide, volume;
};

}  // namespace

void viewCosts(sk::Device& device, std::string_view name, sk::Target target, int rounds,
               double sampleMilliseconds, Report& report) {
  Streams s(device);
  const sk::CallOptions options{.target = target};
  const auto plus = add.with(options);
  const auto curve = wave.with(options);
  const auto total = sum.with(options);
  const auto compared = [&](const char* what, auto&& view, auto&& dense) {
    const auto repeated = [&device](auto& call) {
      return [&device, &call](int times) {
        for (int i = 0; i < times; ++i) call();
        device.finish();
      };
    };
    Comparison all;
    compare(repeated(view), repeated(dense), rounds, sampleMilliseconds, all,
            device.isSoftware() ? Time::Processor : Time::Wall);
    report.add({fmt::format("view: {}, on {}", what, name), "x", quartilesOf(all.ratios), {}, {}});
  };
  const auto addDense = [&] { plus(1.5f, s.x, s.y); };
  compared("y = x + c, x every second column", [&] { plus(1.5f, s.columns(), s.y); }, addDense);
  compared("y = x + c, y every second column", [&] { plus(1.5f, s.x, s.columns()); }, addDense);
  compared(
      "y = x + c, both the same columns, in place", [&] { plus(1.5f, s.columns(), s.columns()); },
      [&] { plus(1.5f, s.x, s.x); });
  compared(
      "y = exp(sin(x)) * cos(x), y every second column", [&] { curve(s.x, s.columns()); },
      [&] { curve(s.x, s.y); });
  compared("a sum of every second column", [&] { total(s.columns()); }, [&] { total(s.x); });
  compared(
      "the mean of four inputs, each every second row and column, against a gather",
      [&] {
        meanOfFour.with(options)(s.quarter(0, 0), s.quarter(0, 1), s.quarter(1, 0), s.quarter(1, 1), s.small);
      },
      [&] { meanOfSquare.with(options)(s.wide, s.small); });
  compared("y = x + c, x a plane in another shape", [&] { plus(1.5f, s.plane(), s.y); }, addDense);
  compared("y = x + c, y a plane in another shape", [&] { plus(1.5f, s.x, s.plane()); }, addDense);
}

}  // namespace bench
