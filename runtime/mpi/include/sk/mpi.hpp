// SPDX-License-Identifier: MIT
//
// Grids that are divided over the ranks of MPI (target sk::mpi). Every rank makes the same calls, in the same order: creating
// a domain and its streams, running kernels, reducing, scanning, gather(), scatter() and copyTo() are collective. Kernels and reductions are
// called as with ordinary streams, and the results are those of one device; skc knows how far a kernel reads, so halos are
// exchanged when a call needs them, and only as deep as it reads.
#pragma once

#ifndef OMPI_SKIP_MPICXX
#define OMPI_SKIP_MPICXX 1
#endif
#ifndef MPICH_SKIP_MPICXX
#define MPICH_SKIP_MPICXX 1
#endif
#include <mpi.h>

#include <algorithm>
#include <array>
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <vector>

#include "sk/call.hpp"
#include "sk/device.hpp"
#include "sk/future.hpp"
#include "sk/host_vector.hpp"
#include "sk/mpi_run.hpp"
#include "sk/options.hpp"
#include "sk/owner.hpp"
#include "sk/shape.hpp"
#include "sk/stream.hpp"

namespace sk {

struct DomainOptions {
  /// The extents of the whole, rows first.
  Shape shape = {};
  /// Whether the last elements of a dimension have the first ones as neighbors. Gathers with [[wrap]] that reach beyond
  /// their own element need it in every dimension that is divided.
  std::array<bool, maxRank> periodic = {};
  /// The number of parts in each dimension; their product is the number of ranks. If empty, the grid with the least surface.
  Index split = {};
  /// How many calls that read neighbors share an exchange. Halos are deeper by this factor, and the elements in them are
  /// computed by both sides. Fewer messages, more work.
  int exchangeEvery = 1;
  /// Whether a call computes elements that need no halo while messages are under way.
  bool overlap = true;
  /// The device of this rank. If `device` of these options is empty, SK_DEVICE decides, and without it: GPU number r modulo
  /// the number of GPUs, for the rank that is number r on its host; without GPUs, as for any sk::Device.
  DeviceOptions device = {};
};

/// What this rank has sent since the domain was created, or since resetStatistics().
struct DomainStatistics {
  std::int64_t exchanges = 0;  ///< calls that exchanged halos
  std::int64_t messages = 0;  ///< sent for halos
  std::int64_t bytes = 0;  ///< in these messages
  std::int64_t reductions = 0;  ///< collective steps of reductions

  bool operator==(const DomainStatistics&) const = default;
};

class DomainState;  // the library's own
class DomainStreamState;

namespace detail {

struct DomainDeleter {
  void operator()(DomainState* state) const noexcept;
  void operator()(DomainStreamState* state) const noexcept;
};
using DomainOwner = Owner<DomainState, DomainDeleter>;
using DomainStreamOwner = Owner<DomainStreamState, DomainDeleter>;

StreamRegion regionOf(DomainStreamState* stream);
const Box& ownBox(const DomainStreamState* stream);
/// Calls visit(context, region) for the elements of this rank on its device.
using OwnVisit = void (*)(void* context, const StreamRegion& region);
void readOwn(DomainStreamState* stream, OwnVisit visit, void* context);
/// What visit() writes, all elements: one value, which needs no other rank, or what the application gives or computes, which it may
/// do wrong on one rank alone, so that the ranks agree on it.
enum class OwnWrite : std::uint8_t { Value, Function, Elements };
void writeOwn(DomainStreamState* stream, OwnWrite kind, OwnVisit visit, void* context);
/// On the root, room(context, count) allocates all elements and returns where
/// they are.
void gather(DomainStreamState* stream, int root, void* (*room)(void*, std::size_t), void* context);
void scatter(DomainStreamState* stream, int root, const void* elements, std::size_t count);
std::vector<double> gatherReals(DomainStreamState* stream, int root);
void scatterReals(DomainStreamState* stream, int root, std::span<const double> components);
void copyOwn(DomainStreamState* from, DomainStreamState* to);
void copyToWhole(DomainStreamState* stream, const StreamRegion& whole);
void copyFromWhole(DomainStreamState* stream, const StreamRegion& whole);
void save(DomainStreamState* stream, const std::string& file);
void load(DomainStreamState* stream, const std::string& file);
/// Starts the reduction that call(context) calls.
TransferOwner later(DomainState* domain, void (*call)(void*), void* context);

}  // namespace detail

/// A stream over all elements of a domain, of which each rank holds its own box. Move-only; an argument of kernels,
/// reductions and scans wherever an ordinary stream can be, but not of scatter outputs and variable outputs. A stream that has
/// outlived its domain throws sk::Error.
template <ElementType T>
class DomainStream {
 public:
  using value_type = T;

  DomainStream() = default;
  explicit operator bool() const noexcept { return state_.get() != nullptr; }

  /// The extents of the whole.
  Shape shape() const { return region().shape; }
  std::int64_t size() const { return region().shape.size(); }
  /// The box of this rank, in indices of the whole.
  Box own() const { return detail::ownBox(state_.get()); }

  /// Sets every element to a value, or to start(index), where the index is that of the whole, rows first. Every rank must call it; the
  /// second is collective, and throws on all ranks what start() throws on one of them.
  void fill(const T& value) {
    write(detail::OwnWrite::Value, [&](const View<T>& own) { own.fill(value); });
  }
  template <std::invocable<const Index&> Start>
    requires std::convertible_to<std::invoke_result_t<Start, const Index&>, T>
  void fill(Start&& start);

  /// The elements of this rank, row-major. Not collective.
  std::vector<HostElement<T>> read() const {
    std::vector<HostElement<T>> elements;
    detail::readOwn(
        state_.get(),
        [](void* to, const StreamRegion& own) {
          *static_cast<std::vector<HostElement<T>>*>(to) = View<const T>(own).read();
        },
        &elements);
    return elements;
  }
  /// Writes the elements of this rank: exactly own()'s, row-major. Collective: every rank must write its own. Throws sk::Error on all
  /// ranks if one of them gives another number of elements.
  void write(std::span<const HostElement<T>> elements) {
    write(detail::OwnWrite::Elements, [&](const View<T>& own) { own.write(elements); });
  }

  /// All elements, row-major, on rank `root`; nothing on the others.
  std::vector<HostElement<T>> gather(int root = 0) const {
    std::vector<HostElement<T>> elements;
    const auto room = [](void* to, std::size_t number) -> void* {
      auto& whole = *static_cast<std::vector<HostElement<T>>*>(to);
      whole = detail::hostVector<HostElement<T>>(number);
      return whole.data();
    };
    detail::gather(state_.get(), root, room, &elements);
    return elements;
  }
  /// Distributes the elements that rank `root` gives, all of them, row-major; the other ranks' are ignored.
  void scatter(std::span<const HostElement<T>> elements, int root = 0) {
    detail::scatter(state_.get(), root, elements.data(), elements.size());
  }

  /// The components of all elements, element by element, in the precision in which they are stored (Stream::readReals), on
  /// rank `root`; nothing on the others. Throws sk::Error if a component is not a float.
  std::vector<double> gatherReals(int root = 0) const { return detail::gatherReals(state_.get(), root); }
  /// Distributes what rank `root` gives of what gatherReals() returns, rounded to nearest if the storage is narrower; what the
  /// other ranks give is ignored.
  void scatterReals(std::span<const double> components, int root = 0) {
    detail::scatterReals(state_.get(), root, components);
  }

  /// Collective: every rank gives an ordinary stream on domain.device() with this shape and storage, which gets all elements with
  /// their bits. They pass through host memory. Throws sk::Error if the shape, the storage or the device is another one.
  void copyTo(Stream<T>& whole) const { detail::copyToWhole(state_.get(), whole.region()); }
  /// Copies every rank's own elements to a stream of the same domain, on the devices and without messages. Throws sk::Error if the
  /// domain is another one.
  void copyTo(DomainStream& target) const { detail::copyOwn(state_.get(), target.state_.get()); }
  /// Takes this rank's own elements from an ordinary stream like that of copyTo(), on the device and without messages. Not
  /// collective, but every rank must do it. Throws sk::Error as copyTo() does.
  void copyFrom(const Stream<T>& whole) { detail::copyFromWhole(state_.get(), whole.region()); }

  /// Writes all elements to a .npy file, which NumPy reads, together with the other ranks (MPI-IO). The file appears under its name
  /// when it is whole; until then, or if that fails, an older file of the name stays. Throws sk::Error on all ranks if it
  /// cannot be written. Streams that are stored in doubles are written as doubles.
  void save(const std::string& file) const { detail::save(state_.get(), file); }
  /// Reads all elements from a .npy file of this shape and type, which any number of ranks may have written. Throws sk::Error on
  /// all ranks if it is another one.
  void load(const std::string& file) { detail::load(state_.get(), file); }

  StreamRegion region() const { return detail::regionOf(state_.get()); }
  DomainStreamState* state() const noexcept { return state_.get(); }

 private:
  friend class Domain;
  explicit DomainStream(detail::DomainStreamOwner state) : state_(std::move(state)) {}

  template <std::invocable<const View<T>&> Write>
  void write(detail::OwnWrite kind, Write&& visit) {
    detail::writeOwn(
        state_.get(), kind,
        [](void* call, const StreamRegion& own) {
          (*static_cast<std::remove_reference_t<Write>*>(call))(View<T>(own));
        },
        const_cast<void*>(static_cast<const void*>(&visit)));
  }

  detail::DomainStreamOwner state_;
};

template <ElementType T>
StreamRegion regionOf(const DomainStream<T>& stream) {
  return stream.region();
}
template <class T>
inline constexpr bool isWritable<DomainStream<T>> = true;

/// Divides a box of elements over the ranks of a communicator, and runs kernels on the parts. Move-only. It must be
/// destroyed before MPI_Finalize, and its streams should be destroyed before it.
class Domain {
 public:
  /// Collective. Throws sk::Error if MPI has not been initialized, if the ranks cannot divide the shape, or if they do not
  /// agree on the options. The communicator is duplicated.
  Domain(MPI_Comm communicator, const DomainOptions& options);
  /// Another grid on the ranks and the device of `beside`, so that kernels may read streams of both. Collective. Without
  /// `options.split`, it is divided in as many parts as the other one, in dimensions that are counted from the fastest;
  /// `options.device` does not count. Throws sk::Error as above.
  Domain(const Domain& beside, const DomainOptions& options);
  ~Domain() = default;
  Domain(Domain&&) noexcept = default;
  Domain& operator=(Domain&&) noexcept = default;

  /// Creates a stream with undefined elements; the arguments are those of Device::stream.
  template <ElementType T>
  DomainStream<T> stream(Storage storage = Storage::Default, std::string_view name = {}) {
    return DomainStream<T>(createStream(ElementTraits<T>::element(), storage, name));
  }
  detail::DomainStreamOwner createStream(const program::Element& element, Storage storage = Storage::Default,
                                         std::string_view name = {});

  const Shape& shape() const;
  /// The number of parts in each dimension; ranks are numbered in row-major order of the parts.
  const Index& split() const;
  int rank() const;
  int ranks() const;
  /// The box of this or of another rank, in indices of the whole.
  Box own() const { return own(rank()); }
  Box own(int rank) const;
  /// This rank's device. Ordinary streams on it may be arguments beside those of the domain: as tables that kernels
  /// read anywhere, the same on every rank, and for uniforms.
  Device& device();
  /// The duplicate of the communicator.
  MPI_Comm communicator() const;

  /// Starts a reduction to one value, as in `domain.later(sum, u)`, and does not wait for other ranks. The future has one
  /// element; get() combines what all ranks have folded. It must be asked or destroyed before the domain ends, on its thread.
  /// Later calls may write `u`.
  template <class Reduce, class... Arguments>
  auto later(const Reduce& reduce, const Arguments&... arguments)
      -> Future<std::remove_cvref_t<decltype(reduce(arguments...))>> {
    const auto call = [&] { (void)reduce(arguments...); };
    return {detail::later(
                state_.get(), [](void* context) { (*static_cast<decltype(call)*>(context))(); },
                const_cast<void*>(static_cast<const void*>(&call))),
            1};
  }

  const DomainStatistics& statistics() const;
  void resetStatistics();

 private:
  detail::DomainOwner state_;
};

template <ElementType T>
template <std::invocable<const Index&> Start>
  requires std::convertible_to<std::invoke_result_t<Start, const Index&>, T>
void DomainStream<T>::fill(Start&& start) {
  write(detail::OwnWrite::Function, [&](const View<T>& own) {
    const Box box = this->own();
    const int rank = box.begin.rank();
    const std::int64_t row = box.end[rank - 1] - box.begin[rank - 1];
    auto values = detail::hostVector<HostElement<T>>(static_cast<std::size_t>(own.size()));
    Index index = box.begin;
    for (std::size_t at = 0; at < values.size();) {
      for (std::int64_t x = 0; x < row; ++x, ++at) {
        index[rank - 1] = box.begin[rank - 1] + x;
        values[at] = static_cast<HostElement<T>>(start(std::as_const(index)));
      }
      for (int d = rank - 2; d >= 0 && ++index[d] == box.end[d]; --d) index[d] = box.begin[d];
    }
    own.write(std::span<const HostElement<T>>(values));
  });
}

}  // namespace sk
