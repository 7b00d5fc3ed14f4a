// SPDX-License-Identifier: MIT
//
// Promises: no rounding error exceeds its bound, in random formulas and at the edges of formats; what is exact has none; decisions that
// rounding may turn are found.
#include "bounds/evaluator.hpp"

#include <algorithm>
#include <cmath>
#include <random>

#include <catch2/catch.hpp>

#include "bounds/search.hpp"

namespace skc::bounds {
namespace {

const Rounding nearestFloat = {.kind = Rounding::Kind::Nearest, .format = floatFormat};

NodeId inputOf(Graph& graph, double low, double high) {
  Input input;
  input.range = {low, high};
  return graph.input(input, {});
}

NodeId operation(Graph& graph, Op op, NodeId x, NodeId y = noNode) {
  const bool isExact =
      op == Op::Negate || op == Op::Absolute || op == Op::Min || op == Op::Max || op == Op::Less;
  return graph.add({.op = op, .operands = {x, y, noNode}, .rounding = isExact ? Rounding{} : nearestFloat});
}

NodeId call(Graph& graph, UnaryFunction function, NodeId x) {
  const Rounding units = {.kind = Rounding::Kind::Units, .format = floatFormat, .amount = 0.51};
  return graph.add({.op = Op::Call,
                    .function = function,
                    .operands = {x, noNode, noNode},
                    .rounding = function == UnaryFunction::Sqrt ? nearestFloat : units});
}

double boundOf(const Graph& graph, NodeId output, Objective objective = Objective::Error,
               std::size_t boxes = 2000) {
  Evaluator evaluator(graph, output);
  return maximise(evaluator, graph, objective, {.boxes = boxes}).bound;
}

/// Runs a graph on numbers: exactly, in long doubles, and with each operation rounded to float.
class Run {
 public:
  Run(const Graph& graph, const std::vector<double>& inputs) : exact_(graph.size()), rounded_(graph.size()) {
    for (NodeId id = 0; id < graph.size(); ++id) {
      const Node& node = graph[id];
      compute(node, id, exact_, inputs);
      compute(node, id, rounded_, inputs);
      if (node.rounding.kind != Rounding::Kind::Exact) rounded_[id] = static_cast<float>(rounded_[id]);
      if (isComparison(node.op)) hasTurned_ = hasTurned_ || exact_[id] != rounded_[id];
    }
  }
  long double exact(NodeId id) const { return exact_[id]; }
  long double error(NodeId id) const { return std::fabs(exact_[id] - rounded_[id]); }
  bool hasTurned() const { return hasTurned_; }

 private:
  static void compute(const Node& node, NodeId id, std::vector<long double>& values,
                      const std::vector<double>& inputs) {
    const auto at = [&](std::size_t k) { return values[node.operands[k]]; };
    long double& value = values[id];
    switch (node.op) {
      case Op::Input: value = inputs[node.index]; break;
      case Op::Constant: value = node.value; break;
      case Op::Negate: value = -at(0); break;
      case Op::Absolute: value = std::fabs(at(0)); break;
      case Op::Add: value = at(0) + at(1); break;
      case Op::Subtract: value = at(0) - at(1); break;
      case Op::Multiply: value = at(0) * at(1); break;
      case Op::Divide: value = at(0) / at(1); break;
      case Op::Min: value = std::fmin(at(0), at(1)); break;
      case Op::Max: value = std::fmax(at(0), at(1)); break;
      case Op::Less: value = at(0) < at(1) ? 1 : 0; break;
      case Op::Select: value = at(0) != 0 ? at(1) : at(2); break;
      case Op::Call:
        value = node.function == UnaryFunction::Sqrt  ? std::sqrt(at(0))
                : node.function == UnaryFunction::Exp ? std::exp(at(0))
                                                      : std::sin(at(0));
        break;
      default: FAIL("an operation that these graphs have not");
    }
  }

  std::vector<long double> exact_, rounded_;
  bool hasTurned_ = false;
};

/// A graph of `count` random operations of floats.
Graph randomGraph(std::mt19937_64& random, int count) {
  Graph graph;
  const auto below = [&](std::size_t limit) { return static_cast<NodeId>(random() % limit); };
  std::vector<NodeId> numbers;
  for (int i = 0; i < 3; ++i) {
    const double low = static_cast<double>(below(17)) / 4 - 2;
    numbers.push_back(inputOf(graph, low, low + static_cast<double>(1 + below(8)) / 8));
  }
  numbers.push_back(graph.constant(0.375));
  numbers.push_back(graph.constant(2));
  for (int i = 0; i < count; ++i) {
    const NodeId x = numbers[below(numbers.size())], y = numbers[below(numbers.size())];
    const NodeId z = numbers[below(numbers.size())];
    constexpr Op ops[] = {Op::Add,      Op::Subtract, Op::Multiply, Op::Divide, Op::Add,
                          Op::Subtract, Op::Multiply, Op::Min,      Op::Max};
    switch (below(7)) {
      case 0: numbers.push_back(operation(graph, below(2) == 0 ? Op::Negate : Op::Absolute, x)); break;
      case 1: numbers.push_back(call(graph, UnaryFunction::Sqrt, operation(graph, Op::Absolute, x))); break;
      case 2:
        numbers.push_back(call(graph, below(2) == 0 ? UnaryFunction::Exp : UnaryFunction::Sin, x));
        break;
      case 3: numbers.push_back(graph.select(operation(graph, Op::Less, x, y), y, z, {})); break;
      default: numbers.push_back(operation(graph, ops[below(std::size(ops))], x, y)); break;
    }
  }
  return graph;
}

TEST_CASE("no error of a random formula exceeds its bound") {
  std::mt19937_64 random(11);
  std::uniform_real_distribution<double> unit(0, 1);
  int bounded = 0;
  double closest = 0;
  for (int trial = 0; trial < 400; ++trial) {
    const Graph graph = randomGraph(random, 4 + trial % 12);
    const auto output = static_cast<NodeId>(graph.size() - 1);
    if (isCondition(graph[output].op)) continue;
    const double bound = boundOf(graph, output, Objective::Error, 300);
    const double high = boundOf(graph, output, Objective::Largest, 100);
    const double low = -boundOf(graph, output, Objective::Smallest, 100);
    if (!(bound < infinity)) continue;
    ++bounded;
    for (int sample = 0; sample < 60; ++sample) {
      std::vector<double> inputs;
      for (const Input& input : graph.inputs()) {
        const double at = unit(random) < 0.2 ? std::round(unit(random)) : unit(random);
        const double x = input.range.low + at * input.range.width();
        inputs.push_back(
            std::clamp(static_cast<double>(static_cast<float>(x)), input.range.low, input.range.high));
      }
      const Run run(graph, inputs);
      INFO("formula " << trial << ", inputs " << inputs[0] << " " << inputs[1] << " " << inputs[2]);
      CHECK(run.exact(output) <= high);
      CHECK(run.exact(output) >= low);
      if (run.hasTurned()) continue;
      CHECK(run.error(output) <= bound + 1e-18L);  // a long double is not exact, either
      if (bound > 0) closest = std::max(closest, static_cast<double>(run.error(output)) / bound);
    }
  }
  CHECK(bounded > 200);
  CHECK(closest > 0.8);
}

TEST_CASE("products with powers of 2, near differences, and the smaller operand's part of a sum are exact") {
  Graph graph;
  const NodeId x = inputOf(graph, 1, 2);
  CHECK(boundOf(graph, operation(graph, Op::Multiply, x, graph.constant(0.25))) == 0);
  CHECK(boundOf(graph, operation(graph, Op::Subtract, x, graph.constant(1.5))) == 0);
  const NodeId tiny = inputOf(graph, 0, 0x1p-60);
  CHECK(boundOf(graph, operation(graph, Op::Add, x, tiny)) <= 0x1.001p-60);
  CHECK(boundOf(graph, operation(graph, Op::Multiply, x, x)) == Approx(0x1p-23).epsilon(0.02));
  CHECK(operation(graph, Op::Multiply, x, graph.constant(1)) == x);
}

TEST_CASE("below the smallest normal number, products are off by half of the smallest number") {
  Graph graph;
  const NodeId x = inputOf(graph, 0, 0x1p-100);
  CHECK(boundOf(graph, operation(graph, Op::Multiply, x, x)) == Approx(0x1p-150));
  Rounding flushing = nearestFloat;
  flushing.format.flushes = true;
  const NodeId y = inputOf(graph, 0, 0x1p-63);
  const NodeId product = graph.add({.op = Op::Multiply, .operands = {y, y, noNode}, .rounding = flushing});
  CHECK(boundOf(graph, product) == Approx(0x1p-126).epsilon(0.02));
}

TEST_CASE("a root near 0 has a bound, a quotient by 0 and an overflow have none") {
  Graph graph;
  const NodeId x = inputOf(graph, 0, 1);
  const NodeId sum = operation(graph, Op::Add, operation(graph, Op::Multiply, x, x), x);
  CHECK(boundOf(graph, call(graph, UnaryFunction::Sqrt, sum)) < 1e-3);
  const auto problemOf = [&](NodeId output) {
    Evaluator evaluator(graph, output);
    const SearchResult result = maximise(evaluator, graph, Objective::Error, {.boxes = 500});
    CHECK(result.bound == infinity);
    return result.problem;
  };
  CHECK(problemOf(operation(graph, Op::Divide, graph.constant(1), x)) == Problem::DivisionByZero);
  const NodeId large = inputOf(graph, 0, 1e38);
  CHECK(problemOf(operation(graph, Op::Multiply, large, graph.constant(5))) == Problem::Overflow);
  CHECK(problemOf(call(graph, UnaryFunction::Sqrt, operation(graph, Op::Subtract, x, graph.constant(0.5)))) ==
        Problem::Undefined);
}

TEST_CASE("roots and clamps of what rounding leaves nothing of") {
  Graph graph;
  const NodeId x = inputOf(graph, 0, 1), one = graph.constant(1);
  const NodeId lost = operation(graph, Op::Subtract, operation(graph, Op::Add, x, one), one);
  const double root = boundOf(graph, call(graph, UnaryFunction::Sqrt, lost));
  CHECK(root >= 0x1p-12);  // of 2^-24, which is lost
  CHECK(root < 0x1p-11);
  const NodeId large = graph.constant(0x1p30);
  const NodeId gone = operation(graph, Op::Subtract, operation(graph, Op::Add, x, large), large);
  const NodeId clamped = operation(graph, Op::Min, operation(graph, Op::Max, gone, graph.constant(0)), one);
  CHECK(boundOf(graph, clamped) == Approx(1));
}

TEST_CASE("a branch guards what is undefined elsewhere") {
  Graph graph;
  const NodeId x = inputOf(graph, -1, 1);
  const NodeId isPositive = operation(graph, Op::Less, graph.constant(0), x);
  const NodeId root = graph.select(isPositive, call(graph, UnaryFunction::Sqrt, x), graph.constant(0), {});
  CHECK(boundOf(graph, root) <= 0x1p-24);
  CHECK(boundOf(graph, call(graph, UnaryFunction::Sqrt, x)) == infinity);
}

TEST_CASE("decisions on computed numbers may turn, those on inputs may not") {
  Graph graph;
  const NodeId x = inputOf(graph, 0, 1);
  const NodeId product = operation(graph, Op::Multiply, x, graph.constant(0.3F));
  const NodeId ofInput = operation(graph, Op::Less, x, graph.constant(0.5));
  const NodeId ofProduct = operation(graph, Op::Less, product, graph.constant(0.125));
  const auto jumpOf = [&](NodeId condition, NodeId yes, NodeId no) {
    Evaluator evaluator(graph, graph.select(condition, yes, no, {}));
    return maximise(evaluator, graph, Objective::Jump, {.boxes = 2000, .tolerance = 0.1}, {condition}).bound;
  };
  const NodeId one = graph.constant(1), three = graph.constant(3);
  CHECK(jumpOf(ofInput, one, three) <= 0);
  CHECK(jumpOf(ofProduct, one, three) == Approx(2));
  // The sides meet at the threshold.
  const NodeId twice = operation(graph, Op::Multiply, x, graph.constant(2));
  const NodeId shifted = operation(graph, Op::Add, x, graph.constant(0.125F / 0.3F));
  CHECK(jumpOf(ofProduct, twice, shifted) < 1e-5);
}

}  // namespace
}  // namespace skc::bounds
