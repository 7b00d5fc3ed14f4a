// SPDX-License-Identifier: MIT
//
// Streams are shaped, typed collections of elements on a device; views are boxes of a stream, every n-th element of
// one, or its elements in another shape. Device::stream creates streams. The templates here wrap a few untyped
// functions; GL appears only in StreamTexture and fillBuffer.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <type_traits>
#include <utility>
#include <vector>

#include "sk/future.hpp"
#include "sk/host_vector.hpp"
#include "sk/owner.hpp"
#include "sk/program.hpp"
#include "sk/shape.hpp"
#include "sk/types.hpp"

namespace sk {

class StreamState;  // the runtime's own
class LoopState;  // the runtime's own
class Device;
namespace detail {
struct TypedStreams;
class DistributedStream;
}  // namespace detail
template <ElementType T>
class Stream;

/// Where elements lie in a larger whole (sk/placed.hpp). The default stands for elements that are a whole themselves.
struct Placement {
  Index origin = {};  ///< index in the whole of the first element; negative if a halo begins before the whole
  Shape whole = {};  ///< the extents of the whole

  bool operator==(const Placement&) const = default;
};

/// Elements of a stream without their type: the argument of an untyped call. They are a box of the stream, or, if
/// `stride` has a rank, any elements at regular distances.
struct StreamRegion {
  StreamState* stream = nullptr;
  Index begin = {};  ///< of a box: the first element
  Shape shape = {};  ///< the extents; the rank of a box is the stream's
  /// Element i is number first + sum(i[d] * stride[d]) of the stream, row-major; distances are above 0.
  Index stride = {};
  std::int64_t first = 0;
  /// Set if several processes share the stream (sk/mpi.hpp); `stream` is then null, and `shape` is the shape of the whole.
  detail::DistributedStream* distributed = nullptr;
  Placement placement = {};  ///< what kernels see: a part of a whole, or these elements alone
};

/// The texture that holds one plane of a stream. A scalar or vector element has one plane; a struct has one
/// for each member of scalar or vector type, in order of declaration.
///
/// If the stream has rank 1 or 2 and its extents fit the device's texture limit, `linear` is false and texel
/// (x, y) holds row y, column x (rank 1: one row). Any other stream, and any stream that a kernel has pushed
/// to, is linearised: row-major element i is in texel (i % width, i / width), and `width` is a power of two.
/// If one such texture is too small, an array texture holds the elements in `layers` consecutive layers.
/// Texels after the last element and the fourth channel of a three-component vector are unspecified. A bool
/// is an unsigned 0 or 1. The texture has one level and no filter.
struct StreamTexture {
  std::uint32_t name = 0;  ///< the GL texture; 0 if the stream is empty
  std::uint32_t internalFormat = 0;  ///< GL_R32F, GL_RGBA32F, GL_R32I, GL_R8UI (bool) ...
  std::int32_t width = 0;
  std::int32_t height = 0;
  bool linear = false;
  std::int32_t layers = 0;  ///< 0: the target is GL_TEXTURE_2D, else GL_TEXTURE_2D_ARRAY
};

/// The element of a host array of T: T itself, or a byte of 0 or 1 for bool, because std::vector<bool> is not
/// contiguous.
template <class T>
using HostElement = std::conditional_t<std::is_same_v<T, bool>, std::uint8_t, T>;

namespace detail {

struct StreamDeleter {
  /// A loop may keep the stream for its calls.
  void operator()(StreamState* state) const noexcept;
  static void moved(StreamState* state, Owner<StreamState, StreamDeleter>* holder) noexcept;
};

/// A handle of a stream. Device::record gives the handles of its device back what they held, however its function moves
/// them, and therefore has to know which handles it has destroyed.
class StreamOwner : public Owner<StreamState, StreamDeleter> {
 public:
  StreamOwner() = default;
  explicit StreamOwner(StreamState* state) noexcept : Owner(state) {}
  StreamOwner(StreamOwner&& other) noexcept : Owner(std::move(other)) {}
  StreamOwner& operator=(StreamOwner&& other) noexcept {
    Owner::operator=(std::move(other));
    return *this;
  }
  ~StreamOwner() {
    if (recording_ != nullptr) leaveRecording();
  }

 private:
  friend class sk::LoopState;
  void leaveRecording() noexcept;

  LoopState* recording_ = nullptr;  ///< refers to this handle; or null
};

StreamRegion wholeRegion(StreamState* state);
Shape shapeOf(StreamState* state);
StreamRegion partOf(const StreamRegion& region, const Index& begin, const Index& end);
StreamRegion strided(const StreamRegion& region, const Index& steps, const Index& offsets);
StreamRegion reshaped(const StreamRegion& region, const Shape& shape);
StreamRegion placed(const StreamRegion& region, const Placement& placement);
void write(const StreamRegion& region, const void* elements, std::size_t count);
void read(const StreamRegion& region, void* elements, std::size_t count);
TransferOwner readAsync(const StreamRegion& region);
void writeAsync(const StreamRegion& region, const void* elements, std::size_t count);
std::vector<double> readReals(const StreamRegion& region);
void writeReals(const StreamRegion& region, std::span<const double> values);
void fill(const StreamRegion& region, const void* element);
void copy(const StreamRegion& from, const StreamRegion& to);
StreamTexture textureOf(StreamState* state, int plane);
void fillBuffer(StreamState* state, std::uint32_t buffer, std::int64_t byteOffset, int plane);

}  // namespace detail

/// Elements of a stream, by reference: it must not outlive the stream. A view can be an input or an output of a
/// kernel wherever the stream can. A View<const T> cannot be written. After its device has ended, a view still has its
/// shape(), size() and region(); everything else throws sk::Error.
template <class T>
class View {
 public:
  using value_type = std::remove_const_t<T>;
  static constexpr bool isWritable = !std::is_const_v<T>;

  explicit View(const StreamRegion& region) : region_(region) {}
  /// A writable view converts to a read-only one.
  operator View<const value_type>() const
    requires isWritable
  {
    return View<const value_type>(region_);
  }

  /// Copies `elements`, row-major, to the region. Throws sk::Error unless there are exactly size() elements.
  void write(std::span<const value_type> elements) const
    requires isWritable
  {
    detail::write(region_, elements.data(), elements.size());
  }
  /// Writes bools from bytes: any nonzero byte is true.
  void write(std::span<const std::uint8_t> elements) const
    requires(isWritable && std::is_same_v<value_type, bool>)
  {
    detail::write(region_, elements.data(), elements.size());
  }
  void write(const std::vector<bool>& elements) const
    requires(isWritable && std::is_same_v<value_type, bool>)
  {
    auto bytes = detail::hostVector<std::uint8_t>(elements.size(), "write");
    for (std::size_t i = 0; i < bytes.size(); ++i) bytes[i] = elements[i] ? 1 : 0;
    detail::write(region_, bytes.data(), bytes.size());
  }

  /// Like write(), but does not wait for earlier work of the device. The caller may change `elements` as soon
  /// as this returns.
  void writeAsync(std::span<const value_type> elements) const
    requires isWritable
  {
    detail::writeAsync(region_, elements.data(), elements.size());
  }
  void writeAsync(std::span<const std::uint8_t> elements) const
    requires(isWritable && std::is_same_v<value_type, bool>)
  {
    detail::writeAsync(region_, elements.data(), elements.size());
  }

  /// Returns the elements of the region, row-major (bool: bytes of 0 and 1). Waits for the device.
  std::vector<HostElement<value_type>> read() const {
    auto elements = detail::hostVector<HostElement<value_type>>(static_cast<std::size_t>(size()), "read");
    detail::read(region_, elements.data(), elements.size());
    return elements;
  }
  /// Reads into the caller's memory. Throws sk::Error unless `elements` has exactly size() elements.
  void read(std::span<value_type> elements) const { detail::read(region_, elements.data(), elements.size()); }
  void read(std::span<std::uint8_t> elements) const
    requires std::is_same_v<value_type, bool>
  {
    detail::read(region_, elements.data(), elements.size());
  }

  /// Returns a future of the elements' current values, which later writes do not change; does not wait for
  /// the device. Throws sk::Error if there is no memory.
  Future<HostElement<value_type>> readAsync() const {
    return {detail::readAsync(region_), static_cast<std::size_t>(size())};
  }

  /// Returns the components of the elements, element by element, in the precision in which the device stores
  /// them: a reference device stores doubles. Throws sk::Error if a component is not a float.
  std::vector<double> readReals() const { return detail::readReals(region_); }
  /// Writes what readReals() returns, rounded to nearest if the storage is narrower. Throws sk::Error for
  /// another count.
  void writeReals(std::span<const double> components) const
    requires isWritable
  {
    detail::writeReals(region_, components);
  }

  /// Sets every element to `value`, on the device.
  void fill(const value_type& value) const
    requires isWritable
  {
    detail::fill(region_, &value);
  }
  /// Copies the elements to a region of the same shape; throws sk::Error for another shape. The regions may
  /// overlap and may be on different devices. On one device and with one storage, nothing goes through host
  /// memory.
  void copyTo(const View<value_type>& target) const { detail::copy(region_, target.region()); }
  void copyTo(Stream<value_type>& target) const { detail::copy(region_, target.region()); }

  /// The box from `begin` (inclusive) to `end` (exclusive) of this view, rows first. Throws sk::Error unless
  /// the box is inside the view.
  View domain(const Index& begin, const Index& end) const {
    return View(detail::partOf(region_, begin, end));
  }
  /// The same elements, in row-major order, in another shape; nothing is copied. Throws sk::Error if the shape has
  /// another number of elements, or if the view's elements do not lie at regular distances in it.
  View reshape(const Shape& shape) const { return View(detail::reshaped(region_, shape)); }

  /// The shape with which the view was made.
  const Shape& shape() const { return region_.shape; }
  std::int64_t size() const { return region_.shape.size(); }
  const StreamRegion& region() const { return region_; }

 private:
  StreamRegion region_;
};

/// Elements of type T on a device, undefined until they are written. Move-only. A stream that has outlived
/// its device, is default-constructed or was moved from can only be destroyed or assigned to; everything else
/// throws sk::Error, except operator bool, region() and handle(), which refer to a stream without using it, and size(),
/// which is 0 if there is no stream.
template <ElementType T>
class Stream {
 public:
  using value_type = T;

  /// Holds no stream: assign the result of Device::stream to it.
  Stream() = default;
  /// False if default-constructed or moved from. True if the device has ended.
  explicit operator bool() const noexcept { return state_.get() != nullptr; }

  /// Copies `elements`, row-major, to the stream. Throws sk::Error unless there are exactly size() elements.
  void write(std::span<const T> elements) { all().write(elements); }
  /// Writes bools from bytes: any nonzero byte is true.
  void write(std::span<const std::uint8_t> elements)
    requires std::is_same_v<T, bool>
  {
    all().write(elements);
  }
  void write(const std::vector<bool>& elements)
    requires std::is_same_v<T, bool>
  {
    all().write(elements);
  }

  /// Like write(), but does not wait for earlier work of the device. The caller may change `elements` as soon
  /// as this returns.
  void writeAsync(std::span<const T> elements) { all().writeAsync(elements); }
  void writeAsync(std::span<const std::uint8_t> elements)
    requires std::is_same_v<T, bool>
  {
    all().writeAsync(elements);
  }

  /// Returns the elements, row-major (bool: bytes of 0 and 1). Waits for the device.
  std::vector<HostElement<T>> read() const { return all().read(); }
  /// Reads into the caller's memory. Throws sk::Error unless `elements` has exactly size() elements.
  void read(std::span<T> elements) const { all().read(elements); }
  void read(std::span<std::uint8_t> elements) const
    requires std::is_same_v<T, bool>
  {
    all().read(elements);
  }

  /// Returns a future of the elements' current values, which later writes do not change. Does not wait for
  /// the device, unless a kernel has pushed to the stream and the number of elements is not known yet. Throws
  /// sk::Error if there is no memory.
  Future<HostElement<T>> readAsync() const { return all().readAsync(); }

  /// Returns the components of the elements, element by element, in the precision in which the device stores
  /// them: a reference device stores doubles. Throws sk::Error if a component is not a float.
  std::vector<double> readReals() const { return all().readReals(); }
  /// Writes what readReals() returns, rounded to nearest if the storage is narrower. Throws sk::Error for
  /// another count.
  void writeReals(std::span<const double> components) { all().writeReals(components); }

  /// Sets every element to `value`, on the device.
  void fill(const T& value) { all().fill(value); }
  /// Copies the elements to a stream or view of the same shape; throws sk::Error for another shape. Source
  /// and target may overlap and may be on different devices. On one device and with one storage, nothing goes
  /// through host memory.
  void copyTo(Stream& target) const { all().copyTo(target.all()); }
  void copyTo(const View<T>& target) const { all().copyTo(target); }

  /// The box from `begin` (inclusive) to `end` (exclusive), rows first. Throws sk::Error unless it is inside
  /// the stream.
  View<T> domain(const Index& begin, const Index& end) { return all().domain(begin, end); }
  View<const T> domain(const Index& begin, const Index& end) const { return all().domain(begin, end); }
  /// The elements, in row-major order, in another shape; nothing is copied. Throws sk::Error if the shape has another
  /// number of elements.
  View<T> reshape(const Shape& shape) { return all().reshape(shape); }
  View<const T> reshape(const Shape& shape) const { return all().reshape(shape); }

  /// After a kernel has pushed to the stream, the first call of one of these waits for that kernel. If default-constructed or
  /// moved from, the stream has size 0 and a shape of rank 0. Throws sk::Error if the device has ended.
  Shape shape() const { return detail::shapeOf(state_.get()); }
  std::int64_t size() const { return shape().size(); }
  /// What the call that gets the region checks: this does not throw if there is no stream or no device.
  StreamRegion region() const { return detail::wholeRegion(state_.get()); }

  /// The stream without its shape, so that this does not wait for pushes.
  StreamRegion handle() const { return {state_.get(), {}, {}}; }

  /// The texture of a plane, for drawing from it in the same (adopted) context. It is valid until a kernel
  /// next writes the stream: a call that both reads and writes the stream replaces the texture.
  StreamTexture texture(int plane = 0) const { return detail::textureOf(state_.get(), plane); }

  /// Copies a plane's elements, row-major and without gaps, to a GL buffer of the device's context, for
  /// example as vertex attributes; nothing goes through host memory. `byteOffset` is a multiple of 4.
  /// Elements have the texture's format: three components take the space of four, and halves stay halves.
  /// Throws sk::Error if the buffer is too small or the device has no GL.
  void fillBuffer(std::uint32_t buffer, std::int64_t byteOffset = 0, int plane = 0) const {
    detail::fillBuffer(state_.get(), buffer, byteOffset, plane);
  }

 private:
  friend class Device;
  friend struct detail::TypedStreams;
  explicit Stream(detail::StreamOwner state) : state_(std::move(state)) {}

  View<T> all() { return View<T>(region()); }
  View<const T> all() const { return View<const T>(region()); }

  detail::StreamOwner state_;
};

template <ElementType T>
StreamRegion regionOf(const Stream<T>& stream) {
  return stream.region();
}
template <class T>
StreamRegion regionOf(const View<T>& view) {
  return view.region();
}

/// Every steps[d]-th element of a stream or view in each dimension, from offsets[d] on (by default, from the first), rows
/// first: a view of the shape ceil((extent - offset) / step), to be read and written. Throws sk::Error unless there are a
/// step of at least 1 and an offset from 0 to the extent in every dimension.
template <ElementType T>
View<T> stride(Stream<T>& stream, const Index& steps, const Index& offsets = {}) {
  return View<T>(detail::strided(stream.region(), steps, offsets));
}
template <ElementType T>
View<const T> stride(const Stream<T>& stream, const Index& steps, const Index& offsets = {}) {
  return View<const T>(detail::strided(stream.region(), steps, offsets));
}
template <class T>
View<T> stride(const View<T>& view, const Index& steps, const Index& offsets = {}) {
  return View<T>(detail::strided(view.region(), steps, offsets));
}

/// Whether a reference to S may be an output: non-const streams, and writable views.
template <class S>
inline constexpr bool isWritable = false;
template <class T>
inline constexpr bool isWritable<Stream<T>> = true;
template <class T>
inline constexpr bool isWritable<View<T>> = View<T>::isWritable;
template <class T>
inline constexpr bool isWritable<const View<T>> = View<T>::isWritable;

}  // namespace sk
