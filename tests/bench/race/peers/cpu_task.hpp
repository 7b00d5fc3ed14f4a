// SPDX-License-Identifier: MIT
//
// A task of a function on the host's memory: it reads the problem where it is, and writes a result that it finds
// allocated and touched.
#pragma once

#include <algorithm>
#include <functional>
#include <utility>

#include "contender.hpp"

namespace race {

class CpuTask final : public Task {
 public:
  using Function = std::function<void(const Problem&, float* result)>;

  CpuTask(const Problem& problem, std::int64_t resultSize, Function function)
      : problem_(problem), result_(static_cast<std::size_t>(resultSize)), function_(std::move(function)) {}

  void run(int times) override {
    for (int i = 0; i < times; ++i) function_(problem_, result_.data());
  }
  std::vector<float> result() override { return result_; }

 private:
  const Problem& problem_;
  std::vector<float> result_;
  Function function_;
};

/// A contender whose result has `resultSize(problem)` numbers.
inline Contender onCpu(const char* program, const char* name, std::int64_t (*resultSize)(const Problem&),
                       void (*function)(const Problem&, float*)) {
  return {program, name, [=](const Problem& problem) {
            return std::make_unique<CpuTask>(problem, resultSize(problem), function);
          }};
}

inline std::int64_t one(const Problem&) { return 1; }
inline std::int64_t asMany(const Problem& problem) { return problem.size(); }
inline std::int64_t twoEach(const Problem& problem) { return 2 * problem.size(); }

}  // namespace race
