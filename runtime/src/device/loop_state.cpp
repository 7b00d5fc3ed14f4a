// SPDX-License-Identifier: MIT
#include "device/loop_state.hpp"

#include <algorithm>
#include <cstring>
#include <new>
#include <unordered_map>
#include <utility>

#include <fmt/format.h>

#include "device/device_state.hpp"
#include "sk/error.hpp"

namespace sk {

DeviceState::~DeviceState() {
  for (LoopState* loop : loops) loop->leave();
  for (const std::shared_ptr<ScalarNode>& node : pendingScalars.nodes) node->device = nullptr;
}

void detail::StreamDeleter::operator()(StreamState* state) const noexcept {
  state->holder = nullptr;
  if (state->device != nullptr) {
    for (LoopState* loop : state->device->loops) {
      if (loop->keep(state)) return;
    }
  }
  delete state;
}

void detail::StreamDeleter::moved(StreamState* state, StreamOwner* holder) noexcept {
  state->holder = holder;
}

LoopState::LoopState(DeviceState& device) : device_(&device) {
  refuseInRecording(device, "record");
  for (StreamState* stream = device.firstStream(); stream != nullptr; stream = stream->next()) {
    if (stream->holder != nullptr) held_.push_back({stream, stream->holder});
  }
  device.loops.push_back(this);
  device.recording = this;
}

LoopState::~LoopState() {
  if (isRecording()) {
    dropScalars();
    undoSwaps();
  }
  endRecording();
  runner_.reset();  // before the streams whose elements it may hold
  if (device_ != nullptr) std::erase(device_->loops, this);
  for (StreamState* stream : kept_) detail::StreamDeleter()(stream);  // another loop may use it
}

bool LoopState::isRecording() const { return device_ != nullptr && device_->recording == this; }

void LoopState::endRecording() noexcept {
  if (isRecording()) device_->recording = nullptr;
  held_.clear();
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
  if (uses(stream)) {
    kept_.push_back(stream);
    return true;
  }
  for (Held& held : held_) {
    if (held.stream == stream) held.stream = nullptr;
  }
  return false;
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

LoopState::Moves LoopState::moves() const {
  std::unordered_map<const detail::StreamOwner*, StreamState*> now;
  for (StreamState* stream = device_->firstStream(); stream != nullptr; stream = stream->next()) {
    if (stream->holder != nullptr) now.emplace(stream->holder, stream);
  }
  Moves moved;
  for (const Held& before : held_) {
    const auto found = now.find(before.holder);
    if (found != now.end() && found->second != before.stream)
      moved.emplace_back(before.stream, found->second);
  }
  return moved;
}

void LoopState::undo(const Moves& moved) {
  std::vector<std::pair<detail::StreamOwner*, StreamState*>> holders;
  for (const auto& [before, after] : moved) holders.emplace_back(after->holder, before);
  for (const auto& [holder, before] : holders) static_cast<void>(holder->release());
  for (const auto& [holder, before] : holders) *holder = detail::StreamOwner(before);
}

/// Gives handles back what they held before a recording that is given up. Where its body has put other streams in them, or deleted
/// streams, they keep what they hold.
void LoopState::undoSwaps() noexcept try {
  const Moves moved = moves();
  std::vector<StreamState*> before, after;
  for (const auto& [from, to] : moved) {
    before.push_back(from);
    after.push_back(to);
  }
  if (std::ranges::is_permutation(before, after)) undo(moved);
} catch (const std::bad_alloc&) {  // the handles keep what they hold
}

void LoopState::finish() {
  failIfLost();
  flushScalars(*device_);
  const Moves moved = moves();
  findExchanges(moved);
  undo(moved);
  runner_ = device_->makeLoopRunner();
  endRecording();
}

/// Writes a permutation as exchanges of two: for the cycle s0, s1, s2, where the handle of s0 now holds s1, first
/// s0 and s1, then s1 and s2.
void LoopState::findExchanges(std::span<const std::pair<StreamState*, StreamState*>> moved) {
  std::unordered_map<StreamState*, StreamState*> next(moved.begin(), moved.end());
  for (const auto& [before, after] : moved) {
    if (before == nullptr || !next.contains(after)) {
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
    checkElementsOf({used.stream, {}, {}}, false, "a loop");
  }
}

void LoopState::runOnce() {
  for (const std::unique_ptr<RecordedCall>& call : calls_) call->run();
  for (const auto& [a, b] : exchanges_) a->exchangeElements(*b);
}

void LoopState::run(std::int64_t times) {
  if (runner_) return runner_->run(*this, times);
  for (std::int64_t i = 0; i < times; ++i) runOnce();
}

std::int64_t LoopState::runUntil(const StreamRegion& done, const LoopEnd& end) {
  if (runner_) return runner_->runUntil(*this, done, end);
  return runAndAsk(done, device_->hasQueue() ? end.every : 1, end.most);
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
  return ran;
}

bool LoopState::isTrue(const StreamRegion& done) {
  checkElementsOf(done, false, "until");
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

}  // namespace sk
