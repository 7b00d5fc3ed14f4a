// SPDX-License-Identifier: MIT
//
// Messages of bytes between ranks, and MPI's errors as sk::Error. MPI counts in 32 bits: longer messages go in pieces.
//
// Waits have a limit, SK_MPI_TIMEOUT: a rank that waits longer than this for other ranks says on
// standard error in which call, once, and goes on waiting. MPI has no way to
// give up what other ranks may still answer. Without the variable, waits are
// those of MPI.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>
#include <utility>
#include <vector>

#include <mpi.h>

namespace sk::mpi {

class WaitLimit {
 public:
  /// Reads SK_MPI_TIMEOUT, in seconds. Throws sk::Error unless it is a number
  /// above 0.
  static double secondsOfEnvironment();

  void setRank(int rank, int ranks) {
    rank_ = rank;
    ranks_ = ranks;
  }
  /// 0: there is no limit.
  void setSeconds(double seconds) { seconds_ = seconds; }
  bool isSet() const { return seconds_ > 0; }
  /// What is waited for from now on: the call, and how many calls there have
  /// been.
  void enter(std::string_view what, std::uint64_t number) {
    what_ = what;
    number_ = number;
  }

  /// Waits for all requests. `statuses` has one for each, or is empty. Returns
  /// an error of MPI.
  int wait(std::span<MPI_Request> requests, std::span<MPI_Status> statuses = {}) const;

 private:
  void report() const;

  int rank_ = 0, ranks_ = 1;
  double seconds_ = 0;
  std::string_view what_ = "a call";
  std::uint64_t number_ = 0;
};

/// Throws sk::Error unless an MPI function has succeeded.
void check(int status, std::string_view what);

/// Begins an operation of MPI by begin(&request). What MPI refuses, for lack of
/// memory, say, is tried a second time. Returns an error of that.
template <class Begin>
int begun(MPI_Request& request, Begin&& begin) {
  request = MPI_REQUEST_NULL;
  if (begin(&request) == MPI_SUCCESS) return MPI_SUCCESS;
  request = MPI_REQUEST_NULL;
  return begin(&request);
}

/// A communicator that is freed, unless MPI has ended.
class Communicator {
 public:
  explicit Communicator(MPI_Comm communicator) : communicator_(communicator) {}
  ~Communicator();
  Communicator(Communicator&& other) noexcept
      : communicator_(std::exchange(other.communicator_, MPI_COMM_NULL)) {}
  Communicator(const Communicator&) = delete;
  Communicator& operator=(const Communicator&) = delete;
  operator MPI_Comm() const { return communicator_; }
  /// Calls make(&communicator), a function of MPI, for one that is null.
  /// Returns its status.
  template <class Make>
  int become(Make&& make) {
    return make(&communicator_);
  }

 private:
  MPI_Comm communicator_;
};

/// A datatype that is freed.
class Datatype {
 public:
  /// `make` is a function of MPI that makes one. Throws sk::Error if it fails.
  template <class Make>
  Datatype(std::string_view what, Make&& make) {
    check(make(&type_), what);
    if (const int status = MPI_Type_commit(&type_); status != MPI_SUCCESS) {
      MPI_Type_free(&type_);
      check(status, what);
    }
  }
  ~Datatype() { MPI_Type_free(&type_); }
  Datatype(const Datatype&) = delete;
  Datatype& operator=(const Datatype&) = delete;
  operator MPI_Datatype() const { return type_; }

 private:
  MPI_Datatype type_ = MPI_DATATYPE_NULL;
};

/// The bytes of one piece of a message.
inline constexpr std::size_t mostBytes = std::size_t{1} << 30;

/// Messages that are under way together. Each of them is completed, whatever
/// happens: a later call would take it for its own.
class Messages {
 public:
  /// The limit must outlive the messages.
  Messages(MPI_Comm communicator, const WaitLimit& limit) : communicator_(communicator), limit_(limit) {}
  ~Messages();
  Messages(const Messages&) = delete;
  Messages& operator=(const Messages&) = delete;

  /// Makes room for the requests of a message of `count` bytes, so that posting it allocates nothing.
  void reserve(std::size_t count);
  /// Posts a message; the bytes must stay as they are until wait(). What MPI
  /// refuses is posted a second time. Throws sk::Error if it refuses that, too.
  void send(const void* bytes, std::size_t count, int to, int tag);
  void receive(void* bytes, std::size_t count, int from, int tag);
  /// Posts an empty message instead of one of `count` bytes: the receiver's wait() then throws.
  void sendNothing(std::size_t count, int to, int tag);
  /// Waits for all that have been posted. Throws sk::Error if MPI has failed,
  /// or if a rank had nothing to send.
  void wait();

 private:
  int complete();
  template <class Post>
  void post(int expected, Post&& post);

  MPI_Comm communicator_;
  const WaitLimit& limit_;
  std::vector<MPI_Request> requests_;
  std::vector<MPI_Status> statuses_;
  std::vector<int> expected_;  ///< bytes of each; of messages that are sent -1
};

/// Copies bytes from `root` to all ranks.
void broadcast(MPI_Comm communicator, int root, void* bytes, std::size_t count);

}  // namespace sk::mpi
