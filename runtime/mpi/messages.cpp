// SPDX-License-Identifier: MIT
#include "messages.hpp"

#include <algorithm>
#include <charconv>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <string>
#include <thread>
#include <utility>

#include <fmt/format.h>

#include "sk/error.hpp"

namespace sk::mpi {

double WaitLimit::secondsOfEnvironment() {
  const char* const value = std::getenv("SK_MPI_TIMEOUT");
  if (value == nullptr || *value == '\0') return 0;
  const std::string_view text(value);
  double seconds = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), seconds);
  if (error == std::errc() && end == text.data() + text.size() && seconds > 0) return seconds;
  throw Error(fmt::format("SK_MPI_TIMEOUT is '{}'; give a number of seconds above 0, or unset it", value));
}

int WaitLimit::wait(std::span<MPI_Request> requests, std::span<MPI_Status> statuses) const {
  const auto count = static_cast<int>(requests.size());
  MPI_Status* const to = statuses.empty() ? MPI_STATUSES_IGNORE : statuses.data();
  if (!isSet()) return MPI_Waitall(count, requests.data(), to);
  using std::chrono::microseconds;
  const auto start = std::chrono::steady_clock::now();
  const auto limit = start + std::chrono::duration<double>(seconds_);
  bool isReported = false;
  microseconds pause{0};
  for (;;) {
    int isDone = 0;
    const int status = MPI_Testall(count, requests.data(), &isDone, to);
    if (status != MPI_SUCCESS || isDone != 0) return status;
    const auto now = std::chrono::steady_clock::now();
    if (!isReported && now > limit) {
      report();
      isReported = true;
    }
    if (now - start < std::chrono::milliseconds(1)) continue;  // most waits end here
    pause = std::min(pause + microseconds(10), microseconds(1000));
    std::this_thread::sleep_for(pause);
  }
}

void WaitLimit::report() const {
  const std::string text = fmt::format(
      "sk: rank {} of {} has waited {} s for other ranks in {} "
      "(call {} of its domain)\n",
      rank_, ranks_, seconds_, what_, number_);
  std::fputs(text.c_str(), stderr);
  std::fflush(stderr);
}

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
