// SPDX-License-Identifier: MIT
//
// Kernels and reductions on a native device: arguments become the operands of native code (operands.hpp).
#include <algorithm>
#include <functional>
#include <list>
#include <numeric>
#include <span>

#include "assemble/condition.hpp"
#include "call/check_call.hpp"
#include "call/iterator.hpp"
#include "call/resolved_call.hpp"
#include "device/device_state.hpp"
#include "device/region.hpp"
#include "device/rows_state.hpp"
#include "native/call.hpp"
#include "native/coalesce.hpp"
#include "native/entries.hpp"
#include "native/fold_code.hpp"
#include "native/local_tiles.hpp"
#include "native/native_device.hpp"
#include "native/native_pass.hpp"
#include "native/native_stream.hpp"
#include "native/operands.hpp"
#include "native/prepared_run.hpp"
#include "native/run_code.hpp"
#include "native/sum_exactly.hpp"
#include "native/tiled_loop.hpp"
#include "sk/call.hpp"
#include "sk/native/quad_type.hpp"

namespace sk {

namespace {

using native::Extents;
using native::Operand;
using program::Kernel;
using program::Parameter;
using program::Role;

template <class Real>
class NativeSums final : public RoundedSums {
 public:
  explicit NativeSums(std::vector<Real> sums) : sums_(std::move(sums)) {}

  void store(const StreamRegion& results, std::size_t offset) const override {
    nativeStream(results).writeScalars(results, offset, reinterpret_cast<const std::byte*>(sums_.data()));
  }

 private:
  std::vector<Real> sums_;
};

std::optional<native::ScanOf> scanOf(const ResolvedReduction& call) {
  if (!call.scan) return std::nullopt;
  return native::ScanOf{.isExclusive = call.scan->isExclusive, .combinesRuns = foldsDigits(call)};
}

bool hasDoubles(const program::Element& element) {
  return std::ranges::any_of(
      element.fields, [](const program::Field& field) { return field.scalar == program::Scalar::Double; });
}

/// Whether rows are folded in doubles from operands that hold floats: none has doubles, and the code that combines
/// accumulators reads no operands of its own.
bool foldsFloatRows(const program::Reduction& reduction, std::span<const Argument> arguments,
                    const CodeChoice& choice) {
  if (choice.real != RealType::Double || reduction.fold.code == nullptr ||
      findEntry(*reduction.fold.code, native::EntryKind::FoldFloatRows, choice) == nullptr) {
    return false;
  }
  for (std::size_t i = 0; i < arguments.size(); ++i) {
    if (hasDoubles(*reduction.fold.parameters[i].element)) return false;
    const StreamState* const stream = arguments[i].region.stream;
    if (stream != nullptr && nativeStream(arguments[i].region).components.real() != RealType::Float)
      return false;
  }
  return std::ranges::all_of(reduction.combine.parameters, [](const Parameter& parameter) {
    return parameter.role == Role::Input || parameter.role == Role::Accumulator;
  });
}

/// The rows of a reduction, if its blocks are rows of different lengths.
struct RowsOfCall {
  const RowPieces* pieces = nullptr;
  bool holdsFloats = false;  ///< native::ReduceCall::holdsFloats
};

/// The call of a reduction, without its results.
class Folding {
 public:
  Operands fold;

  Folding(const CodeChoice& choice, const program::Reduction& reduction, std::span<const Argument> arguments,
          const Shape& domain, const Box& box, std::vector<native::Table> foldTables,
          std::vector<native::Table> combineTables, const std::optional<native::ScanOf>& scan,
          const RowsOfCall& rows)
      : fold(rows.holdsFloats ? RealType::Float : choice.real, reduction.fold, arguments, domain,
             std::move(foldTables), scan.has_value(), box),
        choice_(choice),
        reduction_(reduction),
        combineTables_(std::move(combineTables)),
        scan_(scan),
        rows_(rows) {
    for (const std::uint8_t operand : reduction.combineOperands) {
      combine_.push_back(fold.list()[operand]);
    }
    combine_.resize(reduction.combine.parameters.size());
  }

  void run(Extents block) {
    const native::Call whole = rows_.pieces == nullptr ? fold.call(block) : fold.callAsItIs();
    const native::ReduceCall call{
        whole, {combine_, {1, 1, 1, 1}, combineTables_}, block, scan_, rows_.pieces, rows_.holdsFloats};
    foldCode(reduction_, call, choice_);
  }
  /// Combines elements of `parts`, one region for each accumulator, to the element of `results`.
  void combine(std::span<const StreamRegion> parts, std::span<const StreamRegion> results) {
    combineParts(reduction_, {combine_, {1, 1, 1, 1}, combineTables_}, choice_, arraysOf(parts),
                 parts.front().shape.size(), arraysOf(results));
  }
  /// Stores the identities to all blocks, of which there are `counts` in each dimension; `results` are the
  /// indices of the accumulators.
  void storeIdentities(std::span<const std::size_t> results, const Extents& counts) {
    const std::vector<Operand> wholes(fold.list().begin(), fold.list().end());
    const std::int64_t blocks =
        std::accumulate(counts.begin(), counts.end(), std::int64_t{1}, std::multiplies<>());
    for (std::int64_t n = 0; n < blocks; ++n) {
      for (const std::size_t i : results) {
        Operand& one = fold.list()[i] = wholes[i];
        std::int64_t rest = n;
        for (std::size_t d = 0; d < counts.size(); ++d) {
          one.first += rest % counts[d] * one.stride[d];
          rest /= counts[d];
        }
      }
      sk::storeIdentities(reduction_, fold.callAsItIs(), choice_);
    }
  }

 private:
  static std::vector<void*> arraysOf(std::span<const StreamRegion> regions) {
    std::vector<void*> arrays;
    for (const StreamRegion& region : regions) {
      const std::span<void* const> own = nativeStream(region).components.arrays();
      arrays.insert(arrays.end(), own.begin(), own.end());
    }
    return arrays;
  }

  CodeChoice choice_;
  const program::Reduction& reduction_;
  std::vector<native::Table> combineTables_;
  std::optional<native::ScanOf> scan_;
  RowsOfCall rows_;
  std::vector<Operand> combine_;
};

/// The operand of a result, which may lack dimensions in which there is one block. The others keep their
/// order.
Operand resultOperand(Operands& fold, const StreamRegion& region, const Extents& blocks) {
  Operand operand = operandOf(region);
  const Operand own = operand;
  std::size_t next = 0;
  for (std::size_t d = 0; d < blocks.size(); ++d) {
    if (blocks[d] == 1) continue;
    while (own.extent[next] == 1) ++next;
    operand.extent[d] = own.extent[next];
    operand.stride[d] = own.stride[next++];
  }
  NativeStream& stream = nativeStream(region);
  operand.holdsFloats = fold.storesFloats(stream);
  operand.components = operand.holdsFloats ? stream.components.arrays() : fold.arraysToWrite(stream);
  return operand;
}

}  // namespace

/// Where other devices compute with pairs of floats, this one uses doubles, which are cheaper here. A
/// reference always computes in its own precision.
RealType NativeDevice::realOf(const CallOptions& options) const {
  return isWide(options) && real_ == RealType::Float ? RealType::Double : real_;
}

std::vector<native::Table> NativeDevice::tablesOf(const Kernel& kernel, RealType real,
                                                  const CallOptions& options) {
  std::vector<native::Table> list;
  if (real != RealType::Float || options.tables == Tables::Off) return list;
  for (const program::TableUse& use : kernel.tables) {
    list.push_back(tables.of(*use.table, configuration).native());
  }
  return list;
}

void NativeDevice::run(const ResolvedCall& call) {
  checkTarget(call.kernel, call.options.target);
  const Kernel& kernel =
      computesInHalf(call.options) ? precisionVariant(call.kernel, call.options) : call.kernel;
  const RealType real = realOf(call.options);
  Operands operands(real, kernel, call.arguments, call.domain, tablesOf(kernel, real, call.options), false,
                    call.options.box);
  {
    const NativePass traced(*this, kernel, {}, call.arguments, call.domain);
    native::Call nativeCall = operands.call();
    nativeCall.isSilent = isSilent;
    operands.begin();
    runCode(kernel, nativeCall, codeChoice(real, call.options));
  }
  operands.settle();
}

// Gathers and scatters find elements by index, and results of folds are stored, in rows without gaps. A part that a
// call also reads takes a temporary of its own size, rather than a copy of the stream for readers.
bool NativeDevice::needsDense(const Kernel& kernel, std::span<const Argument> arguments, std::size_t i) {
  const StreamRegion& region = arguments[i].region;
  const Role role = kernel.parameters[i].role;
  if (role == Role::Input || role == Role::Uniform) return false;
  const AffineRegion all = affine(region);
  if (role != Role::Output) return all.extent[0] != 1 && all.stride[0] != 1;
  for (std::size_t other = 0; other < arguments.size(); ++other) {
    const Role read = kernel.parameters[other].role;
    const bool isElement = read == Role::Input && arguments[other].fit == program::Fit::Same;
    if ((read == Role::Input || read == Role::Gather) && overlap(region, arguments[other].region) &&
        !(isElement && isSameRegion(region, arguments[other].region)))
      return true;
  }
  return false;
}

std::unique_ptr<LoopRunner> NativeDevice::makeLoopRunner() { return makeTiledLoop(*this); }

bool NativeDevice::runTogether(LoopState& calls, std::span<StreamState* const> locals) {
  return runInLocalTiles(*this, calls, locals);
}

std::unique_ptr<RecordedCall> NativeDevice::prepare(const ResolvedCall& call) {
  checkTarget(call.kernel, call.options.target);
  const Kernel& kernel =
      computesInHalf(call.options) ? precisionVariant(call.kernel, call.options) : call.kernel;
  const RealType real = realOf(call.options);
  auto prepared =
      std::make_unique<PreparedRun>(*this, call, kernel, real, tablesOf(kernel, real, call.options));
  return prepared->mayRun() ? std::move(prepared) : nullptr;
}

void NativeDevice::reduce(const ResolvedReduction& call) {
  checkTarget(call.reduction.fold, call.options.target);
  const program::Reduction& reduction =
      computesInHalf(call.options) ? halfVariant(call.reduction) : call.reduction;
  const RealType real = realOf(call.options);
  const CodeChoice choice = codeChoice(real, call.options);
  RowsOfCall rows;
  if (call.rows != nullptr) {
    rows = {&call.rows->pieces(), !call.scan && foldsFloatRows(reduction, call.arguments, choice)};
  }
  Folding folding(choice, reduction, call.arguments, call.seenDomain(), call.placed.box,
                  tablesOf(reduction.fold, real, call.options),
                  tablesOf(reduction.combine, real, call.options), scanOf(call), rows);
  const Extents counts = fastestFirst(call.blocks);
  std::vector<std::size_t> results;
  std::vector<const Components*> values;
  for (std::size_t i = 0; i < call.arguments.size(); ++i) {
    const Parameter& parameter = reduction.fold.parameters[i];
    if (parameter.role != Role::Accumulator) continue;
    if (call.isToValues()) {
      const Components& value = folding.fold.value(*parameter.element);
      folding.fold.list()[i] = {.components = value.arrays(), .stride = {1, 1, 1, 1}};
      values.push_back(&value);
    } else {
      folding.fold.list()[i] = resultOperand(folding.fold, call.arguments[i].region,
                                             call.scan ? fastestFirst(call.domain) : counts);
      if (rows.holdsFloats) folding.fold.list()[i].holdsFloats = true;
    }
    results.push_back(i);
  }
  {
    const NativePass traced(*this, reduction.fold, "fold", call.arguments, call.domain);
    folding.fold.begin();
    if (call.domain.size() == 0 && call.rows == nullptr) {
      folding.storeIdentities(results, counts);
    } else {
      Extents block = fastestFirst(call.domain);
      for (std::size_t d = 0; d < block.size(); ++d) block[d] /= counts[d];
      folding.run(block);
    }
  }
  folding.fold.settle();
  for (std::size_t k = 0; k < values.size(); ++k) {
    values[k]->read(0, 1, static_cast<std::byte*>(call.values[k]),
                    reduction.fold.parameters[results[k]].element->size);
  }
}

bool NativeDevice::combine(const ResolvedReduction& call, std::span<const StreamRegion> parts,
                           std::span<const StreamRegion> results) {
  const program::Reduction& reduction =
      computesInHalf(call.options) ? halfVariant(call.reduction) : call.reduction;
  const RealType real = realOf(call.options);
  Folding(codeChoice(real, call.options), reduction, call.arguments, call.seenDomain(), call.placed.box,
          tablesOf(reduction.fold, real, call.options), tablesOf(reduction.combine, real, call.options), {},
          {})
      .combine(parts, results);
  return true;
}

// A scan, and a sum without a term, is folded to digits, which hold only floats.
bool NativeDevice::sumsExactly(const ResolvedReduction& call) const {
  if (!isReference()) return true;
  return !call.scan && std::ranges::all_of(call.reduction.exact, [&](const program::ExactSum& sum) {
    const Kernel* const term = sum.term.kernel;
    return hasTerm(sum) && (term == nullptr || (term->code != nullptr && hasCodeFor(*term->code, real_)));
  });
}

namespace {

template <class Real>
std::unique_ptr<RoundedSums> sumsOf(const ResolvedReduction& whole, const program::ExactSum& sum,
                                    Operands& operands, RealType real) {
  const CodeChoice choice{.real = real};  // the same bits on every device: never contracted
  if (whole.rows != nullptr) {
    return std::make_unique<NativeSums<Real>>(
        sumRowsExactly<Real>(whole.reduction, sum, operands.callAsItIs(), whole.rows->pieces(), choice));
  }
  const Extents counts = fastestFirst(whole.blocks);
  Extents block = fastestFirst(whole.domain);
  for (std::size_t d = 0; d < block.size(); ++d) block[d] /= counts[d];
  const native::Call call = operands.call(block);
  return std::make_unique<NativeSums<Real>>(sk::sumExactly<Real>(whole.reduction, sum, call, block, choice));
}

}  // namespace

std::vector<Argument> NativeDevice::termArguments(const ResolvedReduction& whole,
                                                  const program::ExactSum& sum) {
  const std::span<const Argument> arguments = whole.arguments;
  if (sum.term.kernel == nullptr) return {arguments.begin(), arguments.end()};
  std::vector<Argument> all;
  for (std::size_t i = 0; i < arguments.size(); ++i) {
    const Role role = whole.reduction.fold.parameters[i].role;
    if (role != Role::Accumulator && role != Role::Output) all.push_back(arguments[i]);
  }
  all.resize(sum.term.kernel->parameters.size());  // its outputs are read, but never stored
  return all;
}

std::unique_ptr<RoundedSums> NativeDevice::sumExactly(const ResolvedReduction& whole,
                                                      const program::ExactSum& sum) {
  const program::Reduction& reduction = whole.reduction;
  if (whole.scan || reduction.fold.code == nullptr || !hasTerm(sum)) return nullptr;
  const Kernel& kernel = kernelOfTerm(reduction, sum);
  const std::vector<Argument> all = termArguments(whole, sum);
  const RealType real = realOf(whole.options);
  Operands operands(real, kernel, all, whole.seenDomain(), tablesOf(kernel, real, whole.options), false,
                    whole.placed.box);
  const NativePass traced(*this, kernel, "fold", all, whole.domain);
  switch (real) {
    case RealType::Float: break;
    case RealType::Double: return sumsOf<double>(whole, sum, operands, real);
    case RealType::Quad: return sumsOf<native::Quad>(whole, sum, operands, real);
  }
  return sumsOf<float>(whole, sum, operands, real);
}

std::vector<std::int64_t> NativeDevice::exactWords(const ResolvedReduction& whole,
                                                   const program::ExactSum& sum, bool isFirst) {
  const program::Reduction& reduction = whole.reduction;
  const RealType real = realOf(whole.options);
  if (real != RealType::Float || reduction.fold.code == nullptr || !hasTerm(sum)) return {};
  const Kernel& kernel = kernelOfTerm(reduction, sum);
  const std::vector<Argument> all = termArguments(whole, sum);
  Operands operands(real, kernel, all, whole.seenDomain(), tablesOf(kernel, real, whole.options), false,
                    whole.placed.box);
  const NativePass traced(*this, kernel, "fold", all, whole.domain);
  Extents block = fastestFirst(whole.domain);
  const native::Call call = operands.call(block);
  return sk::exactWords(reduction, sum, call, {.real = real}, isFirst);
}

}  // namespace sk
