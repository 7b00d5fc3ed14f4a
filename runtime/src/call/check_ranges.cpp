// SPDX-License-Identifier: MIT
#include "call/check_ranges.hpp"

#include <algorithm>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "assemble/condition.hpp"
#include "call/box.hpp"
#include "call/check_call.hpp"
#include "call/check_written.hpp"
#include "call/placed.hpp"
#include "call/range_values.hpp"
#include "call/resolved_call.hpp"
#include "device/device_state.hpp"
#include "device/loop_state.hpp"
#include "device/region.hpp"
#include "device/stream_state.hpp"

namespace sk {

namespace {

using program::Kernel;
using program::Parameter;
using program::Role;
using program::ValueRange;

bool isGivenTo(const Parameter& parameter) {
  const Role role = parameter.role;
  return role == Role::Input || role == Role::Gather || role == Role::Uniform || role == Role::Spec;
}

bool isWrittenBy(const Parameter& parameter) {
  const Role role = parameter.role;
  return role == Role::Output || role == Role::Accumulator || role == Role::VariableOutput ||
         role == Role::Scatter;
}

/// Throws the error. `verb`: "is", or "would be" in a call that has not run. `place`: the element, or empty.
[[noreturn]] void failAt(const Kernel& kernel, const Parameter& parameter, const OutOfRange& found,
                         std::string_view verb, const std::string& place) {
  fail(kernel, "'{}{}' {} {}{}, outside of its range [{}, {}] (SK_CHECK=ranges)", parameter.name,
       found.component, verb, found.value, place, parameter.range->low, parameter.range->high);
}

/// The elements of a region in host memory: as floats, or as the doubles that their stream stores for them.
class HostElements {
 public:
  explicit HostElements(const StreamRegion& region)
      : element_(*region.stream->element), storage_(region.stream->storage), count_(region.shape.size()) {
    if (count_ == 0) return;
    StreamRegion alone = region;
    alone.placement = {};
    const DenseRegion dense(alone, /*isRead=*/true);
    StreamState& stream = *dense.get().stream;
    if (storage_ == Storage::Extended || storage_ == Storage::Double) {
      for (const program::Field& field : element_.fields) width_ += field.width;
      reals_.resize(static_cast<std::size_t>(count_) * width_);
      stream.readReals(dense.get(), reals_.data());
    } else {
      bytes_.resize(static_cast<std::size_t>(count_) * element_.size);
      stream.read(dense.get(), bytes_.data());
    }
  }

  std::int64_t count() const { return count_; }

  std::optional<OutOfRange> outOfRange(std::int64_t number, const ValueRange& range) const {
    const auto i = static_cast<std::size_t>(number);
    return reals_.empty() ? sk::outOfRange(element_, storage_, range, bytes_.data() + i * element_.size)
                          : sk::outOfRange(element_, storage_, range, reals_.data() + i * width_);
  }

  bool isSame(const HostElements& other, std::int64_t number) const {
    const auto i = static_cast<std::size_t>(number);
    const auto isSameIn = [i](const auto& mine, const auto& others, std::size_t width) {
      const auto begin = mine.begin() + static_cast<std::ptrdiff_t>(i * width);
      return std::equal(begin, begin + static_cast<std::ptrdiff_t>(width),
                        others.begin() + static_cast<std::ptrdiff_t>(i * width));
    };
    return reals_.empty() ? isSameIn(bytes_, other.bytes_, element_.size)
                          : isSameIn(reals_, other.reals_, width_);
  }

 private:
  const program::Element& element_;
  const Storage storage_;
  const std::int64_t count_;
  std::size_t width_ = 0;  ///< reals of an element
  std::vector<std::byte> bytes_;
  std::vector<double> reals_;
};

/// " at {3, 4}": the index, as kernels see it, of an element of the region.
std::string placeIn(const StreamRegion& region, std::int64_t number) {
  Index at = indexOf(region.shape, number);
  for (int d = 0; d < at.rank(); ++d) at[d] += originOf(region, d);
  return fmt::format(" at {}", toString(at));
}

/// Throws if an element of the region is out of range; `before`, unless it is null, has the elements that the region held, and only
/// those that differ count.
void checkRegion(const Kernel& kernel, const Parameter& parameter, const StreamRegion& region,
                 std::string_view verb, const HostElements* before = nullptr) {
  const HostElements elements(region);
  for (std::int64_t i = 0; i < elements.count(); ++i) {
    const std::optional<OutOfRange> found = elements.outOfRange(i, *parameter.range);
    if (!found || (before != nullptr && elements.isSame(*before, i))) continue;
    failAt(kernel, parameter, *found, verb, placeIn(region, i));
  }
}

/// Likewise for a value in host memory.
void checkBytes(const Kernel& kernel, const Parameter& parameter, std::string_view verb,
                const std::byte* value) {
  if (const auto found = outOfRange(*parameter.element, Storage::Single, *parameter.range, value))
    failAt(kernel, parameter, *found, verb, "");
}

/// A run of a call with outputs of our own in the place of all outputs.
class Rehearsal {
 public:
  explicit Rehearsal(const RangedCall& call)
      : call_(call),
        specs_(specsOf(call.kernel, call.arguments)),
        arguments_(call.arguments.begin(), call.arguments.end()),
        values_(call.values.begin(), call.values.end()) {}

  /// Throws sk::Error if a result is not in its range.
  void check() {
    if (!hasRanges()) return;
    createOutputs();
    {
      const UncheckedSteps steps(call_.device);
      const UncountedPasses uncounted(call_.device.passCount);  // these are none of the application's
      call_.run(arguments_, values_);
    }
    std::size_t value = 0, scattered = 0;
    for (std::size_t i = 0; i < arguments_.size(); ++i) {
      const bool isValue = parameter(i).role == Role::Accumulator && !values_.empty();
      if (isValue) {
        const std::byte* const bytes = valueBytes_[value++].data();
        if (isChecked(i)) checkBytes(call_.kernel, parameter(i), verb, bytes);
      } else if (isStream(i)) {
        const HostElements* const before =
            parameter(i).role == Role::Scatter ? &scatterBases_[scattered++] : nullptr;
        if (isChecked(i)) checkRegion(call_.kernel, parameter(i), written(i), verb, before);
      }
    }
  }

 private:
  static constexpr std::string_view verb = "would be";

  const Parameter& parameter(std::size_t i) const { return call_.kernel.parameters[i]; }

  bool isChecked(std::size_t i) const {
    return parameter(i).range && (parameter(i).role != Role::Accumulator || call_.checksFolded);
  }
  bool hasRanges() const {
    for (std::size_t i = 0; i < arguments_.size(); ++i) {
      const bool isGiven = isStream(i) || (parameter(i).role == Role::Accumulator && !values_.empty());
      if (isWrittenBy(parameter(i)) && isChecked(i) && isGiven) return true;
    }
    return false;
  }
  bool isStream(std::size_t i) const {
    return isWrittenBy(parameter(i)) && call_.arguments[i].region.stream != nullptr &&
           !call_.arguments[i].isNone && assemble::isNeeded(parameter(i), specs_);
  }

  StreamRegion createLike(const StreamRegion& given, const Shape& shape) {
    const StreamState& stream = *given.stream;
    streams_.push_back(call_.device.createStream(*stream.element, shape, stream.storage));
    StreamRegion created{streams_.back().get(), Index::origin(shape.rank()), shape};
    created.placement = given.placement;
    return created;
  }

  void createOutputs() {
    std::size_t value = 0;
    for (std::size_t i = 0; i < arguments_.size(); ++i) {
      if (parameter(i).role == Role::Accumulator && !values_.empty()) {
        valueBytes_.emplace_back(parameter(i).element->size);
        values_[value++] = valueBytes_.back().data();
      } else if (isStream(i)) {
        const StreamRegion& given = call_.arguments[i].region;
        const bool isVariable = parameter(i).role == Role::VariableOutput;
        arguments_[i].region = createLike(given, isVariable ? Shape{0} : given.shape);
        if (parameter(i).role == Role::Scatter) keepScattered(given, arguments_[i].region);
      }
    }
  }

  /// A scatter output keeps, or combines, what it holds.
  void keepScattered(const StreamRegion& from, const StreamRegion& to) {
    if (from.shape.size() > 0) {
      const DenseRegion dense(from, /*isRead=*/true);
      if (!to.stream->copyFrom(dense.get(), to)) {
        std::vector<std::byte> bytes(static_cast<std::size_t>(from.shape.size()) *
                                     from.stream->element->size);
        dense.get().stream->read(dense.get(), bytes.data());
        to.stream->write(to, bytes.data());
      }
    }
    scatterBases_.emplace_back(to);
  }

  /// What the call has written of an output.
  StreamRegion written(std::size_t i) const {
    const StreamRegion& region = arguments_[i].region;
    switch (parameter(i).role) {
      case Role::VariableOutput: region.stream->settle(); return detail::wholeRegion(region.stream);
      case Role::Output: break;
      default: return region;
    }
    const Box box = boxOrAll(call_.box, seenShape(region));
    StreamRegion part =
        isPlaced(region) ? partOfWhole(call_.kernel, parameter(i), region, box) : partIn(region, box);
    part.placement = {box.begin, seenShape(region)};
    return part;
  }

  const RangedCall& call_;
  const assemble::SpecValues specs_;
  std::vector<Argument> arguments_;
  std::vector<void*> values_;
  std::vector<std::unique_ptr<StreamState>> streams_;
  std::vector<std::vector<std::byte>> valueBytes_;
  std::vector<HostElements> scatterBases_;
};

void checkNow(const RangedCall& call) {
  checkRangesRead(call.kernel, call.arguments);
  checkRangesWritten(call);
}

class RecordedRanges final : public RecordedCall {
 public:
  explicit RecordedRanges(const RangedCall& call) : arguments_(call.kernel, call.arguments), call_(call) {
    call_.arguments = arguments_.get();
    arguments_.noteUses(*call.device.recording);
  }

  void run() override { checkNow(call_); }

 private:
  const OwnedArguments arguments_;
  RangedCall call_;
};

bool hasRange(const Parameter& parameter) { return parameter.range.has_value(); }

}  // namespace

void checkRanges(const RangedCall& call) {
  if (!checksRanges() || call.device.isChecking || std::ranges::none_of(call.kernel.parameters, hasRange))
    return;
  if (call.device.recording == nullptr) return checkNow(call);
  call.device.recording->add(std::make_unique<RecordedRanges>(call));
}

void checkRangesRead(const Kernel& kernel, std::span<const Argument> arguments) {
  const assemble::SpecValues specs = specsOf(kernel, arguments);
  for (std::size_t i = 0; i < arguments.size(); ++i) {
    const Parameter& parameter = kernel.parameters[i];
    const Argument& argument = arguments[i];
    if (!parameter.range || !isGivenTo(parameter)) continue;
    if (argument.value != nullptr) {
      checkBytes(kernel, parameter, "is", static_cast<const std::byte*>(argument.value));
    } else if (argument.region.stream != nullptr && !argument.isNone &&
               assemble::isNeeded(parameter, specs)) {
      checkRegion(kernel, parameter, argument.region, "is");
    }
  }
}

void checkRangesWritten(const RangedCall& call) { Rehearsal(call).check(); }

void checkResultRange(const Kernel& kernel, const Parameter& parameter, const std::byte* value) {
  if (parameter.range) checkBytes(kernel, parameter, "would be", value);
}

void checkResultRange(const Kernel& kernel, const Parameter& parameter, const StreamRegion& region) {
  if (parameter.range) checkRegion(kernel, parameter, region, "would be");
}

}  // namespace sk
