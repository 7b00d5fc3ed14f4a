// SPDX-License-Identifier: MIT
#include "numbers/generator.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "numbers/data.hpp"
#include "numbers/operations.hpp"
#include "random.hpp"

namespace fuzz::numbers {
namespace {

using Extents = std::vector<std::int64_t>;

std::int64_t sizeOf(const Extents& shape) {
  std::int64_t size = 1;
  for (const std::int64_t extent : shape) size *= extent;
  return size;
}

/// Extents around those at which plans of folds change.
std::int64_t extent(Random& random, std::int64_t most) {
  const std::array ends{1,   2,   3,    4,    7,    8,    15,   16,   17,   31,   32,    33,  34,
                        40,  48,  63,   64,   65,   96,   100,  127,  128,  129,  200,   255, 256,
                        257, 512, 1000, 1023, 1024, 1025, 2047, 2049, 4096, 5000, 20'000};
  const auto last = std::ranges::upper_bound(ends, static_cast<int>(most));
  const auto choices = static_cast<std::size_t>(std::max<std::ptrdiff_t>(last - ends.begin(), 1));
  return ends[random.below(choices)];
}

Extents shape(Random& random, std::int64_t most) {
  Extents made;
  const std::size_t rank = random.pick(std::array<std::size_t, 8>{1, 1, 1, 2, 2, 2, 3, 4});
  std::int64_t left = most;
  for (std::size_t d = 0; d < rank; ++d) {
    made.push_back(extent(random, std::max<std::int64_t>(d + 1 == rank ? left : left / 2, 1)));
    left = std::max<std::int64_t>(left / made.back(), 1);
  }
  std::ranges::rotate(made, made.begin() + static_cast<std::ptrdiff_t>(random.below(rank)));
  return made;
}

std::int64_t divisor(Random& random, std::int64_t n) {
  Extents all;
  for (std::int64_t d = 1; d <= std::min<std::int64_t>(n, 64); ++d) {
    if (n % d == 0) all.push_back(d);
  }
  all.push_back(n);
  return random.pick(all);
}

void chooseResult(Random& random, Case& made) {
  for (const std::int64_t one : made.shape)
    made.result.push_back(random.chance(1, 3) ? 1 : random.chance(1, 3) ? one : divisor(random, one));
}

void chooseRows(Random& random, Case& made) {
  made.shape = {extent(random, 3000)};
  const std::int64_t count = made.shape[0];
  // A scan has a result for each element, so that all elements are in rows.
  const bool areAll = operationNamed(made.operation).kind == Kind::Scan;
  made.starts.push_back(!areAll && random.chance(1, 4) ? std::min<std::int64_t>(random.between(0, 3), count)
                                                       : 0);
  while (made.starts.back() < count && made.starts.size() < 200) {
    const std::int64_t length = random.chance(1, 6) ? 0 : extent(random, random.chance(1, 3) ? 1000 : 70);
    made.starts.push_back(std::min(made.starts.back() + length, count));
    if (!areAll && random.chance(1, 60)) break;
  }
  if (made.starts.size() == 1 || areAll) made.starts.push_back(count);
}

void chooseOptions(Random& random, const Operation& operation, Case& made) {
  using sk::Accumulate;
  using sk::Precision;
  sk::CallOptions& options = made.options;
  const bool sumsFloats = std::ranges::count(operation.folds, FoldKind::FloatSum) > 0;
  if (sumsFloats) {
    options.accumulate = random.pick(std::array{Accumulate::Exact, Accumulate::Exact, Accumulate::Exact,
                                                Accumulate::Compensated, Accumulate::Compensated,
                                                Accumulate::Tree, Accumulate::Extended, Accumulate::Default});
  }
  if (operation.isForReals && !operation.hasDoubles) {
    if (operation.kind == Kind::Map) {
      options.precision = random.pick(std::array{Precision::Default, Precision::Default, Precision::Default,
                                                 Precision::Double, Precision::Extended});
      const bool isArithmetic = operation.name == "operators" || operation.name == "literals";
      if (isArithmetic && random.chance(1, 4)) options.precision = Precision::Half;
    } else if (options.accumulate == Accumulate::Default || options.accumulate == Accumulate::Tree) {
      if (random.chance(1, 2))
        options.precision = random.chance(1, 2) ? Precision::Double : Precision::Extended;
    }
  }
  if ((operation.name == "fused" && random.chance(1, 2)) || random.chance(1, 20))
    options.contraction = sk::Contraction::Fast;
  if (operation.kind == Kind::Scan) {
    if (random.chance(1, 3)) options.scan = sk::Scan::Exclusive;
    if (made.starts.empty() && random.chance(2, 3))
      options.along = random.between(0, static_cast<int>(made.shape.size()) - 1);
  }
}

Values valuesOf(Random& random, const Parameter& parameter, const Case& made, std::size_t kindOfTerms) {
  if (parameter.data == Data::Trips)
    return {static_cast<double>(random.pick(std::array{1, 2, 31, 32, 33, 40, 64, 100, 254, 255, 256, 300}))};
  const std::size_t count =
      (parameter.role == Role::Table ? 64 : static_cast<std::size_t>(sizeOf(made.shape))) *
      static_cast<std::size_t>(components(parameter.element));
  const bool isDouble = parameter.element == Element::Double;
  if (parameter.data == Data::Integers) return integers(random, count, parameter.element == Element::Int);
  if (parameter.data == Data::Terms) {
    // Often of one kind, as products carry only where both factors do.
    const std::size_t kind = random.chance(1, 2) ? kindOfTerms : random.below(kindsOfTerms);
    return terms(random, count, isDouble ? doubleRange : floatRange, kind);
  }
  return arguments(random, count, parameter.data, isDouble);
}

void keep(Case& one, std::size_t parameter, const std::vector<bool>& stays, std::size_t width) {
  Values kept;
  for (std::size_t i = 0; i < stays.size(); ++i) {
    if (!stays[i]) continue;
    for (std::size_t c = 0; c < width; ++c) kept.push_back(one.inputs[parameter][i * width + c]);
  }
  one.inputs[parameter] = std::move(kept);
}

/// The case with only some of the indices of a dimension.
Case cut(const Case& one, std::size_t dimension, std::int64_t begin, std::int64_t end) {
  const Operation& operation = operationNamed(one.operation);
  Case made = one;
  std::int64_t inner = 1;
  for (std::size_t d = dimension + 1; d < one.shape.size(); ++d) inner *= one.shape[d];
  std::vector<bool> stays(static_cast<std::size_t>(sizeOf(one.shape)));
  for (std::size_t i = 0; i < stays.size(); ++i) {
    const std::int64_t at = static_cast<std::int64_t>(i) / inner % one.shape[dimension];
    stays[i] = at < begin || at >= end;
  }
  for (std::size_t k = 0; k < one.inputs.size(); ++k) {
    if (operation.inputs[k].role == Role::Elements)
      keep(made, k, stays, static_cast<std::size_t>(components(operation.inputs[k].element)));
  }
  made.shape[dimension] -= end - begin;
  for (std::int64_t& start : made.starts) start -= std::clamp<std::int64_t>(start - begin, 0, end - begin);
  if (!made.result.empty() && one.result[dimension] > 0 &&
      made.shape[dimension] % one.result[dimension] != 0) {
    const std::int64_t block = one.shape[dimension] / one.result[dimension];
    made.result[dimension] = made.shape[dimension] % block == 0 ? made.shape[dimension] / block : 1;
  }
  return made;
}

void addFewerElements(const Case& one, std::vector<Case>& all) {
  for (std::size_t d = 0; d < one.shape.size(); ++d) {
    const std::int64_t extent = one.shape[d];
    for (std::int64_t part = extent / 2; part >= 1; part = part == 1 ? 0 : part / 2) {
      const std::int64_t step = std::max(part, extent / 16);
      for (std::int64_t begin = 0; begin + part <= extent && extent > part; begin += step)
        all.push_back(cut(one, d, begin, begin + part));
    }
  }
}

template <class T>
void addWith(const Case& one, T Case::* member, T value, std::vector<Case>& all) {
  if (one.*member == value) return;
  all.push_back(one);
  all.back().*member = std::move(value);
}

void addSimplerOptions(const Case& one, std::vector<Case>& all) {
  addWith(one, &Case::view, View::Whole, all);
  addWith(one, &Case::textureLimit, 0, all);
  addWith(one, &Case::isPairs, false, all);
  addWith(one, &Case::storage, sk::Storage::Single, all);
  const auto addOption = [&](auto sk::CallOptions::* member, auto value) {
    if (one.options.*member == value) return;
    all.push_back(one);
    all.back().options.*member = value;
  };
  addOption(&sk::CallOptions::scan, sk::Scan::Default);
  addOption(&sk::CallOptions::contraction, sk::Contraction::Default);
  addOption(&sk::CallOptions::precision, sk::Precision::Default);
  if (one.shape.size() > 1) {  // dimensions of extent 1 go
    for (std::size_t d = 0; d < one.shape.size(); ++d) {
      if (one.shape[d] != 1 || one.options.along == static_cast<int>(d)) continue;
      Case made = one;
      made.shape.erase(made.shape.begin() + static_cast<std::ptrdiff_t>(d));
      if (!made.result.empty()) made.result.erase(made.result.begin() + static_cast<std::ptrdiff_t>(d));
      if (made.options.along && *made.options.along > static_cast<int>(d))
        made.options.along = *made.options.along - 1;
      all.push_back(std::move(made));
    }
  }
  if (!one.starts.empty()) {
    for (std::size_t row = 1; row + 1 < one.starts.size();
         row += std::max<std::size_t>(one.starts.size() / 8, 1)) {
      all.push_back(one);
      all.back().starts.erase(all.back().starts.begin() + static_cast<std::ptrdiff_t>(row));
    }
  }
}

void addSimplerData(const Case& one, std::vector<Case>& all) {
  const Operation& operation = operationNamed(one.operation);
  for (std::size_t k = 0; k < one.inputs.size(); ++k) {
    const Values& x = one.inputs[k];
    const Parameter& parameter = operation.inputs[k];
    const auto addAll = [&](const auto& change) {
      Case made = one;
      for (double& value : made.inputs[k]) value = change(value);
      if (made.inputs[k].size() != x.size() || !std::ranges::equal(made.inputs[k], x))
        all.push_back(std::move(made));
    };
    if (parameter.role == Role::Uniform) {
      for (const double value : {1.0, std::floor(x[0] / 2), x[0] - 1}) {
        if (value >= 1 && value < x[0]) addAll([&](double) { return value; });
      }
      continue;
    }
    if (std::ranges::any_of(x, [](double v) { return std::isnan(v); })) {
      addAll([](double v) { return std::isnan(v) ? 0 : v; });
      continue;
    }
    addAll([](double) { return 0.0; });
    addAll([](double) { return 1.0; });
    if (!x.empty()) addAll([&](double) { return x[0]; });
    addAll([](double v) { return std::fabs(v); });
    if (parameter.element == Element::Int || parameter.element == Element::Uint) continue;
    addAll([](double v) {
      return std::isfinite(v) && v != 0 ? std::copysign(std::ldexp(1.0, std::ilogb(v)), v) : v;
    });
    for (const double value : {0.0, 1.0}) {
      for (std::size_t part = x.size() / 2; part >= 1; part /= 2) {
        for (std::size_t begin = 0; begin < x.size(); begin += std::max(part, x.size() / 8)) {
          Case made = one;
          const auto end = std::min(begin + part, x.size());
          std::fill(made.inputs[k].begin() + static_cast<std::ptrdiff_t>(begin),
                    made.inputs[k].begin() + static_cast<std::ptrdiff_t>(end), value);
          // Only towards 0, so that this comes to an end.
          bool isSimpler = false;
          for (std::size_t i = begin; i < end; ++i) isSimpler = isSimpler || (x[i] != value && x[i] != 0);
          if (isSimpler) all.push_back(std::move(made));
        }
        if (x.size() > 64 && part <= x.size() / 16) break;
      }
    }
  }
}

}  // namespace

Case generate(std::uint64_t seed, std::uint64_t number, const std::vector<std::string>& operations) {
  Random random(seed, number);
  Case made;
  const bool isFold = random.chance(3, 5);
  std::vector<const Operation*> choices;
  for (const Operation& one : numbers::operations()) {
    const bool isChosen =
        operations.empty() ? (one.kind != Kind::Map) == isFold : std::ranges::count(operations, one.name) > 0;
    if (isChosen) choices.push_back(&one);
  }
  const Operation& operation = *random.pick(choices);
  made.operation = operation.name;
  const bool isMany = operation.name.find("eighbors") != std::string_view::npos ||
                      operation.name.find("eighted") != std::string_view::npos;
  const std::int64_t most = operation.kind == Kind::Map ? 40
                            : isMany                    ? 130
                            : random.chance(1, 40)      ? 20'000
                            : random.chance(1, 4)       ? 2049
                                                        : 300;
  made.shape = shape(random, most);
  const bool isFoldOfRows = operation.kind == Kind::Reduce || operation.kind == Kind::Scan;
  if (operation.name == "foldedNeighbors")
    made.shape = {sizeOf(made.shape)};
  else if (isFoldOfRows && random.chance(1, 6))
    chooseRows(random, made);
  else if ((operation.kind == Kind::Reduce || operation.kind == Kind::Fold) && random.chance(1, 2))
    chooseResult(random, made);
  chooseOptions(random, operation, made);
  if (random.chance(1, 5)) made.view = random.pick(std::array{View::Box, View::Strided, View::Reshaped});
  if (!made.starts.empty() && made.view == View::Reshaped) made.view = View::Whole;
  if (random.chance(1, 6)) made.textureLimit = random.pick(std::array{64, 8});
  if (operation.hasDoubles && random.chance(1, 4)) made.isPairs = true;
  if (operation.isForReals && !operation.hasDoubles && random.chance(1, 10))
    made.storage = random.pick(std::array{sk::Storage::Half, sk::Storage::Double});
  const std::size_t kindOfTerms = random.below(kindsOfTerms);
  for (const Parameter& parameter : operation.inputs)
    made.inputs.push_back(valuesOf(random, parameter, made, kindOfTerms));
  return made;
}

std::vector<Case> simpler(const Case& one) {
  std::vector<Case> all;
  addFewerElements(one, all);
  addSimplerOptions(one, all);
  addSimplerData(one, all);
  return all;
}

}  // namespace fuzz::numbers
