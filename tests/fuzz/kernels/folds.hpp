// SPDX-License-Identifier: MIT
//
// Random folds (fold_text.hpp), their data, and what they must give: scans of a whole stream, along a dimension or in rows;
// reduces to values, to blocks or of rows; kernels with folded outputs. Arguments are streams, boxes or every second or
// third element of larger ones, and results may take the place of inputs.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "kernels/fold_text.hpp"
#include "random.hpp"
#include "sk/sk.hpp"

namespace fuzz {

class RandomFold {
 public:
  RandomFold(std::uint64_t seed, std::uint64_t number, FoldKind kind);

  const std::string& text() const { return made_.text; }
  /// How the results of `compiled` on a device differ from what the fold means; empty if they agree. The descriptors must
  /// outlive the device.
  std::string difference(sk::Device& device, const sk::program::Reduction& compiled) const;

 private:
  /// What becomes of the accumulators.
  enum class To : std::uint8_t { Values, Blocks, Rows, Line };
  /// Where an argument's elements lie.
  enum class Placement : std::uint8_t { Whole, Box, Strided };
  class Run;
  /// The results of a fold, one list per accumulator and output.
  struct Results {
    std::vector<Words> accumulators, outputs;
  };

  void chooseDomain(Random& random);
  void chooseRows(Random& random);
  void chooseOptions(Random& random);
  void fill(Random& random);
  Words inputsAt(std::int64_t element) const;
  /// The number of the element of a result that folds, or begins with, this element of the domain; -1 if none does.
  std::vector<std::int64_t> targets() const;
  sk::Shape resultShape() const;
  Results expected() const;
  std::string described() const;

  FoldText made_;
  sk::Shape domain_ = sk::Shape(0);
  To to_ = To::Values;
  sk::Shape grid_ = sk::Shape(0);  ///< of blocks
  std::vector<std::int32_t> starts_;  ///< of rows
  sk::CallOptions options_;
  std::vector<Placement> placements_;  ///< of inputs, outputs, accumulators
  bool isInPlace_ = false;
  std::vector<Words> inputs_;
  Words table_;
  std::uint32_t factor_ = 0;
};

}  // namespace fuzz
