// SPDX-License-Identifier: MIT
#include "rank_reduction.hpp"

#include <algorithm>
#include <cstring>

#include "accumulators.hpp"
#include "call/check_call.hpp"
#include "call/check_ranges.hpp"
#include "call/check_reduction.hpp"
#include "call/check_written.hpp"
#include "call/resolved_call.hpp"
#include "call_details.hpp"
#include "native/exact_accumulator.hpp"
#include "support/convert_elements.hpp"

namespace sk::mpi {

using program::CompensatedReduction;
using program::ExactSum;
using program::Parameter;
using program::Reduction;
using program::Role;

namespace {

Variant variantOf(const ResolvedReduction& call) {
  const bool usesVariants = call.device.usesPrecisionVariants();
  Variant variant{&call.reduction, call.options, nullptr, nullptr, !usesVariants && isWide(call.options)};
  if (needsPrecisionVariant(call.options)) {
    if (usesVariants && !isWide(call.options)) variant.reduction = &halfVariant(call.reduction);
    if (usesVariants && isWide(call.options)) variant.wide = call.reduction.wide;
    if (variant.wide != nullptr) variant.reduction = &variant.wide->reduction;
    return variant;
  }
  const CompensatedReduction* const second = compensatedVariant(call);
  if (second == nullptr) return variant;
  if (foldsInDoubles(call)) {
    variant.wide = call.reduction.parts->inDoubles;
    variant.reduction = &variant.wide->reduction;
  } else if (isInDoubles(call, *second)) {
    variant.options.accumulate = Accumulate::Extended;
    variant.inDoubles = true;
  } else {
    variant.second = second;
    variant.reduction = &second->reduction;
  }
  return variant;
}

std::vector<Bytes> valuesFor(const Reduction& reduction) {
  std::vector<Bytes> values;
  for (const Parameter& parameter : reduction.fold.parameters) {
    if (parameter.role == Role::Accumulator) values.emplace_back(parameter.element->size);
  }
  return values;
}

/// A reduction to values, of which checkReduction() only needs to know that there are some.
ResolvedReduction checked(const Reduction& reduction, std::span<const Argument> arguments,
                          std::vector<Bytes>& values, const BoxedArguments& boxed) {
  std::vector<void*> targets;
  for (Bytes& value : values) targets.push_back(value.data());
  ResolvedReduction call = checkReduction(reduction, arguments, targets, {}, boxed.placed, boxed.over);
  call.values = {};
  return call;
}

int lastDivided(const domain::Decomposition& parts) {
  int last = 0;
  for (int d = 0; d < parts.split().rank(); ++d) {
    if (parts.split()[d] > 1) last = d;
  }
  return last;
}

}  // namespace

std::vector<Argument> underlying(std::span<const Argument> given) {
  std::vector<Argument> arguments(given.begin(), given.end());
  for (Argument& argument : arguments) {
    if (argument.region.stream != nullptr) argument.region.stream = &argument.region.stream->underlying();
  }
  return arguments;
}

BoxedArguments underlying(const BoxedArguments& given) {
  BoxedArguments boxed = given;
  boxed.arguments = underlying(std::span<const Argument>(given.arguments));
  if (boxed.over && boxed.over->device != nullptr) boxed.over->device = &boxed.over->device->underlying();
  return boxed;
}

RankReduction::RankReduction(DomainState& domain, const Reduction& reduction, const BoxedArguments& arguments,
                             const CallOptions& options, const Box& box)
    : domain_(domain),
      box_(box),
      hasElements_(!domain::isEmpty(domain::intersection(domain.own, box))),
      arguments_(reduction.fold, underlying(arguments.arguments)),
      values_(valuesFor(reduction)),
      call_(checked(reduction, arguments_.get(), values_, underlying(arguments))),
      dense_(reduction.fold, arguments_.get()) {
  call_.arguments = dense_.get();
  call_.options = resolvedOptions(call_, options);
}

RankReduction::~RankReduction() {
  int isOver = 0;
  MPI_Finalized(&isOver);
  if (isOver != 0) return;
  domain_.agreement.abandon(agreed_);
  complete();
}

/// Whether parts of ranks are not one after the other in the order of the elements.
bool RankReduction::isInterleaved() const {
  return lastDivided(domain_.parts) > 0 && !call_.reduction.commutative;
}

/// The parts of a rank that are consecutive elements of the whole: all of it, or lines.
Shape RankReduction::partsOf(int rank) const {
  const Box own = domain::intersection(domain_.parts.boxOf(rank), box_);
  if (domain::isEmpty(own)) return {0};
  Shape parts = domain::shapeOf(own);
  for (int d = isInterleaved() ? lastDivided(domain_.parts) : 0; d < parts.rank(); ++d)
    parts = parts.with(d, 1);
  return parts;
}

std::int64_t RankReduction::countOfParts() const {
  std::int64_t count = 0;
  for (int rank = 0; rank < domain_.parts.ranks(); ++rank) count += partsOf(rank).size();
  return count;
}

/// Whether this is the first rank that has elements: its exact sum includes the identity.
bool RankReduction::isFirst() const {
  for (int rank = 0; rank < domain_.rank; ++rank) {
    if (partsOf(rank).size() > 0) return false;
  }
  return true;
}

/// Whether every scalar of every accumulator is an exact sum, so that the plain fold is not needed.
bool RankReduction::sumsEverything() const {
  std::size_t scalars = 0;
  for (const Parameter& parameter : call_.reduction.fold.parameters) {
    if (parameter.role != Role::Accumulator) continue;
    for (const program::Field& field : parameter.element->fields) scalars += field.width;
  }
  return scalars == call_.reduction.exact.size();
}

std::byte* RankReduction::valueOf(std::size_t accumulator) {
  std::size_t number = 0;
  for (std::size_t i = 0; i < accumulator; ++i)
    number += call_.reduction.fold.parameters[i].role == Role::Accumulator ? 1 : 0;
  return values_[number].data();
}

void RankReduction::fold() {
  Variant variant = variantOf(call_);  // checks the options, too
  const bool exact = !needsPrecisionVariant(call_.options) && isExact(call_);
  if (exact) {
    variant = {&call_.reduction, call_.options};
    variant.options.accumulate = Accumulate::Tree;
  }
  if (!exact || !sumsEverything()) startStep(variant, nullptr, call_.arguments);
  if (exact) foldExactly();
  if (!steps_.empty()) layOutSteps();
  layOutPosted();
}

void RankReduction::foldExactly() {
  words_ = exactWords();
  if (!words_.empty()) return;
  for (const ExactSum& sum : call_.reduction.exact) {
    std::vector<Argument> inputs;
    for (std::size_t i = 0; i < call_.arguments.size(); ++i) {
      const Role role = call_.reduction.fold.parameters[i].role;
      if (role != Role::Accumulator && role != Role::Output) inputs.push_back(call_.arguments[i]);
    }
    startStep({&sum.reduction, call_.options}, &sum, inputs);
  }
}

ResolvedReduction RankReduction::partOf(const Step& step) const {
  ResolvedReduction part = call_.of(*step.variant.reduction, step.arguments, {});
  part.options = step.variant.options;
  return part;
}

/// Folds this rank's elements to one element for each part.
void RankReduction::startStep(const Variant& variant, const ExactSum* digits,
                              std::span<const Argument> arguments) {
  auto step = std::make_unique<Step>(Step{.variant = variant, .digits = digits, .arguments = {}, .own = {}});
  const Shape shape = isInterleaved() && hasElements_ ? partsOf(domain_.rank) : Shape{1};
  Accumulators own(call_.device, *variant.reduction, shape, variant.inDoubles);
  step->arguments = own.in(*variant.reduction, arguments);
  step->elementBytes = own.elementBytes();
  if (hasElements_) {
    ResolvedReduction part = partOf(*step);
    if (isInterleaved()) part.blocks = shape;
    call_.device.reduce(part);
    dense_.finish();
    step->own = own.read();
  }
  step->arguments.assign(arguments.begin(), arguments.end());
  step->arguments.resize(variant.reduction->fold.parameters.size());
  steps_.push_back(std::move(step));
}

/// The parts of all steps travel in one message: those of a rank lie together,
/// step after step.
void RankReduction::layOutSteps() {
  std::size_t elementBytes = 0, total = 0;
  for (const std::unique_ptr<Step>& step : steps_) {
    elementBytes += step->elementBytes;
    own_.insert(own_.end(), step->own.begin(), step->own.end());
  }
  for (int rank = 0; rank < domain_.parts.ranks(); ++rank) {
    const std::size_t bytes = static_cast<std::size_t>(partsOf(rank).size()) * elementBytes;
    if (total + bytes > mostBytes)
      fail(Error::Kind::Memory, call_.reduction.fold,
           "its operation is not known to commute, and with this split there "
           "are {} lines of elements to "
           "combine; divide "
           "the first dimension alone",
           countOfParts());
    counts_.push_back(static_cast<int>(bytes));
    offsets_.push_back(static_cast<int>(total));
    total += bytes;
  }
  all_.resize(total);
}

/// Bytes of different ranks have different places, so that adding words combines them.
void RankReduction::layOutPosted() {
  const std::size_t count = domain_.agreement.postedWords(), wordBytes = words_.size() * sizeof(std::int64_t);
  if (wordBytes + all_.size() > count * sizeof(std::int64_t)) return;
  posted_.resize(count);
  std::ranges::copy(words_, posted_.begin());
  if (own_.empty()) return;
  auto* const parts = reinterpret_cast<std::byte*>(posted_.data()) + wordBytes;
  std::ranges::copy(own_, parts + offsets_[static_cast<std::size_t>(domain_.rank)]);
}

void RankReduction::takePosted() {
  if (posted_.empty()) return;
  std::copy_n(posted_.begin(), words_.size(), words_.begin());
  const auto* const parts = reinterpret_cast<const std::byte*>(posted_.data() + words_.size());
  std::copy_n(parts, all_.size(), all_.begin());
}

/// What the ranks must have alike, lest their messages have different lengths or be laid out in other ways.
std::uint64_t RankReduction::hashOfMessages() const {
  Hash hash;
  for (const Index& corner : {box_.begin, box_.end}) {
    for (int d = 0; d < corner.rank(); ++d) hash.add(corner[d]);
  }
  hash.add(static_cast<std::int64_t>(words_.size()));
  hash.add(static_cast<std::int64_t>(all_.size()));
  return hash.value();
}

std::string RankReduction::details() const {
  return details_.empty() ? linesOf(domain_, call_.options, box_) : details_;
}

void RankReduction::post(const Call& given) {
  Agreement& agreement = domain_.agreement;
  Call call = given;
  call.details = this;
  call.add(hashOfMessages());
  const bool isTogether = !posted_.empty();
  if (isTogether) {
    agreement.start(agreed_, call);
  } else {
    agreement.agree(call, std::nullopt);
  }
  MPI_Comm communicator = agreement.communicator();
  const auto begin = [&](MPI_Request& request, auto&& operation) {
    const int status = begun(request, operation);
    ++domain_.statistics.reductions;
    if (status == MPI_SUCCESS) return;
    const Refusal error = caught("", [&] { check(status, call_.reduction.fold.name); });
    agreement.giveUp(*error);
    throw Error(*error);
  };
  const auto add = [&](MPI_Request& request, std::vector<std::int64_t>& words) {
    begin(request, [&](MPI_Request* at) {
      return MPI_Iallreduce(MPI_IN_PLACE, words.data(), static_cast<int>(words.size()), MPI_INT64_T, MPI_SUM,
                            communicator, at);
    });
  };
  if (isTogether) return add(wordsRequest_, posted_);
  if (!words_.empty()) add(wordsRequest_, words_);
  if (steps_.empty()) return;
  begin(stepsRequest_, [&](MPI_Request* request) {
    return MPI_Iallgatherv(own_.data(), static_cast<int>(own_.size()), MPI_BYTE, all_.data(), counts_.data(),
                           offsets_.data(), MPI_BYTE, communicator, request);
  });
}

/// The words of all exact sums, or nothing if the device folds them to digits.
std::vector<std::int64_t> RankReduction::exactWords() {
  std::vector<std::int64_t> all;
  for (const ExactSum& sum : call_.reduction.exact) {
    std::vector<std::int64_t> words = call_.device.exactWords(call_, sum, isFirst());
    if (words.empty()) {
      wordCounts_.clear();  // digits for all
      return {};
    }
    if (!hasElements_) std::ranges::fill(words, 0);
    wordCounts_.push_back(words.size());
    all.insert(all.end(), words.begin(), words.end());
  }
  return all;
}

bool RankReduction::isReady() {
  int isDone = domain_.agreement.isReady(agreed_) ? 1 : 0;
  if (isDone != 0) check(MPI_Test(&wordsRequest_, &isDone, MPI_STATUS_IGNORE), call_.reduction.fold.name);
  if (isDone != 0) check(MPI_Test(&stepsRequest_, &isDone, MPI_STATUS_IGNORE), call_.reduction.fold.name);
  return isDone != 0;
}

/// Ranks that refuse the call take part in these messages, too. Returns an
/// error of MPI.
int RankReduction::complete() {
  const WaitLimit& limit = domain_.agreement.waitLimit();
  const int words = limit.wait({&wordsRequest_, 1}), steps = limit.wait({&stepsRequest_, 1});
  return words != MPI_SUCCESS ? words : steps;
}

void RankReduction::wait() {
  domain_.agreement.wait(agreed_);
  const int status = complete();
  if (status == MPI_SUCCESS) return;
  domain_.agreement.act(call_.reduction.fold.name, [&] { check(status, call_.reduction.fold.name); });
}

void RankReduction::receive() {
  wait();
  domain_.agreement.finish(agreed_);
}

void RankReduction::take(std::span<void* const> results) {
  receive();
  domain_.agreement.act(call_.reduction.fold.name, [&] { finish(results); });
}

void RankReduction::finish() {
  takePosted();
  for (std::size_t k = 0; k < steps_.size(); ++k) finishStep(k);
  finishWords();
  if (checksRanges()) checkResults();
}

void RankReduction::checkResults() const {
  std::size_t k = 0;
  for (const Parameter& parameter : call_.reduction.fold.parameters) {
    if (parameter.role == Role::Accumulator)
      checkResultRange(call_.reduction.fold, parameter, values_[k++].data());
  }
}

void RankReduction::store(std::span<const StreamRegion> given) {
  std::vector<StreamRegion> results(given.begin(), given.end());
  for (StreamRegion& region : results) region.stream = &region.stream->underlying();
  storeUnderlying(results);
  for (const StreamRegion& region : given) region.stream->noteUnderlyingWritten();
  for (const StreamRegion& region : given) noteWritten(region);
}

void RankReduction::storeUnderlying(std::span<const StreamRegion> results) {
  if (!doubles_) {
    for (std::size_t k = 0; k < values_.size(); ++k) detail::write(results[k], values_[k].data(), 1);
    return;
  }
  const auto inDoubles = [&](std::size_t k) {
    return detail::reshaped(doubles_->regions[k], results[k].shape);
  };
  const program::WideReduction* const wide = steps_.front()->variant.wide;
  if (wide == nullptr) {
    for (std::size_t k = 0; k < results.size(); ++k) detail::copy(inDoubles(k), results[k]);
    return;
  }
  std::vector<Argument> arguments;
  for (std::size_t k = 0; k < results.size(); ++k) arguments.push_back({.region = inDoubles(k)});
  for (const StreamRegion& region : results) arguments.push_back({.region = region});
  // Its results are doubles for streams that hold floats, which calls of an application do not pass.
  call_.device.run(resolveCall(wide->finish, arguments, call_.device.limits, call_.options));
}

void RankReduction::finish(std::span<void* const> results) {
  finish();
  for (std::size_t k = 0; k < values_.size(); ++k)
    std::memcpy(results[k], values_[k].data(), values_[k].size());
}

/// The parts of all ranks, in the order of their elements.
Bytes RankReduction::allOf(std::size_t step) const {
  const std::size_t elementBytes = steps_[step]->elementBytes;
  std::size_t before = 0;  // bytes of a part in earlier steps
  for (std::size_t k = 0; k < step; ++k) before += steps_[k]->elementBytes;
  Bytes parts;
  for (int rank = 0; rank < domain_.parts.ranks(); ++rank) {
    const auto count = static_cast<std::size_t>(partsOf(rank).size());
    const std::byte* const from =
        all_.data() + offsets_[static_cast<std::size_t>(rank)] + static_cast<std::ptrdiff_t>(count * before);
    parts.insert(parts.end(), from, from + count * elementBytes);
  }
  return isInterleaved() ? inOrder(parts, elementBytes) : parts;
}

/// Sorts lines of elements, those of one rank after those of another, by the index of their first element.
Bytes RankReduction::inOrder(const Bytes& parts, std::size_t elementBytes) const {
  struct Line {
    Index first;
    std::size_t number;
  };
  std::vector<Line> lines;
  for (int rank = 0; rank < domain_.parts.ranks(); ++rank) {
    const Box own = domain::intersection(domain_.parts.boxOf(rank), box_);
    const Shape shape = partsOf(rank);
    for (std::int64_t k = 0; k < shape.size(); ++k) {
      Line line{own.begin, lines.size()};
      std::int64_t rest = k;
      for (int d = shape.rank() - 1; d >= 0; --d) {
        line.first[d] += rest % shape[d];
        rest /= shape[d];
      }
      lines.push_back(line);
    }
  }
  std::ranges::sort(lines, [](const Line& a, const Line& b) {
    for (int d = 0; d < a.first.rank(); ++d) {
      if (a.first[d] != b.first[d]) return a.first[d] < b.first[d];
    }
    return false;
  });
  Bytes sorted(parts.size());
  for (std::size_t k = 0; k < lines.size(); ++k)
    std::memcpy(sorted.data() + k * elementBytes, parts.data() + lines[k].number * elementBytes,
                elementBytes);
  return sorted;
}

/// Combines the parts in order: by native code, or by a reduction of their own.
void RankReduction::combine(const Step& step, const Accumulators& all, const Accumulators& result) {
  const ResolvedReduction part = partOf(step);
  if (call_.device.combine(part, all.regions, result.regions)) return;
  combineAsReduction(domain_, part, all.regions, result.regions);
}

void RankReduction::finishStep(std::size_t number) {
  const Step& step = *steps_[number];
  const Variant& variant = step.variant;
  Accumulators all(call_.device, *variant.reduction, Shape{countOfParts()}, variant.inDoubles);
  all.write(allOf(number));
  Accumulators result(call_.device, *variant.reduction, {1}, variant.inDoubles);
  combine(step, all, result);
  if (step.digits != nullptr) return finishDigits(step, result);
  std::vector<Bytes> finished;
  for (const StreamRegion& region : result.regions) {
    finished.emplace_back(region.stream->element->size);
    region.stream->read(region, finished.back().data());
  }
  std::size_t next = 0;
  std::vector<void*> values, errors;
  for (const Parameter& parameter : call_.reduction.fold.parameters) {
    if (parameter.role != Role::Accumulator) continue;
    values.push_back(values_[next].data());
    if (variant.wide != nullptr) {
      convertElements(*result.regions[next].stream->element, finished[next].data(), *parameter.element,
                      values_[next].data(), 1);
    } else {
      values_[next] = finished[next];
    }
    ++next;
  }
  if (isWide(call_.options)) doubles_.emplace(std::move(result));
  if (variant.second == nullptr) return;
  for (; next < finished.size(); ++next) errors.push_back(finished[next].data());
  addErrors(call_.reduction, *variant.second, values, errors);
}

/// Rounds a sum that was folded to digits.
void RankReduction::finishDigits(const Step& step, const Accumulators& digits) {
  const ExactSum& sum = *step.digits;
  Accumulators result(call_.device, call_.reduction, {1}, false);
  const StreamRegion target = result.in(call_.reduction, call_.arguments)[sum.accumulator].region;
  target.stream->write(target, valueOf(sum.accumulator));
  std::vector<Argument> arguments = {{.region = target}};
  for (const StreamRegion& region : digits.regions) arguments.push_back({.region = region});
  arguments.push_back({.region = target});
  sk::run(sum.finish, arguments, {.precision = Precision::Single});
  target.stream->read(target, valueOf(sum.accumulator));
}

void RankReduction::finishWords() {
  std::size_t at = 0;
  for (std::size_t k = 0; k < wordCounts_.size(); ++k) {
    const ExactSum& sum = call_.reduction.exact[k];
    const float rounded = ExactAccumulator::ofWords(std::span(words_).subspan(at, wordCounts_[k])).rounded();
    std::memcpy(valueOf(sum.accumulator) + sum.offset, &rounded, sizeof rounded);
    at += wordCounts_[k];
  }
}

}  // namespace sk::mpi
