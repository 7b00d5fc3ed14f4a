// SPDX-License-Identifier: MIT
//
// Kernels and reductions on a native device: arguments become the operands of native code. A stream that a
// call reads and writes is read as it was before, unless each element reads only itself. If the call writes
// all of the stream, the results go to spare arrays, which then become the stream's own; otherwise, readers
// get a copy.
#include <algorithm>
#include <functional>
#include <list>
#include <numeric>

#include "assemble/condition.hpp"
#include "call/check_argument.hpp"
#include "call/iterator.hpp"
#include "call/precision.hpp"
#include "call/resolved_call.hpp"
#include "call/resolved_reduction.hpp"
#include "device/rows_state.hpp"
#include "native/coalesce.hpp"
#include "native/entries.hpp"
#include "native/extents.hpp"
#include "native/fold_code.hpp"
#include "native/native_device.hpp"
#include "native/native_stream.hpp"
#include "native/native_trace.hpp"
#include "native/run_code.hpp"
#include "native/sum_exactly.hpp"
#include "sk/native/quad_type.hpp"

namespace sk {

namespace {

using native::Extents;
using native::Operand;
using program::Kernel;
using program::Parameter;
using program::Role;

bool isWritten(Role role) {
  return role == Role::Output || role == Role::Scatter || role == Role::VariableOutput ||
         role == Role::Accumulator;
}

bool isSameRegion(const StreamRegion& a, const StreamRegion& b) {
  bool same = a.shape == b.shape;
  for (int d = 0; same && d < a.shape.rank(); ++d) same = a.begin[d] == b.begin[d];
  return same;
}

/// The operands of one call, and what they point to.
class Operands {
 public:
  Operands(RealType real, const Kernel& kernel, std::span<const Argument> arguments, const Shape& domain,
           std::vector<native::Table> tables, bool isScan = false)
      : real_(real),
        kernel_(kernel),
        arguments_(arguments),
        tables_(std::move(tables)),
        isScan_(isScan),
        specs_(specsOf(kernel, arguments)),
        domain_(domain),
        list_(arguments.size()) {
    for (std::size_t i = 0; i < arguments.size(); ++i) {
      if (kernel.parameters[i].role != Role::Accumulator) list_[i] = operandAt(i);
    }
  }

  std::span<Operand> list() { return list_; }
  /// The call of a kernel, or of a reduction whose domain is divided into such blocks, after coalescing
  /// dimensions.
  native::Call call() {
    Extents whole = fastestFirst(domain_);
    return call(whole);
  }
  native::Call call(Extents& block) {
    native::Call call = callAsItIs();
    coalesce(kernel_, list_, call.domain, block, isScan_);
    return call;
  }
  native::Call callAsItIs() const { return {list_, fastestFirst(domain_), tables_}; }

  /// Allocates `count` values of this element.
  Components& value(const program::Element& element, std::int64_t count = 1) {
    return kept_.emplace_back(element, real_, count);
  }

  /// True if another run needs no more than beginAgain() and settleAgain(), and finds out what these need.
  bool mayRunAgain() {
    if (!copies_.empty() || !written_.empty() || !pushed_.empty()) return false;
    for (std::size_t i = 0; i < list_.size(); ++i) {
      const StreamRegion& region = arguments_[i].region;
      const Role role = kernel_.parameters[i].role;
      if (region.stream == nullptr) continue;
      NativeStream& stream = nativeStream(region);
      if (isWrittenInPlace(i)) writtenInPlace_.push_back(&stream);
      if (writesWholeStream(i) && isReplaced(region)) replaced_.push_back(&stream);
      if (isWritten(role)) results_.push_back(&stream);
      if (role == Role::Uniform || list_[i].components.empty()) continue;
      lent_.push_back({i, &stream, isWritten(role) && isReplaced(region)});
    }
    return true;
  }
  bool readsValuesInStreams() const { return !held_.empty(); }
  /// begin(), with the arrays and values that streams have now.
  void beginAgain() {
    for (const Held& held : held_) copyHeld(held);
    for (const Lent& lent : lent_) {
      list_[lent.operand].components = (lent.isSpare ? lent.stream->spare() : lent.stream->components).arrays();
    }
    for (NativeStream* const stream : writtenInPlace_) stream->isBroken = true;
  }
  void settleAgain() {
    for (NativeStream* const stream : replaced_) stream->exchange();
    for (NativeStream* const stream : results_) {
      stream->keepStorage();
      stream->isBroken = false;
    }
  }

  /// Marks the streams that are written in place as broken until settle().
  void begin() noexcept {
    for (std::size_t i = 0; i < list_.size(); ++i) {
      if (isWrittenInPlace(i)) nativeStream(arguments_[i].region).isBroken = true;
    }
  }

  /// Gives streams what was pushed to them and what was written to a copy or to spare arrays. What may throw
  /// comes first.
  void settle() {
    struct PushedElements {
      NativeStream& stream;
      Components components;
      std::int64_t count, capacity;
    };
    std::list<PushedElements> pushed;
    for (std::size_t i = 0; i < list_.size(); ++i) {
      if (list_[i].pushed == nullptr) continue;
      NativeStream& stream = nativeStream(arguments_[i].region);
      const auto [count, capacity] = std::pair(list_[i].pushed->count, list_[i].pushed->capacity);
      pushed.push_back({stream, stream.heldOf(std::move(*list_[i].pushed), real_), count, capacity});
    }
    for (PushedElements& one : pushed)
      one.stream.replaceElements(std::move(one.components), one.count, one.capacity);
    for (const auto& [stream, copy] : written_) stream->components.assign(copy, stream->shape.size());
    for (std::size_t i = 0; i < list_.size(); ++i) {
      const StreamRegion& region = arguments_[i].region;
      if (region.stream != nullptr && writesWholeStream(i) && isReplaced(region))
        nativeStream(region).exchange();
    }
    for (std::size_t i = 0; i < list_.size(); ++i) {
      if (isWritten(kernel_.parameters[i].role) && arguments_[i].region.stream != nullptr) {
        NativeStream& stream = nativeStream(arguments_[i].region);
        stream.keepStorage();
        stream.isBroken = false;
      }
    }
  }

  /// The arrays of a stream to write to; if the call computes in another real type, those of a copy.
  std::span<void* const> arraysToWrite(NativeStream& stream) {
    if (stream.components.real() == real_) return stream.components.arrays();
    for (const auto& [written, copy] : written_) {
      if (written == &stream) return copy.arrays();
    }
    return written_.emplace_back(&stream, stream.components.clone(stream.shape.size(), real_))
        .second.arrays();
  }

  /// True if results go to the stream's floats one by one, rounded from the code's doubles.
  bool storesFloats(const NativeStream& stream) const { return isScan_ && areWidened(stream); }

 private:
  struct Held {
    StreamRegion region;
    Components& value;
  };
  struct Lent {
    std::size_t operand;  ///< whose arrays are a stream's
    NativeStream* stream;
    bool isSpare;
  };

  /// True if an argument is written neither to spare arrays nor to a copy.
  bool isWrittenInPlace(std::size_t i) const {
    const StreamRegion& region = arguments_[i].region;
    const Role role = kernel_.parameters[i].role;
    return isWritten(role) && role != Role::VariableOutput && region.stream != nullptr &&
           assemble::isNeeded(kernel_.parameters[i], specs_) && !isReplaced(region) &&
           (nativeStream(region).components.real() == real_ || storesFloats(nativeStream(region)));
  }

  Operand operandAt(std::size_t i) {
    const Parameter& parameter = kernel_.parameters[i];
    const Argument& argument = arguments_[i];
    switch (parameter.role) {
      case Role::Uniform:
        if (argument.value == nullptr) return heldOperand(parameter, argument.region);
        return valueOperand(parameter, argument.value, 1);
      case Role::Spec: return valueOperand(parameter, argument.value, 1);
      case Role::Iterator: {
        Operand operand = valueOperand(parameter, argument.value, 2);
        operand.countsElements = countsElements(parameter, domain_.rank());
        return operand;
      }
      case Role::VariableOutput: {
        Operand operand;
        operand.pushed = &pushed_.emplace_back();
        NativeStream& stream = nativeStream(argument.region);
        if (stream.components.real() == real_) *operand.pushed = stream.takeRoom();
        operand.pushed->count = 0;
        return operand;
      }
      case Role::Input:
      case Role::Gather:
      case Role::Output:
      case Role::Scatter:
      case Role::Accumulator: break;
    }
    if (argument.region.stream == nullptr || !assemble::isNeeded(parameter, specs_)) return {};
    Operand operand = operandOf(argument.region);
    NativeStream& stream = nativeStream(argument.region);
    if (isReplaced(argument.region)) {
      operand.components = (isWritten(parameter.role) ? stream.spare() : stream.components).arrays();
    } else if (isWritten(parameter.role)) {
      operand.components = arraysToWrite(stream);
    } else {
      operand.holdsFloats = parameter.role == Role::Input && areWidened(stream) && !isReadWhileWritten(i);
      const bool isOfReal = stream.components.real() == real_ || operand.holdsFloats;
      operand.components =
          isOfReal && !isReadWhileWritten(i) ? stream.components.arrays() : copyOf(stream).arrays();
    }
    if (parameter.role == Role::Input) fit(operand, argument.fit, fastestFirst(domain_));
    return operand;
  }

  Operand valueOperand(const Parameter& parameter, const void* value, std::int64_t count) {
    Components& components = this->value(*parameter.element, count);
    components.write(0, count, static_cast<const std::byte*>(value), parameter.element->size);
    return {.components = components.arrays()};
  }

  /// The value of a uniform that a stream holds, copied, since the call may write the stream.
  Operand heldOperand(const Parameter& parameter, const StreamRegion& region) {
    Held& held = held_.emplace_back(region, value(*parameter.element));
    copyHeld(held);
    return {.components = held.value.arrays()};
  }
  void copyHeld(const Held& held) const {
    const NativeStream& stream = nativeStream(held.region);
    const std::int64_t number = operandOf(held.region).first;
    if (stream.components.real() == real_) {
      held.value.copy(stream.components, number, 0, 1);
      return;
    }
    std::vector<std::byte> bytes(stream.element->size);
    stream.components.read(number, 1, bytes.data(), bytes.size());
    held.value.write(0, 1, bytes.data(), bytes.size());
  }

  /// True if the code has a double for each float that the stream holds, and for nothing else.
  bool areWidened(const NativeStream& stream) const {
    return real_ == RealType::Double && stream.components.real() == RealType::Float &&
           std::ranges::none_of(stream.element->fields, [](const program::Field& field) {
             return field.scalar == program::Scalar::Double;
           });
  }

  bool isReadWhileWritten(std::size_t input) const {
    const Role role = kernel_.parameters[input].role;
    if (isWritten(role)) return false;
    for (std::size_t i = 0; i < arguments_.size(); ++i) {
      if (!isWritten(kernel_.parameters[i].role) ||
          arguments_[i].region.stream != arguments_[input].region.stream) {
        continue;
      }
      const bool isForEachElement = kernel_.parameters[i].role == Role::Output || isScan_;
      const bool readsItself = role == Role::Input && isForEachElement &&
                               isSameRegion(arguments_[i].region, arguments_[input].region);
      if (!readsItself) return true;
    }
    return false;
  }

  /// True if an output covers a whole stream that is also read: it is written to the spare arrays.
  bool isReplaced(const StreamRegion& region) const {
    bool isWhole = false, isRead = false;
    for (std::size_t i = 0; i < arguments_.size(); ++i) {
      const StreamRegion& other = arguments_[i].region;
      if (other.stream != region.stream) continue;
      isWhole = isWhole || writesWholeStream(i);
      isRead = isRead || isReadWhileWritten(i);
    }
    return isWhole && isRead;
  }
  bool writesWholeStream(std::size_t i) const {
    const Parameter& parameter = kernel_.parameters[i];
    const StreamRegion& region = arguments_[i].region;
    return parameter.role == Role::Output && assemble::isNeeded(parameter, specs_) &&
           region.shape == region.stream->shape && nativeStream(region).components.real() == real_;
  }

  /// Copies a stream; only once if several parameters read it.
  const Components& copyOf(NativeStream& stream) {
    for (const auto& [source, copy] : copies_) {
      if (source == &stream) return *copy;
    }
    Components* copy = nullptr;
    if (stream.components.real() == real_) {
      copy = &stream.spare();
      copy->assign(stream.components, stream.shape.size());
    } else {
      copy = &kept_.emplace_back(stream.components.clone(stream.shape.size(), real_));
    }
    copies_.emplace_back(&stream, copy);
    return *copy;
  }

  RealType real_;
  const Kernel& kernel_;
  std::span<const Argument> arguments_;
  std::vector<native::Table> tables_;
  bool isScan_;  ///< accumulators have an element for each of the domain
  const assemble::SpecValues specs_;
  Shape domain_;
  std::vector<Operand> list_;
  std::list<Components> kept_;
  std::vector<Held> held_;  ///< uniforms
  std::vector<Lent> lent_;  ///< this and the next three: for beginAgain() and settleAgain()
  std::vector<NativeStream*> writtenInPlace_, replaced_, results_;
  std::list<native::Pushed> pushed_;
  std::vector<std::pair<const NativeStream*, const Components*>> copies_;  ///< for reading
  std::list<std::pair<NativeStream*, Components>> written_;
};

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

CodeChoice codeChoice(RealType real, const CallOptions& options) {
  return {.real = real,
          .mayContract = options.contraction == Contraction::Fast,
          .mayReorder = options.order == Order::Any};
}

/// Only a reduction to digits has no exact variant of its own in an exact call.
std::optional<native::ScanOf> scanOf(const ResolvedReduction& call) {
  if (!call.scan) return std::nullopt;
  const bool foldsDigits = call.options.accumulate == Accumulate::Exact && call.reduction.exact.empty();
  return native::ScanOf{.isExclusive = call.scan->isExclusive, .combinesRuns = foldsDigits};
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
          const Shape& domain, std::vector<native::Table> foldTables,
          std::vector<native::Table> combineTables, const std::optional<native::ScanOf>& scan,
          const RowsOfCall& rows)
      : fold(rows.holdsFloats ? RealType::Float : choice.real, reduction.fold, arguments, domain,
             std::move(foldTables), scan.has_value()),
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
  Operands operands(real, kernel, call.arguments, call.domain, tablesOf(kernel, real, call.options));
  {
    const NativePass traced(*this, kernel, {}, call.arguments, call.domain);
    const native::Call nativeCall = operands.call();
    operands.begin();
    runCode(kernel, nativeCall, codeChoice(real, call.options));
  }
  operands.settle();
}

namespace {

/// A kernel's call that keeps its operands for the next run.
class PreparedRun final : public RecordedCall {
 public:
  PreparedRun(NativeDevice& device, const ResolvedCall& call, const Kernel& kernel, RealType real,
              std::vector<native::Table> tables)
      : device_(device),
        resolved_(call),
        kernel_(kernel),
        choice_(codeChoice(real, call.options)),
        operands_(real, kernel, call.arguments, call.domain, std::move(tables)),
        call_(operands_.call()),
        code_(kernel, choice_, operands_.readsValuesInStreams()) {}

  bool mayRun() { return operands_.mayRunAgain(); }

  void run() override {
    {
      const NativePass traced(device_, kernel_, {}, resolved_.arguments, resolved_.domain);
      operands_.beginAgain();
      code_.run(call_);
    }
    operands_.settleAgain();
  }

 private:
  NativeDevice& device_;
  const ResolvedCall& resolved_;
  const Kernel& kernel_;
  const CodeChoice choice_;
  Operands operands_;
  const native::Call call_;
  RepeatedCode code_;
};

}  // namespace

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
  Folding folding(choice, reduction, call.arguments, call.domain,
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

std::unique_ptr<RoundedSums> NativeDevice::sumExactly(const ResolvedReduction& whole,
                                                      const program::ExactSum& sum) {
  const program::Reduction& reduction = whole.reduction;
  const std::span<const Argument> arguments = whole.arguments;
  if (whole.scan || reduction.fold.code == nullptr || !hasTerm(sum)) return nullptr;
  const Kernel& kernel = kernelOfTerm(reduction, sum);
  std::vector<Argument> all;
  if (sum.term.kernel == nullptr) {
    all.assign(arguments.begin(), arguments.end());
  } else {
    for (std::size_t i = 0; i < arguments.size(); ++i) {
      if (reduction.fold.parameters[i].role != Role::Accumulator) all.push_back(arguments[i]);
    }
    all.resize(kernel.parameters.size());  // its outputs are read, but never stored
  }
  const RealType real = realOf(whole.options);
  Operands operands(real, kernel, all, whole.domain, tablesOf(kernel, real, whole.options));
  const NativePass traced(*this, kernel, "fold", all, whole.domain);
  switch (real) {
    case RealType::Float: break;
    case RealType::Double: return sumsOf<double>(whole, sum, operands, real);
    case RealType::Quad: return sumsOf<native::Quad>(whole, sum, operands, real);
  }
  return sumsOf<float>(whole, sum, operands, real);
}

}  // namespace sk
