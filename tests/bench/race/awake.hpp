// SPDX-License-Identifier: MIT
//
// Keeps a GPU awake. It lowers its clock while it has little to do, as when others are measured on the processor, and raises
// it again step by step: a contender on it would be timed at some clock in between.
#pragma once

#include <memory>

#include <sk/sk.hpp>

namespace race {

class Awake {
 public:
  /// Null, or a renderer in software: there is nothing to keep.
  explicit Awake(sk::Device* device);
  ~Awake();

  /// Gives the GPU work for so many seconds, and waits for it.
  void work(double seconds) const;

 private:
  struct Load;
  std::unique_ptr<Load> load_;
};

}  // namespace race
