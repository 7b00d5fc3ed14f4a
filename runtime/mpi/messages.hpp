// SPDX-License-Identifier: MIT
//
// Messages of bytes between ranks, and MPI's errors as sk::Error. MPI counts in 32 bits: longer messages go in pieces.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string_view>
#include <vector>

#include <mpi.h>

namespace sk::mpi {

/// Throws sk::Error unless an MPI function has succeeded.
void check(int status, std::string_view what);

/// A communicator that is freed, unless MPI has ended.
class Communicator {
 public:
  explicit Communicator(MPI_Comm communicator) : communicator_(communicator) {}
  ~Communicator();
  Communicator(const Communicator&) = delete;
  Communicator& operator=(const Communicator&) = delete;
  operator MPI_Comm() const { return communicator_; }

 private:
  MPI_Comm communicator_;
};

/// The bytes of one piece of a message.
inline constexpr std::size_t mostBytes = std::size_t{1} << 30;

/// Messages that are under way together.
class Messages {
 public:
  explicit Messages(MPI_Comm communicator) : communicator_(communicator) {}
  ~Messages();
  Messages(const Messages&) = delete;
  Messages& operator=(const Messages&) = delete;

  /// Posts a message; the bytes must stay as they are until wait().
  void send(const void* bytes, std::size_t count, int to, int tag);
  void receive(void* bytes, std::size_t count, int from, int tag);
  /// Waits for all that have been posted.
  void wait();

 private:
  MPI_Comm communicator_;
  std::vector<MPI_Request> requests_;
};

/// Copies bytes from `root` to all ranks.
void broadcast(MPI_Comm communicator, int root, void* bytes, std::size_t count);

}  // namespace sk::mpi
