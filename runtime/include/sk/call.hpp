// SPDX-License-Identifier: MIT
//
// The interface of generated stubs: arguments whose static types are checked and then erased, and the entry
// points that run a kernel or a reduction. Applications use the stubs instead. Descriptors are identified by
// their addresses: they must be constants that outlive every device.
#pragma once

#include <concepts>
#include <cstdint>
#include <optional>
#include <span>
#include <type_traits>
#include <utility>

#include "sk/iter.hpp"
#include "sk/program.hpp"
#include "sk/rows.hpp"
#include "sk/stream.hpp"

namespace sk {

/// An argument of a call, in order of declaration: a host value or a region of a stream.
struct Argument {
  /// Uniforms and spec parameters: the value, laid out as Element says. Iterators: both ends, one after the
  /// other. Null for a uniform that a stream of one element holds.
  const void* value = nullptr;
  StreamRegion region =
      {};  ///< all other arguments, and such uniforms; of an iterator only the shape, if any
  bool isNone = false;  ///< sk::none
  program::Fit fit = program::Fit::Same;  ///< element inputs
  const RowsState* rows = nullptr;  ///< element inputs of reduces and scans: the rows they are in, or null
};

/// Passed for a stream that the values of a kernel's spec parameters switch off.
struct None {};
inline constexpr None none{};

/// A stream or view with elements of type T. A constraint rather than an assertion, so that it also selects
/// among overloads of a kernel.
template <class S, class T>
concept StreamOf = requires { typename std::remove_cvref_t<S>::value_type; } &&
                   std::same_as<typename std::remove_cvref_t<S>::value_type, T>;

namespace detail {

template <class S>
concept HasRegion = requires(const S& stream) {
  { regionOf(stream) } -> std::same_as<StreamRegion>;
};

/// The region of an argument, which has been chosen by the type of its elements alone.
template <class S>
StreamRegion regionOfArgument(const S& stream) {
  static_assert(HasRegion<S>,
                "StreamKernel: kernels take streams, and this is memory of the host; create a stream, "
                "device.stream<T>(shape), and write() the elements to it");
  if constexpr (HasRegion<S>) {
    return regionOf(stream);
  } else {
    return {};
  }
}

}  // namespace detail

/// An element input that is fitted to the domain. Created by stretch() and stride().
template <class T>
struct Fitted {
  StreamRegion region;
  program::Fit fit;
};

/// Repeats elements of a stream or view. In a dimension with n elements and a domain of n * k, each element
/// serves k consecutive indices. A call throws sk::Error unless the extents divide the domain's.
template <class S>
  requires requires { typename S::value_type; }
Fitted<typename S::value_type> stretch(const S& stream) {
  return {regionOf(stream), program::Fit::Stretched};
}

/// Skips elements of a stream or view. In a dimension with n * k elements and a domain of n, every k-th
/// element is read, starting with the first. A call throws sk::Error unless the extents are multiples of the
/// domain's.
template <class S>
  requires requires { typename S::value_type; }
Fitted<typename S::value_type> stride(const S& stream) {
  return {regionOf(stream), program::Fit::Strided};
}

/// stretch(stride(stream)) and stride(stretch(stream)) fit each dimension on its own: an extent that divides
/// the domain's is stretched, a multiple of it is strided. A call throws sk::Error if it is neither.
template <class T>
Fitted<T> stretch(const Fitted<T>& input) {
  const bool isStretched = input.fit == program::Fit::Stretched;
  return {input.region, isStretched ? input.fit : program::Fit::StretchedOrStrided};
}

template <class T>
Fitted<T> stride(const Fitted<T>& input) {
  const bool isStrided = input.fit == program::Fit::Strided;
  return {input.region, isStrided ? input.fit : program::Fit::StretchedOrStrided};
}

/// The parameter types of stubs: any stream or view of T. They are valid for one call.
template <class T>
class In {
 public:
  template <StreamOf<T> S>
  In(const S& stream) : region_(detail::regionOfArgument(stream)) {}
  Argument argument() const { return {.region = region_}; }

 private:
  StreamRegion region_;
};

/// Like In, but also accepts stretch(), stride() and rows (sk::Rows).
template <class T>
class ElementIn {
 public:
  template <StreamOf<T> S>
  ElementIn(const S& stream) : argument_{.region = detail::regionOfArgument(stream)} {}
  ElementIn(const Fitted<T>& stream) : argument_{.region = stream.region, .fit = stream.fit} {}
  ElementIn(const InRows<T>& stream) : argument_{.region = stream.region, .rows = stream.rows} {}
  Argument argument() const { return argument_; }

 private:
  Argument argument_;
};

template <class T>
class Out {
 public:
  template <StreamOf<T> S>
  Out(S&& stream) : region_(detail::regionOfArgument(stream)) {
    static_assert(isWritable<std::remove_reference_t<S>>,
                  "StreamKernel: the kernel writes this stream, but it is const");
  }
  Argument argument() const { return {.region = region_}; }

 private:
  StreamRegion region_;
};

/// An In or Out of a stream that some values of the spec parameters switch off: also accepts sk::none.
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

/// A uniform parameter in calls where a stream or view of one element stands for one of them: such a stream, or
/// a value.
template <class T>
class Uniform {
 public:
  Uniform(const T& value) : value_(value) {}
  template <class V>
    requires(std::is_arithmetic_v<V> && std::is_arithmetic_v<T> && !std::same_as<V, T>)
  Uniform(V value) : value_(static_cast<T>(value)) {}
  template <StreamOf<T> S>
  Uniform(const S& stream) : region_(detail::regionOfArgument(stream)) {}
  /// A pointer into this object, unless it is a stream.
  Argument argument() const { return value_ ? Argument{.value = &*value_} : Argument{.region = region_}; }

 private:
  std::optional<T> value_;
  StreamRegion region_;
};

template <class T>
Argument argumentOf(const Iter<T>& iterator) {
  return {.value = iterator.ends, .region = {.shape = iterator.shape}};
}

/// A variable output: a stream that is resized to the number of pushed elements. Views have a fixed size.
template <class T>
class VariableOut {
 public:
  VariableOut(Stream<T>& stream) : region_(stream.handle()) {}
  Argument argument() const { return {.region = region_}; }

 private:
  StreamRegion region_;
};

namespace detail {

/// Throws sk::Error if the device was moved from.
DeviceState& deviceStateOf(const Device& device);

}  // namespace detail

/// Base of the callable objects of kernels and reductions. with(options) returns a copy in which `options`
/// override the options chosen before, except where they are Default.
template <class Derived>
struct WithOptions {
  CallOptions options = {};

  constexpr Derived with(const CallOptions& chosen) const {
    Derived made;
    made.options = options.with(chosen);
    return made;
  }

  /// Returns a copy whose calls run over a domain of this shape, rows first. Nothing is allocated for it. Inputs repeat in
  /// it as they do in the domain of an output. A call throws sk::Error if the shape has no dimension, if an element output or
  /// an iterator has another shape, or if the device cannot number the elements. An empty domain is that of an empty stream.
  constexpr Derived over(const Shape& shape) const { return with({.over = GivenDomain{.shape = shape}}); }

  /// The same on this device, for calls without any stream. The device must exist when the copy is called.
  Derived over(const Device& device, const Shape& shape) const {
    return with({.over = GivenDomain{.shape = shape, .device = &detail::deviceStateOf(device)}});
  }
};

/// Runs a kernel over the domain that its outputs define or, if all outputs are variable or scatter outputs,
/// `options.over`, its inputs or its iterators. Throws sk::Error, which names the kernel and the parameter, if the
/// arguments do not match, or if the kernel or the device does not support the options.
void run(const program::Kernel& kernel, std::span<const Argument> arguments, const CallOptions& options = {});

/// Folds the inputs, whose common shape is the domain unless `options.over` gives it, to one value for each accumulator. The values are
/// written to `results` in order, laid out as the accumulators' Elements say. `arguments` has one entry for
/// each parameter of the fold; entries of accumulators are ignored. For an empty domain, the result is the
/// identity. Throws sk::Error if there is no identity, or if the arguments do not match.
void reduce(const program::Reduction& reduction, std::span<const Argument> arguments,
            std::span<void* const> results, const CallOptions& options = {});

/// Folds the inputs to smaller streams: the arguments of the accumulators, all of one shape. Their extents
/// divide those of the inputs; each element folds one block of the inputs in row-major order. A stream of
/// lower rank stands for a shape with additional extents of 1; if several such shapes are possible, the call
/// throws sk::Error. Inputs in rows (sk::Rows) are folded row by row instead, to one element for each row.
void reduce(const program::Reduction& reduction, std::span<const Argument> arguments,
            const CallOptions& options = {});

/// Runs a kernel with folded outputs over the domain that its other outputs define. Folds, besides, each block of the
/// domain to one element of the arguments of the accumulators, whose extents divide the domain's as in a reduction to
/// streams. Throws sk::Error like run() and reduce().
void fold(const program::Reduction& reduction, std::span<const Argument> arguments,
          const CallOptions& options = {});

/// Folds, for each element of the inputs, all elements up to it (CallOptions::scan, along) to one element of the
/// arguments of the accumulators, which have the shape of the inputs and may be the same streams. Inputs in rows
/// (sk::Rows) are scanned row by row. Throws sk::Error if the arguments do not match, or if an exclusive scan
/// has no identity.
void scan(const program::Reduction& reduction, std::span<const Argument> arguments,
          const CallOptions& options = {});

/// Calls the kernels of a pipeline, in order. Its domain is the shape of its outputs; without any, that of `options.over` or of its
/// inputs together. Throws sk::Error like run() and reduce(), before any kernel has run if the shapes or the streams do not
/// match what the pipeline says of them; if an output's stream is read by a kernel after the one that writes it, under another
/// name; if memory for its local streams is exhausted; and for options of single calls: a box, or those of scans.
void run(const program::Pipeline& pipeline, std::span<const Argument> arguments,
         const CallOptions& options = {});

namespace detail {

/// The rank of a gather's argument, by which stubs choose among kernels; 0 if none is given.
inline int rankOf(const Argument& argument) {
  const Shape& whole = argument.region.placement.whole;
  return whole.rank() != 0 ? whole.rank() : argument.region.shape.rank();
}
/// Throws sk::Error: no kernel of this name takes such a gather. `ranks`: "2 or 3".
[[noreturn]] void refuseRank(const char* kernel, const char* gather, int rank, const char* ranks);

/// Runs calls with streams that several processes share (sk/mpi.hpp): the functions above pass such a call on. An empty
/// `results` means that the arguments of accumulators are streams.
class Distribution {
 public:
  virtual void run(const program::Kernel& kernel, std::span<const Argument> arguments,
                   const CallOptions& options) = 0;
  virtual void reduce(const program::Reduction& reduction, std::span<const Argument> arguments,
                      std::span<void* const> results, const CallOptions& options) = 0;
  virtual void fold(const program::Reduction& reduction, std::span<const Argument> arguments,
                    const CallOptions& options) = 0;
  virtual void scan(const program::Reduction& reduction, std::span<const Argument> arguments,
                    const CallOptions& options) = 0;

 protected:
  ~Distribution() = default;
};

class DistributedStream {
 public:
  virtual Distribution& distribution() = 0;

 protected:
  ~DistributedStream() = default;
};

}  // namespace detail

}  // namespace sk
