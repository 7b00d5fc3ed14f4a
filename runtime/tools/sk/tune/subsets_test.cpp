// SPDX-License-Identifier: MIT
#include "tune/subsets.hpp"

#include <set>
#include <string>

#include <catch2/catch.hpp>

namespace {

using sk_tool::tune::Setting;
using sk_tool::tune::Step;
using sk_tool::tune::Steps;

Step stepOf(int kernel, const std::string& value = "double") {
  const std::string name = "k" + std::to_string(kernel);
  return {.changes = {{{"kernels", name, "precision"}, value}}, .of = name};
}

Steps stepsUpTo(int count) {
  Steps steps;
  for (int i = 0; i < count; ++i) steps.push_back(stepOf(i));
  return steps;
}

bool hasAll(const Setting& setting, const std::set<int>& kernels) {
  for (const int kernel : kernels) {
    if (!setting.contains({"kernels", "k" + std::to_string(kernel), "precision"})) return false;
  }
  return true;
}

std::set<int> numbersOf(const Steps& steps) {
  std::set<int> numbers;
  for (const Step& step : steps) numbers.insert(std::stoi(step.of.substr(1)));
  return numbers;
}

}  // namespace

TEST_CASE("what is needed is found among many, and nothing else") {
  for (const std::set<int>& needed :
       {std::set<int>{}, {0}, {39}, {3, 17}, {1, 2, 20, 38}, {0, 1, 2, 3, 4, 5}}) {
    int runs = 0;
    const Steps found = sk_tool::tune::shrink({}, stepsUpTo(40), [&](const Setting& setting) {
      ++runs;
      return hasAll(setting, needed);
    });
    CHECK(numbersOf(found) == needed);
    CHECK(runs < 300);
  }
}

TEST_CASE("where one of two is enough, one is kept") {
  const Steps found = sk_tool::tune::shrink({}, stepsUpTo(10), [](const Setting& setting) {
    return hasAll(setting, {4}) || hasAll(setting, {2, 7});
  });
  const std::set<int> numbers = numbersOf(found);
  CHECK((numbers == std::set<int>{4} || numbers == std::set<int>{2, 7}));
}

TEST_CASE("as much is added as holds") {
  Setting setting;
  int runs = 0;
  // 5 never holds, and 11 not beside 3, which comes first
  sk_tool::tune::grow(setting, stepsUpTo(16), [&](const Setting& grown) {
    ++runs;
    return !hasAll(grown, {5}) && !hasAll(grown, {3, 11});
  });
  CHECK(setting.size() == 14);
  CHECK(hasAll(setting, {3}));
  CHECK_FALSE(hasAll(setting, {11}));
  CHECK(runs < 20);
}

TEST_CASE("another value for what has been changed is tried only where the first does not hold") {
  const Steps steps = {stepOf(0, "half"), stepOf(0, "single"), stepOf(1, "single"), stepOf(1, "half")};
  Setting setting;
  sk_tool::tune::grow(setting, steps, [](const Setting& grown) {
    const auto first = grown.find({"kernels", "k0", "precision"});
    return first == grown.end() || first->second != "half";
  });
  CHECK(setting ==
        Setting{{{"kernels", "k0", "precision"}, "single"}, {{"kernels", "k1", "precision"}, "single"}});
}
