// SPDX-License-Identifier: MIT
//
// The interface of every kind of device, GL (gl_device/gl_device.hpp) or native (native/native_device.hpp): it creates
// streams and runs kernels on them, brings elements into a new order, and may have host memory that its own programs reach.
// All arguments have been checked before.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "device/configuration.hpp"
#include "device/function_table.hpp"
#include "device/loop_runner.hpp"
#include "device/scalar_pass.hpp"
#include "device/stream_state.hpp"
#include "sk/call.hpp"
#include "sk/device.hpp"
#include "sk/program.hpp"
#include "sk/stream.hpp"
#include "trace/trace.hpp"

namespace sk {

namespace results {
class Recorder;
}

/// A stable new order of a stream's elements, which a device may carry out itself (DeviceState::reorder).
struct Reordering {
  enum class By : std::uint8_t {
    Keys,  ///< sorted by keys
    DescendingKeys,
    Changes,  ///< keys that differ from the one before come first (sk::unique)
    Flags,  ///< elements whose flag is true, or not 0, come first
  };

  By by;
  StreamRegion keys;  ///< or flags; at least one
  std::span<const StreamRegion> moved = {};  ///< of the same shape, in different streams; may include `keys`
  const StreamRegion* places = nullptr;  ///< gets the number that each element had, of type int; or null

  bool choosesFirst() const { return by == By::Changes || by == By::Flags; }
};

/// Host memory that a device's own programs reach: they copy boxes of streams there and back, without the driver between
/// them. In memory, a box has a word of 32 bits for each component as it is stored, in the order of
/// assemble/transfer/staging_program.hpp.
class Staging {
 public:
  /// Who writes the memory, and who reads it.
  enum class Way : bool { ToHost, ToDevice };

  virtual ~Staging() = default;
  Staging() = default;
  Staging(const Staging&) = delete;
  Staging& operator=(const Staging&) = delete;

  /// The bytes of a box.
  virtual std::size_t bytesOf(const StreamRegion& box) const = 0;
  /// Makes room for `bytes` undefined bytes, once the device has finished with those before. Throws sk::Error if memory is
  /// exhausted. Pointers into the memory are valid until the next call.
  virtual std::byte* room(std::size_t bytes) = 0;
  /// Adds the copy of a box, which is not empty, to the memory or from it, at a multiple of 4 bytes. Streams must stay until
  /// flush().
  virtual void copy(const StreamRegion& box, std::size_t offset) = 0;
  /// Begins to carry out all copies, those of one stream together.
  virtual void flush() = 0;
  /// Waits until the copies have been carried out. Throws sk::Error if the device is lost or has failed.
  virtual void wait() = 0;
};

class LoopState;
struct ResolvedCall;
struct ResolvedReduction;
struct Reordering;

/// Exact sums, one per element of the results. They are stored only after all are known: a result may be an
/// input.
class RoundedSums {
 public:
  RoundedSums() = default;
  virtual ~RoundedSums() = default;
  RoundedSums(const RoundedSums&) = delete;
  RoundedSums& operator=(const RoundedSums&) = delete;

  /// Stores them to the scalar that is `offset` bytes from the start of each element of a region in host
  /// memory.
  virtual void store(const StreamRegion& results, std::size_t offset) const = 0;
};

class DeviceState {
 public:
  virtual ~DeviceState();  // device/loop_state.cpp
  DeviceState(const DeviceState&) = delete;
  DeviceState& operator=(const DeviceState&) = delete;

  /// The device that runs the calls: another one if this device stands in front of it (shadow/shadow_device.hpp).
  virtual DeviceState& underlying() { return *this; }
  virtual const std::string& name() const = 0;
  virtual const std::string& driver() const = 0;
  virtual const std::string& shadingLanguage() const = 0;
  virtual std::string_view profileName() const = 0;
  virtual bool isSoftware() const = 0;
  /// Tests the device's arithmetic on first use.
  virtual const Arithmetic& arithmetic() = 0;
  /// The trials of all classes of kernels; empty if the device has only one kind of program.
  virtual std::string_view kind() const { return "native"; }
  virtual std::vector<DeviceTrait> traitValues() const { return {}; }
  virtual std::vector<TargetTrial> trialTargets() { return {}; }
  /// Whether scatter outputs may combine a new value with the stored one.
  virtual bool combinesScattered() const = 0;
  /// Whether other precisions than float need variants of a kernel: native code computes in any real type.
  virtual bool usesPrecisionVariants() const = 0;
  /// Whether summing in doubles is cheaper than compensated sums of floats.
  virtual bool sumsInDoubles() const { return false; }
  /// Whether calls return before they have run, so that to read a result means to wait.
  virtual bool hasQueue() const = 0;
  /// Whether the domain of a call with placed streams (sk/placed.hpp) is a region of its outputs (ResolvedCall::place)
  /// rather than the whole.
  virtual bool placesDomains() const { return false; }
  /// Whether it computes in double wherever kernels say float.
  virtual bool isReference() const { return false; }
  /// Throws sk::Error if this device has no program for the kernel.
  virtual void checkProgram(const program::Kernel& kernel) = 0;
  virtual void checkProgram(const program::Reduction& reduction) = 0;

  /// Throws sk::Error if memory is exhausted. A storage other than Single requires elements with floats.
  virtual std::unique_ptr<StreamState> createStream(const program::Element& element, const Shape& shape,
                                                    Storage storage) = 0;
  /// Traces all later work. Throws sk::Error if the file cannot be written.
  virtual void startTrace(const std::string& file) = 0;
  virtual void finish() = 0;
  /// Measures the work that is queued from now on by the device's own clock. False if it has none, as on devices in software.
  virtual bool beginMeasuring() { return false; }
  /// Waits for the work since beginMeasuring(), and returns the nanoseconds that it took.
  virtual std::int64_t endMeasuring() { return 0; }
  virtual void release() = 0;
  virtual void makeCurrent() = 0;
  /// Throws sk::Error in the child of a fork if the device works in the parent alone. Operations that are only collected
  /// ask this, so that they do not fail later.
  virtual void checkProcess() const {}

  /// The domain may be empty only if there are variable outputs: they become empty.
  virtual void run(const ResolvedCall& call) = 0;
  /// The same call, prepared to run many times; null if that saves nothing. `call` must outlive it. The streams keep
  /// their shapes, but not the memory of their elements.
  virtual std::unique_ptr<RecordedCall> prepare(const ResolvedCall&) { return nullptr; }
  /// Operations with scalars, prepared to run any number of times.
  virtual std::unique_ptr<RecordedCall> prepareScalars(ScalarPass pass) = 0;
  /// Null if loops need no more than their calls one after the other.
  virtual std::unique_ptr<LoopRunner> makeLoopRunner() { return nullptr; }
  /// Runs recorded calls once, in any way that has the effect of one after the other, but for the elements of `locals`: streams that
  /// nothing else uses. Returns false, without any effect, if that saves nothing.
  virtual bool runTogether(LoopState& /*calls*/, std::span<StreamState* const> /*locals*/) { return false; }
  /// Whether runTogether() can pay for streams of this size: recording a call takes longer than checking it.
  virtual bool mayRunTogether(std::int64_t /*elements*/) const { return false; }
  /// Whether argument `i` of a checked call, a region with strides, needs a temporary stream in its place
  /// (call/placed.hpp).
  virtual bool needsDense(const program::Kernel& kernel, std::span<const Argument> arguments,
                          std::size_t i) = 0;
  /// Likewise for transfers between a region and host memory.
  virtual bool needsDense(const StreamRegion& region) = 0;
  /// There is at least one block. For an empty domain, the results are the identities, which then exist.
  virtual void reduce(const ResolvedReduction& call) = 0;
  /// Deletes what is kept of a reduction that is about to end. Those of files that are unloaded need no call (UnloadWatch).
  virtual void forget(const program::Reduction&) {}
  /// Combines the results of consecutive parts of a domain: element k of `parts`, which have one region for each accumulator,
  /// belongs to part k. Stores them to the one element of `results`. The streams hold floats in the precision of the call.
  /// Returns false, without any effect, if the parts must be folded as a reduction of their own.
  virtual bool combine(const ResolvedReduction&, std::span<const StreamRegion> /*parts*/,
                       std::span<const StreamRegion> /*results*/) {
    return false;
  }
  /// Whether reduce() also writes the outputs of a fold that has some, which are given then.
  virtual bool foldsBesideOutputs(const ResolvedReduction&) { return false; }
  /// Whether it adds sums of floats without rounding; otherwise it compensates them in its own precision.
  virtual bool sumsExactly(const ResolvedReduction&) const { return true; }
  /// The rounded sums of all blocks if the device computes them itself; null if the sum must be folded to
  /// digits.
  virtual std::unique_ptr<RoundedSums> sumExactly(const ResolvedReduction&, const program::ExactSum&) {
    return nullptr;
  }
  /// An exact sum of floats over the whole domain, which is not empty, before it is rounded: words that are added up over
  /// several devices (native/exact_accumulator.hpp), of which one includes the identity, `isFirst`. Empty if the sum must be
  /// folded to digits.
  virtual std::vector<std::int64_t> exactWords(const ResolvedReduction&, const program::ExactSum&,
                                               bool /*isFirst*/) {
    return {};
  }

  /// Reorders streams and returns the number of elements that come first, if it chooses them; nullopt, without any
  /// effect, if the host is faster. Throws sk::Error if memory is exhausted; nothing has moved then.
  virtual std::optional<std::int64_t> reorder(const Reordering&) { return std::nullopt; }

  /// Is told when a loop that runs call by call ends. `isDone`: its condition ended it, and not its limit.
  virtual void noteLoopEnd(const StreamRegion& /*condition*/, std::int64_t /*iterations*/, bool /*isDone*/) {}

  /// Staging memory, which must not outlive the device; null if its elements are in host memory, or if programs of its own
  /// do not reach any. All streams may be staged.
  virtual std::unique_ptr<Staging> makeStaging(Staging::Way) { return nullptr; }

  /// Bytes of memory for streams that are free now; nullopt if nobody tells.
  virtual std::optional<std::int64_t> availableMemory() = 0;

  /// Makes the calls with this device's streams in place of the runtime; or null.
  detail::Distribution* interposed = nullptr;
  DeviceLimits limits;
  std::int64_t memoryLimit = 0;  ///< the most bytes of memory that it reports; 0: all
  Configuration configuration;
  FunctionTables tables;
  std::optional<PassCount> passCount;  ///< empty unless counting is on
  std::unique_ptr<Trace> trace;  ///< null unless SK_TRACE names a file
  bool runsCallByCall =
      false;  ///< loops need no LoopRunner: SK_CHECK=written or ranges checks, or SK_RESULTS measures, each of their calls
  results::Recorder* results = nullptr;  ///< null unless SK_RESULTS names a file
  int internalWork = 0;  ///< above 0: calls and reads are the runtime's own (results/call_scope.hpp)
  bool isChecking =
      false;  ///< a call runs that SK_CHECK=written, asserts or ranges checks; its steps are not checked
  LoopState* recording = nullptr;  ///< records calls instead of running them; or null
  std::vector<LoopState*> loops;  ///< that use the device's streams
  PendingScalars pendingScalars;
  std::vector<detail::StreamOwner>
      keptLocals;  ///< of the last pipeline, for the next one; empty on devices that keep memory themselves

  StreamState* firstStream() const { return firstStream_; }

 protected:
  DeviceState() = default;

 private:
  friend class StreamState;

  StreamState* firstStream_ = nullptr;  ///< list of the streams to notify when the device ends
};

/// While it lives, calls on the device are steps of one that is checked, and are not checked themselves.
class UncheckedSteps {
 public:
  explicit UncheckedSteps(DeviceState& device) : device_(device), before_(device.isChecking) {
    device.isChecking = true;
  }
  ~UncheckedSteps() { device_.isChecking = before_; }
  UncheckedSteps(const UncheckedSteps&) = delete;
  UncheckedSteps& operator=(const UncheckedSteps&) = delete;

 private:
  DeviceState& device_;
  const bool before_;
};

/// Leaves the passes of trials out of the user's count.
class UncountedPasses {
 public:
  explicit UncountedPasses(std::optional<PassCount>& count) : count_(count), before_(count) {}
  ~UncountedPasses() { count_ = before_; }
  UncountedPasses(const UncountedPasses&) = delete;
  UncountedPasses& operator=(const UncountedPasses&) = delete;

 private:
  std::optional<PassCount>& count_;
  const std::optional<PassCount> before_;
};

}  // namespace sk
