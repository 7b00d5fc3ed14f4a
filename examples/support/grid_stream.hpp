// SPDX-License-Identifier: MIT
//
// The streams of a grid, which are on one device or divided over the ranks of MPI. Kernels and reductions take either kind, so
// that an example says once what it computes. This header knows no MPI; join_ranks.hpp makes what is divided.
#pragma once

#include <memory>
#include <span>
#include <stdexcept>
#include <utility>
#include <vector>

#include <sk/sk.hpp>

namespace examples {

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
};

/// A grid of which each rank has a part, with a device of its own.
class DividedGrid {
 public:
  virtual ~DividedGrid() = default;
  virtual sk::Device& device() = 0;
  virtual int rank() const = 0;
  virtual sk::Shape shape() const = 0;
  /// Streams of those elements that examples divide.
  virtual void make(sk::Storage storage, std::unique_ptr<DividedStream<float>>& stream) = 0;
  virtual void make(sk::Storage storage, std::unique_ptr<DividedStream<sk::float3>>& stream) = 0;
  virtual void make(sk::Storage storage, std::unique_ptr<DividedStream<sk::float4>>& stream) = 0;
  virtual void make(sk::Storage storage, std::unique_ptr<DividedStream<int>>& stream) = 0;
  virtual void make(sk::Storage storage, std::unique_ptr<DividedStream<sk::double3>>& stream) = 0;
};

/// A stream over all elements of a grid: an argument wherever a sk::Stream can be one. Move-only.
template <class T>
class GridStream {
 public:
  using value_type = T;

  GridStream(sk::Stream<T> whole, sk::Storage storage) : whole_(std::move(whole)), storage_(storage) {}
  GridStream(std::unique_ptr<DividedStream<T>> divided, sk::Storage storage)
      : divided_(std::move(divided)), storage_(storage) {}

  sk::StreamRegion region() const { return divided_ ? divided_->region() : whole_.region(); }
  sk::Storage storage() const { return storage_; }
  bool isDivided() const { return divided_ != nullptr; }
  /// The stream that has all elements on one device. Throws std::logic_error if they are divided.
  const sk::Stream<T>& whole() const {
    if (isDivided()) throw std::logic_error("the elements of a stream are divided over ranks");
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

 private:
  sk::Stream<T> whole_;
  std::unique_ptr<DividedStream<T>> divided_;
  sk::Storage storage_;
};

template <class T>
sk::StreamRegion regionOf(const GridStream<T>& stream) {
  return stream.region();
}

/// Where the streams of a grid are. A reference: the device or the divided grid must outlive it and the streams.
class Space {
 public:
  Space(sk::Device& device, const sk::Shape& shape) : device_(&device), shape_(shape) {}
  explicit Space(DividedGrid& grid) : device_(&grid.device()), grid_(&grid), shape_(grid.shape()) {}

  /// This process's device.
  sk::Device& device() const { return *device_; }
  const sk::Shape& shape() const { return shape_; }
  bool isDivided() const { return grid_ != nullptr; }
  /// Whether this is the process that has what GridStream::readReals() returns, and that writes files.
  bool isFirst() const { return grid_ == nullptr || grid_->rank() == 0; }

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
  DividedGrid* grid_ = nullptr;
  sk::Shape shape_;
};

}  // namespace examples

template <class T>
inline constexpr bool sk::isWritable<examples::GridStream<T>> = true;
