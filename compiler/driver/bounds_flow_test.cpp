// SPDX-License-Identifier: MIT
//
// Promise: the graph of a kernel has at each input the value that the kernel has, whatever branches, loops, breaks, continues, returns and
// switches it takes. Random kernels are run by the interpreter and compared.
#include <random>
#include <string>

#include <fmt/format.h>
#include <catch2/catch.hpp>

#include "bounds/evaluator.hpp"
#include "bounds/execute.hpp"
#include "driver/compile.hpp"
#include "transforms/interpreter.hpp"

namespace skc::driver {
namespace flow_tests {

/// Writes kernels of floats with nested control flow.
class Writer {
 public:
  explicit Writer(std::uint32_t seed) : random_(seed) {}

  std::string program() {
    std::string function = "float inner(float x, float y) {\n  float a = x, b = y, c = 0.5;\n" +
                           block(3, true, false) + "  return a + b * c;\n}\n";
    std::string kernel =
        "kernel void f(float x<>, float y<>, out float r<>) {\n  float a = x, b = y, c = 0.25;\n";
    kernel +=
        block(3, false, false) + "  a += inner(b, c);\n" + block(2, false, false) + "  r = a - b + c;\n}\n";
    return function + kernel;
  }

 private:
  int below(int limit) { return static_cast<int>(random_() % static_cast<unsigned>(limit)); }
  std::string variable() { return std::string(1, "abc"[below(3)]); }

  /// A value of moderate size.
  std::string value() {
    switch (below(6)) {
      case 0: return fmt::format("{} * 0.5 + {}", variable(), variable());
      case 1: return fmt::format("sin({} + {})", variable(), variable());
      case 2: return fmt::format("min({}, {}) - 0.125", variable(), variable());
      case 3: return fmt::format("({} > {} ? {} : x)", variable(), variable(), variable());
      case 4: return fmt::format("abs({}) * 0.75", variable());
      default: return fmt::format("{} - 0.3125 * {}", variable(), variable());
    }
  }

  std::string condition() {
    const char* const operators[] = {"<", "<=", ">", ">="};
    std::string text =
        fmt::format("{} {} {}", variable(), operators[below(4)], below(2) == 0 ? variable() : "0.3125");
    if (below(3) == 0) text += fmt::format(" {} {} < y", below(2) == 0 ? "&&" : "||", variable());
    if (below(6) == 0) text = "!(" + text + ")";
    return text;
  }

  std::string block(int depth, bool mayReturn, bool isInLoop) {
    std::string text;
    for (int i = 1 + below(3); i > 0; --i) text += statement(depth, mayReturn, isInLoop);
    return text;
  }

  std::string statement(int depth, bool mayReturn, bool isInLoop) {
    const std::string indent(static_cast<std::size_t>(2 * (5 - depth)), ' ');
    const int kind = depth == 0 ? 0 : below(8);
    if (kind <= 2)
      return fmt::format("{}{} {} {};\n", indent, variable(), below(3) == 0 ? "+=" : "=", value());
    if (kind <= 4) {
      std::string text =
          fmt::format("{}if ({}) {{\n{}", indent, condition(), block(depth - 1, mayReturn, isInLoop));
      if (isInLoop && below(2) == 0)
        text += indent + (below(2) == 0 ? "  break;\n" : "  continue;\n");
      else if (mayReturn && below(3) == 0)
        text += fmt::format("{}  return {};\n", indent, value());
      if (below(2) == 0)
        text += fmt::format("{}}} else {{\n{}", indent, block(depth - 1, mayReturn, isInLoop));
      return text + indent + "}\n";
    }
    if (kind <= 6) {
      const int number = loops_++;
      return fmt::format("{}for (int i{} = 0; i{} < {}; ++i{}) {{\n{}{}}}\n", indent, number, number,
                         1 + below(4), number, block(depth - 1, mayReturn, true), indent);
    }
    std::string text = fmt::format("{}switch (int(4 * {})) {{\n", indent, variable());
    for (int label = -1; label <= 1; ++label) {
      text += fmt::format("{}case {}:\n{}", indent, label, block(depth - 1, mayReturn, false));
      if (below(3) != 0) text += indent + "  break;\n";
    }
    return text + fmt::format("{}default: {} = {};\n{}}}\n", indent, variable(), value(), indent);
  }

  std::mt19937 random_;
  int loops_ = 0;
};

TEST_CASE("the graph of a random kernel has its value at each input") {
  std::mt19937 random(2);
  std::uniform_real_distribution<float> between(-1, 1);
  int compared = 0, narrow = 0;
  for (std::uint32_t seed = 0; seed < 40; ++seed) {
    const std::string text = Writer(seed).program();
    INFO(seed << "\n" << text);
    Options options;
    options.emit = Emit::Bounds;
    const Translation translation = translateText(options, "flow.sk", text);
    REQUIRE(translation.module);
    const ir::Module& module = *translation.module;
    options.bounds.ranges = {{"x", -1, 1}, {"y", -1, 1}};
    const bounds::KernelGraph kernel = bounds::graphOf(module, module.kernels[0], options.bounds);
    bounds::Evaluator evaluator(kernel.graph, kernel.outputs.at(0).node);
    const std::vector<bounds::Decision> open(evaluator.comparisons().size(), bounds::Decision::Open);
    for (int sample = 0; sample < 40; ++sample) {
      const double x = between(random), y = between(random);
      int steps = 100'000;
      const auto values = interpret(module, module.kernels[0].entry, {{x}, {y}, {0}}, {}, steps);
      if (!values) continue;  // a large number became an integer
      std::vector<bounds::Interval> box;
      for (const bounds::Input& input : kernel.graph.inputs())
        box.push_back(bounds::Interval::point(input.name == "x" ? x : y));
      const bounds::BoxResult result = evaluator.evaluate(box, open);
      if (result.undecided != bounds::noNode) continue;  // a tie
      INFO("x " << x << " y " << y << " is " << values->at(2)[0] << ", not " << result.value.middle());
      CHECK(result.value.contains(values->at(2)[0]));
      ++compared;
      if (result.value.width() < 1e-9 * (1 + result.value.magnitude())) ++narrow;
    }
  }
  CHECK(compared > 1000);
  CHECK(narrow > 0.9 * compared);  // some loops grow numbers, and what roundings of doubles leave unknown
}

}  // namespace flow_tests
}  // namespace skc::driver
