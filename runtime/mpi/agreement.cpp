// SPDX-License-Identifier: MIT
#include "agreement.hpp"

#include <algorithm>
#include <cstring>
#include <exception>
#include <limits>
#include <new>
#include <span>

#include <fmt/format.h>

#include "call/check_written.hpp"
#include "support/checked_size.hpp"

namespace sk::mpi {

Error currentError(std::string_view what) noexcept {
  static const Error unknown("an exception that is no std::exception", Error::Kind::Misuse);
  try {
    try {
      throw;
    } catch (const Error&) {
      throw;
    } catch (const std::bad_alloc& error) {
      failForHostMemory(what, error);
    } catch (const std::exception& error) {
      throw Error(fmt::format("{}: {}", what, error.what()));
    }
  } catch (const Error& error) {
    return error;  // a copy allocates nothing
  } catch (...) {
    return unknown;
  }
}

namespace {

/// The numbers of a comparison, of which the ranks take the largest.
enum Number : std::uint8_t {
  RefusedAt,  ///< above 0 if a rank refuses; the lowest one has the largest
  AcceptedAt,  ///< 1 if a rank does not refuse
  MostCallsAt,
  FewestCallsAt,
  MostHashAt,
  LeastHashAt,
  PostedAt  ///< 1 if a rank has posted words
};

constexpr int rankBits = 24;
constexpr std::uint64_t rankMask = (std::uint64_t{1} << rankBits) - 1;

std::uint64_t mostWith(std::uint64_t value, int rank) {
  return value << rankBits | (rankMask - static_cast<std::uint64_t>(rank));
}
std::uint64_t leastWith(std::uint64_t value, int rank) {
  return ~(value << rankBits | static_cast<std::uint64_t>(rank));
}

/// The lowest ranks that have the most and the least of a value; equal if all
/// have the same.
struct Ends {
  int most, least;
};
Ends endsOf(std::uint64_t most, std::uint64_t least) {
  if (most >> rankBits == ~least >> rankBits) return {0, 0};
  return {static_cast<int>(rankMask - (most & rankMask)), static_cast<int>(~least & rankMask)};
}

/// What a rank says of its call: the name, and a line for each detail. What cannot be said for lack of memory is left out.
Error wordsOf(const Call& call) noexcept {
  try {
    return Error(fmt::format("{}\n{}", call.what, call.details == nullptr ? "" : call.details->details()));
  } catch (const std::exception&) {
    return currentError("a call");
  }
}

std::vector<std::string_view> linesOf(std::string_view words) {
  std::vector<std::string_view> lines;
  while (!words.empty()) {
    const std::size_t end = std::min(words.find('\n'), words.size());
    lines.push_back(words.substr(0, end));
    words.remove_prefix(std::min(end + 1, words.size()));
  }
  return lines;
}

/// The name of a call, with those of its details that the call of another rank lacks, if that has the same name.
std::string shown(std::string_view words, std::string_view others) {
  const std::vector<std::string_view> lines = linesOf(words), otherLines = linesOf(others);
  if (lines.empty() || otherLines.empty() || lines.front() != otherLines.front())
    return std::string(lines.empty() ? words : lines.front());
  std::string details;
  for (const std::string_view line : std::span(lines).subspan(1)) {
    if (std::ranges::find(otherLines, line) == otherLines.end())
      details += fmt::format("{}{}", details.empty() ? "" : ", ", line);
  }
  if (!details.empty()) return fmt::format("{} ({})", lines.front(), details);
  return fmt::format("{}{}", lines.front(), lines == otherLines ? " (with other code or halos)" : "");
}

/// A tag that no other message uses.
constexpr int wordsTag = 1002;
/// The bytes of an error, at most: such messages need no receiver yet.
constexpr std::size_t mostText = 2000;

}  // namespace

void Agreement::open(MPI_Comm communicator, const Refusal& refusal) {
  used_ = communicator;
  MPI_Comm_rank(communicator, &rank_);
  MPI_Comm_size(communicator, &ranks_);
  waitLimit_.setRank(rank_, ranks_);
  agree({"a domain"}, refusal);
  check(communicator_.become([&](MPI_Comm* copy) { return MPI_Comm_dup(communicator, copy); }));
  MPI_Comm_set_errhandler(communicator_, MPI_ERRORS_RETURN);
  used_ = communicator_;
}

void Agreement::readEnvironment() {
  isAlways_ = checksCollectives();
  waitLimit_.setSeconds(WaitLimit::secondsOfEnvironment());
}

Agreement::Numbers Agreement::numbersOf(const Call& call, bool isRefused, bool hasPosted) const {
  Numbers numbers{};
  numbers[RefusedAt] = isRefused ? static_cast<std::uint64_t>(ranks_ - rank_) : 0;
  numbers[AcceptedAt] = isRefused ? 0 : 1;
  const std::uint64_t hash = (call.hash ^ call.detail) >> rankBits;
  numbers[MostCallsAt] = mostWith(calls_, rank_);
  numbers[FewestCallsAt] = leastWith(calls_, rank_);
  numbers[MostHashAt] = mostWith(hash, rank_);
  numbers[LeastHashAt] = leastWith(hash, rank_);
  numbers[PostedAt] = hasPosted ? 1 : 0;
  return numbers;
}

/// Nothing that the ranks compare can be trusted after an error of MPI.
void Agreement::check(int status) {
  if (status == MPI_SUCCESS) return;
  try {
    mpi::check(status, "the ranks of a sk::Domain cannot be compared any more");
  } catch (const Error& error) {
    broken_ = error;
    throw;
  }
}

Agreement::Numbers Agreement::compare(const Call& call, const Numbers& own) {
  if (broken_) throw Error(*broken_);
  waitLimit_.enter(call.what, calls_);
  Numbers all{};
  // Not MPI_Allreduce, which does not match what start() posts on another rank.
  MPI_Request request = MPI_REQUEST_NULL;
  check(MPI_Iallreduce(own.data(), all.data(), static_cast<int>(Started::numbers), MPI_UINT64_T, MPI_MAX,
                       used_, &request));
  check(waitLimit_.wait({&request, 1}));
  return all;
}

void Agreement::agree(const Call& call, const Refusal& refusal) {
  if (ranks_ == 1) {
    if (refusal) throw Error(*refusal);
    return;
  }
  settle();
  if (announced_) announce(call);
  const Numbers own = numbersOf(call, refusal.has_value(), false), all = compare(call, own);
  takePart(all);
  if (const Refusal error = verdict(all, call, calls_, refusal)) throw Error(*error);
}

/// Tells the other ranks of an error that only this one has thrown, in the
/// place of their next call. This rank then goes on with its own.
void Agreement::announce(const Call& call) {
  const Refusal error = std::exchange(announced_, std::nullopt);
  const Numbers own = numbersOf(call, true, false), all = compare(call, own);
  takePart(all);
  const std::uint64_t sinceThen = calls_ - failedAt_;  // as the others count from now on
  (void)verdict(all, call, calls_, error);
  calls_ = sinceThen;
  if (call.id != 0) known_[call.id] = call.hash;
}

void Agreement::failAlone(const Error& error) {
  if (ranks_ > 1) {
    if (!announced_) {
      announced_ = error;
      failedAt_ = calls_;
    }
    known_.clear();  // as on the others when they hear of it: what a handler calls is compared on all
    for (Member* const member : members_) member->forget();
  }
  throw Error(error);
}

std::uint64_t Agreement::most(std::uint64_t own) {
  std::uint64_t all = own;
  if (ranks_ > 1) check(MPI_Allreduce(&own, &all, 1, MPI_UINT64_T, MPI_MAX, used_));
  return all;
}

void Agreement::start(Started& started, const Call& call) {
  settle();
  if (announced_) announce(call);
  if (broken_) throw Error(*broken_);
  started_.push_back(&started);
  started.call_ = call;
  started.calls_ = calls_;
  started.own_ = numbersOf(call, false, true);
  const int status =
      MPI_Iallreduce(started.own_.data(), started.all_.data(), static_cast<int>(Started::numbers),
                     MPI_UINT64_T, MPI_MAX, used_, &started.request_);
  if (status != MPI_SUCCESS) started_.pop_back();
  check(status);
}

bool Agreement::isReady(Started& started) {
  int isDone = 0;
  check(MPI_Test(&started.request_, &isDone, MPI_STATUS_IGNORE));
  return isDone != 0;
}

void Agreement::wait(Started& started) {
  waitLimit_.enter(started.call_.what, started.calls_);
  check(waitLimit_.wait({&started.request_, 1}));
}

void Agreement::finish(Started& started) {
  conclude(started);
  if (started.error_) throw Error(*started.error_);
}

void Agreement::abandon(Started& started) noexcept {
  (void)caught(started.call_.what, [&] { conclude(started); });
  std::erase(started_, &started);
}

/// Waits for what has been started, and finds out whether the ranks agree. That
/// sends or receives words, in the order of the calls.
void Agreement::conclude(Started& started) {
  while (std::ranges::find(started_, &started) != started_.end()) {
    Started& first = *started_.front();
    wait(first);
    started_.erase(started_.begin());
    first.error_ = verdict(first.all_, first.call_, first.calls_, std::nullopt);
  }
}

/// Whoever refuses a call that others have only started goes on at once; these
/// hear of it at their next call.
void Agreement::settle() {
  while (!started_.empty()) finish(*started_.front());
}

/// Contributes zeros to what other ranks have posted, where this one has posted
/// nothing.
void Agreement::takePart(const Numbers& all) {
  if (all[PostedAt] == 0) return;
  MPI_Request request = MPI_REQUEST_NULL;
  std::ranges::fill(zeros_, 0);
  check(MPI_Iallreduce(MPI_IN_PLACE, zeros_.data(), static_cast<int>(zeros_.size()), MPI_INT64_T, MPI_SUM,
                       used_, &request));
  check(waitLimit_.wait({&request, 1}));
}

/// What all ranks throw, if anything.
Refusal Agreement::verdict(const Numbers& all, const Call& call, std::uint64_t calls, const Refusal& own) {
  Refusal error = all[RefusedAt] != 0 ? refused(all, own) : different(all, call, calls);
  if (error) forget();
  return error;
}

Refusal Agreement::refused(const Numbers& all, const Refusal& own) {
  const int first = ranks_ - static_cast<int>(all[RefusedAt]);
  if (first == rank_) send(*own);
  const Error error = first == rank_ ? *own : receive(first);
  if (all[AcceptedAt] == 0) return error;  // all refuse: it is the program's mistake, not the rank's
  try {
    return Error(fmt::format("rank {}: {}", first, error.what()), error.kind());
  } catch (const std::bad_alloc&) {
    return error;
  }
}

Refusal Agreement::different(const Numbers& all, const Call& call, std::uint64_t calls) {
  Ends ends = endsOf(all[MostHashAt], all[LeastHashAt]);
  const bool isOther = ends.most != ends.least;
  if (!isOther) ends = endsOf(all[MostCallsAt], all[FewestCallsAt]);
  if (ends.most == ends.least) return std::nullopt;
  const auto [one, other] = std::minmax(ends.most, ends.least);
  const Error own = isOther ? wordsOf(call) : Error(fmt::format("{} as its call {}", call.what, calls));
  if (rank_ == one || rank_ == other) send(own);
  const std::string first = rank_ == one ? own.what() : receive(one).what();
  const std::string second = rank_ == other ? own.what() : receive(other).what();
  return Error(
      fmt::format("the ranks do not make the same call: rank {} has "
                  "{}, rank {} has {}; let all ranks run one "
                  "program, with the same arguments in the same order",
                  one, shown(first, second), other, shown(second, first)));
}

/// Sends the error to all other ranks.
void Agreement::send(const Error& error) {
  std::array<char, 1 + mostText> bytes;
  bytes[0] = static_cast<char>(error.kind());
  const std::size_t length = std::min(std::strlen(error.what()), mostText);
  std::memcpy(bytes.data() + 1, error.what(), length);
  for (int to = 0; to < ranks_; ++to) {
    if (to != rank_)
      check(MPI_Send(bytes.data(), static_cast<int>(1 + length), MPI_CHAR, to, wordsTag, used_));
  }
}

Error Agreement::receive(int from) {
  std::array<char, 1 + mostText> bytes;
  MPI_Status status;
  int length = 0;
  check(MPI_Recv(bytes.data(), static_cast<int>(bytes.size()), MPI_CHAR, from, wordsTag, used_, &status));
  MPI_Get_count(&status, MPI_CHAR, &length);
  try {
    return Error(std::string(bytes.data() + 1, static_cast<std::size_t>(length - 1)),
                 static_cast<Error::Kind>(bytes[0]));
  } catch (const std::bad_alloc&) {
    return currentError("a call over ranks");
  }
}

/// All ranks are at the same place.
void Agreement::forget() noexcept {
  calls_ = failedAt_ = 0;
  known_.clear();
  for (Member* const member : members_) member->forget();
}

}  // namespace sk::mpi
