// SPDX-License-Identifier: MIT
#include "native/sum_exactly.hpp"

#include <algorithm>
#include <utility>

#include "native/chunk_runner.hpp"
#include "native/components.hpp"
#include "native/exact_accumulator.hpp"
#include "native/fold_pieces.hpp"
#include "native/fold_state.hpp"
#include "native/slot_arrays.hpp"
#include "native/sum_floats.hpp"
#include "sk/native/parallel.hpp"

namespace sk {

namespace {

using native::Call;
using native::Extents;
using native::Range;
using program::Kernel;
using program::Role;

/// The accumulator for sums of numbers of a type, or of products of two.
template <class Real>
struct Summing {
  static WideSum<Real> of(bool /*areProducts*/) { return {}; }
};
template <>
struct Summing<float> {
  static ExactAccumulator of(bool areProducts) {
    return ExactAccumulator(areProducts ? ExactAccumulator::Of::Products : ExactAccumulator::Of::Floats);
  }
};
template <class Real>
using Accumulator = decltype(Summing<Real>::of(false));

template <class Real>
const Real* realsAt(void* array) {
  return static_cast<const Real*>(array);
}

/// Adds terms that are inputs, or products of two.
template <class Real>
class FactorAdder {
 public:
  explicit FactorAdder(const SlotLayout& layout)
      : longest_(layout.isDirect() ? layout.width() : mostStaged),
        factors_(layout.slots().size()),
        arrays_(layout, mostStaged, 0) {}

  void add(Accumulator<Real>& sum, const Extents& first, std::int64_t count) {
    arrays_.moveTo(first);
    for (std::int64_t at = 0; at < count; at += longest_) {
      const std::int64_t now = std::min(longest_, count - at);
      arrays_.place(first[0] + at, now, now);
      if (factors_ == 1) {
        sum.add(now, realsAt<Real>(arrays_.get()[0]));
      } else {
        sum.add(now, realsAt<Real>(arrays_.get()[0]), realsAt<Real>(arrays_.get()[1]));
      }
    }
  }

 private:
  std::int64_t longest_;
  std::size_t factors_;
  SlotArrays arrays_;
};

/// Adds the terms that a kernel computes for each element.
template <class Real>
class TermAdder {
 public:
  TermAdder(const SlotLayout& layout, std::span<const std::size_t> outputs, bool areProducts,
            const native::Entry& run, const native::Frame* frame)
      : outputs_(outputs), areProducts_(areProducts), runner_(layout, run, frame) {}

  void add(Accumulator<Real>& sum, Extents first, std::int64_t count) {
    for (std::int64_t now = 0; count > 0; first[0] += now, count -= now) {
      now = std::min(count, mostStaged);
      runner_.runChunk(first, now, [&](void* const* arrays) { addOutputs(sum, now, arrays); });
    }
  }

 private:
  void addOutputs(Accumulator<Real>& sum, std::int64_t count, void* const* arrays) const {
    const std::size_t perTerm = areProducts_ ? 2 : 1;
    for (std::size_t k = 0; k < outputs_.size(); k += perTerm) {
      if (areProducts_) {
        sum.add(count, realsAt<Real>(arrays[outputs_[k]]), realsAt<Real>(arrays[outputs_[k + 1]]));
      } else {
        sum.add(count, realsAt<Real>(arrays[outputs_[k]]));
      }
    }
  }

  std::span<const std::size_t> outputs_;
  bool areProducts_;
  ChunkRunner runner_;
};

/// The numbers of the outputs' first arrays, in the order of the parameters.
std::vector<std::size_t> outputArrays(const Kernel& kernel, const SlotLayout& layout) {
  std::vector<std::pair<std::uint8_t, std::size_t>> outputs;
  for (std::size_t s = 0; s < layout.slots().size(); ++s) {
    const SlotLayout::Slot& slot = layout.slots()[s];
    if (slot.kind == SlotLayout::Kind::Output) {
      outputs.emplace_back(kernel.code->slots[s].parameter, slot.firstArray);
    }
  }
  std::ranges::sort(outputs);
  std::vector<std::size_t> arrays;
  for (const auto& [parameter, array] : outputs) arrays.push_back(array);
  return arrays;
}

/// The scalar's identity, which must exist.
template <class Real>
Real identityOf(const program::Reduction& reduction, const program::ExactSum& sum, const CodeChoice& choice) {
  const std::span<const program::Parameter> parameters = reduction.fold.parameters;
  const StateShape shape(parameters, choice.real);
  const StateColumns identities(shape, 1);
  const std::vector<native::Operand> none(parameters.size());
  const CodeFrame frame(reduction.fold, {none, {}, {}});
  const native::Entry& entry = entryOf(reduction.fold, native::EntryKind::Identity, choice);
  functionOf<native::ValuesFunction>(entry)(frame.get(), identities.arrays());
  std::size_t scalar = 0;
  for (std::size_t i = 0; i < sum.accumulator; ++i) {
    if (parameters[i].role == Role::Accumulator) scalar += scalarsOf(*parameters[i].element);
  }
  for (const ComponentType& type : componentsOf(*parameters[sum.accumulator].element, choice.real)) {
    if (type.offset == sum.offset) break;
    ++scalar;
  }
  return *realsAt<Real>(identities.arrays()[scalar]);
}

/// The rounded sums of all blocks; each sum starts with `start`. make() returns what adds the terms of a row,
/// for one thread.
template <class Real, class Make>
std::vector<Real> sumBlocks(const BlockPieces& pieces, const Accumulator<Real>& start, native::Deal deal,
                            Make&& make) {
  const std::int64_t ofBlock = pieces.ofBlock();
  const auto count = static_cast<std::size_t>(pieces.count());
  std::vector<Real> results(count / static_cast<std::size_t>(ofBlock));
  std::vector<Accumulator<Real>> parts(ofBlock == 1 ? 0 : count, start);
  native::inParallel(pieces.count(), pieces.elementsOfOne(), deal, [&](Range range) {
    auto adder = make();
    for (std::int64_t piece = range.begin; piece < range.end; ++piece) {
      Accumulator<Real> sum = start;
      const std::int64_t inBlock = piece % ofBlock;
      if (inBlock != 0) sum.clear();
      pieces.forEachRow(pieces.blockAt(piece / ofBlock), inBlock,
                        [&](const Extents& first, std::int64_t length) { adder.add(sum, first, length); });
      if (ofBlock == 1) {
        results[static_cast<std::size_t>(piece)] = sum.rounded();
      } else {
        parts[static_cast<std::size_t>(piece)] = sum;
      }
    }
  });
  for (std::size_t block = 0; block < results.size() && ofBlock > 1; ++block) {
    const auto first = parts.begin() + static_cast<std::ptrdiff_t>(block) * ofBlock;
    for (auto part = first + 1; part != first + ofBlock; ++part) first->add(*part);
    results[block] = first->rounded();
  }
  return results;
}

/// The sum of all elements. Sums are exact in any order.
template <class Make>
ExactAccumulator sumWhole(const BlockPieces& pieces, ExactAccumulator start, native::Deal deal, Make&& make) {
  ExactAccumulator none = start;
  none.clear();
  std::vector<ExactAccumulator> parts(static_cast<std::size_t>(pieces.count()), none);
  native::inParallel(pieces.count(), pieces.elementsOfOne(), deal, [&](Range range) {
    auto adder = make();
    for (std::int64_t piece = range.begin; piece < range.end; ++piece) {
      pieces.forEachRow(pieces.blockAt(0), piece, [&](const Extents& first, std::int64_t length) {
        adder.add(parts[static_cast<std::size_t>(piece)], first, length);
      });
    }
  });
  for (const ExactAccumulator& part : parts) start.add(part);
  return start;
}

/// Likewise, of all rows; those without elements have the value `ofNone`. Sums are exact in any order.
template <class Real, class Make>
std::vector<Real> sumRows(const RowPieces& rows, const Accumulator<Real>& start, Real ofNone,
                          native::Deal deal, Make&& make) {
  struct Part {
    std::int64_t row, begin, end;
    bool isAlone;  ///< a whole row
  };
  std::vector<Real> results(static_cast<std::size_t>(rows.rows()), ofNone);
  std::vector<Part> parts;
  for (std::int64_t row = 0; row < rows.rows(); ++row) {
    const std::int64_t first = rows.starts()[static_cast<std::size_t>(row)];
    const std::int64_t end = rows.starts()[static_cast<std::size_t>(row) + 1];
    for (std::int64_t begin = first; begin < end; begin += BlockPieces::most)
      parts.push_back(
          {row, begin, std::min(begin + BlockPieces::most, end), end - first <= BlockPieces::most});
  }
  std::vector<std::size_t> shared;  // parts of rows that have several
  std::vector<std::size_t> place(parts.size());
  for (std::size_t i = 0; i < parts.size(); ++i) {
    place[i] = shared.size();
    if (!parts[i].isAlone) shared.push_back(i);
  }
  std::vector<Accumulator<Real>> sums(shared.size(), start);
  const auto count = static_cast<std::int64_t>(parts.size());
  const std::int64_t cost = count == 0 ? 1 : (parts.back().end - parts.front().begin) / count + 1;
  native::inParallel(count, cost, deal, [&](Range range) {
    auto adder = make();
    for (std::int64_t i = range.begin; i < range.end; ++i) {
      const Part& part = parts[static_cast<std::size_t>(i)];
      Accumulator<Real> sum = start;
      const bool isFirst = part.begin == rows.starts()[static_cast<std::size_t>(part.row)];
      if (!isFirst) sum.clear();
      adder.add(sum, {part.begin, 0, 0, 0}, part.end - part.begin);
      if (part.isAlone) {
        results[static_cast<std::size_t>(part.row)] = sum.rounded();
      } else {
        sums[place[static_cast<std::size_t>(i)]] = sum;
      }
    }
  });
  for (std::size_t k = 0, first = 0; k < shared.size(); ++k) {
    const Part& part = parts[shared[k]];
    if (k == 0 || parts[shared[k - 1]].row != part.row) first = k;
    if (k != first) sums[first].add(sums[k]);
    if (k + 1 == shared.size() || parts[shared[k + 1]].row != part.row)
      results[static_cast<std::size_t>(part.row)] = sums[first].rounded();
  }
  return results;
}

/// Calls sumAll(start, deal, make), which returns the sums, with what sumBlocks() takes.
template <class Real, class SumAll>
auto withAdder(const program::Reduction& reduction, const program::ExactSum& sum, const Call& call,
               const CodeChoice& choice, SumAll&& sumAll) {
  Accumulator<Real> start = Summing<Real>::of(sum.ofProducts);
  if (!reduction.seeded) {  // the identity is one of the terms
    const Real identity = identityOf<Real>(reduction, sum, choice);
    start.add(1, &identity);
  }
  if (sum.term.kernel == nullptr) {
    const FactorKernel factors(reduction.fold, sum.term.factors, call);
    const CodeFrame frame(factors.kernel(), factors.call());
    const SlotLayout layout(factors.kernel(), factors.call(), frame, choice);
    return sumAll(start, native::Deal::Evenly, [&] { return FactorAdder<Real>(layout); });
  }
  const Kernel& kernel = *sum.term.kernel;
  const native::Entry& run = entryOf(kernel, native::EntryKind::Run, choice);
  const CodeFrame frame(kernel, call);
  const SlotLayout layout(kernel, call, frame, choice);
  const std::vector<std::size_t> outputs = outputArrays(kernel, layout);
  const native::Deal deal = kernel.code->isUneven != 0 ? native::Deal::AsTheyCome : native::Deal::Evenly;
  return sumAll(start, deal,
                [&] { return TermAdder<Real>(layout, outputs, sum.ofProducts, run, frame.get()); });
}

}  // namespace

const Kernel& kernelOfTerm(const program::Reduction& reduction, const program::ExactSum& sum) {
  return sum.term.kernel != nullptr ? *sum.term.kernel : reduction.fold;
}

template <class Real>
std::vector<Real> sumExactly(const program::Reduction& reduction, const program::ExactSum& sum,
                             const Call& call, const Extents& block, const CodeChoice& choice) {
  const native::Part all = call.computed();
  const BlockPieces pieces(all.extent, block, all.first);
  return withAdder<Real>(reduction, sum, call, choice,
                         [&](const Accumulator<Real>& start, native::Deal deal, auto&& make) {
                           return sumBlocks<Real>(pieces, start, deal, make);
                         });
}

template <class Real>
std::vector<Real> sumRowsExactly(const program::Reduction& reduction, const program::ExactSum& sum,
                                 const Call& call, const RowPieces& rows, const CodeChoice& choice) {
  const bool hasEmptyRows = std::ranges::adjacent_find(rows.starts()) != rows.starts().end();
  const Real ofNone = hasEmptyRows ? identityOf<Real>(reduction, sum, choice) : Real(0);
  return withAdder<Real>(reduction, sum, call, choice,
                         [&](const Accumulator<Real>& start, native::Deal, auto&& make) {
                           return sumRows<Real>(rows, start, ofNone, native::Deal::AsTheyCome, make);
                         });
}

std::vector<std::int64_t> exactWords(const program::Reduction& reduction, const program::ExactSum& sum,
                                     const Call& call, const CodeChoice& choice, bool isFirst) {
  const native::Part all = call.computed();
  const BlockPieces pieces(all.extent, all.extent, all.first);
  return withAdder<float>(reduction, sum, call, choice,
                          [&](ExactAccumulator start, native::Deal deal, auto&& make) {
                            if (!isFirst) start.clear();
                            return sumWhole(pieces, start, deal, make).words();
                          });
}

template std::vector<float> sumExactly<float>(const program::Reduction&, const program::ExactSum&,
                                              const Call&, const Extents&, const CodeChoice&);
template std::vector<double> sumExactly<double>(const program::Reduction&, const program::ExactSum&,
                                                const Call&, const Extents&, const CodeChoice&);
template std::vector<native::Quad> sumExactly<native::Quad>(const program::Reduction&,
                                                            const program::ExactSum&, const Call&,
                                                            const Extents&, const CodeChoice&);

template std::vector<float> sumRowsExactly<float>(const program::Reduction&, const program::ExactSum&,
                                                  const Call&, const RowPieces&, const CodeChoice&);
template std::vector<double> sumRowsExactly<double>(const program::Reduction&, const program::ExactSum&,
                                                    const Call&, const RowPieces&, const CodeChoice&);
template std::vector<native::Quad> sumRowsExactly<native::Quad>(const program::Reduction&,
                                                                const program::ExactSum&, const Call&,
                                                                const RowPieces&, const CodeChoice&);

}  // namespace sk
