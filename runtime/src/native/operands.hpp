// SPDX-License-Identifier: MIT
//
// The operands of native code for the arguments of one call. A stream that a call reads and writes is read as it was
// before, unless each element reads only itself. If the call writes all of the stream, the results go to spare arrays,
// which then become the stream's own; otherwise, readers get a copy.
#pragma once

#include <algorithm>
#include <functional>
#include <list>
#include <numeric>
#include <utility>
#include <vector>

#include "assemble/condition.hpp"
#include "call/check_call.hpp"
#include "call/iterator.hpp"
#include "call/resolved_call.hpp"
#include "device/region.hpp"
#include "device/write_scope.hpp"
#include "native/call.hpp"
#include "native/coalesce.hpp"
#include "native/native_device.hpp"
#include "native/native_stream.hpp"

namespace sk {

/// The operands of one call, and what they point to.
class Operands {
  using Extents = native::Extents;
  using Operand = native::Operand;
  using Kernel = program::Kernel;
  using Parameter = program::Parameter;
  using Role = program::Role;

 public:
  /// `box` is the part of the domain that a kernel writes, or a reduction folds.
  Operands(RealType real, const Kernel& kernel, std::span<const Argument> arguments, const Shape& domain,
           std::vector<native::Table> tables, bool isScan = false, const Box& box = {})
      : real_(real),
        kernel_(kernel),
        arguments_(arguments),
        tables_(std::move(tables)),
        isScan_(isScan),
        box_(box),
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
    if (!box_.isWhole()) {
      native::Call part = callAsItIs();
      part.part = partOf(box_);
      return part;
    }
    Extents whole = fastestFirst(domain_);
    return call(whole);
  }
  native::Call call(Extents& block) {
    if (!box_.isWhole()) return call();
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
      if (isWritten(role)) results_.push_back(region);
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
      list_[lent.operand].components =
          (lent.isSpare ? lent.stream->spare() : lent.stream->components).arrays();
    }
  }
  std::span<StreamState* const> writtenInPlace() const { return writtenInPlace_; }

  /// An operand whose arrays are those of a stream.
  struct Lent {
    std::size_t operand;
    NativeStream* stream;
    bool isSpare;
  };
  /// The rest is for calls that run in parts (native/tiled_call.hpp): known after mayRunAgain().
  std::span<const Lent> lent() const { return lent_; }
  /// The streams that get their spare arrays after a run.
  std::span<NativeStream* const> replaced() const { return replaced_; }
  /// Calls visit(stream) for streams whose elements are values of the call.
  template <class Visit>
  void forEachValueInStream(Visit&& visit) const {
    for (const Held& held : held_) visit(nativeStream(held.region));
  }
  void settleAgain() {
    for (NativeStream* const stream : replaced_) stream->exchange();
    for (const StreamRegion& region : results_) {
      NativeStream& stream = nativeStream(region);
      stream.keepStorage(region);
      stream.setWritten();
    }
  }

  /// From here on, until settle(), the streams that are written in place change.
  void begin() {
    for (std::size_t i = 0; i < list_.size(); ++i) {
      if (isWrittenInPlace(i)) writes_.add(arguments_[i].region.stream);
    }
    writes_.begin();
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
        const StreamRegion& region = arguments_[i].region;
        NativeStream& stream = nativeStream(region);
        stream.keepStorage(list_[i].pushed == nullptr ? region : detail::wholeRegion(&stream));
        stream.setWritten();
      }
    }
    writes_.commit();
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
  static native::Part partOf(const Box& box) {
    native::Part part;
    const int rank = box.begin.rank();
    for (int d = 0; d < rank; ++d) {
      const auto axis = static_cast<std::size_t>(rank - 1 - d);
      part.first[axis] = box.begin[d];
      part.extent[axis] = box.end[d] - box.begin[d];
    }
    return part;
  }

  /// Only [[wrap]] finds elements beyond the ends of the whole.
  static void keepInside(Operand& operand) {
    for (std::size_t d = 0; d < 4; ++d) {
      operand.held->low[d] = std::max<std::int64_t>(operand.held->low[d], 0);
      operand.held->high[d] = std::min(operand.held->high[d], operand.extent[d]);
    }
  }

  struct Held {
    StreamRegion region;
    Components& value;
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
    if (operand.held && parameter.role == Role::Gather && parameter.boundary != program::Boundary::Wrap)
      keepInside(operand);
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
      const bool isApart = kernel_.parameters[i].role != Role::VariableOutput &&
                           !overlap(arguments_[i].region, arguments_[input].region);
      if (isApart) continue;
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
    return parameter.role == Role::Output && box_.isWhole() && assemble::isNeeded(parameter, specs_) &&
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
  Box box_;
  const assemble::SpecValues specs_;
  Shape domain_;
  std::vector<Operand> list_;
  std::list<Components> kept_;
  std::vector<Held> held_;  ///< uniforms
  std::vector<Lent> lent_;  ///< this and the next two lines: for beginAgain() and settleAgain()
  std::vector<StreamState*> writtenInPlace_;
  std::vector<NativeStream*> replaced_;
  std::vector<StreamRegion> results_;
  WriteScope writes_;
  std::list<native::Pushed> pushed_;
  std::vector<std::pair<const NativeStream*, const Components*>> copies_;  ///< for reading
  std::list<std::pair<NativeStream*, Components>> written_;
};

}  // namespace sk
