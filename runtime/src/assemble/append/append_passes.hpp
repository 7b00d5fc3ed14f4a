// SPDX-License-Identifier: MIT
//
// GLSL for variable and scatter outputs ("append outputs") in a kernel's programs. The kernel runs once to
// count each element's pushes, and once more for each entry of an append output's list, to compute its value:
//
//   pass 1     domain   ordinary outputs; for each counted append output, the element's number of pushes
//   pyramid    log4     sums of counts (histo_pyramid.hpp)
//   pass 2     list     entry j: determines its element and which push it is, and computes the value
//
// The list of a variable output is the stream itself. The list of a scatter output also holds the target
// texels of its values, and is then drawn as points (scatter_programs.hpp). A scatter output with few pushes per
// element is not counted: its list has a slot for every possible push, which takes a single pass.
//
// Also the names and expressions that all programs for append outputs share, drawn or dispatched (append_groups.hpp).
//
// How compute programs write each append output: by atomic operations, through a list, or with owners
// (append/append_groups.hpp).
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>

#include "assemble/assemble.hpp"
#include "assemble/elements/domain.hpp"
#include "assemble/glsl/program_text.hpp"
#include "sk/program.hpp"

namespace sk::assemble {

/// Whether a parameter is a variable or a scatter output.
bool isAppendOutput(const program::Parameter& parameter);

/// Whether its pushes are counted before its list is written.
bool isCounted(const program::Parameter& appendOutput);

/// The entries per element in the list of an append output that is not counted; 0 if it never pushes.
int slotsOf(const program::Parameter& appendOutput);

/// Work::Counts: defines the function that the body calls; storeCount follows after all outputs are declared.
void defineCounting(ProgramText& program, const program::Parameter& appendOutput);
void storeCount(ProgramText& program, const program::Parameter& appendOutput);

/// Work::List, for the other append outputs: defines the function that the body calls, with no effect.
void defineIgnored(ProgramText& program, const program::Parameter& appendOutput);

/// Work::List: computes `sk_element`, the number of the element, and `sk_wanted`, the number of the push, for
/// the entry of the fragment; placed in front of main().
void findEntry(ProgramText& program, DomainText& domain, const program::Parameter& appendOutput,
               bool pyramidLayered);

/// Work::List, for the append output itself: its outputs and the function that the body calls; then the
/// stores.
void defineListed(ProgramText& program, const program::Parameter& appendOutput, const StreamAccess& access);
void storeListed(ProgramText& program, const program::Parameter& appendOutput);

/// The function that the body calls: "void sk_push_r(float sk_v)" or "void sk_put_r(ivec2 sk_i, float sk_v)".
std::string signatureOf(const program::Parameter& appendOutput);

/// "sk_KIND_r"
std::string named(std::string_view kind, const program::Parameter& appendOutput);

/// The texel of index `sk_i` of a scatter output. Streams of more than two dimensions are always linearised.
std::string targetTexel(ProgramText& program, const program::Parameter& appendOutput,
                        const StreamAccess& access);

/// Whether the index `sk_i` is in bounds. As unsigned integers, negative indices are too large.
std::string isInside(ProgramText& program, const program::Parameter& appendOutput);

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
