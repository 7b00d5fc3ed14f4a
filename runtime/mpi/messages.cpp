// SPDX-License-Identifier: MIT
#include "messages.hpp"

#include <algorithm>
#include <string>
#include <utility>

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
  if (communicator_ == MPI_COMM_NULL) return;
  int isOver = 0;
  MPI_Finalized(&isOver);
  if (isOver == 0) MPI_Comm_free(&communicator_);
}

Messages::~Messages() {
  if (!requests_.empty()) complete();  // never after wait()
}

void Messages::reserve(std::size_t count) {
  const std::size_t messages = requests_.capacity() + (count + mostBytes - 1) / mostBytes;
  requests_.reserve(messages);
  expected_.reserve(messages);
  statuses_.reserve(messages);
}

template <class Post>
void Messages::post(int expected, Post&& post) {
  expected_.push_back(expected);
  statuses_.emplace_back();
  MPI_Request& request = requests_.emplace_back(MPI_REQUEST_NULL);
  const int status = begun(request, post);
  if (status == MPI_SUCCESS) return;
  requests_.pop_back();
  expected_.pop_back();
  statuses_.pop_back();
  check(status, "a message");
}

void Messages::send(const void* bytes, std::size_t count, int to, int tag) {
  forEachPiece(count, [&](std::size_t at, int piece) {
    post(-1, [&](MPI_Request* request) {
      return MPI_Isend(static_cast<const std::byte*>(bytes) + at, piece, MPI_BYTE, to, tag, communicator_,
                       request);
    });
  });
}

void Messages::sendNothing(std::size_t count, int to, int tag) {
  forEachPiece(count, [&](std::size_t, int) {
    post(-1, [&](MPI_Request* request) {
      return MPI_Isend(nullptr, 0, MPI_BYTE, to, tag, communicator_, request);
    });
  });
}

void Messages::receive(void* bytes, std::size_t count, int from, int tag) {
  forEachPiece(count, [&](std::size_t at, int piece) {
    post(piece, [&](MPI_Request* request) {
      return MPI_Irecv(static_cast<std::byte*>(bytes) + at, piece, MPI_BYTE, from, tag, communicator_,
                       request);
    });
  });
}

/// Completes all, also if MPI fails in between, and returns an error of MPI.
int Messages::complete() {
  const int status = limit_.wait(requests_, statuses_);
  for (std::size_t i = 0; status != MPI_SUCCESS && i < requests_.size(); ++i) {
    if (requests_[i] != MPI_REQUEST_NULL) MPI_Wait(&requests_[i], &statuses_[i]);
  }
  requests_.clear();
  return status;
}

void Messages::wait() {
  const int status = complete();
  int silent = -1;
  for (std::size_t i = 0; status == MPI_SUCCESS && i < expected_.size(); ++i) {
    int count = 0;
    if (expected_[i] >= 0) MPI_Get_count(&statuses_[i], MPI_BYTE, &count);
    if (count < expected_[i]) silent = statuses_[i].MPI_SOURCE;
  }
  expected_.clear();
  statuses_.clear();
  check(status, "a message");
  if (silent < 0) return;
  throw Error(fmt::format("rank {} had nothing to send, because the call has "
                          "failed there; its own message says why",
                          silent),
              Error::Kind::Lost);
}

void broadcast(MPI_Comm communicator, int root, void* bytes, std::size_t count) {
  forEachPiece(count, [&](std::size_t at, int piece) {
    check(MPI_Bcast(static_cast<std::byte*>(bytes) + at, piece, MPI_BYTE, root, communicator), "a broadcast");
  });
}

}  // namespace sk::mpi
