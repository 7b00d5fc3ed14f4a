// SPDX-License-Identifier: MIT
//
// Random numbers that are the same on every machine: SplitMix64 (Steele, Lea and Flood, "Fast splittable
// pseudorandom number generators", 2014). Each input has its own generator, so that any input can be reproduced alone.
#pragma once

#include <cstddef>
#include <cstdint>
#include <iterator>

namespace fuzz {

class Random {
 public:
  /// The generator for input `number` of the campaign `seed`.
  Random(std::uint64_t seed, std::uint64_t number) : state_(seed * 0xd1342543de82ef95u + number) { next(); }

  std::uint64_t next() {
    std::uint64_t z = state_ += 0x9e3779b97f4a7c15u;
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
    z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
    return z ^ (z >> 31);
  }

  /// 0 to count - 1; count is not 0.
  std::size_t below(std::size_t count) { return static_cast<std::size_t>(next() % count); }
  int between(int least, int most) {
    return least + static_cast<int>(below(static_cast<std::size_t>(most - least) + 1));
  }
  /// True with probability `count` / `of`.
  bool chance(std::size_t count, std::size_t of) { return below(of) < count; }

  /// An element of an array or a vector that is not empty.
  template <class List>
  const auto& pick(const List& list) {
    return list[below(std::size(list))];
  }

 private:
  std::uint64_t state_;
};

}  // namespace fuzz
