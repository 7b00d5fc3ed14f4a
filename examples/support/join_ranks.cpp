// SPDX-License-Identifier: MIT
//
// Implements joinRanks() by sk::mpi.
#include "support/ranks.hpp"

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <limits>
#include <memory>
#include <thread>
#include <utility>

#include <fmt/format.h>
#include <sk/mpi.hpp>

namespace examples {
namespace {

template <class T>
class MpiStream final : public DividedStream<T> {
 public:
  MpiStream(std::shared_ptr<sk::Domain> domain, sk::Storage storage)
      : domain_(std::move(domain)), stream_(domain_->stream<T>(storage)) {}
  sk::StreamRegion region() const override { return stream_.region(); }
  void fill(const T& value) override { stream_.fill(value); }
  std::vector<T> gather() const override { return stream_.gather(); }
  void scatter(std::span<const T> elements) override { stream_.scatter(elements); }
  std::vector<double> gatherReals() const override { return stream_.gatherReals(); }
  void scatterReals(std::span<const double> components) override { stream_.scatterReals(components); }
  void copyTo(DividedStream<T>& target) const override {
    stream_.copyTo(dynamic_cast<MpiStream&>(target).stream_);
  }
  void copyTo(sk::Stream<T>& whole) const override { stream_.copyTo(whole); }
  void copyFrom(const sk::Stream<T>& whole) override { stream_.copyFrom(whole); }

 private:
  std::shared_ptr<sk::Domain> domain_;  ///< which the stream needs
  sk::DomainStream<T> stream_;
};

class MpiGrid final : public DividedGrid {
 public:
  MpiGrid(std::shared_ptr<sk::Domain> domain, Ends ends) : domain_(std::move(domain)), ends_(ends) {}
  MpiGrid(const std::string& device, const sk::Shape& shape, Ends ends)
      : MpiGrid(std::make_shared<sk::Domain>(MPI_COMM_WORLD, optionsOf(device, shape, ends)), ends) {}
  sk::Device& device() override { return domain_->device(); }
  int rank() const override { return domain_->rank(); }
  sk::Shape shape() const override { return domain_->shape(); }
  std::unique_ptr<DividedGrid> resized(const sk::Shape& shape) override {
    const sk::Index& split = domain_->split();
    for (int d = 0; d < split.rank(); ++d) {  // d counts from the fastest dimension
      const std::int64_t parts = split[split.rank() - 1 - d];
      const std::int64_t extent = d < shape.rank() ? shape[shape.rank() - 1 - d] : 1;
      if (extent < parts) return nullptr;
    }
    return std::make_unique<MpiGrid>(std::make_shared<sk::Domain>(*domain_, optionsOf("", shape, ends_)),
                                     ends_);
  }
  std::int64_t thinnest() const override {
    std::int64_t least = std::numeric_limits<std::int64_t>::max();
    for (int d = 0; d < domain_->shape().rank(); ++d) {
      if (domain_->split()[d] > 1 || domain_->ranks() == 1)
        least = std::min(least, domain_->shape()[d] / domain_->split()[d]);
    }
    return least;
  }
  void make(sk::Storage storage, std::unique_ptr<DividedStream<float>>& stream) override {
    fill(storage, stream);
  }
  void make(sk::Storage storage, std::unique_ptr<DividedStream<sk::float3>>& stream) override {
    fill(storage, stream);
  }
  void make(sk::Storage storage, std::unique_ptr<DividedStream<sk::float4>>& stream) override {
    fill(storage, stream);
  }
  void make(sk::Storage storage, std::unique_ptr<DividedStream<int>>& stream) override {
    fill(storage, stream);
  }
  void make(sk::Storage storage, std::unique_ptr<DividedStream<std::int8_t>>& stream) override {
    fill(storage, stream);
  }
  void make(sk::Storage storage, std::unique_ptr<DividedStream<sk::double3>>& stream) override {
    fill(storage, stream);
  }

 private:
  static sk::DomainOptions optionsOf(const std::string& device, const sk::Shape& shape, Ends ends) {
    sk::DomainOptions options;
    options.shape = shape;
    options.periodic.fill(ends == Ends::Joined);
    options.device.device = device;
    return options;
  }
  template <class T>
  void fill(sk::Storage storage, std::unique_ptr<DividedStream<T>>& stream) {
    stream = std::make_unique<MpiStream<T>>(domain_, storage);
  }

  std::shared_ptr<sk::Domain> domain_;
  Ends ends_;
};

class MpiRanks final : public Ranks {
 public:
  MpiRanks() {
    MPI_Init(nullptr, nullptr);
    MPI_Comm_rank(MPI_COMM_WORLD, &rank_);
    MPI_Comm_size(MPI_COMM_WORLD, &count_);
    MPI_Comm_dup(MPI_COMM_WORLD, &ends_);
    if (rank_ > 0 && std::freopen("/dev/null", "w", stdout) == nullptr) MPI_Abort(MPI_COMM_WORLD, 1);
  }
  ~MpiRanks() override {
    MPI_Comm_free(&ends_);
    MPI_Finalize();
  }
  MpiRanks(const MpiRanks&) = delete;
  MpiRanks& operator=(const MpiRanks&) = delete;

  int rank() const override { return rank_; }
  int count() const override { return count_; }
  std::string_view whyAlone() const override {
    return "it was built with another MPI; start it with the mpirun of that one";
  }
  std::unique_ptr<DividedGrid> divide(const std::string& device, const sk::Shape& shape, Ends ends) override {
    return divideGrid(device, shape, ends);
  }

  /// The first rank prints an error that all ranks throw. An error that only some ranks throw aborts the others.
  void end(const std::string& error) override {
    if (isFirst()) Ranks::end(error);
    const int own = error.empty() ? 0 : rank_ + 1;
    int first = 0;
    MPI_Request request = MPI_REQUEST_NULL;
    const int key = own == 0 ? count_ + 1 : own;  // the first rank with an error
    MPI_Iallreduce(&key, &first, 1, MPI_INT, MPI_MIN, ends_, &request);
    if (!isOver(request, own == 0 ? std::chrono::hours(24 * 365) : patience)) {
      if (!isFirst()) tell(error);
      MPI_Abort(MPI_COMM_WORLD, 1);
    }
    if (own > 0 && own == first && !isFirst()) tell(error);
  }

 private:
  /// How long a rank with an error waits for others to have theirs: these may still be writing a picture.
  static constexpr std::chrono::seconds patience{5};

  static bool isOver(MPI_Request& request, std::chrono::steady_clock::duration patience) {
    const auto end = std::chrono::steady_clock::now() + patience;
    for (;;) {
      int isDone = 0;
      MPI_Test(&request, &isDone, MPI_STATUS_IGNORE);
      if (isDone != 0) return true;
      if (std::chrono::steady_clock::now() >= end) return false;
      std::this_thread::sleep_for(std::chrono::milliseconds(2));
    }
  }
  void tell(const std::string& error) const {
    fmt::print(stderr, "rank {} of {}: {}\n", rank_, count_, error);
  }

  int rank_ = 0, count_ = 1;
  MPI_Comm ends_ = MPI_COMM_NULL;
};

}  // namespace

std::unique_ptr<Ranks> joinRanks() {
  if (startedProcesses() == 0) return std::make_unique<Ranks>();
  return std::make_unique<MpiRanks>();
}

std::unique_ptr<DividedGrid> divideGrid(const std::string& device, const sk::Shape& shape, Ends ends) {
  return std::make_unique<MpiGrid>(device, shape, ends);
}

}  // namespace examples
