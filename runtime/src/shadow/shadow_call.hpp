// SPDX-License-Identifier: MIT
//
// A call of the program on a shadowed device. It runs three times: on the device, as ever; on the reference with the device's own
// inputs, which shows the error that the call adds; and on the reference with the reference's inputs, which shows what has
// reached its outputs in all. If these inputs are the same, the reference runs it once.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "device/loop_runner.hpp"
#include "native/native_stream.hpp"
#include "shadow/errors.hpp"
#include "shadow/shadow_device.hpp"
#include "shadow/shadow_stream.hpp"
#include "sk/call.hpp"

namespace sk {

/// A call as the program made it.
struct ShadowedCall {
  enum class Kind : std::uint8_t { Kernel, Reduce, Fold, Scan } kind;
  const program::Kernel& kernel;  ///< has the parameters of the arguments
  const program::Reduction* reduction;  ///< null for Kernel
  std::span<const Argument> arguments;
  std::span<void* const> results;  ///< of a reduction to values; else empty
  CallOptions options;

  /// Makes the same call with other arguments, which may be on another device.
  void run(std::span<const Argument> others, std::span<void* const> values, const CallOptions& with) const;
};

/// Runs a call on a shadowed device and its reference, and records their difference. Throws what the call on the device throws.
class CallFollower {
 public:
  CallFollower(ShadowDevice& device, const ShadowedCall& call);
  ~CallFollower();
  CallFollower(const CallFollower&) = delete;
  CallFollower& operator=(const CallFollower&) = delete;

  void run();

 private:
  struct Written {
    std::size_t argument;
    ShadowStream* stream;  ///< null: a value
    bool isPart;  ///< other elements of the region keep their values
    bool isSame = false;  ///< the device's new elements are those of the reference, bit by bit
    std::unique_ptr<NativeStream> own = {}, total = {},
                                  device = {};  ///< temporaries; `total` of values alone
    std::unique_ptr<NativeStream> before =
        {};  ///< the stream's copy of the device's old elements; may be null
    std::optional<std::int64_t> pushed = {};  ///< how many elements the reference has pushed
  };
  struct Read {
    std::size_t argument;
    ShadowStream* stream;
    StreamErrors errors;  ///< before the call
    StreamRegion device =
        {};  ///< the device's elements on the reference; without a stream if the call is not measured
    std::unique_ptr<NativeStream> copy =
        {};  ///< the temporary that `device` is in; null if it is in a copy that the stream keeps
  };

  bool isWritten(std::size_t argument) const;
  bool prepare();
  void prepareOwn();
  void prepareRead(Read& read);
  void prepareWritten(Written& written);
  void runOnDevice();
  bool runOnReference();
  void runOwn();
  /// Finds out how much each input counts in each output. After runOwn(), before the reference replaces its inputs.
  void examineInfluences();
  void examineInfluence(const Read& read);
  std::vector<Argument> ownArguments() const;
  void compareAll();
  void keepElements();
  void keepInputs();
  void compareOutput(Written& written);
  void estimateAll();
  /// Puts a value that the call has returned into `written.device`.
  void takeValue(Written& written);
  /// Whether the device has pushed another number of elements, which is a decision then. The reference takes the device's over.
  bool recordPushed(Written& written, bool hasOwn);
  void recordOrigins();
  /// What the reference computes with the device's inputs; null if that is not known, or if the device's results have replaced it.
  const NativeStream* ownOf(const Written& written) const;
  struct Stored {
    double squares;  ///< the sum of those of what rounding changes
    std::string where;  ///< "'v' in halves"
    std::string better;  ///< what would hold all digits: "floats"
  };
  std::optional<Stored> storedOf(const Written& written, const NativeStream& own) const;
  void recordStored(const shadow::OutputErrors& errors, const std::optional<Stored>& stored);
  void recordErrors(const Written& written, const shadow::OutputErrors& errors, bool hasOwn);
  shadow::ElementRecord elementOf(const Written& written, std::int64_t element, int component,
                                  double own) const;
  void addInputs(const Written& written, std::int64_t element, shadow::ElementRecord& record) const;
  std::string sourceText(const Written& written) const;
  void recordExceptions(const Written& written, const shadow::OutputErrors& errors, int kernel,
                        shadow::Report& report);
  void recordDecisions(const Written& written, const shadow::OutputErrors& errors, int kernel,
                       shadow::Report& report);
  bool areRead(shadow::ExceptionRecord::Kind kind) const;
  bool turns(const Written& written) const;
  std::vector<double> weightsOf(const Written& written) const;
  void recordCompensation(const shadow::OutputErrors& errors, shadow::Report& report) const;
  void recordValue(const Written& written, const shadow::OutputErrors& errors, const StreamErrors& after,
                   shadow::Report& report) const;
  StreamErrors estimatedErrors(const Written& written) const;
  void addRest(const Written& written, StreamErrors& after) const;
  StreamErrors errorsAfter(const Written& written, const shadow::OutputErrors& errors, int kernel) const;
  void loseOutputs(bool isCounted);
  void giveBack();
  StreamRegion regionOf(const Written& written) const;
  template <class ReadOrWritten>
  const program::Parameter& parameterOf(const ReadOrWritten& each) const {
    return call_.kernel.parameters[each.argument];
  }

  ShadowDevice& device_;
  const ShadowedCall& call_;
  NativeDevice& ownReference_;
  std::int64_t number_ = 0;
  int kernel_ = 0;  ///< its number in the report
  bool isMeasured_ = false, hasOwn_ = false;
  bool isKnown_ = false;  ///< an earlier call of its kernel was compared
  bool isRunOnce_ =
      false;  ///< the device's inputs are those of the reference, so that one run on it shows both errors
  std::string ownProblem_;  ///< why the own error is not known
  bool isWorst_ = false;  ///< no call of its kernel has had a larger own error
  const NativeStream* reference_ = nullptr;  ///< what the output that is recorded is compared with
  int exception_ =
      -1;  ///< number of the record of what the output that was recorded last has of NaN or infinity
  double amplification_ = 0;
  double seconds_ = 0, referenceSeconds_ = 0, comparisonSeconds_ = 0;
  std::vector<int> origins_;  ///< kernels whose outputs the call reads
  std::vector<Read> read_;
  std::vector<Written> written_;
};

/// Runs a call by a CallFollower, with other values where the options set them.
void follow(ShadowDevice& device, const ShadowedCall& call);

/// The call, to be run again by a loop. Throws sk::Error as recording it on the device does.
std::unique_ptr<RecordedCall> recordShadowed(ShadowDevice& device, const ShadowedCall& call);

/// Operations with scalars on a shadowed device.
std::unique_ptr<RecordedCall> prepareShadowedScalars(ShadowDevice& device, ScalarPass pass);

}  // namespace sk
