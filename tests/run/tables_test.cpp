// SPDX-License-Identifier: MIT
//
// Promises: a function with a table is looked up, within the error that the device reports, in every kind of kernel and on
// every device; it is computed instead if a call, a kernel's declaration, a file or a precision says so.
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <string>
#include <vector>

#include <catch2/catch.hpp>

#include "error_of.hpp"
#include "sk/sk.hpp"
#include "support/configuration_file.hpp"
#include "support/devices.hpp"
#include "tables.sk.hpp"

namespace run_tests {
namespace {

constexpr float nan = std::numeric_limits<float>::quiet_NaN();
constexpr float infinity = std::numeric_limits<float>::infinity();

sk::Stream<float> streamOf(sk::Device& device, const std::vector<float>& values) {
  auto stream = device.stream<float>({static_cast<std::int64_t>(values.size())});
  stream.write(values);
  return stream;
}

/// Evenly spaced numbers over a range, including both ends.
std::vector<float> ramp(float low, float high, std::size_t count) {
  std::vector<float> values(count);
  for (std::size_t i = 0; i < count; ++i) {
    values[i] = low + (high - low) * static_cast<float>(i) / static_cast<float>(count - 1);
  }
  return values;
}

double bell(double x) { return std::exp(-x * x); }

template <class Kernel>
std::vector<float> called(sk::Device& device, const Kernel& kernel, const std::vector<float>& x) {
  auto r = device.stream<float>({static_cast<std::int64_t>(x.size())});
  kernel(streamOf(device, x), r);
  return r.read();
}

template <class Function>
double largestError(const std::vector<float>& x, const std::vector<float>& got, const Function& right) {
  double largest = 0;
  for (std::size_t i = 0; i < x.size(); ++i) largest = std::max(largest, std::abs(got[i] - right(x[i])));
  return largest;
}

sk::TableReport reportOf(const sk::Device& device, const std::string& function) {
  const std::vector<sk::TableReport> reports = device.tables();
  const auto found = std::ranges::find(reports, function, &sk::TableReport::function);
  REQUIRE(found != reports.end());
  return *found;
}

TEST_CASE("a linear table's error is what theory says, and what the device tells") {
  onEveryTarget([](sk::Device& device) {
    const std::vector<float> x = ramp(-4, 4, 30000);
    const double error = largestError(x, called(device, table::bells, x), bell);
    const sk::TableReport report = reportOf(device, "table::bell");
    // The error of linear interpolation is h^2/8 max |f''|, and |f''| is 2 at 0.
    const double h = 8.0 / 1024;
    CHECK(report.predicted == Approx(h * h / 4).epsilon(0.1));  // plus roundings
    CHECK(report.measured <= report.predicted);
    CHECK(report.measured > 0.9 * h * h / 4);
    CHECK(std::abs(report.worst) < 4 * h);
    CHECK(error <= report.predicted);
    CHECK(error > 0.9 * h * h / 4);
    CHECK(report.range == sk::TableRange{-4, 4, 1024});
    CHECK(report.interpolation == sk::Interpolation::Linear);
  });
}

TEST_CASE("a cubic one's is below what floats round") {
  onEveryTarget([](sk::Device& device) {
    const std::vector<float> x = ramp(0, 6.2831853F, 30000);
    auto r = device.stream<float>({30000});
    auto s = device.stream<float>({30000});
    table::waves(streamOf(device, x), r, s);
    const double error = largestError(x, r.read(), [](double v) { return std::sin(v); });
    const sk::TableReport report = reportOf(device, "table::wave");
    CHECK(report.interpolation == sk::Interpolation::Cubic);
    CHECK(report.measured <= report.predicted);
    CHECK(error <= report.predicted);
    CHECK(report.predicted < 2e-6);
    CHECK(largestError(x, s.read(), [](double v) { return v > 4 ? bell(4) : bell(v); }) < 2e-5);
  });
}

TEST_CASE("a predicted error is a bound where the function changes faster than the table") {
  onSomeLayouts([](sk::Device& device) {
    const auto isBounded = [&](const auto& kernel, const char* function, float low, float high,
                               const auto& right) {
      const std::vector<float> x = ramp(low, high, 30000);
      const double error = largestError(x, called(device, kernel, x), right);
      const sk::TableReport report = reportOf(device, function);
      CHECK(error > 0.9);
      CHECK(report.predicted >= error);
      CHECK(report.measured > 0.9);
      CHECK(report.measured <= report.predicted);
      CHECK(report.predicted < 1.5 * error);
    };
    isBounded(table::ripples, "table::ripple", -3.1415927F, 3.1415927F,
              [](double v) { return std::sin(16 * v); });
    isBounded(table::peaks, "table::peak", -8, 8, [](double v) { return std::exp(-20 * std::abs(v)); });
    const std::string error = errorOf([&] { called(device, table::noises, {1}); });
    CHECK(error.find("the table of 'table::noise' over [-4, 4]: the function changes so fast between") !=
          std::string::npos);
    CHECK(called(device, table::noises.with({.tables = sk::Tables::Off}), {0}) == std::vector<float>{0});
  });
}

TEST_CASE("arguments outside the range count as its ends, and NaN stays NaN") {
  onEveryTarget([](sk::Device& device) {
    const std::vector<float> got =
        called(device, table::bells, {-4, -4.001F, -1e30F, -infinity, 4, 4.001F, 1e30F, infinity, nan});
    for (std::size_t i = 0; i + 1 < got.size(); ++i) {
      INFO(i);
      CHECK(got[i] == Approx(bell(4)).epsilon(1e-5));
    }
    CHECK(std::isnan(got.back()));
  });
}

TEST_CASE("tables are continuous where intervals meet") {
  onEveryTarget([](sk::Device& device) {
    std::vector<float> x;
    for (int i = 1; i < 256; ++i) {
      const float node = static_cast<float>(i) * (6.2831853F / 256);
      x.push_back(std::nextafter(node, 0.0F));
      x.push_back(std::nextafter(node, 9.0F));
    }
    auto r = device.stream<float>({static_cast<std::int64_t>(x.size())});
    auto s = device.stream<float>({static_cast<std::int64_t>(x.size())});
    table::waves(streamOf(device, x), r, s);
    const std::vector<float> wave = r.read();
    for (std::size_t i = 0; i < x.size(); i += 2) CHECK(std::abs(wave[i] - wave[i + 1]) < 1.5e-6F);
  });
}

TEST_CASE("a table of many intervals lies in several rows") {
  onSomeLayouts([](sk::Device& device) {
    const std::vector<float> x = ramp(0, 1, 50000);
    CHECK(largestError(x, called(device, table::fines, x), [](double v) { return v * v; }) < 3e-7);
    CHECK(reportOf(device, "table::fine").range.intervals == 1 << 16);
  });
}

TEST_CASE("a call, a declaration and a precision compute the function") {
  onEveryTarget([](sk::Device& device) {
    const std::vector<float> x = ramp(-4, 4, 1000);
    const std::vector<float> looked = called(device, table::bells, x);
    const auto isComputed = [&](const auto& kernel) {
      return largestError(x, called(device, kernel, x), bell) < 2e-7;
    };
    CHECK(largestError(x, looked, bell) > 5e-6);
    CHECK(isComputed(table::bells.with({.tables = sk::Tables::Off})));
    CHECK(isComputed(table::computed));
    CHECK(called(device, table::computed.with({.tables = sk::Tables::On}), x) == looked);
    CHECK(called(device, table::bells.with({.tables = sk::Tables::On}), x) == looked);
    const auto both = table::bells.with({.precision = sk::Precision::Extended, .tables = sk::Tables::On});
    CHECK(
        errorOf([&] {
          called(device, both, x);
        }).find("tables have the precision of floats; call it in Precision::Single, or without Tables::On") !=
        std::string::npos);
  });
}

TEST_CASE("reductions, pushes and functions of functions look up, too") {
  onSomeLayouts([](sk::Device& device) {
    const std::vector<float> x = ramp(-0.5, 0.5, 5000);  // here every chord is below the curve
    const auto stream = streamOf(device, x);
    double looked = 0;
    for (const float v : called(device, table::bells, x)) looked += v;
    CHECK(table::total(stream) == Approx(looked).epsilon(1e-6));
    double right = 0;
    for (const float v : x) right += bell(v);
    const auto off = table::total.with({.tables = sk::Tables::Off});
    CHECK(off(stream) == Approx(right).epsilon(2e-7));
    CHECK(table::total(stream) < off(stream));

    auto pushed = device.stream<float>({1});
    table::pushed(stream, pushed);
    std::vector<float> expected = called(device, table::bells, x);
    std::erase_if(expected, [](float v) { return !(v > 0.9F); });
    CHECK(pushed.read() == expected);

    const auto shared = [](double v) { return std::sin(v) + bell(v); };
    const std::vector<float> between = ramp(1, 2, 1000);
    CHECK(largestError(between, called(device, table::nested, between), shared) < 4e-5);
    CHECK(reportOf(device, "table::shared").measured < 4e-5);
  });
}

TEST_CASE("tables and pyramids count among the texture units of a kernel that pushes") {
  sk::Device device(sk::DeviceOptions{.device = "software", .profile = "glsl330"});
  REQUIRE(device.limits().textureUnits == 32);  // as in every Mesa since 10
  const auto pushed = [&](const auto& kernel, auto element, sk::Tables tables) {
    auto x = device.stream<decltype(element)>({2});
    element.x0 = 1;
    x.fill(element);
    auto r = device.stream<float>({5});
    kernel.with({.tables = tables})(x, r);
    return r.read();
  };
  const table::Crowd29 fits{};
  const table::Crowd30 more{};
  const auto isRight = [](const std::vector<float>& got) {
    return got.size() == 2 && got[0] == got[1] && std::abs(got[0] - bell(1)) < 1e-4;
  };
  CHECK(isRight(pushed(table::pushed29, fits, sk::Tables::On)));
  CHECK(isRight(pushed(table::pushed30, more, sk::Tables::Off)));
  const std::string error = errorOf([&] { pushed(table::pushed30, more, sk::Tables::On); });
  CHECK(error ==
        "table::pushed30: its streams and the tables of its functions take 33 texture units, but this device "
        "has "
        "32; call it with Tables::Off");
}

TEST_CASE("the reference computes every function") {
  sk::Device device = sk::Device::reference();
  const std::vector<float> x = ramp(-4, 4, 100);
  CHECK(largestError(x, called(device, table::bells, x), bell) < 6e-8);
  CHECK(device.tables().empty());
}

TEST_CASE("a function that is not finite in its range has no table") {
  onEveryTarget([](sk::Device& device) {
    const std::string error = errorOf([&] { called(device, table::poles, {1}); });
    CHECK(error.find("the table of 'table::pole' over [-1, 1]: its value at 0 is") != std::string::npos);
    CHECK(called(device, table::poles.with({.tables = sk::Tables::Off}), {2}) == std::vector<float>{0.5F});
    CHECK_FALSE(errorOf([&] { called(device, table::poles, {1}); }).empty());  // again
  });
}

TEST_CASE("ranges that floats cannot divide have no table") {
  onEveryTarget([](sk::Device& device) {
    const auto isNamed = [&](const auto& kernel, const std::string& what) {
      const std::string error = errorOf([&] { called(device, kernel, {0, 1e38F}); });
      return error.find(what) != std::string::npos &&
             error.find("64 interval(s) are too wide or too narrow for floats") != std::string::npos;
    };
    CHECK(isNamed(table::wides, "the table of 'table::wide' over [-3e+38, 3e+38]"));
    CHECK(isNamed(table::narrows, "the table of 'table::narrow' over [0, 1.2e-38]"));
  });
}

TEST_CASE("a file gives a table another range, or none") {
  const ConfigurationFile file(
      "[tables.\"table::bell\"]\nlow = -2\nhigh = 2.0\nintervals = 4096\n"
      "[kernels.\"table::fines\"]\ntables = \"off\"\n");
  for (const bool isNative : {false, true}) {
    sk::Device device({.device = isNative ? "native" : "gl", .configuration = file.path});
    const std::vector<float> x = ramp(-2, 2, 10000);
    CHECK(largestError(x, called(device, table::bells, x), bell) < 6e-7);
    CHECK(reportOf(device, "table::bell").range == sk::TableRange{-2, 2, 4096});
    CHECK(called(device, table::bells, {3}).front() == Approx(bell(2)).epsilon(1e-5));
    called(device, table::fines, {1});
    CHECK(device.tables().size() == 1);
  }
}

TEST_CASE("mistakes in a file are told") {
  const auto errorIn = [](const std::string& text) {
    const ConfigurationFile file(text);
    return errorOf([&] {
      sk::Device device({.device = "native", .configuration = file.path});
      called(device, table::bells, {1});
    });
  };
  CHECK(errorIn("[tables.\"table::bell\"]\nlow = 5\n")
            .find(":1: the table of 'table::bell' begins at 5 and ends at 4") != std::string::npos);
  CHECK(errorIn("[tables.a]\nintervals = 0\n").find(":2: intervals is a whole number from 1 to 1048576") !=
        std::string::npos);
  CHECK(errorIn("[tables.a]\nlow = nan\n").find(":2: low is a number") != std::string::npos);
  CHECK(errorIn("[tables.a]\nsize = 3\n").find(":2: a table has no 'size'") != std::string::npos);
  CHECK(errorIn("[streams.u]\nstorage = \"quad\"\n").find(":2: storage is one of \"single\", \"half\"") !=
        std::string::npos);
  CHECK(errorIn("[streams.u]\nprecision = \"half\"\n")
            .find(":2: a stream has no 'precision'; it has storage") != std::string::npos);
  CHECK(errorIn("[streams.u]\n").find(":1: expected storage = \"half\" or the like for stream 'u'") !=
        std::string::npos);
  CHECK(errorIn("tables = 3\n").find(":1: expected tables like") != std::string::npos);
}

}  // namespace
}  // namespace run_tests
