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

/// ".y", ".t", or nothing for the only component of an element.
std::string componentName(const program::Element& element, int component) {
  int number = 0;
  for (const program::Field& field : element.fields) {
    for (int c = 0; c < field.width; ++c, ++number) {
      if (number != component) continue;
      const std::string member = field.path.empty() ? "" : fmt::format(".{}", field.path);
      return field.width == 1 ? member : fmt::format("{}.{}", member, "xyzw"[c]);
    }
  }
  return {};
}

program::Scalar scalarOf(const program::Element& element, int component) {
  for (const program::Field& field : element.fields) {
    if (component < field.width) return field.scalar;
    component -= field.width;
  }
  return program::Scalar::Float;
}

/// The index, rows first, of a row-major number.
std::vector<std::int64_t> indexIn(const Shape& shape, std::int64_t number) {
  std::vector<std::int64_t> index(static_cast<std::size_t>(shape.rank()));
  for (int d = shape.rank() - 1; d >= 0; --d) {
    index[static_cast<std::size_t>(d)] = number % shape[d];
    number /= shape[d];
  }
  return index;
}

/// The element of an input that belongs to element `number` of `domain`; -1 if the shapes do not say.
std::int64_t numberIn(const Shape& input, const Shape& domain, std::int64_t number) {
  if (input == domain) return number;
  if (input.size() == 1) return 0;
  if (input.rank() != domain.rank()) return -1;
  const std::vector<std::int64_t> index = indexIn(domain, number);
  std::int64_t result = 0;
  for (int d = 0; d < input.rank(); ++d) {
    if (input[d] != domain[d] && input[d] != 1) return -1;
    result = result * input[d] + (input[d] == 1 ? 0 : index[static_cast<std::size_t>(d)]);
  }
  return result;
}

/// The number in the stream of an element of a region.
std::int64_t numberInStream(const AffineRegion& region, std::int64_t number) {
  std::int64_t result = region.first;
  for (std::size_t d = 0; d < region.extent.size(); ++d) {
    result += number % region.extent[d] * region.stride[d];
    number /= region.extent[d];
  }
  return result;
}

void addUniform(std::vector<shadow::Input>& inputs, const program::Parameter& parameter, const void* value) {
  int component = 0;
  for (const program::Field& field : parameter.element->fields) {
    for (std::uint32_t c = 0; c < field.width; ++c, ++component) {
      const auto* const at =
          static_cast<const std::byte*>(value) + field.offset + c * program::hostBytes(field.scalar);
      inputs.push_back({std::string(parameter.name) + componentName(*parameter.element, component),
                        numberAt(at, field.scalar), shadow::isReal(field.scalar)});
    }
  }
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

void CallFollower::compareOutput(Written& written) {
  TemporaryStreams& temporaries = device_.temporaries();
  std::unique_ptr<NativeStream> copied;
  NativeStream* reference = written.total.get();
  const NativeStream* source = nullptr;  // where the device's elements are, in order
  reference_ = nullptr;
  if (written.stream == nullptr) {
    written.device = temporaries.take(*parameterOf(written).element, Shape{1});
    const auto accumulators =
        std::ranges::count_if(written_.begin(), written_.begin() + (&written - written_.data()),
                              [](const Written& before) { return before.stream == nullptr; });
    written.device->write(
        detail::wholeRegion(written.device.get()),
        static_cast<const std::byte*>(call_.results[static_cast<std::size_t>(accumulators)]));
  } else {
    const StreamRegion region = regionOf(written);
    reference = written.stream->held();
    if (reference->shape.size() != written.stream->shape.size()) {  // another number of elements was pushed
      OutputErrors errors;
      errors.integers = 1;
      errors.decisions.add(0, 0, 0);
      const NativeStream* const own = ownOf(written);
      if (own != nullptr && own->shape.size() != written.stream->shape.size())
        errors.ownDecisions.add(0, 0, 0);
      recordErrors(written, errors, hasOwn_);
      written.stream->goStale(true);
      return;
    }
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
  const bool isHalf = written.stream != nullptr && written.stream->storage == Storage::Half;
  const double stored = hasOwn && isHalf ? shadow::squaresOfHalfRounding(*own) : 0;
  if (hasOwn && source != nullptr && own == written.own.get() && own->device == &device_.reference()) {
    written.device = std::move(written.own);  // the device's results replace it
  } else if (written.device == nullptr) {
    written.device = temporaries.take(*written.stream->element, shape);
    if (source == nullptr)
      copyElements(written.stream->innerOf(regionOf(written)), detail::wholeRegion(written.device.get()));
  }
  const OutputErrors errors = shadow::compare(*written.device, source, hasOwn ? own : nullptr, *reference);
  written.isSame = errors.isSame;
  if (hasOwn && isHalf && errors.reference2 > 0) {
    Recorder::Access report(device_.recorder());
    recordOf(*report, kernel_).storage.add(std::sqrt(stored / errors.reference2));
  }
  recordErrors(written, errors, hasOwn);
  if (device_.recorder().options().followsDecisions && written.stream != nullptr &&
      errors.decisions.count > 0)
    written.stream->takeIntegers(regionOf(written), *written.device);
  temporaries.giveBack(std::move(copied));
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
    if (hasOwn && inputs > 0 && std::isfinite(inputs))
      amplification_ = std::max(amplification_, errors.relativeInherited() / inputs);
    const std::size_t output = Recorder::output(record, parameter.name, parameter.element->name);
    record.outputs[output].points.add({number_, hasOwn ? errors.relativeOwn() : 0, errors.relativeInherited(),
                                       after.relative, errors.absoluteTotal(), turns(written)});
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
  if (written.stream == nullptr) {
    const bool isOnly = call_.results.size() == 1;
    const std::string name(call_.kernel.name);
    shadow::ResultRecord& result = report->results[Recorder::result(
        *report, isOnly ? name : fmt::format("{} of {}", parameter.name, name), true)];
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
}

/// Whether the output has mostly the other sign than an input of its shape, by some of their elements.
bool CallFollower::turns(const Written& written) const {
  constexpr std::int64_t most = 256;
  if (written.device == nullptr || written.stream == nullptr) return false;
  const std::span<const ComponentType> types = written.device->components.types();
  const auto real =
      std::ranges::find_if(types, [](const ComponentType& type) { return shadow::isReal(type.scalar); });
  if (real == types.end()) return false;
  const int component = static_cast<int>(real - types.begin());
  const std::int64_t count = written.device->shape.size(), step = std::max<std::int64_t>(1, count / most);
  return std::ranges::any_of(read_, [&](const Read& read) {
    const bool isAlike = read.device.stream != nullptr && read.device.shape == written.device->shape &&
                         read.stream->element == written.stream->element;
    if (!isAlike) return false;
    const auto& input = static_cast<const NativeStream&>(*read.device.stream);
    const AffineRegion region = affine(read.device);
    double product = 0;
    for (std::int64_t i = 0; i < count; i += step) {
      product += shadow::valueAt(*written.device, component, i) *
                 shadow::valueAt(input, component, numberInStream(region, i));
    }
    return product < 0;
  });
}

/// How much the error of each input counts in an output: by what calls have shown, or else by the inputs' relative errors.
std::vector<double> CallFollower::weightsOf(const Written& written) const {
  std::vector<double> errors, weights;
  for (const Read& read : read_) {
    errors.push_back(read.errors.relative);
    const std::optional<double> factor =
        device_.influences().of(call_.kernel, written.argument, read.argument);
    if (errors.back() == 0) {
      weights.push_back(0);
    } else if (factor) {
      weights.push_back(*factor * errors.back());
    }
  }
  const bool areKnown =
      weights.size() == errors.size() && std::ranges::any_of(weights, [](double each) { return each > 0; });
  return areKnown ? weights : errors;
}

/// What is known of the elements of an output now. The error consists of what the call has added, and of what its inputs had.
StreamErrors CallFollower::errorsAfter(const Written& written, const OutputErrors& errors, int kernel) const {
  StreamErrors after;
  double own = errors.ownShare();
  after.relative = errors.lost > 0 ? std::max(errors.relativeTotal(), 1.0) : errors.relativeTotal();
  if (errors.relativeIntegers() > after.relative) {
    after.relative = errors.relativeIntegers();
    own = std::min(
        1.0, static_cast<double>(errors.ownDecisions.count) / static_cast<double>(errors.decisions.count));
  }
  after.hasNan = errors.nans.count > 0;
  after.hasInfinity = errors.infinities.count > 0;
  if (after.relative > 0) {
    after.shares.add(kernel, own);
    const std::vector<double> weights = weightsOf(written);
    const double inputs = std::accumulate(weights.begin(), weights.end(), 0.0);
    for (std::size_t i = 0; i < read_.size() && inputs > 0; ++i)
      after.shares.add(read_[i].errors.shares, (1 - own) * weights[i] / inputs);
    const double missing = 1 - after.shares.sum();
    if (missing > 1e-6 && own < 1 - 1e-6) after.shares.add(shadow::writtenByHost, missing);
  }
  // Elements outside of the region have the errors that they had.
  if (written.stream != nullptr && written.stream->shape.size() > regionOf(written).shape.size()) {
    const StreamErrors& before = written.stream->errors;
    const double part = static_cast<double>(regionOf(written).shape.size()) /
                        static_cast<double>(written.stream->shape.size());
    const double here = after.relative * after.relative * part,
                 there = before.relative * before.relative * (1 - part);
    shadow::Shares shares;
    shares.add(after.shares, here);
    shares.add(before.shares, there);
    after.shares = shares;
    after.relative = std::sqrt(here + there);
    after.hasNan = after.hasNan || before.hasNan;
    after.hasInfinity = after.hasInfinity || before.hasInfinity;
  }
  after.shares.normalize();
  return after;
}

/// `value` is what the reference computes there with the device's inputs.
ElementRecord CallFollower::elementOf(const Written& written, std::int64_t element, int component,
                                      double value) const {
  const program::Parameter& parameter = parameterOf(written);
  const program::Element& type = written.stream != nullptr ? *written.stream->element : *parameter.element;
  ElementRecord record;
  record.call = number_;
  record.output = std::string(parameter.name) + componentName(type, component);
  record.isReal = shadow::isReal(scalarOf(type, component));
  if (written.device == nullptr) {  // another number of elements was pushed
    const NativeStream* const own = ownOf(written);
    const bool isOwn = own != nullptr && own->shape.size() != written.stream->shape.size();
    record.output += " (number of elements)";
    record.isReal = false;
    record.device = static_cast<double>(written.stream->shape.size());
    record.reference = static_cast<double>((isOwn ? *own : *written.stream->held()).shape.size());
    return record;
  }
  const Shape& shape = written.device->shape;
  record.device = shadow::valueAt(*written.device, component, element);
  record.reference = value;
  if (written.stream == nullptr) return record;
  record.index = indexIn(shape, element);
  const StreamRegion region = regionOf(written);
  if (isBox(region)) {
    for (int d = 0; d < shape.rank(); ++d) record.index[static_cast<std::size_t>(d)] += region.begin[d];
  }
  for (std::size_t i = 0; i < call_.arguments.size() && i < call_.kernel.parameters.size(); ++i) {
    const program::Parameter& given = call_.kernel.parameters[i];
    const bool isValue = given.role == Role::Uniform || given.role == Role::Spec;
    if (isValue && call_.arguments[i].value != nullptr)
      addUniform(record.inputs, given, call_.arguments[i].value);
    const auto read = std::ranges::find(read_, i, &Read::argument);
    if (read == read_.end() || read->device.stream == nullptr) continue;
    const std::int64_t number = numberIn(read->device.shape, shape, element);
    if (number < 0) continue;
    const NativeStream& elements = nativeStream(read->device);
    for (std::size_t c = 0; c < elements.components.types().size(); ++c) {
      const int of = static_cast<int>(c);
      record.inputs.push_back({std::string(given.name) + componentName(*read->stream->element, of),
                               shadow::valueAt(elements, of, numberInStream(affine(read->device), number)),
                               shadow::isReal(elements.components.types()[c].scalar)});
    }
  }
  return record;
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

/// Whether the call has read such a value, which the host may have written.
bool CallFollower::areRead(ExceptionRecord::Kind kind) const {
  for (const Read& read : read_) {
    if (read.device.stream == nullptr || kind == Kind::Flush) continue;
    const NativeStream& elements = nativeStream(read.device);
    const AffineRegion region = affine(read.device);
    for (std::size_t c = 0; c < elements.components.types().size(); ++c) {
      for (std::int64_t i = 0; i < read.device.shape.size(); ++i) {
        const double value = shadow::valueAt(elements, static_cast<int>(c), numberInStream(region, i));
        if (kind == Kind::Nan ? std::isnan(value) : std::isinf(value)) return true;
      }
    }
  }
  return false;
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
