// SPDX-License-Identifier: MIT
//
// A device holds streams and runs kernels. It computes on the CPU, owns a GL or GL ES context that needs no
// window, or adopts the application's current context.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <vector>

#include "sk/arithmetic.hpp"
#include "sk/call.hpp"
#include "sk/loop.hpp"
#include "sk/owner.hpp"
#include "sk/scalar.hpp"
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
  /// Selects the device: "native" (native code on the CPU, no GL), "reference" (native code that computes in
  /// double wherever a kernel says float), "reference:quad" (in __float128), "gpu" or "gpu:N" (hardware
  /// device N, counted from 0), "software", "gl" (the first GPU, or "software" if there is none), or a part
  /// of the renderer's name in any case ("llvmpipe", "nvidia"). If empty, the environment variable SK_DEVICE
  /// decides, and without it the best device: the first GPU; without a GPU, native code, or "software" if a
  /// .sk file of the program has no native code or an option below needs GL (docs/runtime.md, The best
  /// device).
  std::string device = {};
  /// "glsl330" (fragment programs), "glsl430" (compute programs for every kernel that can use them), "essl300"
  /// (OpenGL ES with fragment programs alone) or "essl310" (OpenGL ES 3.1 with compute programs, likewise). If
  /// empty, the environment variable SK_PROFILE decides, and without it: OpenGL with the faster kind of program
  /// if the device has 3.3, else OpenGL ES with the faster kind.
  std::string profile = {};
  /// The largest width and height of a texture: larger extents are linearised, and larger streams use several
  /// layers. If 0, the environment variable SK_TEXTURE_LIMIT decides, and without it the device's limit,
  /// which is the maximum in any case. It shows how a program runs where textures are smaller.
  std::int32_t textureLimit = 0;
  /// The most bytes that DeviceLimits::memory and availableMemory() report. If 0, the environment variable
  /// SK_MEMORY_LIMIT decides, and without it the device's own memory. It shows how a program that asks for
  /// them runs where there is less memory; streams may be larger in any case.
  std::int64_t memoryLimit = 0;
  /// "device": the device's own limits. "guaranteed": a pass reads and writes no more planes than every
  /// device of the profile can, which shows how a program runs elsewhere. If empty, the environment variable
  /// SK_LIMITS decides, and without it "device".
  std::string limits = {};
  /// "native": the device's own doubles, if it has them. "pairs": pairs of floats. If empty, the environment
  /// variable SK_DOUBLES decides, and without it "native", or "pairs" if limits are "guaranteed".
  std::string doubles = {};
  /// A file that chooses the accuracy of kernels by name (docs/accuracy.md). If empty, the environment
  /// variable SK_CONFIG names the file, and without it there is none.
  std::string configuration = {};
  /// "precise", "xor" or "none": the Barrier of the device's programs, used without a trial. If empty, the
  /// environment variable SK_BARRIER decides, and without it the first of precise and xor that passes the
  /// trial (Device::arithmetic).
  std::string barrier = {};
  /// True if the application also draws in the device's own context, off screen. The context is current after
  /// makeCurrent(), and every call restores the GL state that it changes, as in an adopted context. The best
  /// device then has GL; a native device chosen by name ignores the option.
  bool sharesContext = false;
};

struct DeviceLimits {
  std::int32_t textureSize = 0;  ///< largest width and height of a texture
  std::int32_t textureLayers = 0;  ///< layers of an array texture: multiplies the elements of a stream
  std::int32_t drawBuffers = 0;  ///< planes that one pass may write
  std::int32_t images = 0;  ///< planes that a compute program may write; 0 if the device has none
  std::int32_t textureUnits = 0;  ///< planes that one pass may read
  std::int32_t uniformComponents = 0;  ///< components of the uniform arguments of a kernel
  std::int64_t elements = 0;  ///< elements of a stream or a domain (sk/limits.hpp)
  /// Bytes of the memory that holds streams: a GPU's, or the host's if streams are there. Empty if the driver
  /// does not tell.
  std::optional<std::int64_t> memory = {};
};

/// What the runtime assumes of a device and does not measure (docs/runtime.md, "What is known of devices").
struct DeviceTrait {
  std::string_view name;
  double value;  ///< 1 for true, 0 for false
  double most;  ///< the largest value; 1 for what is true or false
  std::string_view meaning, reason;
};

/// The result of a trial with one class of kernels (docs/runtime.md, Targets).
struct TargetTrial {
  /// "elements", "neighbours", "gathers", "loops", "reduces", "pushes", "scatters" or "ordered-scatters"
  std::string_view kernels;
  double computeOverFragment;  ///< time of compute programs divided by time of fragment programs
};

/// Counts what kernels and reductions have done on a device.
struct PassCount {
  std::int64_t passes = 0;  ///< draws, dispatches and native loop nests, also of reductions and copies
  std::int64_t bytesRead = 0;  ///< by operands: each texel of an input or gather counts once per pass
  std::int64_t bytesWritten = 0;
};

/// The arithmetic of a reference device: double (53 bits) or __float128 (113 bits, in software).
enum class Reference : std::uint8_t { Double, Quad };

/// Move-only. A process may have several devices; one thread may use a device at a time. A call makes the
/// device's context current on the calling thread and restores the previous one afterwards; if there was
/// none, the device's context stays current.
class Device {
 public:
  /// Creates the best device (DeviceOptions::device), or the one that the environment variable SK_DEVICE
  /// names. Throws sk::Error, which lists everything that was tried, why it failed, and what to do.
  Device();
  explicit Device(std::string_view device);
  explicit Device(const DeviceOptions& options);
  ~Device();
  Device(Device&& other) noexcept;
  Device& operator=(Device&& other) noexcept;

  /// Creates a device on the context (GL 3.3, ES 3.0 or later) that is current on this thread; ignores
  /// `device` of the options. The context must be current at every use and must outlive the device. Every
  /// call restores the GL state that it changes. No query and no conditional rendering may be active during a
  /// call: it would count, or discard, what is drawn.
  static Device adopt(const DeviceOptions& options = {});

  /// Creates a device without GL: kernels run as native code that skc compiled, and streams are in host
  /// memory. Arithmetic follows IEEE 754 and is defined for every operand (docs/language.md).
  static Device native();
  /// Creates a native device that replaces floats by doubles, or floats and doubles by __float128, in streams
  /// and kernels: the reference for measuring errors. Kernels ignore the precision that a call asks for.
  /// Reference::Quad needs kernels compiled with `skc --quad`.
  static Device reference(Reference kind = Reference::Double);

  /// Creates a stream with undefined elements. A configuration file may refer to it by `name`; the streams of
  /// a struct in a .sk file have their qualified names. Throws sk::Error if the shape has no dimension, if
  /// the device is out of memory, or if `storage` is not Single for elements without floats.
  template <ElementType T>
  Stream<T> stream(const Shape& shape, Storage storage = Storage::Default, std::string_view name = {}) {
    return Stream<T>(createStream(ElementTraits<T>::element(), shape, storage, name));
  }

  /// Says which elements streams have.
  template <class T>
    requires(!ElementType<T>)
  auto stream(const Shape&, Storage = Storage::Default, std::string_view = {}) {
    static_assert(
        ElementType<T>,
        "StreamKernel: a stream holds bool, float, double, integers of 8 to 64 bits such as std::int32_t, "
        "sk::half, vectors such as sk::float4, or a struct of a .sk file, whose header has to be included; "
        "for long long take std::int64_t");
  }

  /// Creates a scalar: a value on the device, undefined until something writes it, or `value`. Throws sk::Error if the
  /// device is out of memory.
  template <ElementType T>
  Scalar<T> scalar() {
    return Scalar<T>(
        detail::ScalarHandle(createStream(ElementTraits<T>::element(), {1}, Storage::Single, {})));
  }
  template <ElementType T>
  Scalar<T> scalar(const std::type_identity_t<T>& value) {
    Scalar<T> made = scalar<T>();
    made.assign(value);
    return made;
  }

  /// Creates a stream whose element type is known only at run time; detail::write() and read() copy its
  /// elements as bytes. `element` must outlive the stream.
  detail::StreamOwner createStream(const program::Element& element, const Shape& shape,
                                   Storage storage = Storage::Default, std::string_view name = {});

  /// Records the calls of kernels, reductions to streams, scans, fill() and copyTo() that `calls` makes on this
  /// device, without running them. Code of the application between the calls runs now and never again: uniform
  /// arguments keep their values. Streams of this device that `calls` swaps (std::swap(u, v)) are swapped in each
  /// iteration; after record() they are where they were. Throws sk::Error if `calls` reads or writes a stream,
  /// asks for a value, pushes to a variable output, or moves a stream without a swap, or if an argument does not match.
  /// If it throws, or `calls` does, streams and scalars are as before, even those that `calls` has moved or destroyed.
  template <class Calls>
  Loop record(Calls&& calls) {
    detail::Recording recording(state());
    std::forward<Calls>(calls)();
    return Loop(recording.finish());
  }

  /// The renderer's name, as reported by the driver.
  const std::string& name() const;
  /// The versions of GL with the driver, and of the shading language, as reported by the driver; empty
  /// without GL.
  const std::string& driver() const;
  const std::string& shadingLanguage() const;
  /// "glsl330" or "essl300", "glsl430" or "essl310" if compute programs were requested, or "native".
  std::string_view profile() const;
  const DeviceLimits& limits() const;
  /// Bytes of limits().memory that nobody uses at present; empty if it is unknown (docs/runtime.md, Limits).
  /// Some drivers tell this and not the whole, or neither.
  std::optional<std::int64_t> availableMemory() const;
  /// Whether the renderer runs on the CPU.
  bool isSoftware() const;
  /// "native", or what the renderer's name says: "software renderer", "virtual GPU", "integrated GPU" or "discrete GPU".
  std::string_view kind() const;
  /// What the runtime assumes of the device. Tables [devices] of the configuration file change it. Empty without GL.
  std::vector<DeviceTrait> traits() const;
  /// What the device's float arithmetic guarantees. The first call runs a program on a thousand pairs of
  /// floats, which takes some ms; the result is cached on disk for the driver (docs/runtime.md).
  const Arithmetic& arithmetic();

  /// Returns whether compute or fragment programs are faster for each class of kernels. Measures the classes
  /// that have not been measured on this driver. Empty if the device does not have both.
  std::vector<TargetTrial> trialTargets();

  /// The tables that have replaced functions of kernels on this device, sorted by function name.
  std::vector<TableReport> tables() const;

  /// Starts counting passes from 0, or stops counting. Counting costs some host time for each pass.
  void countPasses(bool on);
  /// The passes since counting started, without those that the runtime uses to probe the device. Throws
  /// sk::Error if counting is off.
  PassCount passCount() const;

  /// Makes the device's own context current on the calling thread and leaves it current, for applications
  /// that draw in it (DeviceOptions::sharesContext). Throws sk::Error if the device has no context of its
  /// own.
  void makeCurrent();
  /// Waits until the device has finished all work submitted so far.
  void finish();
  /// Detaches the device from the calling thread, so that another thread may use it.
  void release();

 private:
  friend DeviceState& detail::deviceStateOf(const Device& device);

  explicit Device(detail::DeviceOwner state);
  DeviceState& state() const;

  detail::DeviceOwner state_;
};

}  // namespace sk
