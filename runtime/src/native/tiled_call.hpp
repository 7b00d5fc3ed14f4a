// SPDX-License-Identifier: MIT
//
// A kernel's call in a loop that runs in tiles (native/time_tiles.hpp): what it reads and writes, and how far from its own
// element, in terms of the indices of the stream that it writes; and its code for boxes of them.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "native/operands.hpp"
#include "native/prepared_run.hpp"
#include "native/run_code.hpp"
#include "native/time_tiles.hpp"

namespace sk {

class TiledCall {
 public:
  /// A stream's arrays, or the spare ones, which the call uses.
  struct Use {
    NativeStream* stream;
    bool isSpare;
    bool isWritten;
    native::Extents distance;  ///< native::TileAccess::distance
    std::size_t operand;  ///< its number in the call
    bool wraps;  ///< it is a gather whose ends are neighbours
  };

  /// The run must outlive it.
  explicit TiledCall(const PreparedRun& run);

  /// Why its elements may not be computed in tiles; empty if they may.
  const std::string& whyNot() const { return whyNot_; }
  std::string_view name() const { return run_.kernel().name; }

  std::span<const Use> uses() const { return uses_; }
  /// The streams of which elements are values of the call.
  std::span<NativeStream* const> values() const { return values_; }
  /// The streams whose spare arrays become their own after the call.
  std::span<NativeStream* const> replaced() const { return operands_.replaced(); }
  /// The indices of the stream that it writes, and the part of them that it computes.
  const native::Extents& extent() const { return extent_; }
  const native::Part& computed() const { return computed_; }
  bool isPeriodic(std::size_t dimension) const { return isPeriodic_[dimension]; }

  const program::Kernel& kernel() const { return run_.kernel(); }
  const CodeChoice& choice() const { return run_.choice(); }
  /// The call with the arrays that the streams have now. It is valid until the next one, and until code().
  const native::Call& withArrays() {
    operands_.beginAgain();
    return call_;
  }
  /// The code for the arrays that the streams have now. It stays until dropCode().
  const BoxCode& code();
  void dropCode() { codes_.clear(); }
  std::size_t codes() const { return codes_.size(); }
  /// What is in `box`, in indices of the stream that it writes, is computed by `code`.
  void run(const BoxCode& code, const native::Part& box) const;

 private:
  void findUses();
  void addUse(const Operands::Lent& lent);
  native::Extents distanceOf(std::size_t parameter) const;

  const PreparedRun& run_;
  Operands operands_;
  native::Call call_;
  std::string whyNot_;
  std::vector<Use> uses_;
  std::vector<NativeStream*> values_;
  native::Extents extent_{1, 1, 1, 1};
  native::Extents origin_{};  ///< index in the stream of the first element of the domain
  native::Part computed_;
  std::array<bool, 4> isPeriodic_{};
  std::vector<std::unique_ptr<BoxCode>> codes_;
};

}  // namespace sk
