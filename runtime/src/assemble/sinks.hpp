// SPDX-License-Identifier: MIT
//
// How variable and scatter outputs ("sinks") are spelled in a kernel's program. A sink's kernel runs once to
// count what each element pushes, and once more for each entry of the sink's list, to find its value:
//
//   pass 1     domain   ordinary outputs, and for each counted sink the number of pushes of the element
//   tree       log4     sums of counts (count_tree.hpp)
//   pass 2     list     entry j: the element and the push that it comes from, and the value pushed
//
// The list of a variable output is the stream. That of a scatter output holds the texels that its values
// belong to as well, and is then drawn as points (point_program.hpp). A scatter output with few pushes an
// element is not counted: its list has a slot for each push that may be, which takes one pass.
#pragma once

#include <cstdint>
#include <string>

#include "assemble/assemble.hpp"
#include "assemble/domain.hpp"
#include "assemble/program_text.hpp"

namespace sk::assemble {

/// Whether a parameter is a variable or a scatter output.
bool isSink(const program::Parameter& parameter);

/// Whether its pushes are counted before its list is made.
bool isCounted(const program::Parameter& sink);

/// Entries of an element in the list of a sink that is not counted, 0 where nothing is ever pushed.
int slotsOf(const program::Parameter& sink);

/// Work::Counts: what the body calls; and, once all outputs are declared, that of the counts.
void defineCounting(ProgramText& program, const program::Parameter& sink);
void storeCount(ProgramText& program, const program::Parameter& sink);

/// Work::List, of the other sinks: what the body calls, to no effect.
void defineIgnored(ProgramText& program, const program::Parameter& sink);

/// Work::List: finds `sk_element`, the number of the element, and `sk_wanted`, which of its pushes is
/// taken, for the entry under the fragment; in front of main().
void findEntry(ProgramText& program, DomainText& domain, const program::Parameter& sink, bool treeLayered);

/// Work::List, of the sink itself: its outputs and what the body calls, and the stores.
void defineListed(ProgramText& program, const program::Parameter& sink, const StreamAccess& access);
void storeListed(ProgramText& program, const program::Parameter& sink);

}  // namespace sk::assemble
