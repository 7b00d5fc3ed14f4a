// SPDX-License-Identifier: MIT
#include "assemble/sort/radix_program.hpp"

#include <fmt/format.h>

#include "assemble/glsl/group_sums.hpp"
#include "glsl_text/radix_sort.hpp"

namespace sk::assemble {

namespace {

std::string_view definitionsOf(RadixStep step) {
  switch (step) {
    case RadixStep::Count:
    case RadixStep::Sum:
    case RadixStep::Move: return "";
    case RadixStep::MoveFirst: return "#define SK_PLACES\n#define SK_FIRST\n";
    case RadixStep::MovePairs: return "#define SK_PLACES\n";
  }
  return {};
}

std::string_view bodyOf(RadixStep step) {
  switch (step) {
    case RadixStep::Count: return library::countDigits;
    case RadixStep::Sum: return library::sumCounts;
    case RadixStep::Move:
    case RadixStep::MoveFirst:
    case RadixStep::MovePairs: return library::moveKeys;
  }
  return {};
}

}  // namespace

std::string radixProgram(const Profile& profile, RadixStep step) {
  return fmt::format("{}\n{}{}{}{}", profile.version, definitionsOf(step), library::radixHead, groupSums(),
                     bodyOf(step));
}

}  // namespace sk::assemble
