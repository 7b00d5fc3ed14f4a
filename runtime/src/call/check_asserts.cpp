// SPDX-License-Identifier: MIT
#include "call/check_asserts.hpp"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "call/box.hpp"
#include "call/check_written.hpp"
#include "call/placed.hpp"
#include "call/resolved_call.hpp"
#include "device/device_state.hpp"
#include "device/loop_state.hpp"
#include "device/rows_state.hpp"
#include "sk/error.hpp"

namespace sk {

namespace {

using program::Kernel;

/// "[3][4]".
std::string subscripts(const Index& index) {
  std::string text;
  for (int d = 0; d < index.rank(); ++d) text += fmt::format("[{}]", index[d]);
  return text;
}

/// The numbers of failed assertions for the elements of a box.
class Verdict {
 public:
  /// `isPlaced`: the stream holds the box alone, and not the whole domain.
  Verdict(DeviceState& device, const Kernel& kernel, const Shape& domain, const Box& box, bool isPlaced)
      : kernel_(kernel), box_(box) {
    Shape shape = domain;
    for (int d = 0; isPlaced && d < shape.rank(); ++d) shape = shape.with(d, box.end[d] - box.begin[d]);
    stream_ = device.createStream(ElementTraits<std::int32_t>::element(), shape, Storage::Single);
    region_ = {stream_.get(), Index::origin(shape.rank()), shape};
    if (isPlaced) region_.placement = {box.begin, domain};
  }

  const StreamRegion& region() const { return region_; }

  /// Throws sk::Error if an assertion has failed.
  void judge() const {
    StreamRegion checked = region_;
    checked.placement = {};
    if (region_.shape.size() != sizeOf(box_)) checked = partIn(checked, box_);
    std::vector<std::int32_t> failed(static_cast<std::size_t>(checked.shape.size()));
    stream_->read(checked, reinterpret_cast<std::byte*>(failed.data()));
    const auto first = std::ranges::find_if(failed, [](std::int32_t number) { return number != 0; });
    if (first == failed.end()) return;
    const program::Assertion& assertion =
        kernel_.assertions->assertions[static_cast<std::size_t>(*first - 1)];
    throw Error(fmt::format("{}:{}: assertion '{}' failed in '{}' at element {} (SK_CHECK=asserts)",
                            assertion.file, assertion.line, assertion.text, kernel_.name,
                            subscripts(indexOf(first - failed.begin()))),
                Error::Kind::Misuse);
  }

 private:
  static std::int64_t sizeOf(const Box& box) {
    std::int64_t size = 1;
    for (int d = 0; d < box.begin.rank(); ++d) size *= box.end[d] - box.begin[d];
    return size;
  }

  /// The index of an element of the box by its number.
  Index indexOf(std::int64_t number) const {
    Index index = box_.begin;
    for (int d = index.rank() - 1; d >= 0; --d) {
      const std::int64_t extent = box_.end[d] - box_.begin[d];
      index[d] += number % extent;
      number /= extent;
    }
    return index;
  }

  const Kernel& kernel_;
  const Box box_;
  std::unique_ptr<StreamState> stream_;
  StreamRegion region_;
};

class RecordedVerdict final : public RecordedCall {
 public:
  explicit RecordedVerdict(Verdict&& verdict) : verdict_(std::move(verdict)) {}
  void run() override { verdict_.judge(); }

 private:
  const Verdict verdict_;
};

/// The elements that a call computes or folds. Those in no row of a reduction in rows are not.
Box checkedBox(std::span<const Argument> arguments, const Shape& domain, const CallOptions& options) {
  Box box = boxOrAll(options.box, domain);
  for (const Argument& argument : arguments) {
    if (argument.rows == nullptr) continue;
    box.begin[0] = argument.rows->begin();
    box.end[0] = argument.rows->end();
    break;
  }
  return box;
}

}  // namespace

void checkAssertions(DeviceState& device, const Kernel& kernel, std::span<const Argument> arguments,
                     const Shape& domain, const CallOptions& options) {
  if (kernel.assertions == nullptr || !checksAsserts() || device.isChecking) return;
  const Box box = checkedBox(arguments, domain, options);
  for (int d = 0; d < domain.rank(); ++d) {
    if (box.begin[d] == box.end[d]) return;
  }
  const program::AssertionCheck& check = *kernel.assertions;
  std::vector<Argument> own;
  for (const std::uint8_t operand : check.operands) {
    own.push_back(arguments[operand]);
    own.back().rows = nullptr;
  }
  Verdict verdict(device, kernel, domain, box, hasPlaced(arguments));
  own.push_back({.region = verdict.region()});
  CallOptions chosen = options;
  chosen.accumulate = Accumulate::Default;
  chosen.scan = {};
  chosen.along = {};
  chosen.box = isAll(box, domain) && !hasPlaced(arguments) ? Box{} : box;
  run(check.check, own, chosen);
  if (device.recording == nullptr) return verdict.judge();
  device.recording->add(std::make_unique<RecordedVerdict>(std::move(verdict)));
}

void checkFoldAssertions(DeviceState& device, const Kernel& fold, std::span<const Argument> arguments,
                         const Box& box, const CallOptions& options) {
  CallOptions boxed = options;
  boxed.box = box;
  checkAssertions(device, fold, arguments, domainOf(fold, arguments, specsOf(fold, arguments), options.over),
                  boxed);
}

}  // namespace sk
