// SPDX-License-Identifier: MIT
#include "device/loop_state.hpp"

#include <algorithm>
#include <cstring>
#include <new>
#include <unordered_map>
#include <utility>

#include <fmt/format.h>

#include "call/resolved_call.hpp"
#include "device/device_state.hpp"
#include "device/internal_work.hpp"
#include "sk/error.hpp"

namespace sk {

DeviceState::~DeviceState() {
  for (LoopState* loop : loops) loop->leave();
  for (const std::shared_ptr<ScalarNode>& node : pendingScalars.nodes) node->device = nullptr;
}

void detail::StreamDeleter::operator()(StreamState* state) const noexcept {
  state->holder = nullptr;
  if (state->device != nullptr) {
    if (state->device->recording != nullptr && state->device->recording->keep(state)) return;
    for (LoopState* loop : state->device->loops) {
      if (loop->keep(state)) return;
    }
  }
  delete state;
}

void detail::StreamDeleter::moved(StreamState* state, Owner<StreamState, StreamDeleter>* holder) noexcept {
  state->holder = static_cast<StreamOwner*>(holder);
}

void detail::StreamOwner::leaveRecording() noexcept { recording_->forget(*this); }

LoopState::LoopState(DeviceState& device) : device_(&device) {
  refuseInRecording(device, "record");
  for (StreamState* stream = device.firstStream(); stream != nullptr; stream = stream->next()) {
    detail::StreamOwner* const handle = stream->holder;
    if (handle != nullptr && handle->recording_ == nullptr) held_.push_back({stream, handle});
  }
  kept_.reserve(held_.size());  // so that keep() never allocates
  device.loops.push_back(this);
  for (const Held& held : held_) held.handle->recording_ = this;
  device.recording = this;
}

LoopState::~LoopState() {
  if (isRecording()) giveUp();
  endRecording();
  runner_.reset();  // before the streams whose elements it may hold
  if (device_ != nullptr) std::erase(device_->loops, this);
  for (StreamState* stream : kept_) detail::StreamDeleter()(stream);  // another loop may use it
}

bool LoopState::isRecording() const { return device_ != nullptr && device_->recording == this; }

void LoopState::endRecording() noexcept {
  if (isRecording()) device_->recording = nullptr;
  for (const Held& held : held_) {
    if (held.handle != nullptr) held.handle->recording_ = nullptr;
  }
  held_.clear();
}

bool LoopState::isHeld(const StreamState* stream) const {
  return std::ranges::any_of(held_, [&](const Held& held) { return held.stream == stream; });
}

bool LoopState::uses(const StreamState* stream) const {
  return std::ranges::any_of(used_, [&](const Used& used) { return used.stream == stream; });
}

void LoopState::use(StreamState* stream) {
  if (stream == nullptr || uses(stream)) return;
  kept_.reserve(kept_.size() + used_.size() + held_.size() + 1);  // so that keep() never allocates
  used_.push_back({stream, stream->shape});
}

void LoopState::use(const program::Kernel& kernel) {
  const std::uint64_t object = program::LinkedFile::objectOf(&kernel);
  if (object != 0 && std::ranges::find(objects_, object) == objects_.end()) objects_.push_back(object);
}

bool LoopState::keep(StreamState* stream) noexcept {
  if (!uses(stream) && !isHeld(stream)) return false;
  kept_.push_back(stream);
  return true;
}

void LoopState::forget(const detail::StreamOwner& handle) noexcept {
  for (Held& held : held_) {
    if (held.handle == &handle) held.handle = nullptr;
  }
}

/// Drops the operations with scalars of a recording that is given up: scalars that they assign to keep their values, and
/// those that they make have none.
void LoopState::dropScalars() noexcept {
  const PendingScalars dropped = std::exchange(device_->pendingScalars, {});
  for (const std::shared_ptr<ScalarNode>& node : dropped.nodes) {
    if (node->state != ScalarNode::State::Pending) continue;
    node->state = node->target != nullptr ? ScalarNode::State::Done : ScalarNode::State::Lost;
  }
}

/// Ends a recording without a loop: everything is as before it, except what it has computed for streams that it has created.
void LoopState::giveUp() noexcept {
  dropScalars();
  returnStreams();
  returnDestroyed();
  for (const Used& used : used_) {
    if (!isHeld(used.stream)) used.stream->markLost();
  }
}

/// Returns the streams that have other handles now. Handles exchange what they hold, so that none of it is lost.
void LoopState::returnStreams() noexcept {
  for (const Held& held : held_) {
    detail::StreamOwner* const now = held.stream->holder;
    if (held.handle != nullptr && now != nullptr && now != held.handle) std::swap(*held.handle, *now);
  }
}

/// Returns the streams that have been destroyed. A handle with a stream of another device keeps that one.
void LoopState::returnDestroyed() noexcept {
  for (const Held& held : held_) {
    if (held.handle == nullptr || held.stream->holder != nullptr) continue;
    if (*held.handle && held.handle->get()->device != device_) continue;
    if (std::erase(kept_, held.stream) > 0) *held.handle = detail::StreamOwner(held.stream);
  }
}

/// Deletes the streams that were destroyed during the recording, if no call of the loop uses them.
void LoopState::deleteUnused() noexcept {
  const auto unused = [&](const StreamState* stream) { return !uses(stream); };
  for (auto found = std::ranges::find_if(kept_, unused); found != kept_.end();
       found = std::ranges::find_if(kept_, unused)) {
    StreamState* const stream = *found;
    kept_.erase(found);
    detail::StreamDeleter()(stream);  // another loop may use it
  }
}

void LoopState::finish() {
  failIfLost();
  flushScalars(*device_);
  findExchanges();
  std::unique_ptr<LoopRunner> runner = device_->runsCallByCall ? nullptr : device_->makeLoopRunner();
  returnStreams();
  runner_ = std::move(runner);
  endRecording();
  deleteUnused();
}

/// Writes a permutation as exchanges of two: for the cycle s0, s1, s2, where the handle of s0 now holds s1, first
/// s0 and s1, then s1 and s2.
void LoopState::findExchanges() {
  std::unordered_map<StreamState*, StreamState*> next;  // what each handle held, and what it holds now
  bool leavesEmpty = false;
  for (const auto& [stream, handle] : held_) {
    if (handle == nullptr || handle->get() == stream) continue;
    if (*handle) {
      next.emplace(stream, handle->get());
    } else if (stream->holder != nullptr) {
      leavesEmpty = true;
    }
  }
  if (next.empty() && leavesEmpty) {
    throw Error(
        "record: a stream was moved to another handle, which leaves its own empty; only swaps of streams "
        "that existed "
        "before, as by std::swap(u, v), can be repeated",
        Error::Kind::Misuse);
  }
  for (const auto& [before, after] : next) {
    if (leavesEmpty || before->holder == nullptr || !next.contains(after)) {
      throw Error(
          "record: another stream was assigned to a stream; only swaps of streams that existed before, as by "
          "std::swap(u, v), can be repeated",
          Error::Kind::Misuse);
    }
    if (before->shape != after->shape || before->element != after->element ||
        before->storage != after->storage) {
      throw Error(
          fmt::format("record: streams of shapes {} and {}, or of other storage, were swapped; a loop "
                      "exchanges elements only of streams that are made alike",
                      toString(before->shape), toString(after->shape)),
          Error::Kind::Shape);
    }
    use(before);
  }
  while (!next.empty()) {
    StreamState* at = next.begin()->first;
    for (auto found = next.find(at); found != next.end(); found = next.find(at)) {
      StreamState* const after = found->second;
      next.erase(found);
      if (next.contains(after)) exchanges_.emplace_back(at, after);
      at = after;
    }
  }
}

void LoopState::failIfLost() const {
  if (device_ != nullptr) return;
  throw Error("a loop: its device has been destroyed; keep the device for as long as its loops are used",
              Error::Kind::Lost);
}

void LoopState::checkBeforeRun() const {
  failIfLost();
  refuseInRecording(*device_, "a loop");
  if (program::LinkedFile::unloads() != unloads_ &&
      !std::ranges::all_of(objects_, program::LinkedFile::isLoaded)) {
    throw Error(
        "a loop: a library with kernels that it runs has been unloaded; keep the library loaded for as long "
        "as "
        "the loop is used, or record the calls again",
        Error::Kind::Lost);
  }
  for (const Used& used : used_) {
    used.stream->settle();
    if (used.stream->shape != used.shape) {
      throw Error(
          fmt::format("a loop: a stream of shape {} has shape {} now, since a kernel has pushed to it; "
                      "record the calls again",
                      toString(used.shape), toString(used.stream->shape)),
          Error::Kind::Shape);
    }
    checkNotLost({used.stream, {}, {}}, false, "a loop");
  }
}

void LoopState::runOnce() {
  for (const std::unique_ptr<RecordedCall>& call : calls_) call->run();
  exchangeStreams();
}

void LoopState::exchangeStreams() {
  for (const auto& [a, b] : exchanges_) a->exchangeElements(*b);
}

void LoopState::run(std::int64_t times) {
  if (runner_) return runner_->run(*this, times);
  for (std::int64_t i = 0; i < times; ++i) runOnce();
}

std::int64_t LoopState::runUntil(const StreamRegion& done, const LoopEnd& end) {
  if (runner_) return runner_->runUntil(*this, done, end);
  return runAndAsk(done, device_->hasQueue() && !device_->runsCallByCall ? end.every : 1, end.most);
}

std::int64_t LoopState::runAndAsk(const StreamRegion& done, std::int64_t every, std::int64_t most) {
  std::int64_t ran = 0;
  bool isDone = false;
  while (!isDone && ran < most) {
    const std::int64_t times = std::min(every, most - ran);
    run(times);
    ran += times;
    isDone = isTrue(done);
  }
  device_->noteLoopEnd(done, ran, isDone);
  return ran;
}

std::string LoopState::plan() {
  if (runner_) return runner_->plan(*this);
  return fmt::format("{} calls run one after the other\n", calls_.size());
}

bool LoopState::isTrue(const StreamRegion& done) {
  checkElementsOf(done, false, "until");
  const InternalWork work(*done.stream->device);
  bool isDone = false;
  done.stream->read(done, reinterpret_cast<std::byte*>(&isDone));
  return isDone;
}

void refuseInRecording(const DeviceState& device, std::string_view what) {
  if (device.recording == nullptr) return;
  throw Error(fmt::format("{}: the device is recording calls, none of which has run yet; do this before "
                          "Device::record, or after Loop::repeat",
                          what),
              Error::Kind::Misuse);
}

OwnedArguments::OwnedArguments(const program::Kernel& kernel, std::span<const Argument> arguments)
    : kernel_(&kernel), arguments_(arguments.begin(), arguments.end()) {
  for (std::size_t i = 0; i < arguments_.size(); ++i) {
    if (arguments_[i].value == nullptr) continue;
    const program::Parameter& parameter = kernel.parameters[i];
    const std::size_t ends = parameter.role == program::Role::Iterator ? 2 : 1;
    const std::size_t bytes = ends * parameter.element->size;
    values_.push_back(std::make_unique<std::byte[]>(bytes));
    std::memcpy(values_.back().get(), arguments_[i].value, bytes);
    arguments_[i].value = values_.back().get();
  }
}

void OwnedArguments::addUses(std::vector<StreamUse>& uses) const {
  for (std::size_t i = 0; i < arguments_.size(); ++i) {
    StreamState* const stream = arguments_[i].region.stream;
    if (stream == nullptr) continue;
    const program::Role role = kernel_->parameters[i].role;
    uses.push_back({stream, isWritten(role)});
    if (role == program::Role::Scatter) uses.push_back({stream, false});  // what it does not store to stays
  }
}

}  // namespace sk
