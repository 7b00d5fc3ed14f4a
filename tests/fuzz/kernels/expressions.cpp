// SPDX-License-Identifier: MIT
#include "kernels/expressions.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include <fmt/format.h>

#include "kernels/operations.hpp"
#include "sk/types.hpp"

namespace fuzz {
namespace {

constexpr char axes[] = "xyzw";

bool isFunction(const char* what) { return what[0] >= 'a' && what[0] <= 'z'; }

/// Applies f component by component; a scalar operand is broadcast.
template <class F>
std::function<Value(Frame&)> componentwise(const Expr& a, const Expr& b, int width, F f) {
  return [left = a.value, right = b.value, aWide = a.type.width > 1, bWide = b.type.width > 1, width,
          f](Frame& frame) {
    const Value x = left(frame), y = right(frame);
    Value r;
    for (int i = 0; i < width; ++i) f(r, i, x, aWide ? i : 0, y, bWide ? i : 0);
    return r;
  };
}

template <class F>
std::function<Value(Frame&)> componentwise(const Expr& a, F f) {
  return [inner = a.value, width = a.type.width, f](Frame& frame) {
    const Value x = inner(frame);
    Value r;
    for (int i = 0; i < width; ++i) f(r, i, x);
    return r;
  };
}

std::string binary(const char* what, const Expr& a, const Expr& b) {
  if (isFunction(what)) return fmt::format("{}({}, {})", what, a.text, b.text);
  return fmt::format("({} {} {})", a.text, what, b.text);
}
std::string unary(const char* what, const Expr& a) {
  return isFunction(what) ? fmt::format("{}({})", what, a.text) : fmt::format("({}{})", what, a.text);
}

}  // namespace

// ---- places and leaves ----------------------------------------------------------------------------

Place Expressions::whole(const Variable& variable, int depth) {
  if (variable.length == 0) {
    return {variable.type, variable.name,
            [slot = variable.slot](Frame&) {
              Where where{slot, {}};
              for (std::size_t i = 0; i < 16; ++i) where.components[i] = static_cast<std::uint8_t>(i);
              return where;
            },
            variable.isWritable};
  }
  // An index out of bounds is clamped.
  const Expr index = depth > 0 ? make({Scalar::Int, 1}, depth - 1) : makeLiteral({Scalar::Int, 1});
  return {variable.type, fmt::format("{}[{}]", variable.name, index.text),
          [slot = variable.slot, length = variable.length, at = index.value](Frame& frame) {
            Where where{slot + std::clamp(at(frame).asInt(0), 0, length - 1), {}};
            for (std::size_t i = 0; i < 16; ++i) where.components[i] = static_cast<std::uint8_t>(i);
            return where;
          },
          variable.isWritable};
}

std::vector<Place> Expressions::partsOf(const Place& place) {
  if (place.type.record < 0 && !place.type.isMatrix) return {place};
  std::vector<Place> parts{place};
  const auto add = [&](const Type& type, const std::string& suffix, int offset) {
    const Place part{type, place.text + suffix,
                     [outer = place.where, offset](Frame& frame) {
                       Where where = outer(frame);
                       for (std::size_t i = 0; i + static_cast<std::size_t>(offset) < 16; ++i) {
                         where.components[i] = where.components[i + static_cast<std::size_t>(offset)];
                       }
                       return where;
                     },
                     place.isWritable};
    const std::vector<Place> inner = partsOf(part);
    parts.insert(parts.end(), inner.begin(), inner.end());
  };
  int offset = 0;
  if (place.type.isMatrix) {
    for (int row = 0; row < place.type.width; ++row, offset += place.type.width) {
      add({Scalar::Float, place.type.width}, fmt::format("[{}]", row), offset);
    }
    return parts;
  }
  for (const Record::Member& member :
       (*scope_.records)[static_cast<std::size_t>(place.type.record)].members) {
    add(member.type, "." + member.name, offset);
    offset += componentsOf(*scope_.records, member.type);
  }
  return parts;
}

/// One or several components of a vector, by name or by a computed index.
Place Expressions::component(const Place& place, int depth) {
  const int width = place.type.width;
  if (random_.chance(1, 2)) {
    const Expr index = make({Scalar::Int, 1}, depth - 1);
    const int mask = width == 4 ? 3 : 1;
    return {{place.type.scalar, 1},
            fmt::format("{}[{} & {}]", place.text, index.text, mask),
            [outer = place.where, at = index.value, mask](Frame& frame) {
              const auto i = static_cast<std::size_t>(at(frame).asInt(0) & mask);
              Where where = outer(frame);
              where.components[0] = where.components[i];
              return where;
            },
            place.isWritable};
  }
  std::array<std::uint8_t, 4> order{0, 1, 2, 3};
  for (int i = width - 1; i > 0; --i) {
    std::swap(order[static_cast<std::size_t>(i)], order[random_.below(static_cast<std::size_t>(i) + 1)]);
  }
  const int count = random_.between(1, width);
  std::string names;
  for (int i = 0; i < count; ++i) names += axes[order[static_cast<std::size_t>(i)]];
  return {{place.type.scalar, count},
          place.text + "." + names,
          [outer = place.where, order, count](Frame& frame) {
            const Where all = outer(frame);
            Where where = all;
            for (std::size_t i = 0; i < static_cast<std::size_t>(count); ++i) {
              where.components[i] = all.components[order[i]];
            }
            return where;
          },
          place.isWritable};
}

std::optional<Place> Expressions::writable(int depth) {
  std::vector<const Variable*> candidates;
  for (const Variable& variable : scope_.variables) {
    if (variable.isWritable) candidates.push_back(&variable);
  }
  if (candidates.empty()) return std::nullopt;
  const std::vector<Place> parts = partsOf(whole(*random_.pick(candidates), depth));
  Place place = random_.pick(parts);
  const bool isVector = place.type.record < 0 && !place.type.isMatrix && place.type.width > 1;
  if (isVector && !isNormalized(place.type.scalar) && random_.chance(1, 3)) place = component(place, depth);
  return place;
}

Expr Expressions::read(const Place& place) {
  const Type type = place.type;
  const auto load = [where = place.where, count = componentsOf(*scope_.records, type)](Frame& frame) {
    const Where at = where(frame);
    const Value& slot = frame.slots[static_cast<std::size_t>(at.slot)];
    Value value;
    for (std::size_t i = 0; i < static_cast<std::size_t>(count); ++i)
      value.bits[i] = slot.bits[at.components[i]];
    return value;
  };
  if (type.record >= 0 || type.isMatrix) return {type, place.text, load, kept};
  const Type arithmetic{arithmeticScalar(type.scalar), type.width};
  if (!isNarrow(type.scalar)) return {type, place.text, load, kept};
  const std::string wide = fmt::format("{}({})", spelling({}, arithmetic), place.text);
  if (!isNormalized(type.scalar)) return {arithmetic, wide, load, kept};
  // The stored integer, which is exact.
  const float scale = scaleOf(type.scalar);
  Expr number{{Scalar::Int, type.width},
              fmt::format("{}(roundEven({} * {:.1f}))", spelling({}, {Scalar::Int, type.width}), wide, scale),
              [load, scale, width = type.width](Frame& frame) {
                Value value = load(frame);
                for (int i = 0; i < width; ++i) {
                  value.set(i, static_cast<std::uint32_t>(
                                   static_cast<std::int32_t>(std::nearbyint(value.asFloat(i) * scale))));
                }
                return value;
              }};
  return number;
}

/// `expr` with another number of components.
Expr Expressions::fit(Expr expr, int width, int depth) {
  const Type type{expr.type.scalar, width};
  if (expr.type.width == width) return expr;
  if (expr.type.width > 1 && expr.type.width > width) {
    std::array<int, 4> picks{};
    std::string names;
    for (int i = 0; i < width; ++i) {
      picks[static_cast<std::size_t>(i)] = random_.between(0, expr.type.width - 1);
      names += axes[picks[static_cast<std::size_t>(i)]];
    }
    return {type, expr.text + "." + names,
            [inner = expr.value, picks, width](Frame& frame) {
              const Value x = inner(frame);
              Value r;
              for (std::size_t i = 0; i < static_cast<std::size_t>(width); ++i) {
                r.bits[i] = x.bits[static_cast<std::size_t>(picks[i])];
              }
              return r;
            },
            expr.bound};
  }
  const std::string name = spelling({}, type);
  if (expr.type.width == 1 && random_.chance(1, 2)) {   // broadcast
    return {type, fmt::format("{}({})", name, expr.text),
            [inner = expr.value](Frame& frame) {
              Value r = inner(frame);
              r.bits.fill(r.bits[0]);
              return r;
            },
            expr.bound};
  }
  const int first = expr.type.width;
  const Expr rest = make({expr.type.scalar, width - first}, depth - 1);
  return {type,
          fmt::format("{}({}, {})", name, expr.text, rest.text),
          [a = expr.value, b = rest.value, first, width](Frame& frame) {
            Value r = a(frame);
            const Value more = b(frame);
            for (int i = first; i < width; ++i) {
              r.bits[static_cast<std::size_t>(i)] = more.bits[static_cast<std::size_t>(i - first)];
            }
            return r;
          },
          {std::max(expr.bound.magnitude, rest.bound.magnitude),
           std::max(expr.bound.fraction, rest.bound.fraction)}};
}

Expr Expressions::makeLiteral(Type type) {
  Value value = randomValue({}, type, random_);
  if (type.scalar != Scalar::Float && random_.chance(2, 3)) {
    for (std::uint32_t& bits : value.bits) bits &= type.scalar == Scalar::Bool ? 1u : 15u;
  }
  return {type, literal(type, value), [value](Frame&) { return value; }, kept};
}

/// A part of a variable with the same arithmetic type, or a literal.
Expr Expressions::leaf(Type type, int depth) {
  std::vector<Place> fitting;
  if (!scope_.variables.empty() && !random_.chance(1, 6)) {
    for (int tries = 0; tries < 4 && fitting.empty(); ++tries) {
      for (const Place& part : partsOf(whole(random_.pick(scope_.variables), std::max(depth, 0)))) {
        if (part.type.record >= 0 || part.type.isMatrix) continue;
        const Scalar scalar =
            isNormalized(part.type.scalar) ? Scalar::Int : arithmeticScalar(part.type.scalar);
        if (scalar == type.scalar) fitting.push_back(part);
      }
    }
  }
  if (fitting.empty()) return makeLiteral(type);
  return fit(read(random_.pick(fitting)), type.width, depth);
}

// ---- by type --------------------------------------------------------------------------------------

Expr Expressions::make(Type type, int depth) {
  if (depth <= 0) return leaf(type, 0);
  if (random_.chance(1, 8)) return chosen(type, depth);
  if (random_.chance(1, 5)) {
    if (const std::optional<Expr> result = call(type, depth)) return *result;
  }
  if (random_.chance(1, 4)) {
    if (const std::optional<Expr> result = gatherRead(type, depth)) return *result;
  }
  if (random_.chance(1, 7)) return leaf(type, depth);
  switch (type.scalar) {
    case Scalar::Bool: return makeBool(type.width, depth);
    case Scalar::Float: return makeFloat(type.width, depth);
    default: return makeInteger(type.scalar, type.width, depth);
  }
}

Expr Expressions::tamed(Expr expr) {
  if (expr.bound.magnitude <= kept.magnitude && expr.bound.fraction <= kept.fraction) return expr;
  const float unit = 1 << kept.fraction, most = 1 << kept.magnitude;
  return {
      expr.type,
      fmt::format("clamp(floor({} * {:.1f}) / {:.1f}, -{:.1f}, {:.1f})", expr.text, unit, unit, most, most),
      componentwise(expr,
                    [unit, most](Value& r, int i, const Value& x) {
                      r.set(i, std::clamp(std::floor(x.asFloat(i) * unit) / unit, -most, most));
                    }),
      kept};
}

Expr Expressions::makeFloat(int width, int depth) {
  const Type type{Scalar::Float, width};
  switch (random_.below(8)) {
    case 0: {   // conversion of a small integer
      const Expr small = make({random_.chance(1, 2) ? Scalar::Int : Scalar::Uint, width}, depth - 1);
      const char* mask = small.type.scalar == Scalar::Int ? "63" : "63u";
      return {type,
              fmt::format("{}({} & {})", spelling({}, type), small.text, mask),
              componentwise(small, [](Value& r, int i,
                                      const Value& x) { r.set(i, static_cast<float>(x.asUint(i) & 63)); }),
              {6, 0}};
    }
    case 1: {
      const Expr flag = make({Scalar::Bool, width}, depth - 1);
      return {type,
              fmt::format("{}({})", spelling({}, type), flag.text),
              componentwise(
                  flag, [](Value& r, int i, const Value& x) { r.set(i, x.asUint(i) != 0 ? 1.0F : 0.0F); }),
              {0, 0}};
    }
    case 2: {
      const FloatFunction& function = randomFloatFunction(random_);
      const Expr a = make(type, depth - 1);
      return {type, unary(function.what, a),
              componentwise(
                  a, [f = function.value](Value& r, int i, const Value& x) { r.set(i, f(x.asFloat(i))); }),
              function.bound(a.bound)};
    }
    case 3:
      if (width > 1) return product(width, depth);
      [[fallthrough]];
    case 4:
      if (width == 1) {
        Expr a = tamed(make({Scalar::Float, random_.between(2, 4)}, depth - 1));
        const Expr b = tamed(make(a.type, depth - 1));
        return {type,
                fmt::format("dot({}, {})", a.text, b.text),
                [x = a.value, y = b.value, count = a.type.width](Frame& frame) {
                  const Value left = x(frame), right = y(frame);
                  float sum = 0;
                  for (int i = 0; i < count; ++i) sum += left.asFloat(i) * right.asFloat(i);
                  Value r;
                  r.set(0, sum);
                  return r;
                },
                {2 * kept.magnitude + 2, 2 * kept.fraction}};
      }
      [[fallthrough]];
    default: {
      const FloatOperation& operation = randomFloatOperation(random_);
      Expr a = make(type, depth - 1);
      // The second operand may be a scalar, which is broadcast.
      Expr b = make({Scalar::Float, random_.chance(1, 4) && operation.what[0] != 's' ? 1 : width}, depth - 1);
      if (operation.bound(a.bound, b.bound).bits() > exactBits) a = tamed(a), b = tamed(b);
      return {type, binary(operation.what, a, b),
              componentwise(a, b, width,
                            [f = operation.value](Value& r, int i, const Value& x, int ai, const Value& y,
                                                  int bi) { r.set(i, f(x.asFloat(ai), y.asFloat(bi))); }),
              operation.bound(a.bound, b.bound)};
    }
  }
}

Expr Expressions::makeInteger(Scalar scalar, int width, int depth) {
  const Type type{scalar, width};
  switch (random_.below(9)) {
    case 0: {
      const bool isInt = scalar == Scalar::Int;
      const Expr x = make({Scalar::Float, width}, depth - 1);
      return {type, fmt::format("{}({}({}))", spelling({}, type), isInt ? "floor" : "abs", x.text),
              componentwise(x, [isInt](Value& r, int i, const Value& v) {
                const float f = isInt ? std::floor(v.asFloat(i)) : std::fabs(v.asFloat(i));
                r.set(i, static_cast<std::uint32_t>(static_cast<std::int32_t>(f)));
              })};
    }
    case 1: {   // a conversion that keeps the bits
      const Expr other = make({scalar == Scalar::Int ? Scalar::Uint : Scalar::Int, width}, depth - 1);
      return {type, fmt::format("{}({})", spelling({}, type), other.text), other.value};
    }
    case 2: {
      const IntFunction* function = &randomIntFunction(random_);
      while (scalar == Scalar::Uint && !function->forUint) function = &randomIntFunction(random_);
      const Expr a = make(type, depth - 1);
      return {type, unary(function->what, a),
              componentwise(
                  a, [f = function->value](Value& r, int i, const Value& x) { r.set(i, f(x.asUint(i))); })};
    }
    case 3: {
      if (scalar == Scalar::Int && width > 1) return comparison(width, depth);
      const Expr flag = make({Scalar::Bool, width}, depth - 1);
      return {type, fmt::format("{}({})", spelling({}, type), flag.text), flag.value};
    }
    case 4:
      if (scalar == Scalar::Int && !scope_.indexed.empty()) return position(width);
      [[fallthrough]];
    default: {
      const IntOperation& operation = randomIntOperation(random_);
      const Expr a = make(type, depth - 1);
      Expr b =
          operation.right == IntOperation::Right::Divisor ? makeLiteral({scalar, 1}) : make(type, depth - 1);
      if (operation.right == IntOperation::Right::Divisor) {
        Value divisor;
        divisor.set(0, static_cast<std::uint32_t>(random_.between(1, 20)));
        b = {{scalar, 1}, literal({scalar, 1}, divisor), [divisor](Frame&) { return divisor; }};
      } else if (operation.right == IntOperation::Right::Shift) {
        b.text = fmt::format("({} & {})", b.text, scalar == Scalar::Int ? "31" : "31u");
      }
      const auto f = scalar == Scalar::Int ? operation.asInt : operation.asUint;
      return {
          type, binary(operation.what, a, b),
          componentwise(a, b, width, [f](Value& r, int i, const Value& x, int ai, const Value& y, int bi) {
            r.set(i, f(x.asUint(ai), y.asUint(bi)));
          })};
    }
  }
}

Expr Expressions::position(int width) {
  const bool isIndex = random_.chance(2, 3);
  const Expr all{{Scalar::Int, 4},
                 fmt::format("{}({})", isIndex ? "indexof" : "extentof", random_.pick(scope_.indexed)),
                 [isIndex](Frame& frame) {
                   Value r;
                   const std::array<int, 4>& from = isIndex ? frame.index : frame.extent;
                   for (int i = 0; i < 4; ++i)
                     r.set(i, static_cast<std::uint32_t>(from[static_cast<std::size_t>(i)]));
                   return r;
                 }};
  return fit(all, width, 0);
}

}  // namespace fuzz
