// SPDX-License-Identifier: MIT
//
// What generated stubs call: arguments with their static types checked and then erased, and the
// two entry points that run a kernel or a reduction. Applications use it only through the stubs.
// Descriptors are known by their addresses: they must be constants that outlive every device.
#pragma once

#include <concepts>
#include <cstdint>
#include <span>
#include <type_traits>
#include <utility>

#include "sk/iter.hpp"
#include "sk/program.hpp"
#include "sk/stream.hpp"

namespace sk {

/// One argument of a call, in the order of the declaration: a host value or a region of a stream.
struct Argument {
  const void* value = nullptr;     ///< uniforms and spec: the value, laid out as Element says; iterators:
                                   ///< the two ends, one after the other
  StreamRegion region = {};        ///< everything else; of an iterator just the shape, or none
  bool isNone = false;             ///< sk::none
  program::Fit fit = program::Fit::Same;             ///< element inputs
};

/// In place of a stream that the values of a kernel's spec parameters switch off.
struct None {};
inline constexpr None none{};

/// A stream or view whose elements are T. A constraint and no assertion, because it is also what
/// chooses between overloads of a kernel.
template <class S, class T>
concept StreamOf = requires { typename std::remove_cvref_t<S>::value_type; } &&
                   std::same_as<typename std::remove_cvref_t<S>::value_type, T>;

/// An element input that fits itself to the domain. Made by stretch() and stride().
template <class T>
struct Fitted {
  StreamRegion region;
  program::Fit fit;
};

/// A stream or view whose extents divide the domain's: along a dimension where it has n elements and the domain n * k,
/// each serves k of these in a row. A call throws sk::Error where they do not divide.
template <class S>
  requires requires { typename S::value_type; }
Fitted<typename S::value_type> stretch(const S& stream) {
  return {regionOf(stream), program::Fit::Stretched};
}

/// A stream or view whose extents are multiples of the domain's: along a dimension where it has n * k elements and
/// the domain n, every k-th is read, from the first on. A call throws sk::Error where they are none.
template <class S>
  requires requires { typename S::value_type; }
Fitted<typename S::value_type> stride(const S& stream) {
  return {regionOf(stream), program::Fit::Strided};
}

/// Parameter types of the stubs: any stream or view of T. They last for one call.
template <class T>
class In {
 public:
  template <StreamOf<T> S>
  In(const S& stream) : region_(regionOf(stream)) {}
  Argument argument() const { return {.region = region_}; }

 private:
  StreamRegion region_;
};

/// In that may be fitted to the domain.
template <class T>
class ElementIn {
 public:
  template <StreamOf<T> S>
  ElementIn(const S& stream) : argument_{.region = regionOf(stream)} {}
  ElementIn(const Fitted<T>& stream) : argument_{.region = stream.region, .fit = stream.fit} {}
  Argument argument() const { return argument_; }

 private:
  Argument argument_;
};

template <class T>
class Out {
 public:
  template <StreamOf<T> S>
  Out(S&& stream) : region_(regionOf(stream)) {
    static_assert(isWritable<std::remove_reference_t<S>>,
                  "StreamKernel: the kernel writes this stream, but it is const");
  }
  Argument argument() const { return {.region = region_}; }

 private:
  StreamRegion region_;
};

/// In or Out of a stream that some values of the spec parameters switch off: takes sk::none, too.
template <class Parameter>
class Optional {
 public:
  template <class S>
    requires std::constructible_from<Parameter, S&&>
  Optional(S&& stream) : argument_(Parameter(std::forward<S>(stream)).argument()) {}
  Optional(None) : argument_{.isNone = true} {}
  Argument argument() const { return argument_; }

 private:
  Argument argument_;
};

template <class T>
Argument argumentOf(const Iter<T>& iterator) {
  return {.value = iterator.ends, .region = {.shape = iterator.shape}};
}

/// A variable output: a stream that gets as many elements as are pushed. Views have a size of their own.
template <class T>
class VariableOut {
 public:
  VariableOut(Stream<T>& stream) : region_(stream.handle()) {}
  Argument argument() const { return {.region = region_}; }

 private:
  StreamRegion region_;
};

/// The callable objects of kernels and reduces: with(options) is the same with these, and what was chosen before stays where they
/// say nothing.
template <class Derived>
struct WithOptions {
  CallOptions options = {};

  constexpr Derived with(const CallOptions& chosen) const {
    Derived made;
    made.options = options.with(chosen);
    return made;
  }
};

/// Runs a kernel over the domain that its outputs fix, or, where all of them are variable or scatter outputs,
/// its inputs. Throws sk::Error naming the kernel and the parameter where the arguments do not fit, and where
/// the kernel or the device has not what the options ask for.
void run(const program::Kernel& kernel, std::span<const Argument> arguments, const CallOptions& options = {});

/// Folds the inputs, which together are the domain, to one value for each accumulator, in their order,
/// written to `results` (laid out as the accumulators' Elements say). `arguments` are one a parameter of the
/// fold; nobody looks at those of the accumulators. Where there is no element, a result is the identity;
/// throws sk::Error where there is none, and where the arguments do not fit.
void reduce(const program::Reduction& reduction, std::span<const Argument> arguments,
            std::span<void* const> results, const CallOptions& options = {});

/// Folds the inputs to smaller streams, the arguments of the accumulators, all of one shape. Its extents
/// divide those of the inputs, and each of its elements folds one block of them in row-major order. Of
/// fewer dimensions, it is what remains of such a shape without some extents of 1; where that does not
/// tell which, the call throws sk::Error.
void reduce(const program::Reduction& reduction, std::span<const Argument> arguments,
            const CallOptions& options = {});

}  // namespace sk
