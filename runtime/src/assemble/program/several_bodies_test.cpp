// SPDX-License-Identifier: MIT
#include "assemble/program/several_bodies.hpp"

#include <array>

#include <catch2/catch.hpp>

#include "assemble/program/sample_kernels.hpp"

namespace sk::assemble {
namespace {

using Catch::Matchers::Contains;
using program::Definition;
using program::Kernel;
using program::Parameter;
using program::Role;

constexpr std::string_view helper = "int sk_div(int a, int b) { return a / max(b, 1); }\n";

/// A kernel with a helper of skc's, a function of its own, and a gather `u`.
struct Sample {
  explicit Sample(std::string_view factor, std::string_view name = "eased")
      : body(std::string(helper) + "float " + std::string(name) + "(float x) { return " +
             std::string(factor) + " * x; }\nvoid ease(out float y) { y = " + std::string(name) +
             "(sk_near_u(1)); }\n"),
        names{{{.bytes = static_cast<std::uint32_t>(helper.size())}, {.name = name}, {.name = "ease"}}},
        parameters{{{.name = "u",
                     .symbol = "u",
                     .role = Role::Gather,
                     .element = &samples::floatElement,
                     .rank = 1,
                     .usesNear = true},
                    {.name = "y", .symbol = "y", .role = Role::Output, .element = &samples::floatElement}}},
        kernel{.name = "ease",
               .entry = "ease",
               .declarations = {},
               .body = body,
               .parameters = parameters,
               .sources = {},
               .definitions = names} {}
  Sample(const Sample&) = delete;
  Sample& operator=(const Sample&) = delete;

  std::string body;
  std::array<Definition, 3> names;
  std::array<Parameter, 2> parameters;
  Kernel kernel;
};

std::size_t countOf(std::string_view what, std::string_view text) {
  std::size_t count = 0;
  for (std::size_t at = text.find(what); at != std::string_view::npos; at = text.find(what, at + 1)) ++count;
  return count;
}

const std::array<std::string, 2> first = {"a", ""}, second = {"b", ""};

TEST_CASE("bodies that differ get names of their own, and share what is skc's") {
  const Sample one("2.0"), other("3.0");
  SeveralBodies bodies;
  CHECK(bodies.add(one.kernel, first) == "ease");
  CHECK(bodies.add(other.kernel, first) == "sk_1_ease");
  CHECK(countOf(helper, bodies.text()) == 1);
  CHECK_THAT(bodies.text(), Contains("#define sk_near_u sk_near_a\n") &&
                                Contains("#define eased sk_1_eased\n") && Contains("#undef eased\n"));
}

TEST_CASE("a body is there once for all calls that read by the same functions") {
  const Sample one("2.0");
  SeveralBodies bodies;
  CHECK(bodies.add(one.kernel, first) == "ease");
  CHECK(bodies.add(one.kernel, first) == "ease");
  CHECK(bodies.add(one.kernel, second) == "sk_1_ease");
  CHECK(countOf("void ease", bodies.text()) == 2);
}

TEST_CASE("names that macros cannot change are refused without effect") {
  const Sample one("2.0", "xy"), other("3.0", "xy");
  SeveralBodies bodies;
  CHECK(bodies.add(one.kernel, first) == "ease");
  const std::string before = bodies.text();
  CHECK_FALSE(bodies.add(other.kernel, first));  // v.xy would change, too
  Kernel unknown = one.kernel;
  unknown.definitions = {};
  CHECK_FALSE(bodies.add(unknown, second));
  CHECK(bodies.text() == before);
}

}  // namespace
}  // namespace sk::assemble
