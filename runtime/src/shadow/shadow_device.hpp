// SPDX-License-Identifier: MIT
//
// A device that owns two others: the one that runs the program, whose results are the program's, and a reference in double.
// Neither knows of it. Every call runs on both (shadow_call.hpp), and a recorder collects how far they are apart.
#pragma once

#include <algorithm>
#include <cstdint>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "device/device_state.hpp"
#include "native/native_device.hpp"
#include "native/native_stream.hpp"
#include "shadow/influences.hpp"
#include "shadow/recorder.hpp"
#include "shadow/shadow_stream.hpp"

namespace sk {

class ShadowDevice;

/// Streams on a native device that calls need for a while. Those that nobody needs are kept for the next call, as far as
/// ShadowDevice::roomForTemporaries() allows.
class TemporaryStreams {
 public:
  TemporaryStreams(NativeDevice& device, const ShadowDevice& owner) : device_(device), owner_(owner) {}

  /// A stream with undefined elements. Throws sk::Error if there is no memory.
  std::unique_ptr<NativeStream> take(const program::Element& element, const Shape& shape);
  void giveBack(std::unique_ptr<NativeStream> stream);
  /// Counts a stream among those that are taken, or no longer.
  void countTaken(std::int64_t bytes);
  /// Frees those that have not been taken for longest.
  void trim();

  std::int64_t freeBytes() const { return free_; }
  std::int64_t mostTakenBytes() const { return mostTaken_; }

 private:
  NativeDevice& device_;
  const ShadowDevice& owner_;
  std::vector<std::unique_ptr<NativeStream>> streams_;
  std::int64_t free_ = 0;  ///< bytes of streams_
  std::int64_t taken_ = 0, mostTaken_ = 0;  ///< bytes that are taken now, and the most at once
};

class ShadowDevice final : public DeviceState, public detail::Distribution {
 public:
  ShadowDevice(std::unique_ptr<DeviceState> primary, shadow::Recorder& recorder);
  ~ShadowDevice() override;

  DeviceState& primary() const { return *primary_; }
  NativeDevice& reference() const { return *reference_; }
  shadow::Recorder& recorder() const { return recorder_; }
  TemporaryStreams& temporaries() { return temporaries_; }
  /// Whether calls are compared: not in the child of a fork.
  bool isFollowing() const { return recorder_.isInOwnProcess(); }
  /// The number of this call, from 1.
  std::int64_t nextCall();
  std::int64_t nextStream() { return ++streams_; }
  /// Counts the bytes of the reference's streams. Returns false, without counting them, if they are more than allowed.
  bool takeMemory(std::int64_t bytes);
  void freeMemory(std::int64_t bytes) { memory_ -= bytes; }
  /// Whether a stream may keep another copy of its device's elements: all copies take at most as much as the reference's streams.
  bool hasRoomForCopy(std::int64_t bytes) const { return kept_ + bytes <= mostKept(); }
  /// A stream keeps one of temporaries(), gives it to a call, or frees it.
  void keep(std::int64_t bytes);
  void takeKept(std::int64_t bytes);
  void dropKept(std::int64_t bytes) noexcept { kept_ -= bytes; }
  /// The bytes that all temporaries may have that nobody needs: what copies leave, and what one call has needed at once.
  std::int64_t roomForTemporaries() const;
  /// The reference device of a kernel whose own error is measured in __float128; else the usual one.
  NativeDevice& ownReference(const program::Kernel& kernel);
  TemporaryStreams& ownTemporaries(const program::Kernel& kernel);
  /// The same rows on another device, if they are on this one.
  const RowsState* rowsOn(DeviceState& device, const RowsState* rows);
  /// Whether the kernel is among those that are compared.
  bool isChosen(const program::Kernel& kernel) const;
  /// A kernel that the reference cannot run.
  bool isGivenUp(const program::Kernel& kernel) const { return givenUp_.contains(&kernel); }
  void giveUp(const program::Kernel& kernel, const std::string& why);
  shadow::Influences& influences() { return influences_; }

  // the calls of the program
  void run(const program::Kernel& kernel, std::span<const Argument> arguments,
           const CallOptions& options) override;
  void reduce(const program::Reduction& reduction, std::span<const Argument> arguments,
              std::span<void* const> results, const CallOptions& options) override;
  void fold(const program::Reduction& reduction, std::span<const Argument> arguments,
            const CallOptions& options) override;
  void scan(const program::Reduction& reduction, std::span<const Argument> arguments,
            const CallOptions& options) override;

  // what the device that runs the program says
  DeviceState& underlying() override { return *primary_; }
  const std::string& name() const override { return primary_->name(); }
  const std::string& driver() const override { return primary_->driver(); }
  const std::string& shadingLanguage() const override { return primary_->shadingLanguage(); }
  std::string_view profileName() const override { return primary_->profileName(); }
  bool isSoftware() const override { return primary_->isSoftware(); }
  const Arithmetic& arithmetic() override { return primary_->arithmetic(); }
  std::string_view kind() const override { return primary_->kind(); }
  std::vector<DeviceTrait> traitValues() const override { return primary_->traitValues(); }
  std::vector<TargetTrial> trialTargets() override { return primary_->trialTargets(); }
  bool combinesScattered() const override { return primary_->combinesScattered(); }
  bool usesPrecisionVariants() const override { return primary_->usesPrecisionVariants(); }
  bool sumsInDoubles() const override { return primary_->sumsInDoubles(); }
  bool hasQueue() const override { return primary_->hasQueue(); }
  bool placesDomains() const override { return primary_->placesDomains(); }
  void checkProgram(const program::Kernel& kernel) override { primary_->checkProgram(kernel); }
  void checkProgram(const program::Reduction& reduction) override { primary_->checkProgram(reduction); }
  std::unique_ptr<StreamState> createStream(const program::Element& element, const Shape& shape,
                                            Storage storage) override;
  void startTrace(const std::string& file) override { primary_->startTrace(file); }
  void finish() override { primary_->finish(); }
  void release() override { primary_->release(); }
  void makeCurrent() override { primary_->makeCurrent(); }
  void checkProcess() const override { primary_->checkProcess(); }
  std::optional<std::int64_t> availableMemory() override { return primary_->availableMemory(); }
  std::unique_ptr<RecordedCall> prepareScalars(ScalarPass pass) override;
  std::optional<std::int64_t> reorder(const Reordering& order) override;
  std::unique_ptr<Staging> makeStaging(Staging::Way way) override;
  bool needsDense(const StreamRegion&) override { return false; }

  void noteLoopEnd(const StreamRegion& condition, std::int64_t iterations, bool isDone) override;

  // steps of calls, none of which comes here
  void run(const ResolvedCall& call) override;
  void reduce(const ResolvedReduction& call) override;
  bool needsDense(const program::Kernel&, std::span<const Argument>, std::size_t) override { return false; }

 private:
  std::int64_t mostKept() const { return std::min(memory_, memoryLimit_ - memory_); }

  std::unique_ptr<DeviceState> primary_;
  shadow::Recorder& recorder_;
  std::unique_ptr<NativeDevice> reference_;
  std::unique_ptr<NativeDevice> quad_;
  TemporaryStreams temporaries_;
  std::unique_ptr<TemporaryStreams> quadTemporaries_;
  shadow::Influences influences_;
  std::map<const program::Kernel*, std::string> givenUp_;
  struct RowsCopy;
  std::vector<std::unique_ptr<RowsCopy>> rows_;
  std::int64_t streams_ = 0;
  std::int64_t memory_ = 0,
               memoryLimit_ = 0;  ///< bytes of the reference's streams, and the most for these and copies
  std::int64_t kept_ = 0;  ///< bytes of the copies that streams keep
};

/// Puts a shadow around a device if SK_SHADOW asks for one and the device can have one; else returns the device itself.
std::unique_ptr<DeviceState> withShadow(std::unique_ptr<DeviceState> device);

}  // namespace sk
