// SPDX-License-Identifier: MIT
#include "assemble/sort/radix_program.hpp"

#include <fmt/format.h>

#include "assemble/glsl/program_text.hpp"
#include "glsl_text/group_sums.hpp"
#include "glsl_text/radix_sort.hpp"

namespace sk::assemble {

namespace {

/// Whether the words that a step reads or writes in the buffer are pairs.
bool hasPairs(RadixStep step) {
  switch (step) {
    case RadixStep::Count:
    case RadixStep::Sum:
    case RadixStep::Move: return false;
    case RadixStep::CountPairs:
    case RadixStep::MoveFirst:
    case RadixStep::MovePairs:
    case RadixStep::StorePairs: return true;
  }
  return false;
}

std::string definitionsOf(RadixStep step, RadixStorage storage) {
  std::string text;
  if (hasPairs(step)) text += "#define SK_PAIRS\n";
  if (step == RadixStep::MoveFirst) text += "#define SK_FIRST\n";
  if (storage.reads) text += "#define SK_FROM_BUFFER\n";
  if (storage.writes) text += "#define SK_TO_BUFFER\n";
  return text;
}

std::string_view bodyOf(RadixStep step) {
  switch (step) {
    case RadixStep::Count:
    case RadixStep::CountPairs: return library::countDigits;
    case RadixStep::Sum: return library::sumCounts;
    case RadixStep::Move:
    case RadixStep::MoveFirst:
    case RadixStep::MovePairs: return library::moveKeys;
    case RadixStep::StorePairs: return library::storePairs;
  }
  return {};
}

}  // namespace

std::string radixProgram(const Profile& profile, RadixStep step, RadixStorage storage) {
  return fmt::format("{}\n{}{}{}{}{}", profile.version, definitionsOf(step, storage), library::radixHead,
                     text(Function::Paired), groupSums(), bodyOf(step));
}

std::string_view groupSums() { return library::groupSums; }

}  // namespace sk::assemble
