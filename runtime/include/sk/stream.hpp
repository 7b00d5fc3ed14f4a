// SPDX-License-Identifier: MIT
//
// Streams: shaped, typed collections of elements on a device, and views of a region of one. A stream
// is made by Device::stream. Everything here is a typed face of a few functions without types; no
// GL is visible, but for the texture that holds a stream's elements.
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
class Device;
template <ElementType T>
class Stream;

/// A box of a stream's elements, its type forgotten: what kernels are called with.
struct StreamRegion {
  StreamState* stream = nullptr;
  Index begin = {};   ///< its first element
  Shape shape = {};   ///< its extents; the rank is the stream's
};

/// Where the elements of one plane of a stream lie: a scalar or vector element has one plane, a
/// struct one for each member of scalar or vector type, in order of declaration.
///
/// A stream of rank 1 or 2 whose extents fit the device's texture limit lies as it is: texel (x, y)
/// holds row y, column x, and `linear` is false (rank 1: one row). Any other, and one that a kernel has pushed
/// to, is linearised: element number i, row-major, is texel (i % width, i / width), and `width` is a power of two. Where
/// one such texture does not hold them, there are `layers` of them, one after the other, in an array texture. Nothing is
/// said of the texels after the last element, nor of the fourth channel of a vector of three. A bool is
/// an unsigned 0 or 1. The texture has one level and no filter.
struct StreamTexture {
  std::uint32_t name = 0;  ///< of the GL texture, 0 where the stream is empty
  std::uint32_t internalFormat = 0;  ///< GL_R32F, GL_RGBA32F, GL_R32I, GL_R8UI (bool) ...
  std::int32_t width = 0;
  std::int32_t height = 0;
  bool linear = false;
  std::int32_t layers = 0;  ///< 0: the target is GL_TEXTURE_2D, else GL_TEXTURE_2D_ARRAY
};

/// What a host array of T is made of: T itself, but bytes of 0 and 1 for bool, because a
/// std::vector<bool> is no array.
template <class T>
using HostElement = std::conditional_t<std::is_same_v<T, bool>, std::uint8_t, T>;

namespace detail {

struct StreamDeleter {
  void operator()(StreamState* state) const noexcept;
};
using StreamOwner = Owner<StreamState, StreamDeleter>;

StreamRegion wholeRegion(StreamState* state);
StreamRegion partOf(const StreamRegion& region, const Index& begin, const Index& end);
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

/// A box of a stream, by reference: it must not outlive the stream. It may be an input or an output
/// of a kernel wherever the stream may. View<const T> cannot be written.
template <class T>
class View {
 public:
  using value_type = std::remove_const_t<T>;
  static constexpr bool isWritable = !std::is_const_v<T>;

  explicit View(const StreamRegion& region) : region_(region) {}
  /// A view that may be written is one that may be read.
  operator View<const value_type>() const
    requires isWritable
  {
    return View<const value_type>(region_);
  }

  /// Copies `elements`, row-major, to the region. Throws sk::Error unless there are exactly size().
  void write(std::span<const value_type> elements) const
    requires isWritable
  {
    detail::write(region_, elements.data(), elements.size());
  }
  /// bool: bytes, any that is not 0 being true.
  void write(std::span<const std::uint8_t> elements) const
    requires(isWritable && std::is_same_v<value_type, bool>)
  {
    detail::write(region_, elements.data(), elements.size());
  }
  void write(const std::vector<bool>& elements) const
    requires(isWritable && std::is_same_v<value_type, bool>)
  {
    auto bytes = detail::hostVector<std::uint8_t>(elements.size());
    for (std::size_t i = 0; i < bytes.size(); ++i) bytes[i] = elements[i] ? 1 : 0;
    detail::write(region_, bytes.data(), bytes.size());
  }

  /// The same without waiting for what the device has been asked before. The memory may be changed as soon as this
  /// returns.
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

  /// The elements of the region, row-major (bool: bytes of 0 and 1). Waits for the device.
  std::vector<HostElement<value_type>> read() const {
    auto elements = detail::hostVector<HostElement<value_type>>(static_cast<std::size_t>(size()));
    detail::read(region_, elements.data(), elements.size());
    return elements;
  }
  /// The same into memory of the caller's, of exactly size() elements, else sk::Error.
  void read(std::span<value_type> elements) const { detail::read(region_, elements.data(), elements.size()); }
  void read(std::span<std::uint8_t> elements) const
    requires std::is_same_v<value_type, bool>
  {
    detail::read(region_, elements.data(), elements.size());
  }

  /// The elements as they are now, when somebody asks the future for them; returns without waiting for the device. What
  /// is written later does not change them. Throws sk::Error where there is no memory.
  Future<HostElement<value_type>> readAsync() const {
    return {detail::readAsync(region_), static_cast<std::size_t>(size())};
  }

  /// The components of the elements, which are floats, in the precision that the device holds them in: a
  /// reference device has doubles. One element after the other. Throws sk::Error where a component is no float.
  std::vector<double> readReals() const { return detail::readReals(region_); }
  /// The other way: `components` are as many as readReals() gives, else sk::Error. What holds less rounds them to nearest.
  void writeReals(std::span<const double> components) const
    requires isWritable
  {
    detail::writeReals(region_, components);
  }

  /// Gives every element this value, on the device.
  void fill(const value_type& value) const
    requires isWritable
  {
    detail::fill(region_, &value);
  }
  /// Copies the elements to a region of the same shape, else sk::Error. The two may overlap, and may be on different devices;
  /// on one device and in one storage, nothing goes through host memory.
  void copyTo(const View<value_type>& target) const { detail::copy(region_, target.region()); }

  /// The box from `begin` (inclusive) to `end` (exclusive) of this one, rows first. Throws sk::Error
  /// where it is not inside.
  View domain(const Index& begin, const Index& end) const {
    return View(detail::partOf(region_, begin, end));
  }

  const Shape& shape() const { return region_.shape; }
  std::int64_t size() const { return region_.shape.size(); }
  const StreamRegion& region() const { return region_; }

 private:
  StreamRegion region_;
};

/// Elements of type T on a device, in the shape that they were made with. Move-only. Its elements are
/// undefined until they are written. A stream may outlive its device, be default-constructed or be moved from: it can then be
/// destroyed and assigned to, and everything else throws sk::Error.
template <ElementType T>
class Stream {
 public:
  using value_type = T;

  /// No stream yet: Device::stream makes one to assign to it.
  Stream() = default;
  /// Whether there is a stream: false where it was default-constructed or moved from.
  explicit operator bool() const noexcept { return state_.get() != nullptr; }

  /// Copies `elements`, row-major, to the stream. Throws sk::Error unless there are exactly size().
  void write(std::span<const T> elements) { all().write(elements); }
  /// bool: bytes, any that is not 0 being true.
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

  /// The same without waiting for what the device has been asked before. The memory may be changed as soon as this
  /// returns.
  void writeAsync(std::span<const T> elements) { all().writeAsync(elements); }
  void writeAsync(std::span<const std::uint8_t> elements)
    requires std::is_same_v<T, bool>
  {
    all().writeAsync(elements);
  }

  /// The elements, row-major (bool: bytes of 0 and 1). Waits for the device.
  std::vector<HostElement<T>> read() const { return all().read(); }
  /// The same into memory of the caller's, of exactly size() elements, else sk::Error.
  void read(std::span<T> elements) const { all().read(elements); }
  void read(std::span<std::uint8_t> elements) const
    requires std::is_same_v<T, bool>
  {
    all().read(elements);
  }

  /// The elements as they are now, when somebody asks the future for them; returns without waiting for the device, unless
  /// a kernel has pushed to the stream and their number is not known yet. What is written later does not change them.
  /// Throws sk::Error where there is no memory.
  Future<HostElement<T>> readAsync() const { return all().readAsync(); }

  /// The components of the elements, which are floats, in the precision that the device holds them in: a
  /// reference device has doubles. One element after the other. Throws sk::Error where a component is no float.
  std::vector<double> readReals() const { return all().readReals(); }
  /// The other way: `components` are as many as readReals() gives, else sk::Error. What holds less rounds them to nearest.
  void writeReals(std::span<const double> components) { all().writeReals(components); }

  /// Gives every element this value, on the device.
  void fill(const T& value) { all().fill(value); }
  /// Copies the elements to a stream or a view of the same shape, else sk::Error. The two may overlap, and may be on different
  /// devices; on one device and in one storage, nothing goes through host memory.
  void copyTo(Stream& target) const { all().copyTo(target.all()); }
  void copyTo(const View<T>& target) const { all().copyTo(target); }

  /// The box from `begin` (inclusive) to `end` (exclusive), rows first. Throws sk::Error where it is
  /// not inside the stream.
  View<T> domain(const Index& begin, const Index& end) { return all().domain(begin, end); }
  View<const T> domain(const Index& begin, const Index& end) const { return all().domain(begin, end); }

  /// Where a kernel has pushed to the stream, the first of these that is called waits for it.
  Shape shape() const { return region().shape; }
  std::int64_t size() const { return region().shape.size(); }
  StreamRegion region() const { return detail::wholeRegion(state_.get()); }

  /// The stream without its shape, which is not asked for.
  StreamRegion handle() const { return {state_.get(), {}, {}}; }

  /// The texture of a plane, for drawing from it in the same context (an adopted one). It is good
  /// until a kernel next writes the stream: a call that reads and writes it puts another in its place.
  StreamTexture texture(int plane = 0) const { return detail::textureOf(state_.get(), plane); }

  /// Copies a plane's elements, row-major and without gaps, to a GL buffer of the device's context from `byteOffset` (a
  /// multiple of 4) on, without a trip through host memory: attributes of vertices, for one. They are as the texture has them, so that
  /// three components take the room of four, and of halves there are halves. Throws sk::Error where the buffer is too small, or
  /// the device has no GL.
  void fillBuffer(std::uint32_t buffer, std::int64_t byteOffset = 0, int plane = 0) const {
    detail::fillBuffer(state_.get(), buffer, byteOffset, plane);
  }

 private:
  friend class Device;
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

/// Whether a reference to S may be an output: streams that are not const, and views of such.
template <class S>
inline constexpr bool isWritable = false;
template <class T>
inline constexpr bool isWritable<Stream<T>> = true;
template <class T>
inline constexpr bool isWritable<View<T>> = View<T>::isWritable;
template <class T>
inline constexpr bool isWritable<const View<T>> = View<T>::isWritable;

}  // namespace sk
