// SPDX-License-Identifier: MIT
#include "assemble/sort/radix_program.hpp"

#include <array>
#include <initializer_list>
#include <string>

#include <fmt/format.h>

#include "assemble/glsl/program_text.hpp"
#include "assemble/glsl/subgroups.hpp"
#include "glsl_text/group_sums.hpp"
#include "glsl_text/radix_sort.hpp"

namespace sk::assemble {

namespace {

/// The invocations of a work group, and the keys or counts of each.
struct GroupShape {
  std::int32_t invocations, run;
};

/// The programs for Sum, Store and StorePairs use it.
constexpr GroupShape plainShape{256, radixSumTile / 256};

GroupShape shapeOf(const Profile& profile) {
  return profile.subgroups ? GroupShape{512, 12} : GroupShape{256, 16};
}

bool hasPairs(RadixStep step) {
  switch (step) {
    case RadixStep::Count:
    case RadixStep::Sum:
    case RadixStep::Move:
    case RadixStep::Store: return false;
    case RadixStep::CountPairs:
    case RadixStep::MoveFirst:
    case RadixStep::MovePairs:
    case RadixStep::StorePairs: return true;
  }
  return false;
}

/// The formats of the images of words and of pairs. GLSL needs none for images that are only written.
std::string formatDefinitions(const Profile& profile, RadixStep step) {
  if (!declaresFormats(profile)) return "#define SK_WORDS\n#define SK_MOVED_WORDS\n";
  return fmt::format("#define SK_WORDS , r32ui\n#define SK_MOVED_WORDS , {}\n",
                     hasPairs(step) ? "rg32ui" : "r32ui");
}

std::string_view extensionOf(const Profile& profile, RadixStep step, RadixStorage storage) {
  if (!declaresFormats(profile) || !hasPairs(step) || step == RadixStep::CountPairs || storage.writes)
    return "";
  return formatExtension(profile, std::array<std::string, 1>{"rg32ui"});
}

std::string definitions(bool usesSubgroups, const GroupShape& shape, RadixStep step, RadixKeys keys,
                        RadixStorage storage) {
  std::string text;
  if (usesSubgroups) text += subgroupExtensions() + "#define SK_SUBGROUPS\n";
  text += fmt::format("#define SK_GROUP {}\n#define SK_RUN {}\n", shape.invocations, shape.run);
  if (keys == RadixKeys::Floats) text += "#define SK_FLOATS\n";
  if (hasPairs(step)) text += "#define SK_PAIRS\n";
  if (step == RadixStep::MoveFirst) text += "#define SK_FIRST\n";
  if (storage.reads) text += "#define SK_FROM_BUFFER\n";
  if (storage.writes) text += "#define SK_TO_BUFFER\n";
  return text;
}

}  // namespace

std::int32_t radixTile(const Profile& profile) {
  const GroupShape shape = shapeOf(profile);
  return shape.invocations * shape.run;
}

std::string radixProgram(const Profile& profile, RadixStep step, RadixKeys keys, RadixStorage storage) {
  const auto after = [&](bool usesSubgroups, const GroupShape& shape,
                         std::initializer_list<std::string_view> texts) {
    std::string program =
        fmt::format("{}\n{}{}{}{}{}", profile.version, extensionOf(profile, step, storage),
                    definitions(usesSubgroups, shape, step, keys, storage), formatDefinitions(profile, step),
                    precisionStatements(profile), library::radixHead);
    for (const std::string_view text : texts) program += text;
    return program;
  };
  switch (step) {
    case RadixStep::Sum: return after(false, plainShape, {groupSums(), library::sumCounts});
    case RadixStep::Store:
    case RadixStep::StorePairs:
      return after(false, plainShape, {text(Function::Paired), library::radixKeys, library::storeWords});
    case RadixStep::Count:
    case RadixStep::CountPairs:
      return after(profile.subgroups, shapeOf(profile), {library::radixKeys, library::countDigits});
    case RadixStep::Move:
    case RadixStep::MoveFirst:
    case RadixStep::MovePairs:
      return after(
          profile.subgroups, shapeOf(profile),
          {profile.subgroups ? std::string_view() : groupSums(), library::radixKeys, library::moveKeys});
  }
  return {};
}

std::string_view groupSums() { return library::groupSums; }

}  // namespace sk::assemble
