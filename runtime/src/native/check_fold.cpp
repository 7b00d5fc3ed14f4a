// SPDX-License-Identifier: MIT
#include "native/check_fold.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <random>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "call/check_call.hpp"
#include "native/piece_folder.hpp"

namespace sk {

namespace {

using native::Extents;

constexpr int trials = 16;
constexpr std::int64_t longest = 4;  // most elements of a run

template <class T>
double valueAt(const std::byte* bytes) {
  T value;
  std::memcpy(&value, bytes, sizeof value);
  return static_cast<double>(value);
}

/// The value of an accumulator's scalar; 0 if its type rounds what it stores.
double numberOf(const ComponentType& type, const std::byte* bytes) {
  switch (type.scalar) {
    case program::Scalar::Bool:
    case program::Scalar::Uint:
    case program::Scalar::Uchar:
    case program::Scalar::Ushort:
      return type.storedBytes == 1   ? valueAt<std::uint8_t>(bytes)
             : type.storedBytes == 2 ? valueAt<std::uint16_t>(bytes)
                                     : valueAt<std::uint32_t>(bytes);
    case program::Scalar::Long: return static_cast<double>(valueAt<std::int64_t>(bytes));
    case program::Scalar::Ulong: return static_cast<double>(valueAt<std::uint64_t>(bytes));
    case program::Scalar::Int:
    case program::Scalar::Char:
    case program::Scalar::Short:
      return type.storedBytes == 1   ? valueAt<std::int8_t>(bytes)
             : type.storedBytes == 2 ? valueAt<std::int16_t>(bytes)
                                     : valueAt<std::int32_t>(bytes);
    case program::Scalar::Float:
    case program::Scalar::Double:
      return type.storedBytes == sizeof(float) ? valueAt<float>(bytes) : valueAt<double>(bytes);
    case program::Scalar::Half:
    case program::Scalar::Unorm8:
    case program::Scalar::Snorm8:
    case program::Scalar::Unorm16:
    case program::Scalar::Snorm16: break;
  }
  return 0;
}

/// How far two results may differ, relative to the largest magnitude.
double boundOf(const ComponentType& type) {
  const bool isReal = type.scalar == program::Scalar::Float || type.scalar == program::Scalar::Double;
  if (!isReal) return 0;
  return type.storedBytes == sizeof(float) ? 0x1p-12 : 0x1p-40;
}

class FoldCheck {
 public:
  FoldCheck(const program::Reduction& reduction, const FoldProgram& program, const native::Call& call,
            const CodeChoice& choice)
      : reduction_(reduction),
        program_(program),
        folded_(call.computed()),
        leaves_(program),
        combiner_(program.shape, program.combine.function, program.combine.lanes, program.combine.frame) {
    for (const program::Parameter& parameter : reduction.fold.parameters) {
      if (parameter.role != program::Role::Accumulator) continue;
      const std::vector<ComponentType> all = componentsOf(*parameter.element, choice.real);
      types_.insert(types_.end(), all.begin(), all.end());
    }
  }

  void tryRuns() {
    const StateColumns a = run(), b = run(), c = run();
    const StateColumns ab = combined(a, b), bc = combined(b, c);
    const StateColumns left = combined(ab, c), right = combined(a, bc);
    const std::vector<const StateColumns*> used = {&a, &b, &c, &ab, &bc, &left, &right};
    if (!areEqual(left, right, used)) {
      fail(reduction_.fold,
           "partial results combine in an order that depends on the device, and {}, {} and {} give {} where "
           "the first two are combined first, and {} where the last two are (SK_CHECK=folds)",
           words(a), words(b), words(c), words(left), words(right));
    }
  }

  void tryIdentity(const StateColumns& identity) {
    const StateColumns a = run();
    for (const bool isFirst : {true, false}) {
      const StateColumns both = isFirst ? combined(identity, a) : combined(a, identity);
      if (areEqual(both, a, {&a, &both})) continue;
      fail(reduction_.fold, "what it starts from is not neutral: {} and then {} give {} (SK_CHECK=folds)",
           words(isFirst ? identity : a), words(isFirst ? a : identity), words(both));
    }
  }

  void tryCombination() {
    const std::vector<Extents> first = elements(), second = elements();
    const StateColumns a = fold(first), b = fold(second);
    std::vector<Extents> both = first;
    both.insert(both.end(), second.begin(), second.end());
    const StateColumns together = fold(both), apart = combined(a, b);
    if (areEqual(together, apart, {&a, &b, &together, &apart})) return;
    fail(reduction_.fold,
         "{} elements folded one after the other give {}, but folded as {} and {} elements, whose results {} "
         "and {} are combined, they give {} (SK_CHECK=folds)",
         both.size(), words(together), first.size(), second.size(), words(a), words(b), words(apart));
  }

 private:
  /// The indices of some random elements.
  std::vector<Extents> elements() {
    std::vector<Extents> chosen(static_cast<std::size_t>(1 + random_() % longest));
    for (Extents& at : chosen) {
      for (std::size_t i = 0; i < 4; ++i)
        at[i] = folded_.first[i] +
                static_cast<std::int64_t>(random_() % static_cast<std::uint64_t>(folded_.extent[i]));
    }
    return chosen;
  }

  StateColumns fold(const std::vector<Extents>& chosen) {
    StateColumns state(program_.shape, 1);
    Start start = Start::New;
    for (const Extents& at : chosen) {
      leaves_.moveToRow(at);
      leaves_.foldInto(state, 0, at[0], 1, start);
      start = Start::Continued;
    }
    return state;
  }

  StateColumns run() { return fold(elements()); }

  StateColumns combined(const StateColumns& earlier, const StateColumns& later) {
    StateColumns state(program_.shape, 1);
    state.assign(0, earlier, 0, 1);
    combiner_.combine(state, later, 0, 1);
    return state;
  }

  double number(const StateColumns& state, std::size_t scalar) const {
    return numberOf(types_[scalar], state.at(scalar, 0));
  }

  bool areEqual(const StateColumns& a, const StateColumns& b,
                const std::vector<const StateColumns*>& used) const {
    for (std::size_t scalar = 0; scalar < types_.size(); ++scalar) {
      const double x = number(a, scalar), y = number(b, scalar);
      if (x == y || !std::isfinite(x) || !std::isfinite(y)) continue;  // an overflow proves nothing
      double largest = 0;
      for (const StateColumns* state : used) {
        const double magnitude = std::fabs(number(*state, scalar));
        if (std::isfinite(magnitude)) largest = std::max(largest, magnitude);
      }
      if (std::fabs(x - y) > boundOf(types_[scalar]) * largest) return false;
    }
    return true;
  }

  std::string words(const StateColumns& state) const {
    std::vector<double> all;
    for (std::size_t scalar = 0; scalar < types_.size(); ++scalar) all.push_back(number(state, scalar));
    return all.size() == 1 ? fmt::format("{:.7g}", all[0]) : fmt::format("{{{:.7g}}}", fmt::join(all, ", "));
  }

  const program::Reduction& reduction_;
  const FoldProgram& program_;
  const native::Part folded_;
  LeafFolder leaves_;
  ColumnCombiner combiner_;
  std::vector<ComponentType> types_;
  std::mt19937_64 random_{20040808};
};

}  // namespace

void checkFold(const program::Reduction& reduction, const FoldProgram& program, const native::Call& call,
               const CodeChoice& choice) {
  if (choice.real == RealType::Quad || std::ranges::find(call.domain, 0) != std::end(call.domain)) return;
  FoldCheck check(reduction, program, call, choice);
  for (int trial = 0; trial < trials; ++trial) check.tryRuns();
  if (!reduction.seeded) {
    StateColumns identity(program.shape, 1);
    const native::Entry& entry = entryOf(reduction.fold, native::EntryKind::Identity, choice);
    functionOf<native::ValuesFunction>(entry)(program.fold.frame, identity.arrays());
    for (int trial = 0; trial < trials; ++trial) check.tryIdentity(identity);
  }
  for (int trial = 0; trial < trials; ++trial) check.tryCombination();
}

}  // namespace sk
