// SPDX-License-Identifier: MIT
//
// What reduces, scans and folded outputs add up.
#include <algorithm>
#include <cmath>

#include "numbers/adversary.sk.hpp"
#include "numbers/operations.hpp"
#include "numbers/signature.hpp"

namespace fuzz::numbers {
namespace {

using In = const std::vector<Values>&;

void addSum(In in, std::size_t i, std::int64_t, Terms& terms) { terms.add(0, in[0][i]); }
void addSum3(In in, std::size_t i, std::int64_t, Terms& terms) {
  for (std::size_t c = 0; c < 3; ++c) terms.add(c, in[0][3 * i + c]);
}
void addProducts(In in, std::size_t i, std::int64_t, Terms& terms) { terms.add(0, in[0][i], in[1][i]); }

/// A difference is rounded to a float first, which is 0 on some devices where it is denormal.
void addDifferences(In in, std::size_t i, std::int64_t, Terms& terms) {
  if (terms.isWide) {
    terms.add(0, in[0][i]);
    return terms.add(0, -in[1][i]);
  }
  const float difference = static_cast<float>(in[0][i]) - static_cast<float>(in[1][i]);
  const bool isUnknown = isDenormal(difference) || isDenormal(in[0][i]) || isDenormal(in[1][i]);
  if (isUnknown && terms.arithmetic.flushesDenormals) return terms.addUnknown(0);
  terms.add(0, difference);
}

constexpr std::int64_t tableSize = 64;
void addNeighbors(In in, std::size_t, std::int64_t last, Terms& terms) {
  const std::int64_t trips = in.size() == 2 ? 36 : static_cast<std::int64_t>(in[2][0]);
  for (std::int64_t k = 0; k < trips; ++k)
    terms.add(0, in[1][static_cast<std::size_t>((last + k) % tableSize)]);
}
void addWeighted(In in, std::size_t i, std::int64_t, Terms& terms) {
  const auto trips = static_cast<std::size_t>(in[2][0]);
  for (std::size_t k = 0; k < trips; ++k)
    terms.add(0, in[0][i], in[1][std::min<std::size_t>(k, tableSize - 1)]);
}

void addSeveral(In in, std::size_t i, std::int64_t, Terms& terms) {
  const double x = in[0][i], y = in[1][i];
  if (terms.arithmetic.flushesDenormals && (isDenormal(x) || isDenormal(y))) {
    terms.addUnknown(0);
  } else if (x > y) {
    terms.add(0, x);
    terms.add(0, -y);
  }
  terms.take(1, x);
  terms.take(2, x);
  terms.add(3, y);
}
void addCount(In in, std::size_t i, std::int64_t, Terms& terms) {
  terms.take(0, in[0][i]);
  terms.take(1, in[0][i]);
}

void addFolded(In in, std::size_t i, std::int64_t, Terms& terms) {
  terms.add(0, in[0][i]);
  terms.add(1, in[0][i], in[1][i]);
}
bool acceptsFolded(const MapJudge& judge, Arguments x, std::size_t, double got) {
  if (std::isnan(x[0]) || std::isnan(x[1]))
    return judge.equals(static_cast<float>(std::fmax(x[0], x[1])), got);
  return judge.equals(static_cast<float>(std::max(x[0], x[1])), got) || (x[0] == x[1] && got == x[0]);
}
void addFoldedNeighbors(In in, std::size_t i, std::int64_t, Terms& terms) {
  const auto count = static_cast<std::int64_t>(in[0].size());
  for (std::int64_t k = -17; k < 17; ++k)
    terms.add(0, in[0][static_cast<std::size_t>(
                     std::clamp<std::int64_t>(static_cast<std::int64_t>(i) + k, 0, count - 1))]);
}
bool acceptsSame(const MapJudge& judge, Arguments x, std::size_t, double got) {
  return judge.equals(static_cast<float>(x[0]), got);
}
bool acceptsNegative(const MapJudge&, Arguments x, std::size_t, double got) {
  return got == static_cast<double>(static_cast<std::int32_t>(
                    0U - static_cast<std::uint32_t>(static_cast<std::int32_t>(x[0]))));
}

template <const auto& kernel, class Ins, class Outs>
Operation fold(Kind kind, std::string_view name, std::vector<FoldKind> folds,
               decltype(Operation::addTerms) addTerms, bool startsFromZero = true,
               decltype(Operation::accepts) accepts = nullptr) {
  bool hasDoubles = false, isForReals = true;
  for (const Parameter& parameter : Ins::parameters()) {
    hasDoubles = hasDoubles || parameter.element == Element::Double;
    if (parameter.role == Role::Elements &&
        (parameter.element == Element::Int || parameter.element == Element::Uint))
      isForReals = false;
  }
  return {.name = name,
          .kind = kind,
          .inputs = Ins::parameters(),
          .outputs = Outs::elements(),
          .folds = std::move(folds),
          .startsFromZero = startsFromZero,
          .hasDoubles = hasDoubles,
          .call = callKernel<kernel, Ins, Outs>,
          .accepts = accepts,
          .addTerms = addTerms,
          .isForReals = isForReals};
}

using Term = Elements<float, Data::Terms>;
using WideTerm = Elements<double, Data::Terms>;
using Count = Elements<std::int32_t, Data::Integers>;
using Hashed = Elements<std::uint32_t, Data::Integers>;
using Weights = Table<float, Data::Terms>;
using Trips = Uniform<std::int32_t, Data::Trips>;
template <class... P>
using I = Inputs<P...>;
template <class... T>
using O = Outputs<T...>;

}  // namespace

std::vector<Operation> foldOperations() {
  namespace k = adversary;
  using enum FoldKind;
  using enum Kind;
  const std::vector<FoldKind> one{FloatSum}, three{FloatSum, FloatSum, FloatSum}, wide{DoubleSum},
      counts{IntSum, MostInt}, hashes{HashValue, HashPower};
  using Int = std::int32_t;
  using Uint = std::uint32_t;
  return {
      fold<k::sum, I<Term>, O<float>>(Reduce, "sum", one, addSum, false),
      fold<k::sumFrom, I<Term>, O<float>>(Reduce, "sumFrom", one, addSum),
      fold<k::sum3, I<Elements<sk::float3, Data::Terms>>, O<sk::float3>>(Reduce, "sum3", three, addSum3,
                                                                         false),
      fold<k::products, I<Term, Term>, O<float>>(Reduce, "products", one, addProducts),
      fold<k::differences, I<Term, Term>, O<float>>(Reduce, "differences", one, addDifferences),
      fold<k::neighbors, I<Term, Weights>, O<float>>(Reduce, "neighbors", one, addNeighbors),
      fold<k::weighted, I<Term, Weights, Trips>, O<float>>(Reduce, "weighted", one, addWeighted),
      fold<k::several, I<Term, Term>, O<float, float, float, float>>(
          Reduce, "several", {FloatSum, Least, Most, FloatSum}, addSeveral),
      fold<k::wideSum, I<WideTerm>, O<double>>(Reduce, "wideSum", wide, addSum),
      fold<k::wideProducts, I<WideTerm, WideTerm>, O<double>>(Reduce, "wideProducts", wide, addProducts),
      fold<k::count, I<Count>, O<Int, Int>>(Reduce, "count", counts, addCount),
      fold<k::hash, I<Hashed>, O<Uint, Uint>>(Reduce, "hash", hashes, addCount),
      fold<k::running, I<Term>, O<float>>(Scan, "running", one, addSum),
      fold<k::running3, I<Elements<sk::float3, Data::Terms>>, O<sk::float3>>(Scan, "running3", three,
                                                                             addSum3),
      fold<k::runningProducts, I<Term, Term>, O<float>>(Scan, "runningProducts", one, addProducts),
      fold<k::runningNeighbors, I<Term, Weights, Trips>, O<float>>(Scan, "runningNeighbors", one,
                                                                   addNeighbors),
      fold<k::runningWeighted, I<Term, Weights, Trips>, O<float>>(Scan, "runningWeighted", one, addWeighted),
      fold<k::runningWideSum, I<WideTerm>, O<double>>(Scan, "runningWideSum", wide, addSum),
      fold<k::runningCount, I<Count>, O<Int, Int>>(Scan, "runningCount", counts, addCount),
      fold<k::runningHash, I<Hashed>, O<Uint, Uint>>(Scan, "runningHash", hashes, addCount),
      fold<k::folded, I<Term, Term>, O<float, float, float>>(Fold, "folded", {FloatSum, FloatSum}, addFolded,
                                                             true, acceptsFolded),
      fold<k::foldedNeighbors, I<Gathered<float, Data::Terms>>, O<float, float>>(
          Fold, "foldedNeighbors", one, addFoldedNeighbors, true, acceptsSame),
      fold<k::foldedCount, I<Count>, O<Int, Int, Int>>(Fold, "foldedCount", counts, addCount, true,
                                                       acceptsNegative),
  };
}

std::size_t Operation::componentsOfElementOutputs() const {
  std::size_t all = 0;
  for (const Element output : outputs) all += static_cast<std::size_t>(components(output));
  return all - folds.size();
}

const std::vector<Operation>& operations() {
  static const std::vector<Operation> all = [] {
    std::vector<Operation> made = mapOperations();
    for (Operation& one : foldOperations()) made.push_back(std::move(one));
    return made;
  }();
  return all;
}

const Operation& operationNamed(std::string_view name) {
  const auto found = std::ranges::find(operations(), name, &Operation::name);
  if (found == operations().end()) throw std::runtime_error("no operation is '" + std::string(name) + "'");
  return *found;
}

}  // namespace fuzz::numbers
