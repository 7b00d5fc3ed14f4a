// SPDX-License-Identifier: MIT
//
// No group waits for another: whichever finds that all others have finished goes on. The list is combined in a fixed order, so
// that results have the same bits in every run.
#include "assemble/reduce/group_fold.hpp"

#include <algorithm>

#include <fmt/format.h>

#include "assemble/elements/planes.hpp"
#include "assemble/reduce/reduce_plan.hpp"

namespace sk::assemble {

using program::Kernel;
using program::Parameter;
using program::Reduction;
using program::Role;

namespace {

constexpr std::size_t mostInvocations = 256;
constexpr std::size_t sharedPlaneBytes = 16;

std::size_t planesOf(const Kernel& fold) {
  std::size_t planes = 0;
  for (const Parameter& parameter : fold.parameters) {
    if (parameter.role == Role::Accumulator) planes += parameter.element->fields.size();
  }
  return planes;
}

/// Adds `more` to `lines`, indented.
void addIndented(std::vector<std::string>& lines, const std::vector<std::string>& more) {
  for (const std::string& line : more) lines.push_back("  " + line);
}

}  // namespace

bool mayFoldInGroups(const Reduction& reduction) {
  const bool combinesAlone = std::ranges::all_of(reduction.combine.parameters, [](const Parameter& p) {
    return p.role == Role::Input || p.role == Role::Accumulator;
  });
  return reduction.commutative && combinesAlone && foldsInGroups(reduction) &&
         planesOf(reduction.fold) * sharedPlaneBytes * mostInvocations <= groupBytes;
}

GroupFold::GroupFold(ProgramText& program, const Reduction& reduction, bool isPacked)
    : program_(program), reduction_(reduction), isPacked_(isPacked) {
  program_.takeShared(planesOf(reduction.fold) * sharedPlaneBytes * mostInvocations);
}

std::string GroupFold::total(const Parameter& accumulator) const {
  return fmt::format("sk_total_{}", accumulator.symbol);
}

std::string GroupFold::shared(const Parameter& accumulator) const {
  return fmt::format("sk_shared_{}", accumulator.symbol);
}

std::string GroupFold::define(const Parameter& accumulator) {
  accumulators_.push_back(&accumulator);
  program_.variable(accumulator.element->glsl, total(accumulator));
  return total(accumulator);
}

template <class ValueOf>
std::string GroupFold::combining(ValueOf&& valueOf) const {
  std::vector<std::string> arguments;
  std::size_t inputs = 0, totals = 0;
  for (const Parameter& parameter : reduction_.combine.parameters) {
    arguments.push_back(parameter.role == Role::Input ? valueOf(*accumulators_[inputs++])
                                                      : total(*accumulators_[totals++]));
  }
  return call(reduction_.combine.entry, arguments, "        ") + ";";
}

void GroupFold::startFromIdentities(std::vector<std::string>& lines) const {
  for (const Parameter* accumulator : accumulators_)
    lines.push_back(fmt::format("{} = {};", total(*accumulator), accumulator->identity));
}

/// Combines the accumulators of all invocations into those of the first one.
void GroupFold::combineInGroup(std::vector<std::string>& lines) const {
  const auto keep = [&](std::string_view indent) {
    for (const Parameter* accumulator : accumulators_)
      lines.push_back(fmt::format("{}{}[sk_i] = {};", indent, shared(*accumulator), total(*accumulator)));
  };
  keep("");
  lines.push_back(fmt::format("for (int sk_s = 1; sk_s < {}; sk_s *= 2) {{", groupSize()));
  lines.emplace_back("  memoryBarrierShared();");
  lines.emplace_back("  barrier();");
  lines.emplace_back("  if ((sk_i & (2 * sk_s - 1)) == 0) {");
  lines.push_back("    " + combining([&](const Parameter& accumulator) {
                    return fmt::format("{}[sk_i + sk_s]", shared(accumulator));
                  }));
  keep("    ");
  lines.emplace_back("  }");
  lines.emplace_back("}");
}

/// Invocation i combines the entries i, i + groupSize() and so on. It reads four of them before it combines the first, so that their latencies overlap.
void GroupFold::combineList(std::vector<std::string>& lines) const {
  constexpr int together = 4;
  const int size = groupSize();
  startFromIdentities(lines);
  lines.push_back(fmt::format("for (int sk_k = sk_i; sk_k < sk_groups.x; sk_k += {}) {{", together * size));
  for (int i = 0; i < together; ++i)
    lines.push_back(
        fmt::format("  sk_Partial sk_p{0} = sk_partials[min(sk_k + {1}, sk_groups.x - 1)];", i, i * size));
  for (int i = 0; i < together; ++i) {
    const std::string one =
        combining([&](const Parameter& a) { return fmt::format("sk_p{}.{}", i, total(a)); });
    lines.push_back(i == 0 ? "  " + one : fmt::format("  if (sk_k + {} < sk_groups.x) {}", i * size, one));
  }
  lines.emplace_back("}");
}

void GroupFold::finish() {
  group_ = isPacked_ ? groupOfWideTexels : program_.groupOfTexels();
  const std::size_t first = program_.outputCount();
  for (const Parameter* accumulator : accumulators_) declareOutputs(program_, *accumulator);
  program_.storeLater(first);
  program_.uniform("ivec4", "sk_groups");
  program_.uniform("ivec4", "sk_result");
  std::string members;
  std::vector<std::string> totals;
  for (const Parameter* accumulator : accumulators_) {
    members += fmt::format("{} {}; ", accumulator->element->glsl, total(*accumulator));
    totals.push_back(total(*accumulator));
    program_.variable(fmt::format("shared {}", accumulator->element->glsl),
                      fmt::format("{}[{}]", shared(*accumulator), groupSize()));
  }
  program_.variable("shared bool", "sk_isLast");
  program_.variable(fmt::format("struct sk_Partial {{ {}}}", members), "");
  program_.buffer("coherent buffer sk_Partials { uint sk_finished; sk_Partial sk_partials[]; }");
  program_.foreign(reduction_.addition);

  std::vector<std::string> before, last, after;
  startFromIdentities(before);
  after.emplace_back("int sk_i = int(gl_LocalInvocationIndex);");
  combineInGroup(after);
  after.emplace_back("if (sk_i == 0) {");
  after.emplace_back(
      "  int sk_number = sk_groups.w + int(gl_WorkGroupID.y) * sk_groups.z + int(gl_WorkGroupID.x);");
  after.push_back(fmt::format("  sk_partials[sk_number] = sk_Partial({});", fmt::join(totals, ", ")));
  after.emplace_back("  memoryBarrierBuffer();");
  after.emplace_back("  sk_isLast = atomicAdd(sk_finished, 1u) + 1u == uint(sk_groups.x);");
  after.emplace_back("}");
  after.emplace_back("memoryBarrierShared();");
  after.emplace_back("barrier();");
  after.emplace_back("if (sk_isLast) {");
  last.emplace_back("memoryBarrierBuffer();");
  combineList(last);
  combineInGroup(last);
  last.emplace_back("if (sk_i == 0) {");
  last.emplace_back("  sk_finished = 0u;");
  addIndented(last, program_.linesOf([&] {
    for (const Parameter* accumulator : accumulators_) store(program_, *accumulator, total(*accumulator));
  }));
  addIndented(last, program_.storesOf(first, program_.outputCount(), "sk_result.xy"));
  last.emplace_back("}");
  addIndented(after, last);
  after.emplace_back("}");
  program_.foldTiles(group_, std::move(before), std::move(after));
}

}  // namespace sk::assemble
