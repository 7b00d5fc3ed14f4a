// SPDX-License-Identifier: MIT
//
// How compute programs write each append output: by atomic operations, through a list, or with owners
// (append/append_groups.hpp).
#pragma once

#include <cstddef>
#include <cstdint>

#include "assemble/assemble.hpp"

namespace sk::assemble {

/// The invocations of a work group.
inline constexpr int appendGroup = 256;

/// How work groups compute a kernel's append outputs.
struct GroupPlan {
  int rounds;  ///< the most texels that an invocation computes
  bool isStaged;  ///< pushes go through shared memory
  bool isHeld = false;  ///< and are held by invocations: the kernel runs once
};
GroupPlan planGroups(const program::Kernel& kernel, bool isPacked, Order order);

/// Whether this is a scatter output that combines values, but not by atomic operations: those have one component, and add floats
/// in any order only. It pushes records in place of values.
bool isListed(const program::Parameter& appendOutput, Order order);
/// Whether this append output pushes to a list: a variable output, or records.
bool isPushed(const program::Parameter& appendOutput, Order order);
/// Whether a record, of a target and a value, is a pair of words: the value is one float. Else records have a plane of targets, and
/// then that of the values.
bool isPair(const program::Parameter& listed);
/// The images that an append output writes.
std::size_t imagesOf(const program::Parameter& appendOutput, Order order);
/// Whether its elements have owners: of several stores to an element, the last one wins. Elements of several components have
/// them in any order, too, so that none consists of parts of two.
bool hasOwners(const program::Parameter& appendOutput, Order order);

}  // namespace sk::assemble
