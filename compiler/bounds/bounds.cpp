// SPDX-License-Identifier: MIT
#include "bounds/bounds.hpp"

#include <algorithm>
#include <map>
#include <utility>

#include <fmt/format.h>

#include "bounds/execute.hpp"
#include "bounds/folds.hpp"
#include "bounds/rewrites.hpp"
#include "bounds/search.hpp"
#include "ir/print.hpp"
#include "sk/options.hpp"

namespace skc::bounds {
namespace {

using namespace ir;

/// Bounds the numbers of one kernel.
class Analysis {
 public:
  Analysis(const Module& module, const Kernel& kernel, const Options& options, KernelGraph kernelGraph)
      : module_(module), kernel_(kernel), options_(options), all_(std::move(kernelGraph)) {}

  std::vector<NumberBound> run() {
    std::vector<NumberBound> numbers;
    std::vector<OutputNumber> outputs = all_.outputs;
    for (const OutputNumber& output : outputs) {
      NumberBound number{.name = output.name};
      try {
        boundNumber(output, number);
      } catch (const NotBounded& reason) {
        number.notBounded = reason.what();
        number.loc = reason.loc;
      }
      const auto same = std::ranges::find(numbers, number.name, &NumberBound::name);
      same == numbers.end() ? numbers.push_back(std::move(number)) : join(*same, std::move(number));
    }
    return numbers;
  }

 private:
  /// One statement that pushes several numbers, as in a loop that was unrolled: what holds for all of them.
  static void join(NumberBound& into, NumberBound other) {
    if (!into.notBounded.empty()) return;
    const bool isLarger = other.absolute > into.absolute || !other.notBounded.empty();
    const Interval range = hull(into.range, other.range);
    std::optional<double> relative;
    if (into.relative && other.relative && !range.contains(0))
      relative = std::max(*into.relative, *other.relative);
    std::vector<Jump> jumps = std::move(into.jumps);
    for (Jump& jump : other.jumps) {
      const auto same = std::ranges::find(jumps, jump.text, &Jump::text);
      if (same == jumps.end())
        jumps.push_back(std::move(jump));
      else
        same->change = std::max(same->change, jump.change);
    }
    if (isLarger) into = std::move(other);
    into.range = range;
    into.relative = relative;
    into.jumps = std::move(jumps);
  }

  void boundNumber(const OutputNumber& output, NumberBound& number) {
    if (!output.isAccumulator) return bound(output.node, number, output.condition);
    number.isFold = true;
    const FoldTerm term = foldTerm(all_.graph, output.node, output.before, kernel_.loc);
    bound(term.node, number);
    if (number.notBounded.empty()) {
      Evaluator magnitude(all_.graph, term.isSum ? term.magnitude : term.node);
      const double largest =
          maximise(magnitude, all_.graph, Objective::Largest, search(magnitude, 0.1)).bound;
      const FoldFacts facts{term, number.range, number.absolute, largest, output.type, output.param};
      const FoldBound whole = boundOfFold(facts, kernel_, options_);
      number.range = whole.range;
      number.absolute = whole.absolute;
      number.relative = whole.relative;
    }
  }

  SearchOptions search(const Evaluator& evaluator, double part) const {
    const double nodes = static_cast<double>(evaluator.nodeCount()) + 1;
    const double boxes = part * static_cast<double>(options_.effort) / nodes;
    return {.boxes = static_cast<std::size_t>(std::clamp(boxes, 200.0, 200'000.0))};
  }

  /// What a node is in the program, with the names of streams.
  std::string textOf(NodeId node) const {
    const KernelGraph::Origin origin =
        node < all_.origins.size() ? all_.origins[node] : KernelGraph::Origin{};
    const Function& function = module_.functions[origin.function];
    std::string text;
    if (origin.expr != nullptr) text = print(module_, function, *origin.expr);
    if (origin.assignment != nullptr) {
      text =
          fmt::format("{} {}= {}", print(module_, function, *origin.assignment->place),
                      spelling(*origin.assignment->op), print(module_, function, *origin.assignment->value));
    }
    for (std::size_t p = kernel_.params.size(); p-- > 0;) {
      const std::string number = fmt::format("${}", p);
      for (std::size_t at = text.find(number); at != std::string::npos; at = text.find(number, at))
        text.replace(at, number.size(), kernel_.params[p].name);
    }
    return text;
  }

  /// Throws unless all inputs of the number have ranges.
  void requireRanges(const Evaluator& evaluator) const {
    for (const std::uint32_t input : evaluator.inputs()) {
      if (!all_.lacksRange[input]) continue;
      std::string name = all_.graph.inputs()[input].name;
      name = name.substr(0, name.find(" ("));
      if (const std::size_t dot = name.find('.');
          dot != std::string::npos && !name.starts_with("indexof") && !name.starts_with("extentof")) {
        throw NotBounded(fmt::format("give {} a range: --range {}=LOW:HIGH, or --range {}=LOW:HIGH", name,
                                     name, name.substr(0, dot)),
                         kernel_.loc);
      }
      throw NotBounded(fmt::format("give {} a range: --range '{}=LOW:HIGH'", name, name), kernel_.loc);
    }
  }

  void bound(NodeId output, NumberBound& number, NodeId condition = noNode) {
    Evaluator evaluator(all_.graph, output, condition);
    requireRanges(evaluator);
    const SearchResult error = maximise(evaluator, all_.graph, Objective::Error, search(evaluator, 0.4));
    if (!(error.bound < infinity))
      throw NotBounded(reasonOf(error), all_.graph[culpritOf(error, output)].loc);
    number.absolute = std::max(error.bound, 0.0);
    const SearchResult high = maximise(evaluator, all_.graph, Objective::Largest, search(evaluator, 0.05));
    const SearchResult low = maximise(evaluator, all_.graph, Objective::Smallest, search(evaluator, 0.05));
    number.range = {-low.bound, high.bound};
    if (!number.range.contains(0)) {
      const SearchResult relative =
          maximise(evaluator, all_.graph, Objective::RelativeError, search(evaluator, 0.25));
      if (relative.bound < infinity) number.relative = relative.bound;
    }
    if (!error.worst.empty()) addContributions(evaluator, error, number);
    addJumps(evaluator, number);
    addRewrites(output, number, condition);
  }

  static NodeId culpritOf(const SearchResult& result, NodeId output) {
    return result.culprit == noNode ? output : result.culprit;
  }

  std::string reasonOf(const SearchResult& result) const {
    const std::string text = result.culprit == noNode ? "" : textOf(result.culprit);
    const std::string where = text.empty() ? "an operation" : fmt::format("`{}`", text);
    switch (result.problem) {
      case Problem::DivisionByZero: return fmt::format("{} divides by an interval that contains 0", where);
      case Problem::Undefined:
        return fmt::format("{} may be computed where the function has no value", where);
      case Problem::Overflow: return fmt::format("{} may overflow", where);
      case Problem::IntegerOverflow: return fmt::format("{} may exceed the integers of its type", where);
      case Problem::None: break;
    }
    return "the derivative of an operation grows without limit";
  }

  /// Sums shares by the expression that the nodes come from.
  void addContributions(Evaluator& evaluator, const SearchResult& error, NumberBound& number) {
    evaluator.evaluate(error.worst, error.decisions);
    std::map<std::pair<std::uint32_t, std::string>, Contribution> byText;
    double sum = 0;
    for (const Evaluator::Share& share : evaluator.shares()) {
      const Node& node = all_.graph[share.node];
      std::string text = node.op == Op::Input ? all_.graph.inputs()[node.index].name : textOf(share.node);
      if (text.empty()) text = "the rounding of the result";
      Contribution& one =
          byText.try_emplace({node.loc.line, text}, Contribution{node.loc, text, 0}).first->second;
      one.share += share.error;
      sum += share.error;
    }
    for (auto& [key, one] : byText) {
      one.share = sum > 0 ? one.share / sum : 0;
      number.contributions.push_back(std::move(one));
    }
    std::ranges::stable_sort(number.contributions, std::greater{}, &Contribution::share);
    if (number.contributions.size() > 3) number.contributions.resize(3);
  }

  /// Conditions on computed numbers, those of one text together, as in an unrolled loop.
  void addJumps(Evaluator& evaluator, NumberBound& number) {
    std::map<std::pair<std::uint32_t, std::string>, std::vector<NodeId>> groups;
    for (const NodeId turn : evaluator.turns())
      groups[{all_.graph[turn].loc.line, textOf(turn)}].push_back(turn);
    std::vector<Interval> box;
    for (const Input& input : all_.graph.inputs()) box.push_back(input.range);
    const std::vector<Decision> open(evaluator.comparisons().size(), Decision::Open);
    const double part = 0.2 / std::max(1.0, static_cast<double>(groups.size()));
    for (const auto& [key, group] : groups) {
      if (evaluator.jumpOf(box, open, group) == 0) continue;
      SearchOptions options = search(evaluator, part);
      options.tolerance = 0.1;
      const SearchResult jump = maximise(evaluator, all_.graph, Objective::Jump, options, group);
      // Where the two sides meet, the change is an error like others.
      if (jump.bound > 4 * number.absolute)
        number.jumps.push_back({all_.graph[group[0]].loc, key.second, jump.bound});
    }
    std::ranges::stable_sort(number.jumps, std::greater{}, &Jump::change);
  }

  /// Keeps rewrites that at least halve the bound.
  void addRewrites(NodeId output, NumberBound& number, NodeId condition) {
    if (number.absolute == 0) return;
    for (const Candidate& candidate : candidates(all_.graph, output, options_)) {
      all_.origins.resize(all_.graph.size());
      Evaluator evaluator(all_.graph, candidate.output, condition);
      const SearchResult error = maximise(evaluator, all_.graph, Objective::Error, search(evaluator, 0.1));
      if (error.bound <= number.absolute / 2)
        number.rewrites.push_back({candidate.from, candidate.to, std::max(error.bound, 0.0)});
    }
    std::ranges::stable_sort(number.rewrites, std::less{}, &Rewrite::bound);
  }

  const Module& module_;
  const Kernel& kernel_;
  const Options& options_;
  KernelGraph all_;
};

/// [[precision(extended)]]
std::optional<Precision> declaredPrecision(const Kernel& kernel) {
  switch (static_cast<sk::Precision>(kernel.choices.precision)) {
    case sk::Precision::Default: return std::nullopt;
    case sk::Precision::Half: return Precision::Half;
    case sk::Precision::Single: return Precision::Single;
    case sk::Precision::Extended: return Precision::Extended;
    case sk::Precision::Double: return Precision::Double;
  }
  return std::nullopt;
}

/// Why the kernel cannot run in a precision; "" if it can.
std::string whyNot(const Kernel& kernel, Precision precision) {
  switch (precision) {
    case Precision::Single: return "";
    case Precision::Half: return kernel.variants.whyNotHalf;
    case Precision::Extended:
    case Precision::Double: break;
  }
  return kernel.variants.whyNotWide;
}

}  // namespace

KernelBounds boundsOf(const Module& module, const Kernel& kernel, const Options& options) {
  Options own = options;
  if (!options.isPrecisionGiven) own.precision = declaredPrecision(kernel).value_or(options.precision);
  KernelBounds result{
      qualifier(kernel.scope) + kernel.name, std::string(wordOf(kernel)), own.precision, {}, kernel.loc, {}};
  if (const std::string why = whyNot(kernel, own.precision); own.hasVariants && !why.empty()) {
    result.notBounded = fmt::format("it has no form in {} precision: {}", nameOf(own.precision), why);
    return result;
  }
  try {
    result.numbers = Analysis(module, kernel, own, graphOf(module, kernel, own)).run();
    if (result.numbers.empty()) result.notBounded = "it writes no floating-point number";
  } catch (const NotBounded& reason) {
    result.notBounded = reason.what();
    result.loc = reason.loc;
  }
  return result;
}

std::vector<KernelBounds> boundsOf(const Module& module, const Options& options) {
  std::vector<KernelBounds> all;
  for (const Kernel& kernel : module.kernels) {
    if (kernel.pass || kernel.isSynthesized || kernel.isPart) continue;
    all.push_back(boundsOf(module, kernel, options));
  }
  return all;
}

}  // namespace skc::bounds
