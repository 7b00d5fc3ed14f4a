// SPDX-License-Identifier: MIT
//
// GLSL for variable and scatter outputs in compute programs. A work group computes a tile: neighbouring texels of the
// domain, `appendGroup` at a time:
//
//   count    each texel's pushes; the group adds them up, and so knows where in its tile each texel's pushes go
//   look     back at the tiles before, each of which has published its own number of pushes or, later, the number up
//            to and including its own: the sum is where this tile's pushes go (Merrill and Garland 2016, "Single-pass
//            Parallel Prefix Scan with Decoupled Look-back"). Tiles are numbered as groups start, so that no group
//            waits for one that may not run.
//   store    the pushes: to shared memory if there are few, from where the group writes them as neighbours
//
// The kernel runs once to count and once to store. If an element pushes at most once, and little, an invocation holds the values
// from the first run, and there is no second one.
//
// Groups must not wait for each other on software renderers, which end long loops. There, and if the host must know the
// number of pushes before it makes room, three dispatches take the place of one (GroupStep).
//
// Order::Any takes the place in the list by one addition per group, without looking back. Scatter outputs are stored to by atomic
// operations. Of several plain stores to an element the last one wins: an earlier pass (Work::Owners) finds
// the last element that stores to each. What no atomic operation combines in order, sums of floats and all vectors, is
// pushed to a list of records, which are then sorted by their targets and combined one after the other
// (append/scatter_programs.hpp).
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "assemble/append/append_passes.hpp"
#include "assemble/assemble.hpp"
#include "assemble/elements/domain.hpp"
#include "assemble/glsl/program_text.hpp"

namespace sk::assemble {

/// GLSL functions of the bits of floats: whether the first is below or above the second (sk_below, sk_above).
std::string_view orderOfFloats();
/// What a dispatch of Work::Groups does: the last component of `sk_rect`, after the texels in a row, the texels of the domain and
/// the rounds of a tile.
enum class GroupStep : std::int32_t {
  Count,  ///< stores the number of each tile's pushes
  All,  ///< counts, looks back and stores; without variable outputs, only stores
  Scan,  ///< replaces these numbers by those of the pushes before each tile; one work group
  Store,  ///< stores the pushes to where they go
};

/// The words at the start of the buffer of states: the numbers of tiles that have begun and ended. Then come one word for each
/// tile and variable output, and the owners.
inline constexpr std::int64_t wordsBeforeStates = 2;

/// Adds what a kernel's program needs for its append outputs, for Work::Append or Work::Owners.
class GroupText {
 public:
  GroupText(ProgramText& program, DomainText& domain, const Profile& profile, const program::Kernel& kernel,
            const Variant& variant);

  /// Defines the function that the body calls.
  void define(const program::Parameter& appendOutput, const StreamAccess& access);
  /// To be called last: the program's main().
  void finish();
  /// A statement of main() that follows each call of the kernel for an element of a packed texel; or nothing.
  std::string_view afterElement() const { return plan_.isHeld && !pushed_.empty() ? "++sk_slot;" : ""; }

 private:
  struct Pushed {
    const program::Parameter* parameter;
    std::size_t first, end;  ///< its planes among the program's outputs
    bool isRecord;  ///< of a scatter output
  };
  Order order() const { return variant_.task.scattersInAnyOrder ? Order::Any : Order::Kept; }
  void definePush(const program::Parameter& appendOutput, std::string_view signature);
  void defineRecord(const program::Parameter& scatter, const StreamAccess& access);
  void storePushed(const Pushed& pushed);
  static std::string shiftOf(const Pushed& pushed);
  void keepPushed(const Pushed& pushed);
  void holdPushed(const Pushed& pushed, std::string_view signature);
  void declareStaged(const Pushed& pushed);
  void definePut(const program::Parameter& scatter, const StreamAccess& access);
  void putAtomically(const program::Parameter& scatter, const std::string& image);
  std::string ownerOf(const program::Parameter& scatter);
  void declareStates();
  void declareTotals();

  std::string mainOfTiles() const;
  std::string mainOfPushes() const;
  std::string runToCount() const;
  std::string runToStore() const;
  std::string visits(std::string_view before, std::string_view after = {}) const;
  std::string copiesOfStaged() const;
  std::string totalOf(std::size_t number, std::string_view total) const;
  std::string scanOfTiles() const;
  template <class Text>
  std::string ofPushed(Text&& text) const;
  std::string forEach(std::string_view pattern) const;
  static std::string stagedName(const Pushed& pushed, std::size_t plane);
  int elementsOfTexel() const { return variant_.domainPacked ? lanes : 1; }
  /// The elements that an invocation computes.
  int slots() const { return plan_.rounds * elementsOfTexel(); }

  ProgramText& program_;
  DomainText& domain_;
  const Variant& variant_;
  const bool hasSubgroups_;
  GroupPlan plan_;
  std::vector<Pushed> pushed_;
  std::size_t totals_ = 0;  ///< the number of the first output that holds a total
};

}  // namespace sk::assemble
