// SPDX-License-Identifier: MIT
//
// Fills the descriptors in, as skc would.
#include "test_kernel.hpp"

namespace sk::test {

namespace {

bool calls(std::string_view body, std::string_view function, std::string_view symbol = {}) {
  const std::string text = std::string(function) + std::string(symbol) + "(";
  return body.find(text) != std::string_view::npos;
}

/// "heat_diffuse" for "heat::diffuse".
std::string entryOf(std::string_view name) {
  std::string entry(name);
  if (const std::size_t colons = entry.find("::"); colons != std::string::npos) {
    entry.replace(colons, 2, "_");
  }
  return entry;
}

}  // namespace

TestKernel::TestKernel(std::string_view name, std::string_view body,
                       std::vector<program::Parameter> parameters, std::string_view declarations, int reach)
    : entry_(entryOf(name)), parameters_(std::move(parameters)) {
  for (program::Parameter& parameter : parameters_) {
    parameter.usesIndex = calls(body, "sk_index_", parameter.symbol);
    parameter.usesExtent = calls(body, "sk_extent_", parameter.symbol);
    parameter.usesAt = calls(body, "sk_at_", parameter.symbol);
    parameter.usesNear = calls(body, "sk_near_", parameter.symbol);
    parameter.reach = reach;
  }
  kernel_.name = name;
  kernel_.entry = entry_;
  kernel_.declarations = declarations;
  kernel_.body = body;
  kernel_.parameters = parameters_;
  kernel_.sources = sources_;
  kernel_.usesIndex = calls(body, "sk_index");
  kernel_.usesLoops =
      body.find("while (") != std::string_view::npos || body.find("for (") != std::string_view::npos;
}

TestReduction::TestReduction(std::string_view name, std::string_view body,
                             std::vector<program::Parameter> parameters, bool seeded,
                             std::string_view declarations, std::string_view combine)
    : parameters_(std::move(parameters)) {
  reduction_.fold.name = name;
  reduction_.fold.entry = name;
  reduction_.fold.declarations = declarations;
  reduction_.fold.body = body;
  reduction_.fold.parameters = parameters_;
  reduction_.fold.sources = sources_;
  reduction_.combine = reduction_.fold;
  if (!combine.empty()) {
    combined_ = {parameters_[1], parameters_[1]};
    combined_[0].role = program::Role::Input;
    combined_[0].symbol = "part";
    reduction_.combine.entry = combine;
    reduction_.combine.parameters = combined_;
  }
  reduction_.seeded = seeded;
}

const TestKernel& twice() {
  static const TestKernel kernel("twice", "void twice(float x, out float r) { r = 2.0 * x; }\n",
                                 {input<float>("x"), output<float>("r")});
  return kernel;
}

const TestReduction& sumOfFloats() {
  static const TestReduction reduction("sum", "void sum(float x, inout float total) { total += x; }\n",
                                       {input<float>("x"), accumulator<float>("total", "0.0")}, true);
  return reduction;
}

// An odd factor makes the map one to one.
std::vector<std::uint32_t> bitPatterns(std::size_t count) {
  std::vector<std::uint32_t> patterns(count);
  for (std::size_t i = 0; i < count; ++i) {
    patterns[i] = static_cast<std::uint32_t>(i) * 2654435761u;
  }
  return patterns;
}

const TestKernel& saxpy() {
  static const TestKernel kernel(
      "saxpy", "void saxpy(float a, float x, float y, out float r) { r = a * x + y; }\n",
      {uniform<float>("a"), input<float>("x"), input<float>("y"), output<float>("r")});
  return kernel;
}

}  // namespace sk::test
