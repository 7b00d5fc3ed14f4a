// SPDX-License-Identifier: MIT
#include "native/entries.hpp"

#include <algorithm>

#include <llvm/IR/Constants.h>

#include "ir/call_graph.hpp"
#include "native/debug_info.hpp"
#include "native/function_code.hpp"
#include "native/leaves.hpp"
#include "native/llvm_passes.hpp"
#include "native/slots.hpp"
#include "transforms/fold_pattern.hpp"
#include "transforms/predicate.hpp"

namespace skc::native {

using namespace ir;
using sk::native::EntryKind;

namespace {

class EntryWriter {
 public:
  EntryWriter(llvm::Module& code, const EntrySource& source, const std::string& name)
      : s_(source),
        b_(code.getContext()),
        l_(b_, source.options),
        streams_(l_, source.module, source.kernel, source.slots,
                 [this](const Expr& expr) { return constantParts(context_, expr); }),
        context_{l_, source.module, source.kernel, streams_, source.uniformity, source.debug},
        code_(code),
        name_(name) {}

  llvm::Function* write(EntryKind kind) {
    switch (kind) {
      case EntryKind::Run: run(); break;
      case EntryKind::RunRows: runRows(); break;
      case EntryKind::Fold: fold(); break;
      case EntryKind::Combine: combine(); break;
      case EntryKind::Identity: values(ParamRole::Accumulator, [&] { return identities(); }); break;
      case EntryKind::Borders: values(ParamRole::Gather, [&] { return borders(); }); break;
      case EntryKind::Apply: apply(); break;
      case EntryKind::Scan: scan(); break;
      case EntryKind::FoldRows:
      case EntryKind::FoldFloatRows: foldRows(); break;
    }
    return function_;
  }

 private:
  // ---- functions and loops ----------------------------------------------------------------------

  /// Starts a function that takes `addresses` pointers, then `numbers` 64-bit integers. Its entry block is the prologue.
  void begin(unsigned addresses, unsigned numbers) {
    std::vector<llvm::Type*> types(addresses, b_.getPtrTy());
    types.insert(types.end(), numbers, b_.getInt64Ty());
    function_ = llvm::Function::Create(llvm::FunctionType::get(b_.getVoidTy(), types, false),
                                       llvm::Function::InternalLinkage, name_, code_);
    for (unsigned i = 0; i < addresses; ++i) function_->addParamAttr(i, llvm::Attribute::NoCapture);
    if (paramsOf(ParamRole::VariableOutput).empty() && paramsOf(ParamRole::Scatter).empty()) {
      function_->setDoesNotThrow();
    } else {
      function_->setUWTableKind(llvm::UWTableKind::Default);  // AppendBuffer::grow may throw
    }
    setLevel(*function_, s_.level);
    if (s_.level.hasMaskRegisters) {
      markSplitMasks(*function_, s_.level.vectorBits);
    } else {
      markWideMasks(*function_);
    }
    prologue_ = llvm::BasicBlock::Create(b_.getContext(), "entry", function_);
    llvm::BasicBlock* const start = llvm::BasicBlock::Create(b_.getContext(), "start", function_);
    b_.SetInsertPoint(start);
    if (s_.debug != nullptr) s_.debug->begin(b_, *function_, entryFunction());
  }
  void end() {
    b_.CreateRetVoid();
    llvm::BasicBlock* const start = prologue_->getNextNode();
    b_.SetInsertPoint(prologue_);
    b_.CreateBr(start);
    if (s_.debug != nullptr) s_.debug->end(b_);
  }

  const Function& entryFunction() const { return s_.module.functions[s_.kernel.entry]; }
  llvm::Value* number(std::int64_t value) { return b_.getInt64(static_cast<std::uint64_t>(value)); }

  /// for (i = first; i < count; i += step) body(i)
  void loop(llvm::Value* first, llvm::Value* count, std::int64_t step,
            const std::function<void(llvm::Value*)>& body) {
    llvm::BasicBlock* const before = b_.GetInsertBlock();
    const auto block = [&](const char* name) {
      return llvm::BasicBlock::Create(b_.getContext(), name, function_);
    };
    llvm::BasicBlock* const round = block("elements");
    llvm::BasicBlock* const end = block("end");
    b_.CreateCondBr(b_.CreateICmpSLT(first, count), round, end);
    b_.SetInsertPoint(round);
    llvm::PHINode* const i = b_.CreatePHI(b_.getInt64Ty(), 2);
    i->addIncoming(first, before);
    body(i);
    llvm::Value* const next = b_.CreateAdd(i, number(step), "", true, true);
    i->addIncoming(next, b_.GetInsertBlock());
    b_.CreateCondBr(b_.CreateICmpSLT(next, count), round, end);
    b_.SetInsertPoint(end);
  }

  // ---- arguments --------------------------------------------------------------------------------

  Parts zeros(Type type) const {
    Parts parts;
    for (const Scalar scalar : scalarsOf(s_.module, type)) {
      parts.push_back({llvm::Constant::getNullValue(l_.type(scalar))});
    }
    return parts;
  }

  /// The value that the entry takes for a parameter; empty for streams, and for accumulators, whose state the
  /// callers pass.
  Parts argument(std::uint32_t i) {
    switch (s_.kernel.params[i].role) {
      case ParamRole::Uniform:
      case ParamRole::Spec: return streams_.uniform(i);
      case ParamRole::Input: return streams_.input(i);
      case ParamRole::Iterator: return streams_.iterator(i);
      case ParamRole::Output: return zeros(s_.kernel.params[i].type);
      case ParamRole::Gather:
      case ParamRole::Accumulator:
      case ParamRole::VariableOutput:
      case ParamRole::Scatter: break;
    }
    return {};
  }

  std::vector<std::uint32_t> paramsOf(ParamRole role) const {
    std::vector<std::uint32_t> found;
    for (std::uint32_t i = 0; i < s_.kernel.params.size(); ++i) {
      if (s_.kernel.params[i].role == role) found.push_back(i);
    }
    return found;
  }

  /// Adds the entry's mask, if it takes one: true in lanes that have an element.
  void addMask(std::vector<Parts>& arguments, llvm::Value* element, llvm::Value* count) {
    if (l_.count() == 1 || !entryMask(s_.module, s_.kernel)) return;
    llvm::Value* const left = b_.CreateTrunc(b_.CreateSub(count, element), b_.getInt32Ty());
    arguments.push_back({{b_.CreateICmpSLT(l_.laneNumbers(b_.getInt32Ty()), l_.broadcast(left))}});
  }
  CallResult call(std::vector<Parts> arguments, llvm::Value* element, llvm::Value* count) {
    addMask(arguments, element, count);
    return inlineCall(context_, s_.kernel.entry, arguments);
  }

  // ---- kernels ----------------------------------------------------------------------------------

  void run() {
    begin(2, 0);
    streams_.begin(function_->getArg(0), function_->getArg(1), prologue_);
    if (hasRowsOfNeighbors()) {
      loop(number(0), streams_.chunkRows(), 1, [&](llvm::Value* row) {
        llvm::BasicBlock* const elements = llvm::BasicBlock::Create(b_.getContext(), "row", function_);
        streams_.beginRow(row, b_.GetInsertBlock());
        b_.CreateBr(elements);
        b_.SetInsertPoint(elements);
        computeChunk(1);
      });
    } else {
      computeChunk(1);
    }
    end();
  }
  /// True if chunks may have several rows (sk::native::Chunk::rows).
  bool hasRowsOfNeighbors() const {
    return std::ranges::any_of(s_.slots.slots, [&](const sk::native::Slot& slot) {
      return s_.kernel.params[slot.parameter].role == ParamRole::Gather;
    });
  }
  void runRows() {
    begin(2, 0);
    streams_.begin(function_->getArg(0), function_->getArg(1), prologue_);
    computeChunk(s_.rows);
    end();
  }

  /// Computes the elements of a row, or those of the chunks of `rows` rows together.
  void computeChunk(std::uint32_t rows) {
    if (s_.numbersRecords) streams_.numberRecords();
    llvm::Value* const count = streams_.chunkCount();
    loop(number(0), count, l_.count(), [&](llvm::Value* element) {
      streams_.moveTo(element);
      std::vector<std::vector<Parts>> arguments(rows);
      for (std::uint32_t row = 0; row < rows; ++row) {
        streams_.selectRow(row);
        for (std::uint32_t i = 0; i < s_.kernel.params.size(); ++i) arguments[row].push_back(argument(i));
        addMask(arguments[row], element, count);
      }
      const std::vector<std::uint32_t> outputs = paramsOf(ParamRole::Output);
      // the loops of several rows take long enough for the outputs to arrive, so that no store waits for memory
      for (std::uint32_t row = 0; rows > 1 && row < rows; ++row) {
        streams_.selectRow(row);
        for (const std::uint32_t output : outputs) streams_.prefetchOutput(output);
      }
      streams_.selectRow(0);
      const std::vector<CallResult> called =
          rows > 1 ? inlineRows(context_, *s_.rowPlan, arguments)
                   : std::vector{inlineCall(context_, s_.kernel.entry, arguments.front())};
      for (std::uint32_t row = 0; row < rows; ++row) {
        streams_.selectRow(row);
        for (std::size_t i = 0; i < outputs.size(); ++i)
          streams_.storeOutput(outputs[i], called[row].outputs[i]);
      }
      streams_.selectRow(0);
    });
  }

  /// A switch over the scatter outputs.
  void apply() {
    begin(2, 1);
    streams_.begin(function_->getArg(0), nullptr, prologue_);
    llvm::BasicBlock* const end = llvm::BasicBlock::Create(b_.getContext(), "end", function_);
    llvm::SwitchInst* const jump = b_.CreateSwitch(function_->getArg(2), end);
    for (const std::uint32_t i : paramsOf(ParamRole::Scatter)) {
      llvm::BasicBlock* const output = llvm::BasicBlock::Create(b_.getContext(), "output", function_);
      jump->addCase(b_.getInt64(i), output);
      b_.SetInsertPoint(output);
      streams_.apply(i, function_->getArg(1));
      b_.CreateBr(end);
    }
    b_.SetInsertPoint(end);
    this->end();
  }

  // ---- reduces ----------------------------------------------------------------------------------

  struct State {
    std::vector<Scalar> scalars;
    std::vector<llvm::Value*> arrays;
  };
  State stateIn(llvm::Value* pointers) {
    State state;
    for (const std::uint32_t i : paramsOf(ParamRole::Accumulator)) {
      for (const Scalar scalar : scalarsOf(s_.module, s_.kernel.params[i].type)) {
        llvm::Value* const address =
            l_.at(b_.getPtrTy(), pointers, number(static_cast<std::int64_t>(state.arrays.size())));
        state.scalars.push_back(scalar);
        state.arrays.push_back(b_.CreateLoad(b_.getPtrTy(), address));
      }
    }
    return state;
  }
  Parts loadState(const State& state, llvm::Value* column) {
    Parts parts;
    for (std::size_t c = 0; c < state.arrays.size(); ++c) {
      parts.push_back(
          l_.loadNeighbors(state.scalars[c], l_.at(l_.stored(state.scalars[c]), state.arrays[c], column)));
    }
    return parts;
  }
  void storeState(const State& state, llvm::Value* column, const Parts& parts) {
    for (std::size_t c = 0; c < state.arrays.size(); ++c) {
      l_.storeNeighbors(state.scalars[c], parts[c],
                        l_.at(l_.stored(state.scalars[c]), state.arrays[c], column));
    }
  }

  Parts identities() {
    Parts parts;
    for (const std::uint32_t i : paramsOf(ParamRole::Accumulator)) {
      const Parts one = constantParts(context_, *s_.kernel.params[i].identity);
      parts.insert(parts.end(), one.begin(), one.end());
    }
    return parts;
  }
  /// The initial accumulators of a column: the identities or, in a seeded reduction, the element itself.
  Parts startOf(llvm::Value* element) {
    Parts parts;
    if (s_.kernel.reduction->seeded) {
      streams_.moveTo(element);
      for (const std::uint32_t i : paramsOf(ParamRole::Input)) {
        const Parts one = streams_.input(i);
        parts.insert(parts.end(), one.begin(), one.end());
      }
    } else {
      parts = identities();
    }
    for (Part& part : parts) part = {l_.broadcast(part)};
    return parts;
  }

  /// Calls the entry with `state` as accumulators, and stores outputs; returns the accumulators' new values.
  Parts folded(const Parts& state, const std::function<Parts(std::uint32_t)>& others, llvm::Value* element,
               llvm::Value* count) {
    std::vector<Parts> arguments;
    auto next = state.begin();
    for (std::uint32_t i = 0; i < s_.kernel.params.size(); ++i) {
      if (s_.kernel.params[i].role != ParamRole::Accumulator) {
        arguments.push_back(others(i));
        continue;
      }
      const auto parts = static_cast<std::ptrdiff_t>(componentCount(s_.module, s_.kernel.params[i].type));
      arguments.emplace_back(next, next + parts);
      next += parts;
    }
    const std::vector<Parts> changed = call(std::move(arguments), element, count).outputs;
    Parts result;
    auto nextChanged = changed.begin();
    for (std::uint32_t i = 0; i < s_.kernel.params.size(); ++i) {
      const ParamRole role = s_.kernel.params[i].role;
      if (role == ParamRole::Output) streams_.storeOutput(i, *nextChanged++);
      if (role != ParamRole::Accumulator) continue;
      for (const Part& part : *nextChanged++) result.push_back({l_.broadcast(part)});
    }
    return result;
  }

  void fold() {
    begin(3, 4);
    streams_.begin(function_->getArg(0), function_->getArg(1), prologue_);
    const State state = stateIn(function_->getArg(2));
    llvm::Value* const columns = function_->getArg(3);
    llvm::Value* const rounds = function_->getArg(4);
    llvm::Value* const leaves = function_->getArg(5);
    llvm::Value* const starts = b_.CreateICmpNE(function_->getArg(6), number(0));
    loop(number(0), leaves, 1, [&](llvm::Value* leaf) {
      const State ofLeaf = from(state, b_.CreateMul(reversed(leaf, leaves), columns));
      foldLeaf(ofLeaf, b_.CreateMul(leaf, b_.CreateMul(rounds, columns)), columns, rounds, starts);
    });
    end();
  }

  /// The state from a column on.
  State from(const State& state, llvm::Value* column) {
    State later = state;
    for (std::size_t c = 0; c < state.arrays.size(); ++c)
      later.arrays[c] = l_.at(l_.stored(state.scalars[c]), state.arrays[c], column);
    return later;
  }

  /// Reverses the bits of a number below `count`, a power of 2.
  llvm::Value* reversed(llvm::Value* value, llvm::Value* count) {
    llvm::Value* const all = b_.CreateUnaryIntrinsic(llvm::Intrinsic::bitreverse, value);
    llvm::Value* const bits = b_.CreateBinaryIntrinsic(llvm::Intrinsic::cttz, count, b_.getTrue());
    // in two steps, because a shift by 64 bits is undefined
    return b_.CreateLShr(b_.CreateLShr(all, b_.CreateSub(number(63), bits)), number(1));
  }

  /// Variables, which LLVM keeps in registers, for one group of lanes of the state.
  State registersFor(const State& state) {
    State registers{state.scalars, {}};
    llvm::IRBuilder<> allocas(prologue_, prologue_->begin());
    for (const Scalar scalar : state.scalars)
      registers.arrays.push_back(allocas.CreateAlloca(l_.vector(l_.type(scalar))));
    return registers;
  }
  void keep(const State& registers, const Parts& parts) {
    for (std::size_t c = 0; c < parts.size(); ++c) b_.CreateStore(parts[c].value, registers.arrays[c]);
  }
  Parts kept(const State& registers) {
    Parts parts;
    for (std::size_t c = 0; c < registers.arrays.size(); ++c) {
      parts.push_back({b_.CreateLoad(l_.vector(l_.type(registers.scalars[c])), registers.arrays[c])});
    }
    return parts;
  }

  /// Folds the leaf whose first element in the chunk is `first`.
  void foldLeaf(const State& state, llvm::Value* first, llvm::Value* columns, llvm::Value* rounds,
                llvm::Value* starts) {
    llvm::Value* const firstRound =
        s_.kernel.reduction->seeded ? b_.CreateZExt(starts, b_.getInt64Ty()) : number(0);
    loop(number(0), columns, l_.count(), [&](llvm::Value* column) {
      const auto block = [&](const char* name) {
        return llvm::BasicBlock::Create(b_.getContext(), name, function_);
      };
      llvm::BasicBlock* const start = block("begin");
      llvm::BasicBlock* const resume = block("resume");
      llvm::BasicBlock* const fold = block("fold");
      const State registers = registersFor(state);
      b_.CreateCondBr(starts, start, resume);
      b_.SetInsertPoint(start);
      keep(registers, startOf(b_.CreateAdd(first, column)));
      if (s_.kernel.reduction->seeded && foldsBesideOutputs(s_.kernel)) {  // the element's outputs alone
        folded(kept(registers), [&](std::uint32_t i) { return argument(i); }, column, columns);
      }
      b_.CreateBr(fold);
      b_.SetInsertPoint(resume);
      keep(registers, loadState(state, column));
      b_.CreateBr(fold);
      b_.SetInsertPoint(fold);
      loop(firstRound, rounds, 1, [&](llvm::Value* round) {
        streams_.moveTo(b_.CreateAdd(first, b_.CreateAdd(b_.CreateMul(round, columns), column)));
        keep(registers,
             folded(kept(registers), [&](std::uint32_t i) { return argument(i); }, column, columns));
      });
      storeState(state, column, kept(registers));
    });
  }

  // ---- rows of different lengths ----------------------------------------------------------------

  void foldRows() {
    begin(4, 1);
    streams_.begin(function_->getArg(0), function_->getArg(1), prologue_);
    const State state = stateIn(function_->getArg(3));
    const State registers = registersFor(state);
    llvm::Value* const before = streams_.chunkFirst();
    const auto startOfRow = [&](llvm::Value* row) {
      llvm::Value* const address = b_.CreateGEP(b_.getInt32Ty(), function_->getArg(2), row);
      llvm::Value* const start = b_.CreateSExt(b_.CreateLoad(b_.getInt32Ty(), address), b_.getInt64Ty());
      return b_.CreateSub(start, before, "", false, true);
    };
    loop(number(0), function_->getArg(4), 1, [&](llvm::Value* row) {
      llvm::Value* const first = startOfRow(row);
      llvm::Value* const end = startOfRow(b_.CreateAdd(row, number(1)));
      llvm::Value* const next = startRow(registers, first, end);
      loop(next, end, 1, [&](llvm::Value* element) {
        streams_.moveTo(element);
        keep(registers, folded(kept(registers), [&](std::uint32_t i) { return argument(i); }, element, end));
      });
      storeRow(state, row, kept(registers));
    });
    end();
  }

  /// Sets the initial accumulators of a row. Returns the first element to fold.
  llvm::Value* startRow(const State& registers, llvm::Value* first, llvm::Value* end) {
    if (!s_.kernel.reduction->seeded) {
      keep(registers, startOf(first));
      return first;
    }
    if (!hasIdentities(s_.kernel)) {
      keep(registers, startOf(first));
      return b_.CreateAdd(first, number(1));
    }
    Parts none = identities();
    for (Part& part : none) part = {l_.broadcast(part)};
    keep(registers, none);
    llvm::Value* const isEmpty = b_.CreateICmpSGE(first, end);
    const auto block = [&](const char* name) {
      return llvm::BasicBlock::Create(b_.getContext(), name, function_);
    };
    llvm::BasicBlock* const seed = block("seed");
    llvm::BasicBlock* const start = block("row");
    b_.CreateCondBr(isEmpty, start, seed);
    b_.SetInsertPoint(seed);
    keep(registers, startOf(first));
    b_.CreateBr(start);
    b_.SetInsertPoint(start);
    return b_.CreateAdd(first, number(1));
  }

  /// Stores accumulators in the type in which they are computed.
  void storeRow(const State& state, llvm::Value* row, const Parts& parts) {
    if (!l_.options().holdsFloats) return storeState(state, row, parts);
    for (std::size_t c = 0; c < state.arrays.size(); ++c) {
      if (state.scalars[c] == Scalar::Float) {
        b_.CreateStore(l_.broadcast(parts[c]), l_.at(l_.real(), state.arrays[c], row));
      } else {
        l_.storeNeighbors(state.scalars[c], parts[c],
                          l_.at(l_.stored(state.scalars[c]), state.arrays[c], row));
      }
    }
  }

  // ---- scans ------------------------------------------------------------------------------------

  void scan() {
    begin(4, 2);
    streams_.begin(function_->getArg(0), function_->getArg(1), prologue_);
    const State state = stateIn(function_->getArg(2));
    const State results = stateIn(function_->getArg(3));
    const auto block = [&](const char* name) {
      return llvm::BasicBlock::Create(b_.getContext(), name, function_);
    };
    llvm::BasicBlock* const inclusive = block("inclusive");
    llvm::BasicBlock* const end = block("end");
    if (hasIdentities(s_.kernel)) {
      llvm::BasicBlock* const exclusive = block("exclusive");
      b_.CreateCondBr(b_.CreateICmpNE(function_->getArg(5), number(0)), exclusive, inclusive);
      b_.SetInsertPoint(exclusive);
      scanElements(state, results, /*isExclusive=*/true);
      b_.CreateBr(end);
    } else {
      b_.CreateBr(inclusive);
    }
    b_.SetInsertPoint(inclusive);
    scanElements(state, results, /*isExclusive=*/false);
    b_.CreateBr(end);
    b_.SetInsertPoint(end);
    this->end();
  }

  /// An element is loaded before its result is stored, which may be in the same place.
  void scanElements(const State& state, const State& results, bool isExclusive) {
    const bool isSeeded = s_.kernel.reduction->seeded;
    llvm::Value* const starts = b_.CreateICmpNE(function_->getArg(4), number(0));
    llvm::Value* const first = isSeeded ? b_.CreateZExt(starts, b_.getInt64Ty()) : number(0);
    const auto block = [&](const char* name) {
      return llvm::BasicBlock::Create(b_.getContext(), name, function_);
    };
    llvm::BasicBlock* const start = block("begin");
    llvm::BasicBlock* const resume = block("resume");
    llvm::BasicBlock* const elements = block("scan");
    const State registers = registersFor(state);
    b_.CreateCondBr(starts, start, resume);
    b_.SetInsertPoint(start);
    keep(registers, startOf(number(0)));
    if (isSeeded) storeState(results, number(0), isExclusive ? identities() : kept(registers));
    b_.CreateBr(elements);
    b_.SetInsertPoint(resume);
    keep(registers, loadState(state, number(0)));
    b_.CreateBr(elements);
    b_.SetInsertPoint(elements);
    loop(first, streams_.chunkCount(), 1, [&](llvm::Value* element) {
      streams_.moveTo(element);
      const Parts before = kept(registers);
      keep(registers,
           folded(before, [&](std::uint32_t i) { return argument(i); }, element, streams_.chunkCount()));
      storeState(results, element, isExclusive ? before : kept(registers));
    });
    storeState(state, number(0), kept(registers));
  }

  void combine() {
    begin(3, 1);
    streams_.begin(function_->getArg(0), nullptr, prologue_);
    const State state = stateIn(function_->getArg(1));
    const State later = stateIn(function_->getArg(2));
    llvm::Value* const columns = function_->getArg(3);
    loop(number(0), columns, l_.count(), [&](llvm::Value* column) {
      const Parts loaded = loadState(later, column);
      auto next = loaded.begin();
      const auto others = [&](std::uint32_t i) {
        if (s_.kernel.params[i].role != ParamRole::Input) return argument(i);
        const auto parts = static_cast<std::ptrdiff_t>(componentCount(s_.module, s_.kernel.params[i].type));
        next += parts;
        return Parts(next - parts, next);
      };
      storeState(state, column, folded(loadState(state, column), others, column, columns));
    });
    end();
  }

  // ---- values -----------------------------------------------------------------------------------

  Parts borders() {
    Parts parts;
    for (const std::uint32_t i : paramsOf(ParamRole::Gather)) {
      if (s_.kernel.params[i].boundary != Boundary::Border) continue;
      const Parts one = streams_.border(i);
      parts.insert(parts.end(), one.begin(), one.end());
    }
    return parts;
  }
  /// The scalars of all accumulators, or of all gathers that have a border.
  std::vector<Scalar> scalarsOfAll(ParamRole role) const {
    std::vector<Scalar> scalars;
    for (const std::uint32_t i : paramsOf(role)) {
      const KernelParam& param = s_.kernel.params[i];
      if (role == ParamRole::Gather && param.boundary != Boundary::Border) continue;
      const std::vector<Scalar> own = scalarsOf(s_.module, param.type);
      scalars.insert(scalars.end(), own.begin(), own.end());
    }
    return scalars;
  }
  void values(ParamRole role, const std::function<Parts()>& make) {
    begin(2, 0);
    streams_.begin(function_->getArg(0), nullptr, prologue_);
    const Parts parts = make();
    const std::vector<Scalar> scalars = scalarsOfAll(role);
    for (std::size_t i = 0; i < parts.size(); ++i) {
      llvm::Value* const address =
          l_.at(b_.getPtrTy(), function_->getArg(1), number(static_cast<std::int64_t>(i)));
      l_.storeOne(scalars[i], parts[i].value, b_.CreateLoad(b_.getPtrTy(), address));
    }
    end();
  }

  const EntrySource& s_;
  llvm::IRBuilder<> b_;
  Lanes l_;
  Streams streams_;
  KernelContext context_;
  llvm::Module& code_;
  std::string name_;
  llvm::Function* function_ = nullptr;
  llvm::BasicBlock* prologue_ = nullptr;
};

}  // namespace

llvm::Function* writeEntry(llvm::Module& code, const EntrySource& source, EntryKind kind,
                           const std::string& name) {
  return EntryWriter(code, source, name).write(kind);
}

}  // namespace skc::native
