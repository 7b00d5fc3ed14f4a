// SPDX-License-Identifier: MIT
#include "call/check_unwritten_reads.hpp"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include "assemble/append/append_passes.hpp"
#include "assemble/condition.hpp"
#include "call/box.hpp"
#include "call/check_call.hpp"
#include "call/check_written.hpp"
#include "call/placed.hpp"
#include "call/resolved_call.hpp"
#include "call/test_values.hpp"
#include "device/device_state.hpp"
#include "device/region.hpp"
#include "device/stream_state.hpp"

namespace sk {

namespace {

using program::Element;
using program::Parameter;
using program::Role;
using program::ScatterOp;

using Elements = std::vector<std::byte>;

bool isReadAs(Role role) { return role == Role::Input || role == Role::Gather || role == Role::Uniform; }
bool isWrittenAs(Role role) {
  return role == Role::Output || role == Role::VariableOutput || role == Role::Scatter ||
         role == Role::Accumulator;
}

std::byte* elementIn(Elements& elements, const Element& element, std::int64_t number) {
  return elements.data() + static_cast<std::size_t>(number) * element.size;
}

std::int64_t countOf(const Elements& elements, const Element& element) {
  return static_cast<std::int64_t>(elements.size() / element.size);
}

/// The part of an element output that the call writes.
StreamRegion writtenPart(const RepeatableCall& call, const Parameter& output, const StreamRegion& region) {
  const bool isPlacedBox = call.isBoxOfWhole && isPlaced(region);
  if (!isPlacedBox) return partIn(region, call.box);
  return partOfWhole(call.kernel, output, region, boxOrAll(call.box, seenShape(region)));
}

/// The runs of a call with other values in the place of elements that nothing has written.
class UnwrittenReads {
 public:
  explicit UnwrittenReads(const RepeatableCall& call)
      : call_(call),
        specs_(specsOf(call.kernel, call.arguments)),
        arguments_(call.arguments.begin(), call.arguments.end()),
        values_(call.values.begin(), call.values.end()) {
    for (std::size_t i = 0; i < arguments_.size(); ++i) {
      if (!isStream(i)) continue;
      const Role role = call.kernel.parameters[i].role;
      if (isReadAs(role)) addVaried(i);
      if (role == Role::Scatter && !unwrittenIn(region(i)).empty()) hasScatters_ = true;
    }
  }

  /// Throws sk::Error if a result depends on an element that nothing has written, and finds out what scatter outputs get.
  void check() {
    if (varied_.empty() && !hasScatters_) return;
    createOutputs();
    const UncountedPasses uncounted(call_.device.passCount);  // these are none of the application's
    vary(0, 0);
    base_ = results();
    for (int number = 1; number < testValueCount && variedCount_ > 0; ++number) {
      vary(variedCount_, number);
      if (differs(results(), number) && isReproducible()) failAt(firstThatMatters(number));
    }
    if (hasScatters_) findScattered();
  }

  /// Notes what the call has written.
  void noteResults() const {
    for (std::size_t i = 0; i < arguments_.size(); ++i) {
      if (!isStream(i)) continue;
      switch (call_.kernel.parameters[i].role) {
        case Role::Output: noteWritten(writtenPart(call_, call_.kernel.parameters[i], region(i))); break;
        case Role::Accumulator: noteWritten(region(i)); break;
        case Role::VariableOutput: noteAllWritten(*region(i).stream); break;
        case Role::Scatter:
        case Role::Input:
        case Role::Gather:
        case Role::Uniform:
        case Role::Iterator:
        case Role::Spec: break;
      }
    }
    for (const Scattered& scattered : scattered_) noteWritten(region(scattered.argument), scattered.numbers);
  }

 private:
  /// An argument with elements that nothing has written, and a stream in its place.
  struct Varied {
    std::size_t argument;
    std::vector<std::int64_t> unwritten;  ///< numbers of elements of its region
    Elements elements;
  };
  /// The elements of a scatter output that the call is the first to write.
  struct Scattered {
    std::size_t argument;
    std::vector<std::int64_t> numbers;
  };

  const Parameter& parameter(std::size_t i) const { return call_.kernel.parameters[i]; }
  const StreamRegion& region(std::size_t i) const { return call_.arguments[i].region; }
  const Element& elementOf(std::size_t i) const { return *region(i).stream->element; }

  /// Whether an argument is a stream that the call uses.
  bool isStream(std::size_t i) const {
    return region(i).stream != nullptr && assemble::isNeeded(parameter(i), specs_) &&
           (isReadAs(parameter(i).role) || isWrittenAs(parameter(i).role));
  }

  StreamRegion createLike(const StreamRegion& given) {
    const StreamState& stream = *given.stream;
    streams_.push_back(call_.device.createStream(*stream.element, given.shape, stream.storage));
    StreamRegion created{streams_.back().get(), Index::origin(given.shape.rank()), given.shape};
    created.placement = given.placement;
    return created;
  }

  static Elements read(const StreamRegion& region) {
    Elements elements(static_cast<std::size_t>(region.shape.size()) * region.stream->element->size);
    const DenseRegion dense(region, /*isRead=*/true);
    if (!elements.empty()) dense.get().stream->read(dense.get(), elements.data());
    return elements;
  }

  void addVaried(std::size_t i) {
    std::vector<std::int64_t> unwritten = unwrittenIn(region(i));
    if (unwritten.empty()) return;
    variedCount_ += unwritten.size();
    arguments_[i].region = createLike(region(i));
    varied_.push_back({i, std::move(unwritten), read(region(i))});
  }

  /// Sets the first `count` of all elements that nothing has written to test value `number`, and the others to 0.
  void vary(std::size_t count, int number) {
    for (Varied& varied : varied_) {
      const Element& element = elementOf(varied.argument);
      for (const std::int64_t unwritten : varied.unwritten) {
        setTestValue(element, region(varied.argument).stream->storage, count > 0 ? number : 0,
                     elementIn(varied.elements, element, unwritten));
        count -= count > 0 ? 1 : 0;
      }
      const StreamRegion& to = arguments_[varied.argument].region;
      to.stream->write(to, varied.elements.data());
    }
  }

  /// Puts streams and host memory of our own in the place of all outputs.
  void createOutputs() {
    std::size_t value = 0;
    for (std::size_t i = 0; i < arguments_.size(); ++i) {
      if (parameter(i).role == Role::Accumulator && !call_.values.empty()) {
        Elements& bytes = valueBytes_.emplace_back(parameter(i).element->size);
        values_[value++] = bytes.data();
      } else if (isStream(i) && parameter(i).role == Role::VariableOutput) {
        streams_.push_back(call_.device.createStream(elementOf(i), Shape{0}, region(i).stream->storage));
        arguments_[i].region = detail::wholeRegion(streams_.back().get());
        outputs_.push_back(i);
      } else if (isStream(i) && isWrittenAs(parameter(i).role)) {
        arguments_[i].region = createLike(region(i));
        outputs_.push_back(i);
      }
    }
  }

  /// What a scatter output holds before the call.
  Elements scatterBase(std::size_t i, int number) const {
    const Element& element = elementOf(i);
    Elements elements(static_cast<std::size_t>(region(i).shape.size()) * element.size);
    for (std::int64_t k = 0; k < region(i).shape.size(); ++k) {
      std::byte* const bytes = elementIn(elements, element, k);
      if (parameter(i).scatter == ScatterOp::Store) {
        setTestValue(element, region(i).stream->storage, number, bytes);
      } else {
        setNeutral(element, parameter(i).scatter, bytes);
      }
    }
    return elements;
  }

  /// Runs the call and returns its outputs, and then its values. `scatterNumber` is the test value that scatter outputs hold
  /// before.
  std::vector<Elements> results(int scatterNumber = 0) {
    for (const std::size_t i : outputs_) {
      const StreamRegion& to = arguments_[i].region;
      if (parameter(i).role == Role::Scatter && to.shape.size() > 0)
        to.stream->write(to, scatterBase(i, scatterNumber).data());
    }
    call_.run(arguments_, values_);
    std::vector<Elements> all;
    for (const std::size_t i : outputs_) {
      StreamRegion result = arguments_[i].region;
      if (parameter(i).role == Role::VariableOutput) {
        result = detail::wholeRegion(result.stream);
      } else if (parameter(i).role == Role::Output) {
        result = writtenPart(call_, parameter(i), result);
      }
      all.push_back(read(result));
    }
    all.insert(all.end(), valueBytes_.begin(), valueBytes_.end());
    return all;
  }

  const Element& resultElement(std::size_t k) const {
    if (k < outputs_.size()) return elementOf(outputs_[k]);
    std::size_t accumulator = k - outputs_.size();
    const auto found = std::ranges::find_if(call_.kernel.parameters, [&](const Parameter& one) {
      return one.role == Role::Accumulator && accumulator-- == 0;
    });
    return *found->element;
  }

  /// Whether results differ from those with zeros. Large values may overflow, and 0 times infinity is no use of a value.
  bool differs(std::vector<Elements> got, int number) {
    for (std::size_t k = 0; k < got.size(); ++k) {
      if (got[k] == base_[k]) continue;
      if (got[k].size() != base_[k].size()) return true;
      const Element& element = resultElement(k);
      for (std::int64_t i = 0; i < countOf(got[k], element); ++i) {
        const std::byte* const one = elementIn(got[k], element, i);
        if (haveSameValues(element, one, elementIn(base_[k], element, i))) continue;
        if (number < firstLargeValue || !hasNaN(element, one)) return true;
      }
    }
    return false;
  }

  /// Whether the call computes the same twice; otherwise nothing can be told from results that differ.
  bool isReproducible() {
    vary(0, 0);
    return !differs(results(), 0);
  }

  /// The number, among all elements that nothing has written, of one on which a result depends: results are those with zeros as
  /// long as fewer elements are changed.
  std::size_t firstThatMatters(int number) {
    std::size_t same = 0, other = variedCount_;
    while (other - same > 1) {
      const std::size_t middle = same + (other - same) / 2;
      vary(middle, number);
      (differs(results(), number) ? other : same) = middle;
    }
    return same;
  }

  [[noreturn]] void failAt(std::size_t number) const {
    std::size_t k = 0;
    while (number >= varied_[k].unwritten.size()) number -= varied_[k++].unwritten.size();
    failAt(varied_[k].argument, varied_[k].unwritten[number]);
  }

  [[noreturn]] void failAt(std::size_t i, std::int64_t number) const {
    if (region(i).stream->unwritten->isAll()) {
      fail(call_.kernel,
           "'{}' reads a stream of shape {} that nothing has written; write() or fill() it first, or let a "
           "kernel write it (SK_CHECK=written)",
           parameter(i).name, toString(isPlaced(region(i)) ? seenShape(region(i)) : region(i).stream->shape));
    }
    Index at = indexOf(region(i).shape, number);
    for (int d = 0; d < at.rank(); ++d) at[d] += originOf(region(i), d);
    fail(call_.kernel,
         "'{}' is read at {} of shape {}, an element that nothing has written; write() or fill() it first, "
         "or let a kernel write it (SK_CHECK=written)",
         parameter(i).name, toString(at), toString(seenShape(region(i))));
  }

  /// A combining output must not reach elements that nothing has written; of one that stores, elements become written that do not
  /// show what the output held before.
  void findScattered() {
    vary(0, 0);
    const std::vector<Elements> others = results(1);
    for (std::size_t k = 0; k < outputs_.size(); ++k) {
      const std::size_t i = outputs_[k];
      if (parameter(i).role != Role::Scatter) continue;
      const bool stores = parameter(i).scatter == ScatterOp::Store;
      Elements other = stores ? others[k] : scatterBase(i, 0);
      std::vector<std::int64_t> numbers = unwrittenIn(region(i));
      const Element& element = elementOf(i);
      std::erase_if(numbers, [&](std::int64_t number) {
        const bool isSame =
            haveSameValues(element, elementIn(base_[k], element, number), elementIn(other, element, number));
        return isSame != stores;
      });
      if (!stores && !numbers.empty()) failAt(i, numbers.front());
      scattered_.push_back({i, std::move(numbers)});
    }
  }

  const RepeatableCall& call_;
  const assemble::SpecValues specs_;
  std::vector<Argument> arguments_;  ///< with streams of our own for those that vary, and for outputs
  std::vector<void*> values_;
  std::vector<std::unique_ptr<StreamState>> streams_;
  std::vector<Varied> varied_;
  std::size_t variedCount_ = 0;  ///< elements of all of them
  bool hasScatters_ = false;  ///< to streams with elements that nothing has written
  std::vector<std::size_t> outputs_;
  std::vector<Elements> valueBytes_;
  std::vector<Elements> base_;  ///< the results with zeros
  std::vector<Scattered> scattered_;
};

}  // namespace

void runChecked(const RepeatableCall& call, const std::function<void()>& run) {
  if (call.device.isChecking) return run();
  UnwrittenReads reads(call);
  const UncheckedSteps steps(call.device);
  reads.check();
  run();
  reads.noteResults();
}

}  // namespace sk
