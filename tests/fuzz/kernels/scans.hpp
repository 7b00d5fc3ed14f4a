// SPDX-License-Identifier: MIT
//
// Random scans of integers: one to three accumulators that each fold an expression of the elements by an operator, or two
// that compose maps, over a stream of any rank, as a whole or along a dimension. They wrap, so that every order of
// combination gives the same bits.
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "random.hpp"
#include "sk/sk.hpp"

namespace fuzz {

class RandomScan {
 public:
  RandomScan(std::uint64_t seed, std::uint64_t number);

  /// The source; the scan is named `random`.
  const std::string& text() const { return text_; }
  /// How the results of `compiled` on a device differ from what the scan means; empty if they agree.
  std::string difference(sk::Device& device, const sk::program::Reduction& compiled) const;

 private:
  using Words = std::vector<std::uint32_t>;
  struct Accumulator {
    bool isSigned;
    std::uint32_t identity;
  };
  using Fold = std::function<void(Words& accumulators, const Words& element, std::uint32_t index)>;

  void makeOperators(Random& random);
  void makeMaps();
  std::vector<Words> results() const;

  std::string text_;
  std::vector<Accumulator> accumulators_;
  std::vector<bool> inputsAreSigned_;
  std::uint32_t factor_ = 0;
  bool hasFactor_ = false;
  Fold fold_;
  sk::Shape shape_;
  int along_ = -1;  ///< -1: the whole stream
  bool isExclusive_ = false;
  std::vector<Words> elements_;  ///< of each input
};

}  // namespace fuzz
