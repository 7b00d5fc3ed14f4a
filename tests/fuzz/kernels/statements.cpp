// SPDX-License-Identifier: MIT
#include "kernels/statements.hpp"

#include <utility>

#include <fmt/format.h>

namespace fuzz {
namespace {

constexpr int expressionDepth = 3;

void store(Frame& frame, const Where& where, const Value& value, int count) {
  Value& slot = frame.slots[static_cast<std::size_t>(where.slot)];
  for (std::size_t i = 0; i < static_cast<std::size_t>(count); ++i)
    slot.bits[where.components[i]] = value.bits[i];
}

/// Runs a loop: `test` returns whether another iteration begins.
template <class Test, class Body>
Flow rounds(Test test, Body body) {
  while (test()) {
    const Flow flow = body();
    if (flow == Flow::Break) break;
    if (flow == Flow::Return) return flow;
  }
  return Flow::Next;
}

}  // namespace

Statement Statements::block(int count, int depth, const std::string& indent) {
  const std::size_t outer = scope_.variables.size();
  std::string text;
  std::vector<std::function<Flow(Frame&)>> parts;
  for (int i = 0; i < count; ++i) {
    Statement one = statement(depth, indent);
    text += one.text;
    parts.push_back(std::move(one.run));
  }
  scope_.variables.resize(outer);
  return {text, [parts](Frame& frame) {
            for (const auto& part : parts) {
              if (const Flow flow = part(frame); flow != Flow::Next) return flow;
            }
            return Flow::Next;
          }};
}

Statement Statements::statement(int depth, const std::string& indent) {
  if (!appendOutputs_.empty() && random_.chance(1, 4)) {
    return writeTo(random_.pick(appendOutputs_), expressions_, *scope_.records, random_, indent);
  }
  switch (random_.below(depth > 0 ? 14 : 7)) {
    case 0: return declaration(indent);
    case 1: return arrayDeclaration(indent);
    case 2:
      if (breakables_ > 0 || canReturn_) return jump(indent);
      [[fallthrough]];
    default: return assignment(indent);
    case 7:
    case 8: return branch(depth, indent);
    case 9:
    case 10: return forLoop(depth, indent);
    case 11: return whileLoop(depth, indent);
    case 12: return choice(depth, indent);
  }
}

Statement Statements::declaration(const std::string& indent) {
  const Type type = randomType(*scope_.records, random_);
  const Expr value = expressions_.makeKept(type, expressionDepth);
  const Variable variable{names_.fresh("v"), type, names_.take(1), 0, true};
  scope_.variables.push_back(variable);
  const bool isConst = random_.chance(1, 5);
  scope_.variables.back().isWritable = !isConst;
  return {fmt::format("{}{}{} {} = {};\n", indent, isConst ? "const " : "", spelling(*scope_.records, type),
                      variable.name, value.text),
          [slot = variable.slot, value = value.value](Frame& frame) {
            const Value made = value(frame);
            frame.slots[static_cast<std::size_t>(slot)] = made;
            return Flow::Next;
          }};
}

Statement Statements::arrayDeclaration(const std::string& indent) {
  const Type type = randomType(*scope_.records, random_);
  const int length = random_.between(1, 5);
  std::string items;
  std::vector<std::function<Value(Frame&)>> values;
  for (int i = 0; i < length; ++i) {
    const Expr value = expressions_.makeKept(type, 1);
    items += (i == 0 ? "" : ", ") + value.text;
    values.push_back(value.value);
  }
  const Variable variable{names_.fresh("a"), type, names_.take(length), length, true};
  scope_.variables.push_back(variable);
  return {fmt::format("{}{} {}[{}] = {{{}}};\n", indent, spelling(*scope_.records, type), variable.name,
                      length, items),
          [slot = variable.slot, values](Frame& frame) {
            std::vector<Value> made;
            for (const auto& value : values) made.push_back(value(frame));
            for (std::size_t i = 0; i < made.size(); ++i)
              frame.slots[static_cast<std::size_t>(slot) + i] = made[i];
            return Flow::Next;
          }};
}

Statement Statements::assignTo(const Place& place, const Expr& value, const std::string& indent) {
  return {fmt::format("{}{} = {};\n", indent, place.text, value.text),
          [where = place.where, value = value.value,
           count = componentsOf(*scope_.records, place.type)](Frame& frame) {
            const Value made = value(frame);
            store(frame, where(frame), made, count);
            return Flow::Next;
          }};
}

Statement Statements::assignment(const std::string& indent) {
  const std::optional<Place> place = expressions_.writable(expressionDepth);
  if (!place) return declaration(indent);
  const bool isNumber = place->type.record < 0 && !place->type.isMatrix &&
                        place->type.scalar != Scalar::Bool && !isNormalized(place->type.scalar) &&
                        (!isNarrow(place->type.scalar) || place->type.width == 1);
  if (isNumber && random_.chance(1, 3)) return compound(*place, indent);
  return assignTo(*place, expressions_.makeKept(place->type, expressionDepth), indent);
}

/// place op= value; or, for a float, an assignment that reduces the result to the bound `kept`.
Statement Statements::compound(const Place& place, const std::string& indent) {
  const Type type = place.type, arithmetic{arithmeticScalar(type.scalar), type.width};
  Expr old = expressions_.read(place);
  Expr value = expressions_.make({arithmetic.scalar, type.width}, 2);
  const bool isFloat = arithmetic.scalar == Scalar::Float;
  if (isFloat) value = expressions_.tamed(value);
  static constexpr char ofFloats[] = {'+', '-', '*'}, ofInts[] = {'+', '-', '*', '&', '|', '^'};
  const char op = isFloat ? random_.pick(ofFloats) : random_.pick(ofInts);
  const auto combined = [a = old.value, b = value.value, op, isFloat, width = type.width](Frame& frame) {
    const Value y = b(frame), x = a(frame);
    Value r;
    for (int i = 0; i < width; ++i) {
      const std::uint32_t l = x.asUint(i), m = y.asUint(i);
      if (isFloat) {
        const float f = x.asFloat(i), g = y.asFloat(i);
        r.set(i, op == '+' ? f + g : op == '-' ? f - g : f * g);
      } else {
        r.set(i, op == '+'   ? l + m
                 : op == '-' ? l - m
                 : op == '*' ? l * m
                 : op == '&' ? l & m
                 : op == '|' ? l | m
                             : l ^ m);
      }
    }
    return r;
  };
  if (!isFloat) {
    const Expr result{type, value.text, [&records = *scope_.records, type, combined](Frame& frame) {
                        return quantized(records, type, combined(frame));
                      }};
    Statement made = assignTo(place, result, indent);
    made.text = fmt::format("{}{} {}= {};\n", indent, place.text, op, value.text);
    return made;
  }
  Expr sum{arithmetic,
           fmt::format("({} {} {})", old.text, op, value.text),
           combined,
           {2 * kept.magnitude, 2 * kept.fraction}};
  sum = expressions_.tamed(sum);
  if (isNarrow(type.scalar)) sum.text = fmt::format("{}({})", spelling({}, type), sum.text);
  return assignTo(place, sum, indent);
}

Statement Statements::branch(int depth, const std::string& indent) {
  const Expr condition = expressions_.condition(expressionDepth);
  const Statement yes = block(random_.between(1, 3), depth - 1, indent + "  ");
  const bool hasElse = random_.chance(1, 2);
  const Statement no = hasElse ? block(random_.between(1, 3), depth - 1, indent + "  ") : Statement{};
  std::string text = fmt::format("{0}if ({1}) {{\n{2}{0}}}", indent, condition.text, yes.text);
  text += hasElse ? fmt::format(" else {{\n{1}{0}}}\n", indent, no.text) : "\n";
  return {text, [c = condition.value, yes = yes.run, no = no.run](Frame& frame) {
            if (c(frame).bits[0] != 0) return yes(frame);
            return no ? no(frame) : Flow::Next;
          }};
}

Statement Statements::forLoop(int depth, const std::string& indent) {
  const Expr bound = expressions_.make({Scalar::Int, 1}, 1);
  const bool isConstant = random_.chance(1, 2);
  const int most = random_.between(1, 4);
  const Variable counter{names_.fresh("i"), {Scalar::Int, 1}, names_.take(1), 0, false};
  const std::string limit = isConstant ? std::to_string(most) : fmt::format("({} & 3)", bound.text);
  const auto limitOf = [isConstant, most, end = bound.value](Frame& frame) {
    return isConstant ? most : end(frame).asInt(0) & 3;
  };
  // The limit is computed once, before the loop: the body may change the variables that it reads.
  const Variable end{names_.fresh("n"), {Scalar::Int, 1}, names_.take(1), 0, false};
  scope_.variables.push_back(counter);
  ++loops_, ++breakables_;
  const Statement body = block(random_.between(1, 3), depth - 1, indent + "  ");
  --loops_, --breakables_;
  scope_.variables.pop_back();
  const std::string head = fmt::format("{0}const int {1} = {2};\n{0}for (int {3} = 0; {3} < {1}; ++{3}) {{\n",
                                       indent, end.name, limit, counter.name);
  return {head + body.text + indent + "}\n", [limitOf, slot = counter.slot, run = body.run](Frame& frame) {
            const int rounds_ = limitOf(frame);
            std::uint32_t i = 0;
            return rounds(
                [&] {
                  frame.slots[static_cast<std::size_t>(slot)].set(0, i);
                  return static_cast<int>(i) < rounds_;
                },
                [&] {
                  const Flow flow = run(frame);
                  ++i;
                  return flow;
                });
          }};
}

/// A while or do loop with a counter that limits its trip count.
Statement Statements::whileLoop(int depth, const std::string& indent) {
  const bool isDo = random_.chance(1, 2);
  const int most = random_.between(1, 4);
  const Variable counter{names_.fresh("w"), {Scalar::Int, 1}, names_.take(1), 0, false};
  scope_.variables.push_back(counter);
  const Expr condition = expressions_.condition(2);
  ++loops_, ++breakables_;
  const Statement body = block(random_.between(1, 3), depth - 1, indent + "  ");
  --loops_, --breakables_;
  scope_.variables.pop_back();
  const std::string test = fmt::format("{} < {} && {}", counter.name, most, condition.text);
  const std::string count = fmt::format("{}  ++{};\n", indent, counter.name);
  std::string text = fmt::format("{}int {} = 0;\n{}", indent, counter.name, indent);
  text += isDo ? fmt::format("do {{\n{}{}{}}} while ({});\n", count, body.text, indent, test)
               : fmt::format("while ({}) {{\n{}{}{}}}\n", test, count, body.text, indent);
  return {text, [c = condition.value, slot = static_cast<std::size_t>(counter.slot), most, isDo,
                 run = body.run](Frame& frame) {
            frame.slots[slot].set(0, 0u);
            bool isFirst = isDo;
            return rounds(
                [&] {
                  return std::exchange(isFirst, false) ||
                         (frame.slots[slot].asInt(0) < most && c(frame).bits[0] != 0);
                },
                [&] {
                  frame.slots[slot].set(0, frame.slots[slot].asUint(0) + 1);
                  return run(frame);
                });
          }};
}

Statement Statements::choice(int depth, const std::string& indent) {
  const Expr value = expressions_.make({Scalar::Int, 1}, 2);
  const int count = random_.between(1, 4);
  const bool hasDefault = random_.chance(1, 2);
  std::string text = fmt::format("{}switch ({} & 3) {{\n", indent, value.text);
  std::vector<std::function<Flow(Frame&)>> bodies;
  ++breakables_;
  for (int i = 0; i < count; ++i) {
    const bool isDefault = hasDefault && i == count - 1;
    Statement body = block(random_.between(0, 2), depth - 1, indent + "    ");
    const bool breaks = random_.chance(2, 3) || i == count - 1;
    text += fmt::format("{}  {}: {{\n{}{}  }}\n", indent, isDefault ? "default" : "case " + std::to_string(i),
                        body.text, indent);
    if (breaks) text += indent + "    break;\n";
    bodies.push_back([run = body.run, breaks](Frame& frame) {
      const Flow flow = run(frame);
      return flow == Flow::Next && breaks ? Flow::Break : flow;
    });
  }
  --breakables_;
  return {text + indent + "}\n", [v = value.value, bodies, hasDefault](Frame& frame) {
            const auto wanted = static_cast<std::size_t>(v(frame).asInt(0) & 3);
            const std::size_t cases = bodies.size() - (hasDefault ? 1 : 0);
            std::size_t at = wanted < cases ? wanted : hasDefault ? cases : bodies.size();
            for (; at < bodies.size(); ++at) {
              const Flow flow = bodies[at](frame);
              if (flow == Flow::Break) break;
              if (flow != Flow::Next) return flow;
            }
            return Flow::Next;
          }};
}

Statement Statements::jump(const std::string& indent) {
  const Expr condition = expressions_.condition(2);
  Flow flow = Flow::Return;
  if (loops_ > 0 && random_.chance(1, 2)) {
    flow = Flow::Continue;
  } else if (breakables_ > 0 && (!canReturn_ || random_.chance(2, 3))) {
    flow = Flow::Break;
  }
  const char* word = flow == Flow::Return ? "return" : flow == Flow::Break ? "break" : "continue";
  return {fmt::format("{}if ({}) {};\n", indent, condition.text, word),
          [c = condition.value, flow](Frame& frame) { return c(frame).bits[0] != 0 ? flow : Flow::Next; }};
}

}  // namespace fuzz
