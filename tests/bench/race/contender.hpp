// SPDX-License-Identifier: MIT
//
// What takes part in a race: a problem, and contenders that solve it. The border to the peers, which are shared
// libraries that sk_race loads and that may be built by another compiler (nvcc, a newer g++): standard C++17 alone.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <vector>

namespace race {

/// The inputs of a program at one size. programs.cpp says for each program what they are.
struct Problem {
  std::int64_t rows = 1;
  std::int64_t columns = 0;
  std::vector<std::vector<float>> floats = {};
  std::vector<std::vector<std::int32_t>> ints = {};

  std::int64_t size() const { return rows * columns; }
};

/// A problem that a contender has taken to its own memory, where it solves it as often as asked: copies to a device and
/// back, compiling and allocating are no part of what is timed, everything else is.
class Task {
 public:
  Task() = default;
  virtual ~Task() = default;
  Task(const Task&) = delete;
  Task& operator=(const Task&) = delete;

  /// Solves the problem `times` times from the start, and waits until that is done.
  virtual void run(int times) = 0;
  /// What run() has computed, one number after the other.
  virtual std::vector<float> result() = 0;
};

/// Somebody who solves one of the programs. The problem outlives the task. make() and tasks throw std::exception where
/// the machine cannot do it.
struct Contender {
  std::string program;
  std::string name;
  std::function<std::unique_ptr<Task>(const Problem&)> make;
};

/// The one function of a peer library, named so that dlsym() finds it: adds its contenders.
using AddPeers = void (*)(std::vector<Contender>&);
constexpr const char* addPeersName = "race_add_peers";

}  // namespace race

/// Begins the definition of that function: RACE_ADD_PEERS(std::vector<race::Contender>& contenders) { ... }
#define RACE_ADD_PEERS extern "C" __attribute__((visibility("default"))) void race_add_peers
