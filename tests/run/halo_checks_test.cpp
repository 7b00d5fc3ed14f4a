// SPDX-License-Identifier: MIT
//
// Promises: with SK_CHECK=halos, a call that reads a gather beyond its promise throws an error that names the gather, the
// dimension and an element, on every target; calls that keep their promises give the results that they give without.
#include <string>
#include <vector>

#include <catch2/catch.hpp>

#include "error_of.hpp"
#include "halo_checks.sk.hpp"
#include "sk/placed.hpp"
#include "sk/sk.hpp"
#include "support/devices.hpp"

namespace run_tests {
namespace {

TEST_CASE("a read beyond the promise is an error, and one within it is none") {
  onEveryTarget([](sk::Device& device) {
    constexpr int count = 20;
    auto u = device.stream<float>({count}), r = device.stream<float>({count});
    auto at = device.stream<int>({count});
    std::vector<float> values(count), expected(count);
    std::vector<int> indices(count);
    for (int i = 0; i < count; ++i) {
      values[i] = static_cast<float>(i * i);
      indices[i] = i + i % 5 - 2;
      expected[i] = values[i];
    }
    for (int i = 0; i < count; ++i) expected[i] = values[std::min(std::max(indices[i], 0), count - 1)];
    u.write(values);
    at.write(indices);
    CHECK(errorOf([&] { taken(u, at, r); }) == "no error");
    CHECK(r.read() == expected);
    indices[7] = 10;
    at.write(indices);
    CHECK(errorOf([&] { taken(u, at, r); }) ==
          "taken: 'u' is read more than 2 before or 2 after the element along x, by elements with index 7 "
          "there; correct its "
          "[[halo]]");
    indices[7] = 7;
    indices[19] = 16;
    at.write(indices);
    CHECK(errorOf([&] { taken(u, at, u); }).find("index 19") != std::string::npos);
    CHECK(u.read() == values);
  });
}

TEST_CASE("each dimension has its own promise, and wrapping is near") {
  onEveryTarget([](sk::Device& device) {
    const sk::Shape shape{9, 12};
    auto u = device.stream<sk::int2>(shape), r = device.stream<sk::int2>(shape),
         by = device.stream<sk::int2>(shape);
    std::vector<sk::int2> values;
    for (int i = 0; i < 108; ++i) values.push_back({i, -i});
    u.write(values);
    std::vector<sk::int2> steps(108, {1, -3});
    by.write(steps);
    CHECK(errorOf([&] { moved(u, by, r); }) == "no error");
    CHECK(r.read()[0].x == 6 * 12 + 1);
    steps[25] = {1, 4};
    by.write(steps);
    CHECK(errorOf([&] { moved(u, by, r); }).find("3 after the element along y, by elements with index 2") !=
          std::string::npos);
    steps[25] = {-2, 3};
    by.write(steps);
    CHECK(errorOf([&] { moved(u, by, r); }).find("1 after the element along x, by elements with index 1") !=
          std::string::npos);
  });
}

TEST_CASE("elements that floats do not hold are no error") {
  sk::Device& native = device("native");
  const sk::Shape shape{7, 9};
  auto u = native.stream<float>(shape, sk::Storage::Double), r = native.stream<float>(shape);
  std::vector<double> values;
  for (int i = 0; i < 63; ++i) values.push_back(0.1 * i);
  u.writeReals(values);
  CHECK(errorOf([&] { known.with({.precision = sk::Precision::Double})(1, u, r); }) == "no error");
}

TEST_CASE("positions between elements and reaches that skc knows are tested, too") {
  onGlAndNative([](sk::Device& device) {
    auto u = device.stream<float>({16}), by = device.stream<float>({16}), r = device.stream<float>({16});
    for (const float step : {0.5F, -1.0F, 1.75F}) {
      u.fill(3);
      by.fill(step);
      CHECK((errorOf([&] { between(u, by, r); }) == "no error") == (step < 1.5F));
    }
    auto plane = device.stream<float>({6, 100}), sums = device.stream<float>({6, 100});
    plane.fill(2);
    CHECK(errorOf([&] { known(12, plane, sums); }) == "no error");
    CHECK(sums.read()[300] == 100);
  });
}

TEST_CASE(
    "reads of placed streams beyond the promise, or beyond what is held, are errors that name the element") {
  onEveryTarget([](sk::Device& device) {
    const sk::Shape held{9, 12};
    auto u = device.stream<sk::int2>(held), r = device.stream<sk::int2>(held),
         by = device.stream<sk::int2>(held);
    std::vector<sk::int2> values, steps(108, {1, -3});
    for (int i = 0; i < 108; ++i) values.push_back({i, -i});
    u.write(values);
    const sk::Placement place{{996, -1}, {1000, 500}};
    const sk::Box box{{999, 0}, {1000, 10}};
    const auto message = [&] {
      by.write(steps);
      return errorOf([&] {
        moved.with({.box = box})(sk::placed(u, place), sk::placed(by, place), sk::placed(r, place));
      });
    };
    CHECK(message() == "no error");
    CHECK(r.read()[3 * 12 + 1].x == 2);
    steps[3 * 12 + 4] = {-2, 0};
    CHECK(message() ==
          "moved: 'u' is read more than 1 before the element along x, by the element with index {999, 3}; "
          "correct its "
          "[[halo]]");
    steps[3 * 12 + 4] = {0, 400000};  // wraps to the element's own row
    CHECK(message() == "no error");
    steps[3 * 12 + 4] = {0, 500};
    CHECK(message().find("along y, by the element with index {999, 3}") != std::string::npos);
  });
}

TEST_CASE("promises about grids of other extents count from the same relative place") {
  onEveryTarget([](sk::Device& device) {
    for (const bool isFiner : {false, true}) {
      const sk::Shape shape = isFiner ? sk::Shape{5, 7} : sk::Shape{11, 15},
                      other = isFiner ? sk::Shape{11, 15} : sk::Shape{5, 7};
      auto u = device.stream<float>(other), r = device.stream<float>(shape);
      auto by = device.stream<sk::int2>(shape);
      std::vector<float> values;
      for (int i = 0; i < other.size(); ++i) values.push_back(static_cast<float>(i * i));
      u.write(values);
      std::vector<sk::int2> steps(static_cast<std::size_t>(shape.size()), {1, -2});
      const std::int64_t x = shape[1] / 2;
      const auto at = static_cast<std::size_t>(shape[1] + x);
      const auto message = [&] {
        by.write(steps);
        return errorOf([&] { elsewhere(u, by, r); });
      };
      CHECK(message() == "no error");
      steps[at] = {-2, 0};
      CHECK(message().find("1 after the element along x, by elements with index " + std::to_string(x) +
                           " there") != std::string::npos);
      steps[at] = {0, 3};
      CHECK(message().find("2 after the element along y, by elements with index 1 there") !=
            std::string::npos);

      const sk::Placement place{{0, 0}, {2 * shape[0], 2 * shape[1]}},
          ofOther{{0, 0}, {2 * other[0], 2 * other[1]}};
      const auto ofParts = [&](const sk::int2& step) {
        steps.assign(steps.size(), {1, -2});
        steps[static_cast<std::size_t>(shape[1] + 3)] = step;
        by.write(steps);
        return errorOf([&] {
          elsewhere.with({.box = {{0, 0}, {3, 4}}})(sk::placed(u, ofOther), sk::placed(by, place),
                                                    sk::placed(r, place));
        });
      };
      CHECK(ofParts({1, 2}) == "no error");
      CHECK(ofParts({0, 3}) ==
            "elsewhere: 'u' is read more than 2 after the element along y, by the element with index {1, 3}; "
            "correct its [[halo]]");
    }
  });
}

}  // namespace
}  // namespace run_tests
