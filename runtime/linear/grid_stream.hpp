// SPDX-License-Identifier: MIT
//
// The streams of a grid, which are on one device or divided over the ranks of MPI. Kernels and reductions take either kind, so
// that an example says once what it computes. This header knows no MPI; joinRanks() makes what is divided.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <stdexcept>
#include <utility>
#include <vector>

#include <sk/sk.hpp>

namespace sk::linear {

/// A stream of which each rank holds a part. All its functions are collective.
template <class T>
class DividedStream {
 public:
  virtual ~DividedStream() = default;
  virtual sk::StreamRegion region() const = 0;
  virtual void fill(const T& value) = 0;
  virtual std::vector<T> gather() const = 0;
  virtual void scatter(std::span<const T> elements) = 0;
  virtual std::vector<double> gatherReals() const = 0;
  virtual void scatterReals(std::span<const double> components) = 0;
  /// Copies to a stream of the same grid.
  virtual void copyTo(DividedStream& target) const = 0;
  /// All elements, to a stream that each rank has for itself, and from one.
  virtual void copyTo(sk::Stream<T>& whole) const = 0;
  virtual void copyFrom(const sk::Stream<T>& whole) = 0;
};

/// A grid of which each rank has a part, with a device of its own.
class DividedGrid {
 public:
  virtual ~DividedGrid() = default;
  virtual sk::Device& device() = 0;
  virtual int rank() const = 0;
  virtual sk::Shape shape() const = 0;
  /// A grid of other extents on the same ranks and devices, divided in as many parts in each dimension; null if an extent
  /// has not as many elements.
  virtual std::unique_ptr<DividedGrid> resized(const sk::Shape& shape) = 0;
  /// The fewest elements that a part has in a dimension that is divided; of one part, in any.
  virtual std::int64_t thinnest() const = 0;
  /// Streams of those elements that examples divide.
  virtual void make(sk::Storage storage, std::unique_ptr<DividedStream<float>>& stream) = 0;
  virtual void make(sk::Storage storage, std::unique_ptr<DividedStream<sk::float3>>& stream) = 0;
  virtual void make(sk::Storage storage, std::unique_ptr<DividedStream<sk::float4>>& stream) = 0;
  virtual void make(sk::Storage storage, std::unique_ptr<DividedStream<int>>& stream) = 0;
  virtual void make(sk::Storage storage, std::unique_ptr<DividedStream<std::int8_t>>& stream) = 0;
  virtual void make(sk::Storage storage, std::unique_ptr<DividedStream<sk::double3>>& stream) = 0;
};

/// A stream over all elements of a grid: an argument wherever a sk::Stream can be one. Move-only.
template <class T>
class GridStream {
 public:
  using value_type = T;

  /// Holds no stream.
  GridStream() = default;
  GridStream(sk::Stream<T> whole, sk::Storage storage = sk::Storage::Default)
      : whole_(std::move(whole)), storage_(storage) {}
  GridStream(std::unique_ptr<DividedStream<T>> divided, sk::Storage storage)
      : divided_(std::move(divided)), storage_(storage) {}

  explicit operator bool() const { return isDivided() || static_cast<bool>(whole_); }
  sk::StreamRegion region() const { return divided_ ? divided_->region() : whole_.region(); }
  sk::Shape shape() const { return region().shape; }
  std::int64_t size() const { return shape().size(); }
  sk::Storage storage() const { return storage_; }
  bool isDivided() const { return divided_ != nullptr; }
  /// The stream that has all elements on one device. Throws std::logic_error if they are divided.
  const sk::Stream<T>& whole() const {
    requireWhole();
    return whole_;
  }
  sk::Stream<T>& whole() {
    requireWhole();
    return whole_;
  }

  void fill(const T& value) { divided_ ? divided_->fill(value) : whole_.fill(value); }
  /// All elements, row-major. If the stream is divided: on rank 0, and none on the others.
  std::vector<T> read() const { return divided_ ? divided_->gather() : whole_.read(); }
  /// Writes all elements. If the stream is divided, rank 0 gives them.
  void write(std::span<const T> elements) { divided_ ? divided_->scatter(elements) : whole_.write(elements); }
  /// The components of all elements, in the precision in which they are stored. If the stream is divided: on rank 0, and none on the others.
  std::vector<double> readReals() const { return divided_ ? divided_->gatherReals() : whole_.readReals(); }
  /// Writes all elements. If the stream is divided, rank 0 gives them.
  void writeReals(std::span<const double> components) {
    divided_ ? divided_->scatterReals(components) : whole_.writeReals(components);
  }

  /// Copies all elements to a stream of the same shape. Of two streams, one or both may be divided: what is whole is
  /// then on every rank.
  void copyTo(GridStream& target) const {
    if (divided_ && target.divided_)
      divided_->copyTo(*target.divided_);
    else if (divided_)
      divided_->copyTo(target.whole_);
    else if (target.divided_)
      target.divided_->copyFrom(whole_);
    else
      whole_.copyTo(target.whole_);
  }

  /// Views of a stream that is on one device.
  sk::View<T> reshape(const sk::Shape& shape) { return whole().reshape(shape); }
  sk::View<const T> reshape(const sk::Shape& shape) const { return whole().reshape(shape); }
  sk::View<T> domain(const sk::Index& begin, const sk::Index& end) { return whole().domain(begin, end); }
  sk::View<const T> domain(const sk::Index& begin, const sk::Index& end) const {
    return whole().domain(begin, end);
  }

 private:
  void requireWhole() const {
    if (isDivided()) throw std::logic_error("the elements of a stream are divided over ranks");
  }

  sk::Stream<T> whole_;
  std::unique_ptr<DividedStream<T>> divided_;
  sk::Storage storage_ = sk::Storage::Default;
};

template <class T>
sk::StreamRegion regionOf(const GridStream<T>& stream) {
  return stream.region();
}

/// Where the streams of a grid are. The device, or the divided grid that a Space was made of, must outlive it and the streams.
class Space {
 public:
  Space(sk::Device& device, const sk::Shape& shape) : device_(&device), shape_(shape) {}
  explicit Space(DividedGrid& grid)
      : device_(&grid.device()), grid_(std::shared_ptr<DividedGrid>(), &grid), shape_(grid.shape()) {}

  /// This process's device.
  sk::Device& device() const { return *device_; }
  const sk::Shape& shape() const { return shape_; }
  bool isDivided() const { return grid_ != nullptr; }
  /// Whether this is the process that has what GridStream::readReals() returns, and that writes files.
  bool isFirst() const { return grid_ == nullptr || grid_->rank() == 0; }
  /// The fewest elements that a part has in a dimension that is divided; of one part, in any. The space must be divided.
  std::int64_t thinnest() const { return grid_->thinnest(); }

  /// Streams of another shape in the same place, or on this process's device alone where that cannot be divided. Collective.
  Space resized(const sk::Shape& shape) const {
    if (shape == shape_) return *this;
    Space other(*device_, shape);
    if (isDivided()) other.grid_ = grid_->resized(shape);
    return other;
  }
  /// Streams of the same shape on this process's device alone.
  Space undivided() const { return {*device_, shape_}; }

  /// Undefined until it is written. Collective.
  template <class T>
  GridStream<T> stream(sk::Storage storage = sk::Storage::Default) const {
    if (grid_ == nullptr) return {device_->stream<T>(shape_, storage), storage};
    std::unique_ptr<DividedStream<T>> divided;
    grid_->make(storage, divided);
    return {std::move(divided), storage};
  }

 private:
  sk::Device* device_;
  std::shared_ptr<DividedGrid> grid_;
  sk::Shape shape_;
};

/// All elements of streams on the first process's device, as pictures need them.
template <class T>
class Gathered {
 public:
  /// The stream itself, if it is not divided. Otherwise a copy, until the next call: on rank 0, and no stream on the others.
  const sk::Stream<T>& of(const GridStream<T>& stream, sk::Device& device) {
    if (!stream.isDivided()) return stream.whole();
    copy_ = {};
    const std::vector<double> components = stream.readReals();
    if (components.empty()) return copy_;
    copy_ = device.stream<T>(stream.shape(), stream.storage());
    copy_.writeReals(components);
    return copy_;
  }

 private:
  sk::Stream<T> copy_;
};

}  // namespace sk::linear

template <class T>
inline constexpr bool sk::isWritable<sk::linear::GridStream<T>> = true;
