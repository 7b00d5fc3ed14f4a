// SPDX-License-Identifier: MIT
//
// What every kind of device is to the public face: a place for streams that runs kernels on them, GL
// (gl_device/gl_device.hpp) or native code (native/native_device.hpp). Arguments have been checked before they get here.
#pragma once

#include <cstddef>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "device/configuration.hpp"
#include "device/function_table.hpp"
#include "device/stream_state.hpp"
#include "sk/call.hpp"
#include "sk/device.hpp"
#include "sk/program.hpp"
#include "trace/trace.hpp"

namespace sk {

struct ResolvedCall;
struct ResolvedReduction;

/// Exact sums, one for each element of the results, which get them once all are known: a result may be an input.
class RoundedSums {
 public:
  RoundedSums() = default;
  virtual ~RoundedSums() = default;
  RoundedSums(const RoundedSums&) = delete;
  RoundedSums& operator=(const RoundedSums&) = delete;

  /// Puts them in the scalar that is `offset` bytes from the start of each element of a region in host memory.
  virtual void store(const StreamRegion& results, std::size_t offset) const = 0;
};

class DeviceState {
 public:
  virtual ~DeviceState() = default;
  DeviceState(const DeviceState&) = delete;
  DeviceState& operator=(const DeviceState&) = delete;

  virtual const std::string& name() const = 0;
  virtual const std::string& driver() const = 0;
  virtual const std::string& shadingLanguage() const = 0;
  virtual std::string_view profileName() const = 0;
  virtual bool isSoftware() const = 0;
  /// Tries the device out, unless that is known.
  virtual const Arithmetic& arithmetic() = 0;
  /// Of all classes of kernels; none where there is no choice.
  virtual std::vector<TargetTrial> trialTargets() { return {}; }
  /// Whether scatter outputs may combine what comes with what they hold.
  virtual bool combinesScattered() const = 0;
  /// Whether precisions other than float's are forms of a kernel: native code computes in any real type.
  virtual bool takesForms() const = 0;
  /// Whether doubles are cheaper to sum in than floats with what they lose.
  virtual bool sumsInDoubles() const { return false; }
  /// Whether it computes in double where kernels say float.
  virtual bool isReference() const { return false; }
  /// Throws sk::Error where this device has no program for the kernel.
  virtual void checkProgram(const program::Kernel& kernel) = 0;
  virtual void checkProgram(const program::Reduction& reduction) = 0;

  /// Throws sk::Error where there is no room. A storage other than Single is for elements with floats.
  virtual std::unique_ptr<StreamState> createStream(const program::Element& element, const Shape& shape,
                                                    Storage storage) = 0;
  /// Traces everything from now on. Throws sk::Error where the file cannot be written.
  virtual void startTrace(const std::string& file) = 0;
  virtual void finish() = 0;
  virtual void release() = 0;
  virtual void makeCurrent() = 0;

  /// Only variable outputs may lack elements: they become empty.
  virtual void run(const ResolvedCall& call) = 0;
  /// There is one block at least. Of a domain without elements, the results are the identities, which then exist.
  virtual void reduce(const ResolvedReduction& call) = 0;
  /// Whether it adds sums of floats without rounding. Else it compensates them, in a precision of its own.
  virtual bool sumsExactly(const program::Reduction&) const { return true; }
  /// The rounded sums of all blocks where the device adds them itself; else null, and the sum is folded to digits.
  virtual std::unique_ptr<RoundedSums> sumExactly(const ResolvedReduction&, const program::ExactSum&) {
    return nullptr;
  }

  DeviceLimits limits;
  Configuration configuration;
  FunctionTables tables;
  std::optional<PassCount> passCount;  ///< none where nobody counts
  std::unique_ptr<Trace> trace;  ///< null where SK_TRACE names no file

 protected:
  DeviceState() = default;

  StreamState* firstStream() const { return firstStream_; }

 private:
  friend class StreamState;

  StreamState* firstStream_ = nullptr;  ///< list of those that must be told of the device's end
};

}  // namespace sk
