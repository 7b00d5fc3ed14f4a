// SPDX-License-Identifier: MIT
//
// How ranks act together or not at all. Before a collective step, each rank
// checks what it can check alone: arguments, files, memory, whether streams are
// lost. Then one small all-reduce compares what the ranks call, and says
// whether a rank refuses. If so, all of them throw the error of the lowest rank
// that does; none waits for messages that do not come.
//
//   const std::vector<std::byte> own = agreement.together({"gather"}, [&] {
//   return bytesOf(stream); });
//   ...                             // messages: every rank is here
//
// What goes wrong between these steps, or in a call that needs no message, is
// thrown on one rank alone. That rank remembers it (act(), failAlone()) and
// announces it at its next collective step, in which the others throw it.
//
// The domains beside each other have one agreement, so that their calls have
// one order. Without other ranks it costs nothing.
//
// Also what an agreement is about: the hash by which ranks compare calls, and
// errors that have been caught, because the other ranks have to hear of them
// before they are thrown.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <type_traits>
#include <unordered_map>
#include <utility>
#include <vector>

#include "messages.hpp"
#include "sk/error.hpp"

namespace sk::mpi {

/// Why this rank does not take part in a call; empty if it does.
using Refusal = std::optional<Error>;

/// The exception that is being handled, as an error. `what` names the call, for
/// an exception that does not. Allocates nothing if there is no memory.
Error currentError(std::string_view what) noexcept;

/// Calls fn(). Returns what it has thrown.
template <class Fn>
Refusal caught(std::string_view what, Fn&& fn) noexcept {
  try {
    std::forward<Fn>(fn)();
    return std::nullopt;
  } catch (...) {
    return currentError(what);
  }
}

/// A hash that is the same in every process (FNV-1a: Fowler, Noll and Vo).
class Hash {
 public:
  void add(std::string_view text) {
    addBytes(text);
    addByte(0);
  }
  void add(std::int64_t number) {
    for (int k = 0; k < 8; ++k) addByte(static_cast<unsigned char>(number >> (8 * k)));
  }
  void addBytes(std::string_view bytes) {
    for (const char c : bytes) addByte(static_cast<unsigned char>(c));
  }
  std::uint64_t value() const { return value_; }

 private:
  void addByte(unsigned char byte) { value_ = (value_ ^ byte) * 0x100000001b3; }

  std::uint64_t value_ = 0xcbf29ce484222325;
};

/// What a rank can say of a call beyond its name.
class Details {
 public:
  /// One detail a line, as in "root 0". Only what differs between two ranks is shown.
  virtual std::string details() const = 0;

 protected:
  ~Details() = default;
};

/// What is called. All ranks must give the same hash.
struct Call {
  std::string_view what;  ///< for messages
  std::uint64_t hash = 0;
  std::uint64_t id = 0;  ///< on this rank, of calls that are compared only once; or 0
  bool isFirst = true;      ///< whether it has not been compared
  std::uint64_t detail = 0;  ///< of this one call
  const Details* details = nullptr;  ///< null, or lives until the ranks have been compared

  /// Adds to what is compared of this one call.
  void add(std::uint64_t number) { detail = (detail ^ number) * 0x9e3779b97f4a7c15; }
};

class Agreement {
 public:
  /// Someone who keeps an account that must be the same on all ranks.
  class Member {
   public:
    /// The ranks may have different accounts: begins a new one.
    virtual void forget() noexcept = 0;

   protected:
    ~Member() = default;
  };

  /// A comparison under way.
  class Started {
   public:
    Started() = default;
    Started(const Started&) = delete;
    Started& operator=(const Started&) = delete;

   private:
    friend class Agreement;
    static constexpr std::size_t numbers = 7;
    std::array<std::uint64_t, numbers> own_{}, all_{};
    Call call_;
    std::uint64_t calls_ = 0;
    MPI_Request request_ = MPI_REQUEST_NULL;
    Refusal error_;
  };

  /// Allocates nothing, so that a rank without memory can refuse to open() it.
  Agreement() = default;
  /// Allocates what calls over this number of ranks need, before open().
  void reserve(int ranks) {
    zeros_.resize(std::max<std::size_t>(leastWords, static_cast<std::size_t>(ranks)));
    started_.reserve(16);
  }
  /// Collective: begins to compare the ranks of a communicator, on a duplicate of it, unless one of them refuses already.
  void open(MPI_Comm communicator, const Refusal& refusal);
  Agreement(const Agreement&) = delete;
  Agreement& operator=(const Agreement&) = delete;

  int rank() const { return rank_; }
  int ranks() const { return ranks_; }
  MPI_Comm communicator() const { return used_; }
  /// Counts the domains beside each other, which all ranks create together.
  std::int64_t nextDomain() { return ++domains_; }
  const WaitLimit& waitLimit() const { return waitLimit_; }

  /// Reads SK_CHECK and SK_MPI_TIMEOUT. Throws sk::Error if they have other
  /// values than those that are documented.
  void readEnvironment();
  /// Whether every call is compared (SK_CHECK=collectives), also those that
  /// need no message.
  bool isAlways() const { return isAlways_; }

  void join(Member& member) { members_.push_back(&member); }
  void leave(Member& member) noexcept { std::erase(members_, &member); }

  /// Counts a call of a domain. Each begins with this, or with begin().
  void count() noexcept { ++calls_; }
  /// Counts a call that is compared when it is first made, whether or not it
  /// has messages. `id` says on this rank which one it is, and hash() is alike
  /// on all ranks.
  template <class Hash>
  Call begin(std::string_view what, std::uint64_t id, Hash&& hash) {
    ++calls_;
    if (ranks_ == 1) return {.what = what, .id = id, .isFirst = false};
    const auto [known, isNew] = known_.try_emplace(id, 0);
    if (isNew) known->second = hash();
    return {what, known->second, id, isNew};
  }

  /// Collective: throws on all ranks unless all make the same call and none
  /// refuses it.
  void agree(const Call& call, const Refusal& refusal);
  /// Collective: runs what this rank can do alone, and returns its result.
  /// Throws on all ranks if one of them throws.
  template <class Check>
  std::invoke_result_t<Check> together(const Call& call, Check&& check) {
    if (ranks_ == 1) return check();
    if constexpr (std::is_void_v<std::invoke_result_t<Check>>) {
      agree(call, caught(call.what, check));
    } else {
      std::optional<std::invoke_result_t<Check>> result;
      agree(call, caught(call.what, [&] { result.emplace(check()); }));
      return *std::move(result);
    }
  }

  /// Collective, between two steps: the largest of a number of each rank.
  std::uint64_t most(std::uint64_t own);

  /// The words of the message that follows start(). Their number depends on the number of ranks alone, not on what a rank calls: where
  /// ranks call different things, their messages still fit each other. There is room for a double of each rank, and for an exact sum.
  std::size_t postedWords() const { return zeros_.size(); }
  /// Begins to compare, without waiting. The caller, which does not refuse the call, then posts an all-reduce on communicator() that adds
  /// postedWords() integers of 64 bits. Ranks that refuse, or that call something else, take part in it with zeros.
  void start(Started& started, const Call& call);
  /// Whether all ranks have started.
  bool isReady(Started& started);
  /// Waits until all ranks have started. Throws only if MPI fails.
  void wait(Started& started);
  /// Waits, and throws as agree() does, each time.
  void finish(Started& started);
  /// Waits, and forgets it. Does nothing if it has not been started.
  void abandon(Started& started) noexcept;

  /// Runs a part of a call in which no rank waits for another. What it throws
  /// is remembered for the others.
  template <class Act>
  void act(std::string_view what, Act&& act) {
    if (ranks_ == 1) return act();
    if (const Refusal refusal = caught(what, act)) failAlone(*refusal);
  }
  /// Remembers the error for the others, and throws it.
  [[noreturn]] void failAlone(const Error& error);
  /// MPI has failed so that messages are missing: every further call throws.
  /// Only the end of the run helps the others.
  void giveUp(const Error& error) noexcept { broken_ = error; }

 private:
  using Numbers = std::array<std::uint64_t, Started::numbers>;

  static constexpr std::size_t leastWords = 64;

  Numbers numbersOf(const Call& call, bool isRefused, bool hasPosted) const;
  void announce(const Call& call);
  Numbers compare(const Call& call, const Numbers& own);
  void conclude(Started& started);
  void settle();
  Refusal verdict(const Numbers& all, const Call& call, std::uint64_t calls, const Refusal& own);
  Refusal refused(const Numbers& all, const Refusal& own);
  Refusal different(const Numbers& all, const Call& call, std::uint64_t calls);
  void takePart(const Numbers& all);
  void send(const Error& error);
  Error receive(int from);
  void forget() noexcept;
  void check(int status);

  Communicator communicator_{MPI_COMM_NULL};
  MPI_Comm used_ = MPI_COMM_NULL;
  int rank_ = 0, ranks_ = 1;
  WaitLimit waitLimit_;
  bool isAlways_ = false;
  std::int64_t domains_ = 0;
  std::uint64_t calls_ = 0;  ///< since the ranks have begun to compare
  std::unordered_map<std::uint64_t, std::uint64_t>
      known_;  ///< hashes of calls that have been compared, by id
  Refusal announced_;  ///< what this rank has thrown, and the others have not
      ///< heard of
  std::uint64_t failedAt_ = 0;  ///< calls_ when it was thrown
  Refusal broken_;  ///< why no more can be compared
  std::vector<Started*> started_;  ///< in their order
  std::vector<Member*> members_;
  std::vector<std::int64_t> zeros_;  ///< for takePart()
};

}  // namespace sk::mpi
