// SPDX-License-Identifier: MIT
//
// Compares the outputs of a call and records the difference: errors, exceptional values, decisions.
#include "shadow/call_record.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstring>
#include <numeric>
#include <optional>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "device/configuration.hpp"
#include "device/region.hpp"
#include "shadow/copies.hpp"
#include "sk/scalar_bytes.hpp"
#include "support/scalar_types.hpp"

namespace sk {

using program::Role;
using shadow::ElementRecord;
using shadow::ExceptionRecord;
using shadow::KernelRecord;
using shadow::OutputErrors;
using shadow::Recorder;
using shadow::Report;
using Kind = shadow::ExceptionRecord::Kind;

void recordTimes(Recorder& recorder, int kernel, const CallTimes& times) {
  Recorder::Access report(recorder);
  report->kernels[static_cast<std::size_t>(kernel)].seconds += times.device;
  report->deviceSeconds += times.device;
  report->referenceSeconds += times.reference;
  report->comparisonSeconds += times.comparison;
}

std::string choicesText(const DeviceState& device, const ShadowedCall& call) {
  std::vector<std::string> choices = choicesOf(device.configuration.resolve(call.kernel, call.options));
  std::erase(choices, "precision single");
  return fmt::format("{}", fmt::join(choices, ", "));
}

namespace {

KernelRecord& recordOf(Report& report, int kernel) {
  return report.kernels[static_cast<std::size_t>(kernel)];
}

/// An element that is far off, in an output that is right elsewhere: another branch was taken there. `value` is the reference's.
bool isJump(const OutputErrors& errors, double value) {
  constexpr double far = 1e-3, share = 0.5;
  constexpr std::int64_t many = 64;
  return errors.reals >= many && errors.own.error > far * std::max(errors.scale(), std::fabs(value)) &&
         errors.own.error * errors.own.error > share * errors.own2;
}

}  // namespace

void CallFollower::compareAll() {
  const auto start = std::chrono::steady_clock::now();
  try {
    for (Written& written : written_) compareOutput(written);
    if (isWorst_ && !device_.recorder().options().inputs.empty()) keepInputs();
    keepElements();
    Recorder::Access report(device_.recorder());
    KernelRecord& record = recordOf(*report, kernel_);
    if (amplification_ > 0) record.amplification.add(amplification_);
    ++record.followed;
    ++report->followed;
  } catch (const std::exception& error) {
    device_.recorder().note(
        fmt::format("call {} of {} was not compared: {}", number_, call_.kernel.name, error.what()));
  }
  comparisonSeconds_ += std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

/// Keeps the converted elements of the device, which the next call may read.
void CallFollower::keepElements() {
  for (Written& written : written_) {
    if (written.stream == nullptr || written.device == nullptr) continue;
    const StreamRegion region = regionOf(written);
    if (isAllInOrder(region)) {
      written.stream->setSame(written.isSame);
      if (!written.isSame) written.stream->keepConverted(std::move(written.device));
      continue;
    }
    if (written.before != nullptr) written.stream->keepConverted(std::move(written.before));
    if (NativeStream* const all = written.stream->converted()) {
      StreamRegion part = region;
      part.stream = all;
      copyElements(detail::wholeRegion(written.device.get()), part);
    }
  }
}

/// Keeps what the call has read, for sk accuracy.
void CallFollower::keepInputs() {
  std::int64_t bytes = 0;
  for (const Read& read : read_) bytes += read.device.shape.size() * read.stream->element->size;
  const std::string name(call_.kernel.name);
  const bool areRecordable = std::ranges::all_of(
      call_.kernel.parameters,
      [](const program::Parameter& parameter) { return shadow::isRecordable(*parameter.element); });
  if (bytes > shadow::mostRecordedBytes || !areRecordable) {
    device_.recorder().note(
        fmt::format("the inputs of {} are not recorded: {}", name,
                    areRecordable ? "they are larger than 64 MiB" : "there are arrays in its parameters"));
    return;
  }
  shadow::RecordedInputs inputs;
  for (std::size_t i = 0; i < call_.arguments.size() && i < call_.kernel.parameters.size(); ++i) {
    const program::Parameter& parameter = call_.kernel.parameters[i];
    const Argument& argument = call_.arguments[i];
    if (argument.isNone) continue;
    if (isWritten(i)) {
      if (argument.region.stream != nullptr) inputs.addShape(parameter.name, argument.region.shape);
      continue;
    }
    const auto read = std::ranges::find(read_, i, &Read::argument);
    if (read != read_.end()) {
      const StreamRegion& region = read->device;
      std::vector<std::byte> elements(static_cast<std::size_t>(region.shape.size()) *
                                      read->stream->element->size);
      if (!elements.empty()) region.stream->read(region, elements.data());
      const bool isValue = parameter.role == Role::Uniform;
      inputs.add(parameter.name, *read->stream->element, isValue ? Shape{} : region.shape, elements.data());
    } else if (argument.value != nullptr) {
      const bool hasEnds = parameter.role == Role::Iterator;
      inputs.add(parameter.name, *parameter.element, hasEnds ? Shape{2} : Shape{},
                 static_cast<const std::byte*>(argument.value));
    }
  }
  device_.recorder().keepInputs(name, std::move(inputs));
}

const NativeStream* CallFollower::ownOf(const Written& written) const {
  if (!hasOwn_) return nullptr;
  if (!isRunOnce_) return written.own.get();
  if (reference_ != nullptr) return reference_;
  return written.stream != nullptr ? written.stream->held() : written.total.get();
}

void CallFollower::takeValue(Written& written) {
  written.device = device_.temporaries().take(*parameterOf(written).element, Shape{1});
  const auto accumulators =
      std::ranges::count_if(written_.begin(), written_.begin() + (&written - written_.data()),
                            [](const Written& before) { return before.stream == nullptr; });
  written.device->write(detail::wholeRegion(written.device.get()),
                        static_cast<const std::byte*>(call_.results[static_cast<std::size_t>(accumulators)]));
}

bool CallFollower::recordPushed(Written& written, bool hasOwn) {
  if (written.stream->held()->shape.size() == written.stream->shape.size()) return false;
  OutputErrors errors;
  errors.integers = 1;
  errors.decisions.add(0, 0, 0);
  const NativeStream* const own = ownOf(written);
  if (own != nullptr && own->shape.size() != written.stream->shape.size()) errors.ownDecisions.add(0, 0, 0);
  recordErrors(written, errors, hasOwn);
  written.stream->goStale(true);
  return true;
}

void CallFollower::compareOutput(Written& written) {
  TemporaryStreams& temporaries = device_.temporaries();
  std::unique_ptr<NativeStream> copied;
  NativeStream* reference = written.total.get();
  const NativeStream* source = nullptr;  // where the device's elements are, in order
  reference_ = nullptr;
  if (written.stream == nullptr) {
    takeValue(written);
  } else {
    if (recordPushed(written, hasOwn_)) return;
    const StreamRegion region = regionOf(written);
    reference = written.stream->held();
    if (region.shape.size() == 0) return;
    const StreamRegion inner = written.stream->innerOf(region);
    source = isAllInOrder(inner) ? dynamic_cast<const NativeStream*>(inner.stream) : nullptr;
    StreamRegion there = region;
    there.stream = reference;
    if (!isAllInOrder(there)) {
      copied = temporaries.take(*written.stream->element, region.shape);
      copyElements(there, detail::wholeRegion(copied.get()));
      reference = copied.get();
    }
  }
  reference_ = reference;
  const NativeStream* const own = ownOf(written);
  const Shape& shape = written.stream != nullptr ? regionOf(written).shape : written.device->shape;
  const bool hasOwn = own != nullptr && own->shape.size() == shape.size();
  const std::optional<Stored> stored = hasOwn ? storedOf(written, *own) : std::nullopt;
  if (hasOwn && source != nullptr && own == written.own.get() && own->device == &device_.reference()) {
    written.device = std::move(written.own);  // the device's results replace it
  } else if (written.device == nullptr) {
    written.device = temporaries.take(*written.stream->element, shape);
    if (source == nullptr)
      copyElements(written.stream->innerOf(regionOf(written)), detail::wholeRegion(written.device.get()));
  }
  const OutputErrors errors = shadow::compare(*written.device, source, hasOwn ? own : nullptr, *reference);
  written.isSame = errors.isSame;
  recordStored(errors, stored);
  recordErrors(written, errors, hasOwn);
  if (device_.recorder().options().followsDecisions && written.stream != nullptr &&
      errors.decisions.count > 0)
    written.stream->takeIntegers(regionOf(written), *written.device);
  temporaries.giveBack(std::move(copied));
}

/// What rounding on storing adds to an output that holds fewer digits than the call computes; nullopt if it holds all.
std::optional<CallFollower::Stored> CallFollower::storedOf(const Written& written,
                                                           const NativeStream& own) const {
  if (written.stream == nullptr) return std::nullopt;
  const Precision precision = device_.primary().configuration.resolve(call_.kernel, call_.options).precision;
  const bool isHalf = written.stream->storage == Storage::Half && precision != Precision::Half;
  const bool isFloat = written.stream->storage == Storage::Single &&
                       (precision == Precision::Extended || precision == Precision::Double);
  if (!isHalf && !isFloat) return std::nullopt;
  const std::string name = written.stream->name.empty() ? std::string(parameterOf(written).name)
                                                        : fmt::format("'{}'", written.stream->name);
  return Stored{shadow::squaresOfRounding(own, isHalf),
                fmt::format("{} in {}", name, isHalf ? "halves" : "floats"), isHalf ? "floats" : "doubles"};
}

void CallFollower::recordStored(const OutputErrors& errors, const std::optional<Stored>& stored) {
  Recorder::Access report(device_.recorder());
  KernelRecord& record = recordOf(*report, kernel_);
  const double own = errors.relativeOwn();
  record.ownSquares += own * own;
  if (!stored || !(errors.reference2 > 0)) return;
  const double part = std::sqrt(stored->squares / errors.reference2);
  record.storage.add(part);
  record.storedSquares += std::min(part * part, own * own);
  record.stored = stored->where;
  record.storedBetter = stored->better;
}

void CallFollower::recordErrors(const Written& written, const OutputErrors& errors, bool hasOwn) {
  const program::Parameter& parameter = parameterOf(written);
  Recorder::Access report(device_.recorder());
  KernelRecord& record = recordOf(*report, kernel_);
  const StreamErrors after = errorsAfter(written, errors, kernel_);
  if (errors.reals > 0 || errors.lost > 0) {
    if (hasOwn) record.own.add(errors.reportedOwn());
    record.inherited.add(errors.relativeInherited());
    record.total.add(errors.reportedTotal());
    double inputs = 0;
    for (const Read& read : read_) inputs = std::max(inputs, read.errors.relative);
    const bool isAmplified = hasOwn && inputs > 0 && std::isfinite(inputs);
    const double amplification = isAmplified ? errors.relativeInherited() / inputs : 1;
    if (isAmplified) amplification_ = std::max(amplification_, amplification);
    if (hasOwn)
      device_.influences().setCompared(call_.kernel, written.argument, {errors.relativeOwn(), amplification});
    const std::size_t output = Recorder::output(record, parameter.name, parameter.element->name);
    record.outputs[output].points.add({number_, hasOwn ? errors.relativeOwn() : 0, errors.relativeInherited(),
                                       after.relative, errors.absoluteTotal(), turns(written)});
    if (hasOwn) recordCompensation(errors, *report);
    const double scale = errors.scale();
    const double worst = hasOwn ? errors.own.error / (scale > 0 ? scale : 1) : 0;
    if (errors.own.element >= 0 && worst > record.worstError) {
      record.worstError = worst;
      record.worst = elementOf(written, errors.own.element, errors.own.component, errors.own.expected);
      isWorst_ = true;
    }
  } else {
    Recorder::output(record, parameter.name, parameter.element->name);
  }
  if (written.stream != nullptr) written.stream->errors = after;
  if (hasOwn) {
    recordExceptions(written, errors, kernel_, *report);
    recordDecisions(written, errors, kernel_, *report);
  }
  if (written.stream == nullptr) recordValue(written, errors, after, *report);
}

/// Notes kernels whose errors have made others smaller. Their share of the results' errors says nothing of how much they count.
void CallFollower::recordCompensation(const OutputErrors& errors, Report& report) const {
  constexpr double noticeable = 0.01;
  const double own = errors.signedOwnShare();
  if (own < -noticeable) recordOf(report, kernel_).compensates = true;
  if (own <= 1 + noticeable) return;
  for (const Read& read : read_) {
    for (const auto& [kernel, share] : read.errors.shares.all()) {
      if (kernel >= 0 && share * (own - 1) > noticeable) recordOf(report, kernel).compensates = true;
    }
  }
}

/// What a reduce returns is read by that.
void CallFollower::recordValue(const Written& written, const OutputErrors& errors, const StreamErrors& after,
                               Report& report) const {
  const program::Parameter& parameter = parameterOf(written);
  const bool isOnly = call_.results.size() == 1;
  const std::string name(call_.kernel.name);
  shadow::ResultRecord& result = report.results[Recorder::result(
      report, isOnly ? name : fmt::format("{} of {}", parameter.name, name), true)];
  ++result.reads;
  result.elements = 1;
  result.numbers = shadow::realComponents(*parameter.element);
  result.exception = exception_;
  result.scale = std::max(result.scale, errors.scale());
  // relative to the largest of the reads, since a sum may be 0 by chance
  result.last = result.scale > 0 && errors.reals > 0
                    ? std::max(errors.absoluteTotal() / result.scale, errors.relativeIntegers())
                    : after.relative;
  if (errors.lost > 0) result.last = std::numeric_limits<double>::infinity();
  const bool isWorst = result.last >= result.largest;
  result.largest = std::max(result.largest, result.last);
  result.differs += errors.decisions.count;
  result.notFinite = errors.newNans.count + errors.newInfinities.count;
  result.withoutValue = std::max(result.withoutValue, errors.nans.count + errors.infinities.count);
  if (isWorst) result.shares = after.shares;
}

void CallFollower::recordExceptions(const Written& written, const OutputErrors& errors, int kernel,
                                    Report& report) {
  constexpr std::size_t most = 256, longestPath = 32;
  KernelRecord& record = recordOf(report, kernel);
  record.nans += errors.newNans.count;
  record.infinities += errors.newInfinities.count;
  record.flushed += errors.flushed.count;
  StreamErrors* const stream = written.stream != nullptr ? &written.stream->errors : nullptr;
  exception_ = -1;
  const auto keep = [&](int exception) {
    exception_ = exception;
    if (stream != nullptr) stream->exception = exception;
  };
  const auto found = [&](Kind kind, const shadow::Found& all, const shadow::Found& added, bool wasThere) {
    if (all.count == 0) return;
    const shadow::Found& shown = added.count > 0 ? added : all;
    for (const Read& read : read_) {
      if (read.errors.exception < 0 || added.count > 0) continue;
      auto& path = report.exceptions[static_cast<std::size_t>(read.errors.exception)].path;
      const bool isKnown = std::ranges::any_of(path, [&](const shadow::Path& step) {
        return step.kernel == kernel && step.output == parameterOf(written).name;
      });
      if (!isKnown && path.size() < longestPath)
        path.push_back({number_, kernel, std::string(parameterOf(written).name), all.count});
      keep(read.errors.exception);
    }
    if (wasThere && added.count == 0) return;
    const auto known = std::ranges::find_if(report.exceptions, [&](const ExceptionRecord& each) {
      return each.kernel == kernel && each.kind == kind && each.isInReference == (added.count == 0);
    });
    if (known != report.exceptions.end()) {
      if (added.count > 0 || exception_ < 0) keep(static_cast<int>(known - report.exceptions.begin()));
      return;
    }
    if (report.exceptions.size() >= most || (added.count == 0 && areRead(kind))) return;
    report.exceptions.push_back({kind,
                                 kernel,
                                 shown.count,
                                 added.count == 0,
                                 elementOf(written, shown.first, shown.component, shown.expected),
                                 {}});
    // infinity minus infinity is NaN: it comes from where the infinity does
    if (added.count > 0 || exception_ < 0) keep(static_cast<int>(report.exceptions.size() - 1));
  };
  const bool hadNan = std::ranges::any_of(read_, [](const Read& read) { return read.errors.hasNan; });
  const bool hadInfinity =
      std::ranges::any_of(read_, [](const Read& read) { return read.errors.hasInfinity; });
  found(Kind::Nan, errors.nans, errors.newNans, hadNan);
  found(Kind::Infinity, errors.infinities, errors.newInfinities, hadInfinity);
  found(Kind::Flush, errors.flushed, errors.flushed, false);
}

void CallFollower::recordDecisions(const Written& written, const OutputErrors& errors, int kernel,
                                   Report& report) {
  constexpr std::size_t most = 256;
  KernelRecord& record = recordOf(report, kernel);
  const auto add = [&](std::int64_t elements, std::int64_t first, int component, double own,
                       bool isInherited) {
    record.decisions += elements;
    const bool isKnown = std::ranges::any_of(report.decisions, [&](const shadow::DecisionRecord& each) {
      return each.kernel == kernel && each.isInherited == isInherited;
    });
    if (isKnown || report.decisions.size() >= most) return;
    report.decisions.push_back({kernel, elements, isInherited, elementOf(written, first, component, own)});
    if (isInherited &&
        reference_ != nullptr)  // with the same inputs, the reference decides as the device does
      report.decisions.back().first.reference = shadow::valueAt(*reference_, component, first);
  };
  if (errors.ownDecisions.count > 0) {
    add(errors.ownDecisions.count, errors.ownDecisions.first, errors.ownDecisions.component,
        errors.ownDecisions.expected, false);
  } else if (errors.decisions.count > 0) {
    add(errors.decisions.count, errors.decisions.first, errors.decisions.component, errors.decisions.expected,
        true);
  }
  if (errors.own.element >= 0 && isJump(errors, errors.own.expected))
    add(1, errors.own.element, errors.own.component, errors.own.expected, false);
}

}  // namespace sk
