// SPDX-License-Identifier: MIT
//
// Devices: where streams live and kernels run. A device owns a GL or GL ES context that needs no
// window, or adopts the one that the application has current.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "sk/arithmetic.hpp"
#include "sk/owner.hpp"
#include "sk/shape.hpp"
#include "sk/stream.hpp"
#include "sk/table.hpp"
#include "sk/types.hpp"

namespace sk {

class DeviceState;  // the runtime's own

namespace detail {

struct DeviceDeleter {
  void operator()(DeviceState* state) const noexcept;
};
using DeviceOwner = Owner<DeviceState, DeviceDeleter>;

}  // namespace detail

struct DeviceOptions {
  /// Which device: "native" (the kernels' native code on the CPU, no GL), "reference" (the same, computing in double
  /// wherever a kernel says float) or "reference:quad" (in __float128), "gpu" or "gpu:N" (the N-th hardware device, from
  /// 0), "software", "gl" (the first GPU, or "software" where there is none), or a part of the renderer's name in any case
  /// ("llvmpipe", "nvidia"). Empty: environment variable SK_DEVICE, and without it the best one, which is the first GPU;
  /// where there is none, native code; and "software" where a .sk file of the program has no native code, or where options
  /// below ask for what devices with GL alone have (docs/runtime.md, The best device).
  std::string device = {};
  /// "glsl330" (fragment programs), "glsl430" (compute programs, wherever these serve) or "essl300". Empty: environment
  /// variable SK_PROFILE, and without it OpenGL where the device has 3.3, of which the faster programs are taken, else
  /// essl300.
  std::string profile = {};
  /// No texture is wider or higher than this: larger extents are linearised, and larger streams lie in several
  /// layers. 0: environment variable SK_TEXTURE_LIMIT, and without it the device's own limit, which this cannot
  /// pass. For tests.
  std::int32_t textureLimit = 0;
  /// "device": what the device can do. "guaranteed": no more planes in a pass than every device of
  /// the profile can write and read, to try out how a program runs elsewhere. Empty: environment
  /// variable SK_LIMITS, and without it "device".
  std::string limits = {};
  /// "native": doubles are the device's own, where it has them. "pairs": they are pairs of floats. Empty:
  /// environment variable SK_DOUBLES, and without it "native", or "pairs" where limits are "guaranteed".
  std::string doubles = {};
  /// A file of choices of accuracy for kernels by name (docs/accuracy.md). Empty: environment variable SK_CONFIG, and
  /// without it none.
  std::string configuration = {};
  /// "precise", "xor" or "none": the Barrier of the device's programs, taken without a trial. Empty: environment
  /// variable SK_BARRIER, and without it the first of precise and xor that proves itself (Device::arithmetic).
  std::string barrier = {};
  /// The application draws in the device's own context, too, off screen: the context is current after makeCurrent(), and every
  /// call puts back the GL state that it changes, as in an adopted one. The best device then has GL; a native one that is
  /// named ignores it.
  bool sharesContext = false;
};

struct DeviceLimits {
  std::int32_t textureSize = 0;  ///< largest width and height of a texture
  std::int32_t textureLayers = 0;  ///< most layers of one: a stream has as many times more elements
  std::int32_t drawBuffers = 0;  ///< planes that one pass may write
  std::int32_t textureUnits = 0;  ///< planes that one pass may read
  std::int32_t uniformComponents = 0;  ///< components of the uniform arguments of a kernel
  std::int64_t elements = 0;  ///< of a stream or a domain (sk/limits.hpp)
};

/// What a trial with one class of kernels has found out (docs/runtime.md, Targets).
struct TargetTrial {
  std::string_view kernels;  ///< "elements", "neighbours", "gathers", "loops" or "reduces"
  double computeOverFragment;  ///< the time that compute programs take over that of fragment programs
};

/// What kernels and reduces have done on a device.
struct PassCount {
  std::int64_t passes =
      0;  ///< draws, dispatches and native loop nests, those of reductions and of copies included
  std::int64_t bytesRead = 0;  ///< of their operands: each texel of an input or gather once a pass
  std::int64_t bytesWritten = 0;
};

/// What the reference computes with: doubles, of 53 bits, or __float128, of 113, which is software.
enum class Reference : std::uint8_t { Double, Quad };

/// Move-only. Several may live in a process; one thread may use a device at a time. A call makes the
/// device's context current on its thread; it puts back the one that was current before, and where
/// there was none leaves its own.
class Device {
 public:
  /// The best device (DeviceOptions::device), or the one that environment variable SK_DEVICE names. Throws sk::Error with
  /// everything that was tried, why it failed, and what to do.
  Device();
  explicit Device(std::string_view device);
  explicit Device(const DeviceOptions& options);
  ~Device();
  Device(Device&& other) noexcept;
  Device& operator=(Device&& other) noexcept;

  /// A device on the context (GL 3.3 or ES 3.0, or later) that is current on this thread; `device`
  /// of the options is not looked at. The context must be current at every use and stay alive as
  /// long as the device. GL state that a call changes is put back before it returns. Neither a query nor
  /// conditional rendering may be in progress during a call: it would count, or drop, what is drawn.
  static Device adopt(const DeviceOptions& options = {});

  /// The device that needs no GL: kernels run as the native code that skc compiled, streams lie in host memory.
  /// Arithmetic is IEEE 754's, and defined for every operand (docs/language.md).
  static Device native();
  /// The same with doubles for floats, in streams and in kernels, or with __float128 for floats and doubles: what results
  /// are measured against. Kernels compute so whatever precision a call asks for. Those of __float128 need native code that
  /// skc was asked for (--quad).
  static Device reference(Reference kind = Reference::Double);

  /// A new stream; its elements are undefined. `name`: what a configuration file may call it; the streams of a .sk file's
  /// struct have their qualified names. Throws sk::Error where the shape has no dimension, the device has no room, or a
  /// storage other than Single is asked for elements without floats.
  template <ElementType T>
  Stream<T> stream(const Shape& shape, Storage storage = Storage::Default, std::string_view name = {}) {
    return Stream<T>(createStream(ElementTraits<T>::element(), shape, storage, name));
  }

  /// The same, of a type that is known at run time only; detail::write() and read() move its elements as bytes. `element`
  /// must outlive the stream.
  detail::StreamOwner createStream(const program::Element& element, const Shape& shape,
                                   Storage storage = Storage::Default, std::string_view name = {});

  /// The renderer's name as the driver gives it.
  const std::string& name() const;
  /// The version of GL and of the driver, and that of the shading language, as the driver words them; empty where
  /// there is no GL.
  const std::string& driver() const;
  const std::string& shadingLanguage() const;
  /// "glsl330", "glsl430" where compute programs were asked for, "essl300", or "native".
  std::string_view profile() const;
  const DeviceLimits& limits() const;
  /// Whether the renderer is a program on the CPU.
  bool isSoftware() const;
  /// What the device's float arithmetic is good for. The first time that anybody asks, a program tries it with a
  /// thousand pairs of floats, in some ms; what comes of it is kept for the driver, on disk, too (docs/runtime.md).
  const Arithmetic& arithmetic();

  /// Which programs are faster for which kernels, compute or fragment ones: tries out what was not tried out on this
  /// driver before. Empty where the device has not both.
  std::vector<TargetTrial> trialTargets();

  /// The tables that stand for functions of kernels which have run on the device, by the functions' names.
  std::vector<TableReport> tables() const;

  /// Begins to count passes at 0, or ends it. Counting costs each pass some of the host's time.
  void countPasses(bool on);
  /// Since they are counted. Passes by which the runtime finds out about the device are left out. Throws sk::Error where
  /// nothing is counted.
  PassCount passCount() const;

  /// Makes the device's own context current on the calling thread, and leaves it so: for applications that draw in it
  /// (DeviceOptions::sharesContext). Throws sk::Error where the device has no context of its own.
  void makeCurrent();
  /// Waits until everything that was asked of the device is done.
  void finish();
  /// Lets go of the calling thread, so that another may use the device.
  void release();

 private:
  explicit Device(detail::DeviceOwner state);
  DeviceState& state() const;

  detail::DeviceOwner state_;
};

}  // namespace sk
