// SPDX-License-Identifier: MIT
//
// Reads of gathers, and what gives them indices: in every spelling, inside and outside, at a rank that is known or is a template's N.
#include "cpp/body.hpp"

namespace fuzz::cpp {

void Body::access(std::string& text, std::vector<Expr>& parts, int rank, int depth) {
  const bool isNear = random_.chance(1, 3);
  if (rank == anyRank) {
    text = isNear ? "neighbor(" + text + ", $)" : text + "[$]";
    parts.push_back(isNear ? offsetOfAnyRank(depth) : ofAnyRank(depth));
    return;
  }
  const auto number = [&] { return isNear ? gatherOffset(depth - 1) : gatherIndex(depth - 1); };
  const auto vector = [&](int width) {
    std::string spelled = "int" + std::to_string(width) + "(";
    for (int d = 0; d < width; ++d) {
      spelled += d == 0 ? "$" : ", $";
      parts.push_back(number());
    }
    return spelled + ")";
  };
  const bool isWhole = rank > 1 && random_.chance(1, 2);
  if (isNear) {
    const int count = isWhole ? rank : random_.between(1, rank);
    std::string offsets;
    for (int d = 0; d < count && !isWhole; ++d) {
      offsets += ", $";
      parts.push_back(number());
    }
    text = "neighbor(" + text + (isWhole ? ", " + vector(rank) : offsets) + ")";
    return;
  }
  int left = rank;
  if (unit_.with("floats", 1, 8) && depth > 0) {
    text += "[$]";
    parts.push_back(floatIndex(isWhole ? rank : 1, depth - 1));
    left -= isWhole ? rank : 1;
  }
  const int whole = isWhole && left > 1 ? random_.between(2, left) : 0;
  for (; left > whole; --left) {
    text += "[$]";
    parts.push_back(number());
  }
  if (left > 0) text += "[" + vector(left) + "]";
}

/// Often one that small gathers have.
Expr Body::gatherIndex(int depth) {
  const TypeId type = Types::of(Scalar::Int);
  if (isFull()) return literal(type);
  Expr any = value(type, depth);
  if (random_.chance(1, 2)) {
    // .sk refuses a comma there.
    return any.node->text.starts_with("($, ") ? made("int($)", type, listOf(std::move(any)), true)
                                              : std::move(any);
  }
  return made("($ & 7)", type, listOf(std::move(any)), true);
}

/// A small one: what lies beyond all integers is not said.
Expr Body::gatherOffset(int depth) {
  const TypeId type = Types::of(Scalar::Int);
  if (depth <= 0 || isFull() || random_.chance(1, 2))
    return made(std::to_string(random_.between(-3, 3)), type, {}, true);
  Expr any = value(type, depth);
  return made("(($ & 7) - 3)", type, listOf(std::move(any)), true);
}

Expr Body::floatIndex(int width, int depth) {
  const TypeId type = width == 1 ? Types::of(Scalar::Float) : Types::vector(Scalar::Float, width);
  Expr result = limited(value(type, depth), 7);
  result.node->isGuard = true;
  return result;
}

std::optional<Expr> Body::gather(const Accepts& accepts) {
  const std::optional<Place> found =
      place([&](TypeId id) { return types_.isGather(id) && accepts(id); }, false);
  if (!found) return std::nullopt;
  Expr result = spelled(*found, 0);
  result.node->isGuard = true;
  return result;
}

std::string Body::axis() {
  std::vector<std::string> numbers = {"0", "N - 1"};
  for (const Variable& variable : variables_) {
    if (variable.isAxis) numbers.insert(numbers.end(), 2, variable.name);
  }
  return random_.pick(numbers);
}

Expr Body::ofAnyRank(int depth) {
  const TypeId type = Types::indexOfAnyRank();
  if (depth <= 0 || isFull()) {
    if (random_.chance(1, 3)) {
      if (std::optional<Expr> found = read([&](TypeId id) { return id == type; }, 0))
        return std::move(*found);
    }
    if (isKernel_ && random_.chance(1, 2)) return made("indexof<N>(r0)", type, {});
    return literal(type);
  }
  switch (random_.below(6)) {
    case 0:
      if (std::optional<Expr> found = gather([&](TypeId id) { return types_[id].count == anyRank; }))
        return made("extentof<N>($)", type, listOf(std::move(*found)));
      break;
    case 1: {
      Expr any = ofAnyRank(depth - 1);
      return made("(-$)", type, listOf(std::move(any)));
    }
    case 2: {
      Expr any = ofAnyRank(depth - 1);
      Expr factor = unsequenced(any, value(Types::of(Scalar::Int), depth - 1));
      return made("($ * $)", type, listOf(std::move(any), std::move(factor)));
    }
    case 3: {
      Expr number = value(Types::of(Scalar::Int), depth - 1);
      return made("index<N>($)", type, listOf(std::move(number)));
    }
    default: break;
  }
  Expr a = value(type, depth - 1);
  Expr b = unsequenced(a, value(type, depth - 1));
  return made(random_.chance(1, 2) ? "($ + $)" : "($ - $)", type, listOf(std::move(a), std::move(b)));
}

Expr Body::offsetOfAnyRank(int depth) {
  const TypeId type = Types::indexOfAnyRank();
  if (depth > 0 && random_.chance(1, 4)) {
    Expr a = offsetOfAnyRank(depth - 1), b = offsetOfAnyRank(depth - 1);
    return made(random_.chance(1, 2) ? "($ + $)" : "($ - $)", type, listOf(std::move(a), std::move(b)), true);
  }
  if (random_.chance(1, 4))
    return made("index<N>(" + std::to_string(random_.between(-2, 2)) + ")", type, {}, true);
  return made((random_.chance(1, 2) ? "axis<N>(" : "-axis<N>(") + axis() + ")", type, {}, true);
}

std::optional<Expr> Body::streamInteger(int depth) {
  const TypeId type = Types::of(Scalar::Int);
  const std::string component(1, "xyzw"[random_.below(4)]);
  switch (random_.below(4)) {
    case 0:
      if (isKernel_)
        return made((random_.chance(2, 3) ? "indexof(r0)." : "extentof(r0).") + component, type, {});
      break;
    case 1:
      if (isOfAnyRank_) {
        Expr any = ofAnyRank(depth - 1);
        return made("at<N>($, " + axis() + ")", type, listOf(std::move(any)));
      }
      break;
    case 2:
      if (std::optional<Expr> found = gather([](TypeId) { return true; }))
        return made("extentof($)." + component, type, listOf(std::move(*found)));
      break;
    default: break;
  }
  return read([&](TypeId id) { return types_.isLikeInteger(id); }, depth);
}

/// Between elements. All that it computes is exact: weights have two bits for each dimension.
std::optional<Expr> Body::sampled(int depth) {
  const TypeId type = Types::of(Scalar::Float);
  std::optional<Expr> whole =
      gather([&](TypeId id) { return types_[id].element == type && types_[id].count != anyRank; });
  if (!whole) return std::nullopt;
  const int rank = types_[whole->type].count;
  Expr position = floatIndex(rank, depth - 1);
  Expr result = made("sample($, $)", type, listOf(std::move(*whole), std::move(position)), true);
  result.range = {4, 2 + 2 * rank};
  return result;
}

}  // namespace fuzz::cpp
