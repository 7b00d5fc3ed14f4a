// SPDX-License-Identifier: MIT
//
// Random expressions that select, compare, read streams or call functions, and initialisers of variables.
#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "kernels/expressions.hpp"
#include "kernels/operations.hpp"

namespace fuzz {
namespace {

std::int64_t inside(std::int64_t i, std::int64_t extent, sk::program::Boundary boundary) {
  switch (boundary) {
    case sk::program::Boundary::Clamp: return std::clamp<std::int64_t>(i, 0, extent - 1);
    case sk::program::Boundary::Wrap: return (i % extent + extent) % extent;
    case sk::program::Boundary::Mirror: {
      const std::int64_t period = 2 * extent, at = (i % period + period) % period;
      return at < extent ? at : period - 1 - at;
    }
    case sk::program::Boundary::Border: return i >= 0 && i < extent ? i : -1;
  }
  return i;
}

}  // namespace

Value gathered(const Gather& gather, const HostStream& stream, std::array<std::int64_t, 2> index) {
  const std::size_t rank = stream.shape.size();
  std::int64_t number = 0;
  for (std::size_t d = 0; d < rank; ++d) {
    const std::int64_t at = inside(index[rank - 1 - d], stream.shape[d], gather.boundary);
    if (at < 0) return gather.border;
    number = number * stream.shape[d] + at;
  }
  return stream.elements[static_cast<std::size_t>(number)];
}

/// The forms of a ? b : c: by a bool, by a mask of ints, and select() by a bool vector.
Expr Expressions::chosen(Type type, int depth) {
  Expr a = make(type, depth - 1), b = make(type, depth - 1);
  const Bound bound{std::max(a.bound.magnitude, b.bound.magnitude),
                    std::max(a.bound.fraction, b.bound.fraction)};
  if (bound.bits() > exactBits) a = tamed(a), b = tamed(b);
  const bool isByComponent = type.width > 1 && type.scalar != Scalar::Bool && random_.chance(1, 2);
  const bool isMask = isByComponent && random_.chance(1, 2);
  const Expr condition = isMask          ? comparison(type.width, depth - 1)
                         : isByComponent ? make({Scalar::Bool, type.width}, depth - 1)
                                         : make({Scalar::Bool, 1}, depth - 1);
  if (isMask) {   // Clang requires the same type on both sides, and counts const as a difference
    a.text = fmt::format("{}({})", spelling({}, type), a.text);
    b.text = fmt::format("{}({})", spelling({}, type), b.text);
  }
  const char* form = isByComponent && !isMask ? "select({}, {}, {})" : "({} ? {} : {})";
  return {type, fmt::format(fmt::runtime(form), condition.text, a.text, b.text),
          [c = condition.value, x = a.value, y = b.value, isByComponent, width = type.width](Frame& frame) {
            const Value choice = c(frame);
            if (!isByComponent) return choice.bits[0] != 0 ? x(frame) : y(frame);
            Value r = x(frame);
            const Value other = y(frame);
            for (std::size_t i = 0; i < static_cast<std::size_t>(width); ++i) {
              if (choice.bits[i] == 0) r.bits[i] = other.bits[i];
            }
            return r;
          },
          bound.bits() > exactBits ? kept : bound};
}

/// A comparison, which gives a bool, or for vectors a mask: ints that are -1 for true.
Expr Expressions::comparison(int width, int depth) {
  static constexpr Scalar scalars[] = {Scalar::Float, Scalar::Int, Scalar::Uint};
  const Scalar scalar = random_.pick(scalars);
  const Comparison& compare = randomComparison(random_);
  const Expr a = make({scalar, width}, depth - 1), b = make({scalar, width}, depth - 1);
  const std::uint32_t yes = width == 1 ? 1u : ~0u;
  return {{width == 1 ? Scalar::Bool : Scalar::Int, width},
          fmt::format("({} {} {})", a.text, compare.what, b.text),
          [x = a.value, y = b.value, compare, scalar, width, yes](Frame& frame) {
            const Value left = x(frame), right = y(frame);
            Value r;
            for (int i = 0; i < width; ++i) {
              const bool is = scalar == Scalar::Float ? compare.ofFloats(left.asFloat(i), right.asFloat(i))
                              : scalar == Scalar::Int ? compare.ofInts(left.asInt(i), right.asInt(i))
                                                      : compare.ofUints(left.asUint(i), right.asUint(i));
              r.set(i, is ? yes : 0u);
            }
            return r;
          }};
}

Expr Expressions::makeBool(int width, int depth) {
  const Type type{Scalar::Bool, width};
  const std::size_t kind = random_.below(6);
  if (kind < 2 && width == 1) return comparison(1, depth);
  if (kind < 2) {
    const Expr mask = comparison(width, depth);
    return {type, fmt::format("{}{}", spelling({}, type), mask.text),
            [inner = mask.value, width](Frame& frame) {
              Value r = inner(frame);
              for (int i = 0; i < width; ++i) r.set(i, r.asUint(i) & 1u);
              return r;
            }};
  }
  if (kind == 2) {
    const Expr a = make(type, depth - 1);
    // For a bool vector, ! gives a mask, and ~ a bool vector.
    const std::string text = width == 1             ? fmt::format("(!{})", a.text)
                             : random_.chance(1, 2) ? fmt::format("(~{})", a.text)
                                                    : fmt::format("{}(!{})", spelling({}, type), a.text);
    return {type, text, [inner = a.value, width](Frame& frame) {
              Value r = inner(frame);
              for (int i = 0; i < width; ++i) r.set(i, r.asUint(i) ^ 1u);
              return r;
            }};
  }
  if (kind == 3 && width == 1) {   // any() or all() of a mask or a bool vector
    const bool isAny = random_.chance(1, 2);
    const int count = random_.between(2, 4);
    const Expr a =
        random_.chance(1, 2) ? comparison(count, depth - 1) : make({Scalar::Bool, count}, depth - 1);
    return {type, fmt::format("{}({})", isAny ? "any" : "all", a.text),
            [inner = a.value, isAny, count](Frame& frame) {
              const Value x = inner(frame);
              int set = 0;
              for (int i = 0; i < count; ++i) set += x.asUint(i) != 0;
              Value r;
              r.set(0, (isAny ? set > 0 : set == count) ? 1u : 0u);
              return r;
            }};
  }
  static constexpr const char* ofOne[] = {"&&", "||", "==", "!="};
  static constexpr const char* ofMany[] = {"&", "|", "^"};
  const std::string what = width == 1 ? random_.pick(ofOne) : random_.pick(ofMany);
  const Expr a = make(type, depth - 1), b = make(type, depth - 1);
  const char op = what == "==" ? '=' : what == "!=" ? '^' : what[0];
  return {type, fmt::format("({} {} {})", a.text, what, b.text),
          [x = a.value, y = b.value, op, width](Frame& frame) {
            const Value left = x(frame), right = y(frame);
            Value r;
            for (int i = 0; i < width; ++i) {
              const std::uint32_t l = left.asUint(i), m = right.asUint(i);
              r.set(i, op == '&' ? l & m : op == '|' ? l | m : op == '^' ? l ^ m : 1u ^ l ^ m);
            }
            return r;
          }};
}

/// A matrix times a vector.
Expr Expressions::product(int width, int depth) {
  const Expr m = matrix(width, depth - 1), v = tamed(make({Scalar::Float, width}, depth - 1));
  return {{Scalar::Float, width},
          fmt::format("({} * {})", m.text, v.text),
          [a = m.value, b = v.value, width](Frame& frame) {
            const Value rows = a(frame), x = b(frame);
            Value r;
            for (int i = 0; i < width; ++i) {
              float sum = 0;
              for (int k = 0; k < width; ++k) sum += rows.asFloat(i * width + k) * x.asFloat(k);
              r.set(i, sum);
            }
            return r;
          },
          {2 * kept.magnitude + 2, 2 * kept.fraction}};
}

/// A matrix whose elements are within the bound `kept`.
Expr Expressions::matrix(int width, int depth) {
  const Type type{Scalar::Float, width, true};
  std::vector<Place> known;
  for (const Variable& variable : scope_.variables) {
    if (variable.type == type) known.push_back(whole(variable, depth));
  }
  if (!known.empty() && (depth <= 0 || random_.chance(1, 2))) return read(random_.pick(known));
  if (depth > 0 && random_.chance(1, 3)) {
    const Expr inner = matrix(width, depth - 1);
    return {type, fmt::format("transpose({})", inner.text),
            [a = inner.value, width](Frame& frame) {
              const Value m = a(frame);
              Value r;
              for (int i = 0; i < width; ++i) {
                for (int k = 0; k < width; ++k) r.set(i * width + k, m.asFloat(k * width + i));
              }
              return r;
            },
            kept};
  }
  std::string rows;
  std::vector<std::function<Value(Frame&)>> values;
  for (int i = 0; i < width; ++i) {
    const Expr row = tamed(make({Scalar::Float, width}, depth - 1));
    rows += (i == 0 ? "" : ", ") + row.text;
    values.push_back(row.value);
  }
  return {type, fmt::format("{}({})", spelling({}, type), rows),
          [values, width](Frame& frame) {
            Value r;
            for (int i = 0; i < width; ++i) {
              const Value row = values[static_cast<std::size_t>(i)](frame);
              for (int k = 0; k < width; ++k) r.set(i * width + k, row.asFloat(k));
            }
            return r;
          },
          kept};
}

Expr Expressions::makeKept(Type type, int depth) {
  const Records& records = *scope_.records;
  if (type.isMatrix) return matrix(type.width, depth);
  if (type.record < 0) {
    Expr expr = make({arithmeticScalar(type.scalar), type.width}, depth);
    if (type.scalar == Scalar::Float || type.scalar == Scalar::Half) expr = tamed(expr);
    // Storage types need an explicit conversion. So does bool: in braces, Clang does not accept a component of a bool vector.
    const bool isBool = type == Type{Scalar::Bool, 1};
    if (isNarrow(type.scalar) || isBool)
      expr.text = fmt::format("{}({})", spelling(records, type), expr.text);
    expr.value = [inner = expr.value, &records, type](Frame& frame) {
      return quantized(records, type, inner(frame));
    };
    expr.type = type;
    return expr;
  }
  std::vector<const Variable*> known;
  for (const Variable& variable : scope_.variables) {
    if (variable.type == type) known.push_back(&variable);
  }
  if (!known.empty() && random_.chance(1, 2)) return read(whole(*random_.pick(known), depth));
  std::string parts;
  std::vector<std::pair<std::function<Value(Frame&)>, int>> values;
  for (const Record::Member& member : records[static_cast<std::size_t>(type.record)].members) {
    const Expr part = makeKept(member.type, depth - 1);
    parts += (parts.empty() ? "" : ", ") + part.text;
    values.emplace_back(part.value, componentsOf(records, member.type));
  }
  return {type, fmt::format("{}{{{}}}", spelling(records, type), parts),
          [values](Frame& frame) {
            Value r;
            std::size_t at = 0;
            for (const auto& [value, count] : values) {
              const Value part = value(frame);
              for (std::size_t i = 0; i < static_cast<std::size_t>(count); ++i) r.bits[at++] = part.bits[i];
            }
            return r;
          },
          kept};
}

std::optional<Expr> Expressions::call(Type type, int depth) {
  std::vector<const Function*> candidates;
  for (const Function& function : scope_.functions) {
    if (function.result.record < 0 && arithmeticScalar(function.result.scalar) == type.scalar &&
        !isNarrow(function.result.scalar))
      candidates.push_back(&function);
  }
  if (candidates.empty()) return std::nullopt;
  const Function& function = *random_.pick(candidates);
  std::string text;
  std::vector<std::pair<std::function<Value(Frame&)>, int>> arguments;
  for (const Variable& parameter : function.parameters) {
    const Expr argument = makeKept(parameter.type, depth - 1);
    text += (text.empty() ? "" : ", ") + argument.text;
    arguments.emplace_back(argument.value, parameter.slot);
  }
  return fit(
      {function.result, fmt::format("{}({})", function.name, text),
       [arguments, run = function.call](Frame& frame) {
         std::vector<Value> values;  // evaluated before any is stored: an argument may call the function, too
         for (const auto& argument : arguments) values.push_back(argument.first(frame));
         for (std::size_t i = 0; i < values.size(); ++i) {
           frame.slots[static_cast<std::size_t>(arguments[i].second)] = values[i];
         }
         return run(frame);
       },
       kept},
      type.width, depth);
}

std::optional<Expr> Expressions::gatherRead(Type type, int depth) {
  std::vector<const Gather*> candidates;
  for (const Gather& gather : scope_.gathers) {
    const Scalar scalar =
        isNormalized(gather.type.scalar) ? Scalar::Int : arithmeticScalar(gather.type.scalar);
    if (gather.type.record < 0 && !gather.type.isMatrix && scalar == type.scalar)
      candidates.push_back(&gather);
  }
  if (candidates.empty()) return std::nullopt;
  const Gather& gather = *random_.pick(candidates);
  const bool isNear = gather.hasNeighbors && random_.chance(1, 2);
  const bool isFloat = !isNear && random_.chance(1, 5);
  const Expr index = tamed(make({isFloat ? Scalar::Float : Scalar::Int, gather.rank}, depth - 1));
  std::string text;
  if (isNear) {
    text = fmt::format("neighbor({}, {})", gather.name, index.text);
  } else {
    text = fmt::format("{}[{}]", gather.name, index.text);
  }
  // Reads the element like a variable that holds it.
  const auto element = [gather, at = index.value, isNear, isFloat](Frame& frame) {
    const Value where = at(frame);
    std::array<std::int64_t, 2> place{};
    for (std::size_t d = 0; d < static_cast<std::size_t>(gather.rank); ++d) {
      const int i = static_cast<int>(d);
      place[d] = isFloat ? static_cast<std::int64_t>(std::floor(where.asFloat(i) + 0.5F)) : where.asInt(i);
      if (isNear) place[d] += frame.index[d];
    }
    return gathered(gather, (*frame.streams)[static_cast<std::size_t>(gather.stream)], place);
  };
  const Place place{gather.type, text, {}, false};
  Expr result = read(place);
  const Type elementType = gather.type;
  result.value = [element, elementType](Frame& frame) {
    Value value = element(frame);
    if (!isNormalized(elementType.scalar)) return value;
    for (int i = 0; i < elementType.width; ++i) {
      value.set(i, static_cast<std::uint32_t>(static_cast<std::int32_t>(
                       std::nearbyint(value.asFloat(i) * scaleOf(elementType.scalar)))));
    }
    return value;
  };
  return fit(result, type.width, depth);
}

}  // namespace fuzz
