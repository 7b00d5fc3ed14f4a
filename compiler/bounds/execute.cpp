// SPDX-License-Identifier: MIT
#include "bounds/execute.hpp"

#include <algorithm>
#include <numeric>
#include <utility>

#include <fmt/format.h>

#include "bounds/executor.hpp"
#include "ir/build.hpp"
#include "ir/print.hpp"
#include "support/overloaded.hpp"

namespace skc::bounds {

using namespace ir;

namespace {

constexpr int mostSteps = 200'000;  // statements, in loops each time
constexpr std::size_t mostNodes = 100'000;

}  // namespace

Executor::Executor(const Module& module, const Kernel& kernel, const Options& options)
    : module_(module), kernel_(kernel), options_(options), arithmetic_(graph_, options) {}

void Executor::tick(Loc loc) {
  if (++steps_ > mostSteps || graph_.size() > mostNodes)
    throw NotBounded("the kernel takes too many steps to follow each of them", loc);
}

std::size_t Executor::size(Type type) const {
  return type.isVoid() ? 0 : static_cast<std::size_t>(scalarCount(module_, type));
}

// ---- paths ----------------------------------------------------------------------------------------

/// Joins two paths: the first if `selector` is true, else the other.
void Executor::merge(std::optional<Path>& into, std::optional<Path> other, NodeId selector) {
  if (!other) return;
  if (!into) {
    into = std::move(other);
    return;
  }
  const auto join = [&](Numbers& mine, const Numbers& theirs) {
    if (mine.size() < theirs.size()) mine.resize(theirs.size(), arithmetic_.number(0));
    for (std::size_t i = 0; i < theirs.size(); ++i)
      mine[i] = graph_.select(selector, mine[i], theirs[i], arithmetic_.loc());
  };
  for (std::size_t v = 0; v < into->variables.size(); ++v) join(into->variables[v], other->variables[v]);
  join(into->result, other->result);
  into->condition = graph_.disjunction(into->condition, other->condition);
}

void Executor::mergeExits(Exits& into, Exits other, NodeId selector) {
  merge(into.next, std::move(other.next), selector);
  merge(into.broken, std::move(other.broken), selector);
  merge(into.continued, std::move(other.continued), selector);
  merge(into.returned, std::move(other.returned), selector);
}

Executor::Path Executor::call(FunctionId id, std::vector<Numbers> arguments,
                              std::vector<std::optional<std::uint32_t>> streams, Loc loc) {
  tick(loc);
  if (++depth_ > 64) throw NotBounded("functions call each other too deeply", loc);
  const Function& function = module_.functions[id];
  Frame frame{id, &function, std::move(streams)};
  Path path{graph_.truth(true), std::move(arguments), {}};
  for (std::size_t v = path.variables.size(); v < function.variables.size(); ++v)
    path.variables.emplace_back(size(function.variables[v].type), arithmetic_.number(0));
  path.result.assign(size(function.result), arithmetic_.number(0));
  Exits exits = block(frame, function.body, std::move(path));
  --depth_;
  // A return that comes first in the text decides.
  if (exits.returned) {
    const NodeId selector = exits.returned->condition;
    merge(exits.returned, std::move(exits.next), selector);
    return std::move(*exits.returned);
  }
  if (!exits.next) throw NotBounded("a function that does not end", loc);
  return std::move(*exits.next);
}

Executor::Exits Executor::block(Frame& frame, const Block& statements, Path path) {
  Exits all;
  std::optional<Path> current = std::move(path);
  for (const Stmt& stmt : statements) {
    Exits exits = statement(frame, stmt, std::move(*current));
    current = std::exchange(exits.next, std::nullopt);
    // An earlier exit excludes later ones.
    if (exits.broken && all.broken) {
      const NodeId selector = all.broken->condition;
      merge(all.broken, std::exchange(exits.broken, std::nullopt), selector);
    }
    if (exits.continued && all.continued) {
      const NodeId selector = all.continued->condition;
      merge(all.continued, std::exchange(exits.continued, std::nullopt), selector);
    }
    if (exits.returned && all.returned) {
      const NodeId selector = all.returned->condition;
      merge(all.returned, std::exchange(exits.returned, std::nullopt), selector);
    }
    mergeExits(all, std::move(exits), graph_.truth(true));
    if (!current) break;
  }
  all.next = std::move(current);
  return all;
}

// ---- statements -----------------------------------------------------------------------------------

Executor::Exits Executor::statement(Frame& frame, const Stmt& stmt, Path path) {
  tick(stmt.loc);
  arithmetic_.at(stmt.loc);
  const auto next = [&] {
    Exits exits;
    exits.next = std::move(path);
    return exits;
  };
  return match(
      stmt.node,
      [&](const Declare& n) {
        const Type type = frame.function->variables[n.var].type;
        path.variables[n.var] =
            n.init ? of(frame, path, *n.init) : Numbers(size(type), arithmetic_.number(0));
        return next();
      },
      [&](const Assign& n) {
        Numbers value = of(frame, path, *n.value);
        if (n.op) {
          value = binary(*n.op, n.place->type, n.value->type, of(frame, path, *n.place), value);
          noteOrigin({nullptr, frame.id, &n});
        }
        store(path, slots(frame, path, *n.place), value);
        return next();
      },
      [&](const CallStmt& n) {
        callStatement(frame, n, path, stmt.loc);
        return next();
      },
      [&](const If& n) { return branch(frame, n, std::move(path)); },
      [&](const Loop& n) { return loop(frame, n, std::move(path), stmt.loc); },
      [&](const Switch& n) { return choice(frame, n, std::move(path)); },
      [&](const Break&) {
        Exits exits;
        exits.broken = std::move(path);
        return exits;
      },
      [&](const Continue&) {
        Exits exits;
        exits.continued = std::move(path);
        return exits;
      },
      [&](const Return& n) {
        if (n.value) path.result = of(frame, path, *n.value);
        Exits exits;
        exits.returned = std::move(path);
        return exits;
      },
      [&](const Scope& n) { return block(frame, n.body, std::move(path)); },
      [&](const Push& n) {
        append(path, n.stream, of(frame, path, *n.value), "pushed", stmt.loc);
        return next();
      },
      [&](const Scatter& n) {
        append(path, n.stream, of(frame, path, *n.value), n.op == ScatterOp::Add ? "added" : "scattered",
               stmt.loc);
        return next();
      },
      [&](const Print&) { return next(); });
}

Executor::Exits Executor::branch(Frame& frame, const If& n, Path path) {
  const NodeId condition = conditionOf(frame, path, *n.cond);
  if (graph_.isConstant(condition)) {
    return block(frame, graph_[condition].value != 0 ? n.then : n.otherwise, std::move(path));
  }
  Path other = path;
  path.condition = graph_.conjunction(path.condition, condition);
  other.condition = graph_.conjunction(other.condition, graph_.negation(condition));
  Exits exits = block(frame, n.then, std::move(path));
  mergeExits(exits, block(frame, n.otherwise, std::move(other)), condition);
  return exits;
}

/// Says why a loop has no known trip count.
void Executor::refuseLoop(NodeId condition, Loc loc) {
  for (const NodeId id : graph_.neededBy({condition})) {
    const Node& node = graph_[id];
    if (node.op != Op::Input || node.integer == Integer::No) continue;
    const std::string& name = graph_.inputs()[node.index].name;
    throw NotBounded(
        fmt::format("how often the loop runs depends on {}; give it one value: --range {}=N", name, name),
        loc);
  }
  throw NotBounded("a data-dependent loop: how often it runs depends on numbers that have ranges", loc);
}

Executor::Exits Executor::loop(Frame& frame, const Loop& n, Path path, Loc loc) {
  Exits all;
  std::optional<Path> current = std::move(block(frame, n.init, std::move(path)).next);
  std::optional<Path> left;  // by a break
  const auto leave = [&](std::optional<Path> by) {
    if (left && by) {
      const NodeId selector = left->condition;
      merge(left, std::move(by), selector);
    } else if (by) {
      left = std::move(by);
    }
  };
  for (bool isFirst = true; current; isFirst = false) {
    tick(loc);
    if (n.cond && (n.kind != LoopKind::DoWhile || !isFirst)) {
      const NodeId condition = conditionOf(frame, *current, *n.cond);
      if (!graph_.isConstant(condition)) refuseLoop(condition, loc);
      if (graph_[condition].value == 0) break;
    }
    Exits exits = block(frame, n.body, std::move(*current));
    if (exits.returned && all.returned) {
      const NodeId selector = all.returned->condition;
      merge(all.returned, std::move(exits.returned), selector);
    } else if (exits.returned) {
      all.returned = std::move(exits.returned);
    }
    leave(std::move(exits.broken));
    current = std::move(exits.next);
    if (exits.continued) {
      const NodeId selector = current ? current->condition : noNode;
      merge(current, std::move(exits.continued), selector);
    }
    if (current && !n.step.empty()) current = std::move(block(frame, n.step, std::move(*current)).next);
  }
  leave(std::move(current));
  all.next = std::move(left);
  return all;
}

/// A switch as a chain of branches: each label runs the cases from its own on.
Executor::Exits Executor::choice(Frame& frame, const Switch& n, Path path) {
  const NodeId value = of(frame, path, *n.value)[0];
  Exits all;
  NodeId rest = graph_.truth(true);  // no label before has matched
  const auto runFrom = [&](std::size_t first, NodeId condition) {
    if (graph_.isConstant(condition, 0)) return;
    Path one = path;
    one.condition = graph_.conjunction(path.condition, condition);
    Exits exits;
    std::optional<Path> current = std::move(one);
    for (std::size_t c = first; c < n.cases.size() && current; ++c) {
      Exits inner = block(frame, n.cases[c].body, std::move(*current));
      current = std::exchange(inner.next, std::nullopt);
      const auto keep = [&](std::optional<Path>& into, std::optional<Path>& from) {
        if (into && from) {
          const NodeId selector = into->condition;
          merge(into, std::move(from), selector);
        } else if (from) {
          into = std::move(from);
        }
      };
      keep(exits.broken, inner.broken);
      keep(exits.continued, inner.continued);
      keep(exits.returned, inner.returned);
    }
    exits.next = std::move(current);
    if (exits.broken) {
      const NodeId selector = exits.broken->condition;
      merge(exits.broken, std::exchange(exits.next, std::nullopt), selector);
      exits.next = std::exchange(exits.broken, std::nullopt);
    }
    // What has been collected belongs to other labels.
    mergeExits(exits, std::move(all), condition);
    all = std::move(exits);
  };
  std::optional<std::size_t> byDefault;
  for (std::size_t c = 0; c < n.cases.size(); ++c) {
    if (n.cases[c].isDefault) byDefault = c;
    NodeId matches = graph_.truth(false);
    for (const std::int64_t label : n.cases[c].values) {
      const NodeId number = arithmetic_.number(n.value->type.scalar, static_cast<double>(label));
      matches = graph_.disjunction(matches, arithmetic_.equal(value, number));
    }
    runFrom(c, graph_.conjunction(rest, matches));
    rest = graph_.conjunction(rest, graph_.negation(matches));
  }
  if (byDefault) {
    runFrom(*byDefault, rest);
  } else if (!graph_.isConstant(rest, 0)) {
    Exits exits;
    exits.next = path;
    exits.next->condition = graph_.conjunction(path.condition, rest);
    mergeExits(exits, std::move(all), rest);
    all = std::move(exits);
  }
  return all;
}

/// Notes an element of a variable or scatter output, under the condition that leads here.
void Executor::append(const Path& path, const StreamRef& stream, const Numbers& value, std::string_view how,
                      Loc loc) {
  if (stream.space != StreamRef::Space::KernelParameter && !callers_.empty())
    throw NotBounded("a value that a function pushes to a stream of its own", loc);
  NodeId condition = path.condition;
  for (const NodeId caller : callers_) condition = graph_.conjunction(caller, condition);
  const KernelParam& param = kernel_.params.at(stream.id);
  std::vector<std::pair<std::string, Scalar>> names;
  nameNumbers(param.name, param.type, names);
  for (std::size_t i = 0; i < names.size(); ++i) {
    const auto& [name, type] = names[i];
    if (!isReal(arithmeticScalar(type))) continue;
    const NodeId node = value.size() == 1 ? value[0] : value.at(i);
    OutputNumber number{fmt::format("{} {} in line {}", name, how, loc.line), stream.id, type,
                        isNarrow(type) ? node : arithmetic_.stored(type, node)};
    if (!graph_.isConstant(condition)) number.condition = condition;
    appended_.push_back(std::move(number));
  }
}

void Executor::callStatement(Frame& frame, const CallStmt& n, Path& path, Loc loc) {
  const Function& callee = module_.functions[n.callee];
  std::vector<Numbers> arguments;
  std::vector<std::optional<std::uint32_t>> streams;
  std::vector<std::pair<std::size_t, Slots>> places;  // before the call changes what their indices are
  for (std::size_t i = 0; i < n.args.size(); ++i) {
    const VarRole role = callee.variables[i].role;
    const auto* variable = std::get_if<VarRef>(&n.args[i]->node);
    const bool isStream =
        role == VarRole::Gather || role == VarRole::Element || role == VarRole::AppendOutput;
    streams.push_back(isStream && variable != nullptr && variable->var < frame.streams.size()
                          ? frame.streams[variable->var]
                          : std::nullopt);
    const bool hasValue = role != VarRole::Gather && role != VarRole::AppendOutput;
    arguments.push_back(hasValue ? of(frame, path, *n.args[i]) : Numbers{});
    if (role == VarRole::InOut) places.emplace_back(i, slots(frame, path, *n.args[i]));
  }
  callers_.push_back(path.condition);
  const Path end = call(n.callee, std::move(arguments), std::move(streams), loc);
  callers_.pop_back();
  for (const auto& [i, place] : places) store(path, place, end.variables[i]);
  if (n.result) store(path, slots(frame, path, *n.result), end.result);
}

// ---- lvalues --------------------------------------------------------------------------------------

Executor::Slots Executor::slots(Frame& frame, const Path& path, const Expr& place) {
  if (const auto* n = std::get_if<VarRef>(&place.node)) {
    Slots all{n->var, std::vector<std::size_t>(path.variables[n->var].size())};
    std::iota(all.numbers.begin(), all.numbers.end(), std::size_t{0});
    return all;
  }
  const auto pick = [](const std::vector<std::size_t>& all, std::size_t first, std::size_t count) {
    const auto begin = all.begin() + static_cast<std::ptrdiff_t>(first);
    return std::vector<std::size_t>(begin, begin + static_cast<std::ptrdiff_t>(count));
  };
  const std::size_t count = size(place.type);
  const auto narrowed = [&](Slots slots, auto&& choose) {
    slots.numbers = choose(slots.numbers);
    for (auto& numbers : slots.choices) numbers = choose(numbers);
    return slots;
  };
  if (const auto* n = std::get_if<Member>(&place.node)) {
    const std::size_t first = scalarOffset(module_, n->base->type, n->field);
    return narrowed(slots(frame, path, *n->base), [&](const auto& all) { return pick(all, first, count); });
  }
  if (const auto* n = std::get_if<Swizzle>(&place.node)) {
    return narrowed(slots(frame, path, *n->base), [&](const auto& all) {
      std::vector<std::size_t> chosen;
      for (const std::uint8_t component : n->components) chosen.push_back(all[component]);
      return chosen;
    });
  }
  const auto* n = std::get_if<Index>(&place.node);
  if (n == nullptr) throw NotBounded("an assignment to an unknown place", place.loc);
  Slots whole = slots(frame, path, *n->base);
  const std::size_t length = whole.numbers.size() / count;
  const NodeId index = of(frame, path, *n->index)[0];
  if (graph_.isExact(index)) {
    const double at = std::clamp(graph_[index].value, 0.0, static_cast<double>(length) - 1);
    return narrowed(std::move(whole),
                    [&](const auto& all) { return pick(all, static_cast<std::size_t>(at) * count, count); });
  }
  if (!whole.choices.empty()) throw NotBounded("two indices that are not constant in one place", place.loc);
  for (std::size_t k = 0; k < length; ++k) whole.choices.push_back(pick(whole.numbers, k * count, count));
  whole.numbers.resize(count);
  whole.index = index;
  return whole;
}

void Executor::store(Path& path, const Slots& at, const Numbers& value) {
  Numbers& variable = path.variables[at.var];
  const auto valueAt = [&](std::size_t i) { return value.size() == 1 ? value[0] : value.at(i); };
  if (at.choices.empty()) {
    for (std::size_t i = 0; i < at.numbers.size(); ++i) variable.at(at.numbers[i]) = valueAt(i);
    return;
  }
  for (std::size_t k = 0; k < at.choices.size(); ++k) {
    const NodeId number = arithmetic_.number(Scalar::Int, static_cast<double>(k));
    NodeId isHere = arithmetic_.equal(at.index, number);
    if (k == 0) isHere = arithmetic_.lessEqual(at.index, number);  // an index outside is clamped
    if (k + 1 == at.choices.size()) isHere = arithmetic_.lessEqual(number, at.index);
    for (std::size_t i = 0; i < at.choices[k].size(); ++i) {
      NodeId& slot = variable.at(at.choices[k][i]);
      slot = arithmetic_.select(isHere, valueAt(i), slot);
    }
  }
}

KernelGraph graphOf(const Module& module, const Kernel& kernel, const Options& options) {
  return Executor(module, kernel, options).run();
}

}  // namespace skc::bounds
