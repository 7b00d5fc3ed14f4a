// SPDX-License-Identifier: MIT
//
// How variable and scatter outputs ("append outputs") are spelled in a kernel's program. An append output's kernel runs once to
// count what each element pushes, and once more for each entry of the append output's list, to find its value:
//
//   pass 1     domain   ordinary outputs, and for each counted append output the number of pushes of the element
//   tree       log4     sums of counts (histo_pyramid.hpp)
//   pass 2     list     entry j: the element and the push that it comes from, and the value pushed
//
// The list of a variable output is the stream. That of a scatter output holds the texels that its values
// belong to as well, and is then drawn as points (point_program.hpp). A scatter output with few pushes an
// element is not counted: its list has a slot for each push that may be, which takes one pass.
#pragma once

#include <cstdint>
#include <string>

#include "assemble/assemble.hpp"
#include "assemble/elements/domain.hpp"
#include "assemble/glsl/program_text.hpp"

namespace sk::assemble {

/// Whether a parameter is a variable or a scatter output.
bool isAppendOutput(const program::Parameter& parameter);

/// Whether its pushes are counted before its list is made.
bool isCounted(const program::Parameter& appendOutput);

/// Entries of an element in the list of an append output that is not counted, 0 where nothing is ever pushed.
int slotsOf(const program::Parameter& appendOutput);

/// Work::Counts: what the body calls; and, once all outputs are declared, that of the counts.
void defineCounting(ProgramText& program, const program::Parameter& appendOutput);
void storeCount(ProgramText& program, const program::Parameter& appendOutput);

/// Work::List, of the other append outputs: what the body calls, to no effect.
void defineIgnored(ProgramText& program, const program::Parameter& appendOutput);

/// Work::List: finds `sk_element`, the number of the element, and `sk_wanted`, which of its pushes is
/// taken, for the entry under the fragment; in front of main().
void findEntry(ProgramText& program, DomainText& domain, const program::Parameter& appendOutput,
               bool treeLayered);

/// Work::List, of the append output itself: its outputs and what the body calls, and the stores.
void defineListed(ProgramText& program, const program::Parameter& appendOutput, const StreamAccess& access);
void storeListed(ProgramText& program, const program::Parameter& appendOutput);

}  // namespace sk::assemble
