// SPDX-License-Identifier: MIT
#include "messages.hpp"

#include <algorithm>
#include <string>

#include <fmt/format.h>

#include "sk/error.hpp"

namespace sk::mpi {

namespace {

/// Calls post(offset, bytes) for each piece of a message.
template <class Post>
void forEachPiece(std::size_t count, Post&& post) {
  for (std::size_t at = 0; at < count; at += mostBytes)
    post(at, static_cast<int>(std::min(mostBytes, count - at)));
}

}  // namespace

void check(int status, std::string_view what) {
  if (status == MPI_SUCCESS) return;
  char text[MPI_MAX_ERROR_STRING] = {};
  int length = 0;
  MPI_Error_string(status, text, &length);
  throw Error(
      fmt::format("{}: MPI has failed: {}", what, std::string_view(text, static_cast<std::size_t>(length))),
      Error::Kind::Lost);
}

Communicator::~Communicator() {
  int isOver = 0;
  MPI_Finalized(&isOver);
  if (isOver == 0) MPI_Comm_free(&communicator_);
}

// Messages that have been posted are received in any case: a later exchange would take them for its own.
Messages::~Messages() {
  MPI_Waitall(static_cast<int>(requests_.size()), requests_.data(), MPI_STATUSES_IGNORE);
}

void Messages::send(const void* bytes, std::size_t count, int to, int tag) {
  forEachPiece(count, [&](std::size_t at, int piece) {
    MPI_Request& request = requests_.emplace_back(MPI_REQUEST_NULL);
    check(MPI_Isend(static_cast<const std::byte*>(bytes) + at, piece, MPI_BYTE, to, tag, communicator_,
                    &request),
          "a message");
  });
}

void Messages::receive(void* bytes, std::size_t count, int from, int tag) {
  forEachPiece(count, [&](std::size_t at, int piece) {
    MPI_Request& request = requests_.emplace_back(MPI_REQUEST_NULL);
    check(MPI_Irecv(static_cast<std::byte*>(bytes) + at, piece, MPI_BYTE, from, tag, communicator_, &request),
          "a message");
  });
}

void Messages::wait() {
  const int status = MPI_Waitall(static_cast<int>(requests_.size()), requests_.data(), MPI_STATUSES_IGNORE);
  requests_.clear();
  check(status, "a message");
}

void broadcast(MPI_Comm communicator, int root, void* bytes, std::size_t count) {
  forEachPiece(count, [&](std::size_t at, int piece) {
    check(MPI_Bcast(static_cast<std::byte*>(bytes) + at, piece, MPI_BYTE, root, communicator), "a broadcast");
  });
}

}  // namespace sk::mpi
