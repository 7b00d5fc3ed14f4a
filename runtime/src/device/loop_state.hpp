// SPDX-License-Identifier: MIT
//
// The calls of an sk::Loop, and what its recording finds out: which streams they use, and which streams the
// application has swapped meanwhile. Knows neither what a call does nor the kind of device.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "device/loop_runner.hpp"
#include "device/stream_state.hpp"
#include "sk/call.hpp"
#include "sk/linked_file.hpp"
#include "sk/stream.hpp"

namespace sk {

class LoopState {
 public:
  /// Starts to record the calls on a device. Throws sk::Error if it is recording already.
  explicit LoopState(DeviceState& device);
  ~LoopState();
  LoopState(const LoopState&) = delete;
  LoopState& operator=(const LoopState&) = delete;

  void add(std::unique_ptr<RecordedCall> call) { calls_.push_back(std::move(call)); }
  /// Notes a stream that the recorded call uses; null is ignored.
  void use(StreamState* stream);
  /// Notes a kernel that it runs, so that the loop knows when its library has been unloaded.
  void use(const program::Kernel& kernel);

  /// Ends the recording. Streams that have been swapped return to the handles that held them before. Throws
  /// sk::Error if streams have changed places that cannot exchange their elements. Unless the recording ends here, the destructor
  /// returns all streams, also those that have been destroyed meanwhile.
  void finish();

  /// Throws sk::Error unless the calls can run now.
  void checkBeforeRun() const;
  /// Runs all calls once, and exchanges the elements of the streams that were swapped.
  void runOnce();
  /// Exchanges the elements of the streams that were swapped.
  void exchangeStreams();
  /// Runs them as the device runs loops.
  void run(std::int64_t times);
  /// Runs them until the condition, one element, is true, and returns how often.
  std::int64_t runUntil(const StreamRegion& done, const LoopEnd& end);
  /// Runs them `every` times at once until then.
  std::int64_t runAndAsk(const StreamRegion& done, std::int64_t every, std::int64_t most);
  static bool isTrue(const StreamRegion& done);

  /// Keeps a stream that its owner has destroyed, if a call uses it, or if the recording may have to return it.
  bool keep(StreamState* stream) noexcept;
  /// A handle is about to end while the device records.
  void forget(const detail::StreamOwner& handle) noexcept;

  /// The device is about to end, or has ended.
  void leave() noexcept {
    runner_.reset();
    device_ = nullptr;
  }
  DeviceState& device() const { return *device_; }

  struct Used {
    StreamState* stream;
    Shape shape;
  };
  std::span<const Used> used() const { return used_; }
  std::span<const std::unique_ptr<RecordedCall>> calls() const { return calls_; }
  /// The streams that exchange their elements after an iteration, in order.
  std::span<const std::pair<StreamState*, StreamState*>> exchanges() const { return exchanges_; }
  /// What Loop::plan() says.
  std::string plan();
  /// Whether a recorded call uses the stream.
  bool uses(const StreamState* stream) const;

 private:
  /// A stream, and the handle that held it when recording began.
  struct Held {
    StreamState* stream;
    detail::StreamOwner* handle;  ///< null once it has ended
  };
  void failIfLost() const;
  bool isRecording() const;
  void endRecording() noexcept;
  void giveUp() noexcept;
  void dropScalars() noexcept;
  void returnStreams() noexcept;
  void returnDestroyed() noexcept;
  void deleteUnused() noexcept;
  bool isHeld(const StreamState* stream) const;
  void findExchanges();

  DeviceState* device_;  ///< null after the device has ended
  std::vector<Held> held_;  ///< all streams of the device, while it records
  std::vector<std::unique_ptr<RecordedCall>> calls_;
  std::vector<Used> used_;
  std::vector<std::uint64_t> objects_;  ///< that have the kernels (LinkedFile::objectOf())
  const std::uint64_t unloads_ = program::LinkedFile::unloads();
  std::vector<std::pair<StreamState*, StreamState*>> exchanges_;  ///< carried out in order
  std::vector<StreamState*> kept_;  ///< streams that it owns
  std::unique_ptr<LoopRunner> runner_;  ///< null: calls run one after the other
};

/// Throws sk::Error if the device records calls: `what` needs a result that only a call that runs has.
void refuseInRecording(const DeviceState& device, std::string_view what);

/// Copies of a call's arguments, with their values.
class OwnedArguments {
 public:
  OwnedArguments(const program::Kernel& kernel, std::span<const Argument> arguments);
  std::span<const Argument> get() const { return arguments_; }
  void noteUses(LoopState& loop) const {
    loop.use(*kernel_);
    for (const Argument& argument : arguments_) loop.use(argument.region.stream);
  }
  /// RecordedCall::addUses()
  void addUses(std::vector<StreamUse>& uses) const;

 private:
  const program::Kernel* kernel_;
  std::vector<Argument> arguments_;
  std::vector<std::unique_ptr<std::byte[]>> values_;
};

}  // namespace sk
