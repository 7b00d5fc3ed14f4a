// SPDX-License-Identifier: MIT
//
// Scans in one pass: a tile takes the result of the tiles before from what their work groups publish, first their own total and
// then that of all tiles up to theirs (decoupled look-back; D. Merrill and M. Garland, "Single-pass parallel prefix scan
// with decoupled look-back", 2016). Groups take their tiles in the order in which they start. A group that waits too
// long for a tile folds it, so that the pass ends on every device (T. Smith, R. Levien and J. Owens, "Decoupled
// fallback: a portable single-pass GPU scan", 2025).
//
// With subgroups, their invocations exchange what they see without waiting for the others of the group.
#include <cstddef>
#include <string>
#include <utility>
#include <vector>

#include "assemble/glsl/subgroups.hpp"
#include "assemble/reduce/scan_tile_text.hpp"

namespace sk::assemble {

using program::Parameter;

namespace {

/// The tiles that a group looks at together.
constexpr std::int32_t lookWindow = 64;
constexpr std::int32_t subgroupSize = 32;
constexpr std::int32_t subgroups = tileGroup / subgroupSize;
/// The subgroups that look, each at as many tiles as it has invocations.
constexpr std::int32_t lookingSubgroups = 8;

}  // namespace

std::string TileScanText::writeChained(const std::vector<Parameter>& written) {
  integers({"sk_length", "sk_groups"});
  if (profile_.subgroups) program_.extensions(subgroupExtensions());
  statement(profile_.subgroups
                ? "int sk_lane = int(gl_SubgroupInvocationID), sk_i = int(gl_SubgroupID) << 5 | sk_lane;"
                : "int sk_i = int(gl_LocalInvocationIndex);");
  declareSharedTotals();
  declareChain();
  statement("if (sk_i == 0) sk_taken = int(atomicAdd(sk_ticket, 1u));");
  wait();
  statement("int sk_tile = sk_taken;");
  statement("if (sk_tile >= sk_groups) return;");
  foldTile(written);
  for (const Parameter* accumulator : accumulators_) {
    statement(fmt::format("{} {} = {}[max(sk_i - 1, 0)], {} = {}[sk_runs - 1];", accumulator->element->glsl,
                          held("sk_own", *accumulator), sharedName(*accumulator),
                          held("sk_all", *accumulator), sharedName(*accumulator)));
  }
  statement("if (sk_i == 0) sk_publish(sk_tile, sk_tile == 0 ? 2u : 1u" + listOf("sk_all") + ");");
  for (const Parameter* accumulator : accumulators_) declareHeld("sk_before", *accumulator);
  statement("if (sk_tile > 0) {");
  lookBack(written);
  startFrom("sk_carried", "sk_before", "  ");
  combineInto("sk_carried", "sk_all", "  ");
  statement("  if (sk_i == 0) sk_publish(sk_tile, 2u" + listOf("sk_carried") + ");");
  statement("}");
  statement("sk_isStarted = sk_tile > 0 || sk_i > 0;");
  statement("if (sk_tile > 0) {");
  assign("sk_total", "sk_before", "  ");
  statement("  if (sk_i > 0) {");
  combineInto("sk_total", "sk_own", "    ");
  statement("  }");
  statement("} else if (sk_i > 0) {");
  assign("sk_total", "sk_own", "  ");
  if (!isSeeded()) {
    statement("} else {");
    for (const Parameter* accumulator : accumulators_)
      statement(fmt::format("  {} = {};", total(*accumulator), identityOf(*accumulator)));
  }
  statement("}");
  foldRun(true, written);
  if (keepsTile()) storeTile(written);
  return finish(comment());
}

/// The variables of all accumulators as arguments behind others.
std::string TileScanText::listOf(std::string_view name) const {
  std::string list;
  for (const Parameter* accumulator : accumulators_) list += ", " + held(name, *accumulator);
  return list;
}

void TileScanText::declareHeld(std::string_view name, const Parameter& accumulator) {
  statement(fmt::format("{} {};", accumulator.element->glsl, held(name, accumulator)));
}

void TileScanText::startFrom(std::string_view name, std::string_view value, std::string_view indent) {
  for (const Parameter* accumulator : accumulators_) {
    statement(fmt::format("{}{} {} = {};", indent, accumulator->element->glsl, held(name, *accumulator),
                          held(value, *accumulator)));
  }
}

void TileScanText::assign(std::string_view name, std::string_view value, std::string_view indent) {
  for (const Parameter* accumulator : accumulators_)
    statement(fmt::format("{}{} = {};", indent, held(name, *accumulator), held(value, *accumulator)));
}

/// Folds `value`, which comes later, into `name`.
void TileScanText::combineInto(std::string_view name, std::string_view value, std::string_view indent) {
  const std::string_view folded = std::exchange(folded_, name);
  statement(fmt::format("{}{}", indent, calling(reduction_.combine, [&](std::size_t, std::size_t k) {
                          return held(value, *accumulators_[k]);
                        })));
  folded_ = folded;
}

/// Folds tile sk_tile: the shared totals become those of all runs up to each.
void TileScanText::foldTile(const std::vector<Parameter>& written) {
  findRunOfTile();
  declareTotals();
  loadRun();
  statement("bool sk_isStarted = false;");
  foldRun(false, written);
  profile_.subgroups ? scanTotalsOfSubgroups() : scanTotals();
}

/// scanTotals() by exchanges within subgroups, then of their last totals.
void TileScanText::scanTotalsOfSubgroups() {
  const auto joinBefore = [&](std::string_view indent) {
    combineInto("sk_before", "sk_total", indent);
    for (const Parameter* accumulator : accumulators_)
      statement(fmt::format("{}{} = {};", indent, total(*accumulator), held("sk_before", *accumulator)));
  };
  statement(fmt::format("for (int sk_s = 1; sk_s < {}; sk_s *= 2) {{", subgroupSize));
  for (const Parameter* accumulator : accumulators_) {
    program_.variable("shared " + std::string(accumulator->element->glsl),
                      fmt::format("{}[{}]", rowsOf(*accumulator), subgroups));
    statement(fmt::format("  {} {} = subgroupShuffleUp({}, uint(sk_s));", accumulator->element->glsl,
                          held("sk_before", *accumulator), total(*accumulator)));
  }
  statement("  if (sk_lane >= sk_s && sk_i < sk_runs) {");
  joinBefore("    ");
  statement("  }");
  statement("}");
  statement(fmt::format("if (sk_lane == {}) {{", subgroupSize - 1));
  for (const Parameter* accumulator : accumulators_)
    statement(fmt::format("  {}[sk_i >> 5] = {};", rowsOf(*accumulator), total(*accumulator)));
  statement("}");
  wait();
  statement("if (sk_i >> 5 > 0 && sk_i < sk_runs) {");
  for (const Parameter* accumulator : accumulators_)
    statement(fmt::format("  {} {} = {}[0];", accumulator->element->glsl, held("sk_before", *accumulator),
                          rowsOf(*accumulator)));
  statement(fmt::format("  for (int sk_r = 1; sk_r < {}; ++sk_r) {{", subgroups));
  for (const Parameter* accumulator : accumulators_)
    statement(fmt::format("    {} {} = {}[sk_r];", accumulator->element->glsl, held("sk_row", *accumulator),
                          rowsOf(*accumulator)));
  statement("    if (sk_r < sk_i >> 5) {");
  combineInto("sk_before", "sk_row", "      ");
  statement("    }");
  statement("  }");
  joinBefore("  ");
  statement("}");
  for (const Parameter* accumulator : accumulators_)
    statement(fmt::format("{}[sk_i] = {};", sharedName(*accumulator), total(*accumulator)));
  wait();
}

/// A tile has a pair of words for each accumulator. Each holds 16 bits of the value, and in the highest bits what it is: 1
/// the tile's total, 2 that of all tiles up to it, 0 nothing yet. Words with different bits are not complete.
void TileScanText::declareChain() {
  program_.buffer("coherent volatile buffer sk_chain {\n  uint sk_ticket;\n  uvec2 sk_states[];\n}");
  program_.variable("shared int", "sk_taken");
  std::string parameters;
  std::vector<std::string> lines;
  for (std::size_t k = 0; k < accumulators_.size(); ++k) {
    parameters += fmt::format(", {} sk_v{}", accumulators_[k]->element->glsl, k);
    lines.push_back(fmt::format(
        "sk_states[sk_t * {} + {}] = uvec2(uint(sk_v{}) & 0xffffu, uint(sk_v{}) >> 16) | sk_flag << 30;",
        accumulators_.size(), k, k, k));
  }
  program_.function(fmt::format("void sk_publish(int sk_t, uint sk_flag{})", parameters), lines);
}

/// Reads the results of a tile to sk_seen, and what they are to sk_flag.
void TileScanText::readResult(std::string_view tile, std::string_view indent) {
  statement(fmt::format("{}uint sk_flag = 3u;", indent));
  for (std::size_t k = 0; k < accumulators_.size(); ++k) {
    statement(fmt::format("{}uvec2 sk_words{} = sk_states[({}) * {} + {}];", indent, k, tile,
                          accumulators_.size(), k));
    statement(fmt::format("{0}sk_flag &= sk_words{1}.x >> 30 & sk_words{1}.y >> 30;", indent, k));
  }
  for (std::size_t k = 0; k < accumulators_.size(); ++k) {
    const Parameter& accumulator = *accumulators_[k];
    statement(fmt::format("{0}{1} {2} = {1}((sk_words{3}.x & 0xffffu) | sk_words{3}.y << 16);", indent,
                          accumulator.element->glsl, held("sk_seen", accumulator), k));
  }
}

/// Sets sk_before to the fold of the tiles before. Some invocations look at a few of them each: fewer would keep a large GPU
/// waiting, as the front of tiles whose results are known advances by as many in each look, and with more, the looks of
/// all groups at the same few words hold up each other.
void TileScanText::lookBack(const std::vector<Parameter>& written) {
  integers({"sk_patience"});
  statement("  bool sk_hasBefore = false;");
  statement("  for (int sk_at = sk_tile - 1, sk_tries = 0; sk_at >= 0;) {");
  profile_.subgroups ? lookInSubgroups() : lookInGroup();
  statement("    if (sk_tries > sk_patience) {");
  statement("      int sk_tile = sk_at;");
  margin_ = "      ";
  foldTile(written);
  margin_ = "";
  takeBefore("sk_runs - 1", "      ");
  wait("      ");
  statement("      --sk_at;");
  statement("      sk_tries = 0;");
  statement("    }");
  statement("  }");
}

/// Looks at the tiles up to sk_at once. Results take the place of the totals of runs in shared memory.
void TileScanText::lookInGroup() {
  program_.variable("shared int", "sk_look_nearest");
  program_.variable("shared int", "sk_missing");
  statement(fmt::format("    if (sk_i == 0) sk_look_nearest = sk_missing = {};", lookWindow));
  wait("    ");
  statement(fmt::format("    if (sk_i < min({}, sk_at + 1)) {{", lookWindow));
  readResult("sk_at - sk_i", "      ");
  for (const Parameter* accumulator : accumulators_)
    statement(fmt::format("      {}[sk_i] = {};", sharedName(*accumulator), held("sk_seen", *accumulator)));
  statement("      if (sk_flag == 0u) atomicMin(sk_missing, sk_i);");
  statement("      if (sk_flag == 2u) atomicMin(sk_look_nearest, sk_i);");
  statement("    }");
  wait("    ");
  statement("    int sk_ready = min(sk_look_nearest + 1, sk_missing);");
  statement("    bool sk_isFound = sk_look_nearest < sk_missing;");
  foldWindow();
  statement("    if (sk_ready > 0) {");
  takeBefore("0", "      ");
  statement("    }");
  statement("    if (sk_isFound) break;");
  statement("    sk_at -= sk_ready;");
  statement("    sk_tries = sk_ready > 0 ? 0 : sk_tries + 1;");
  wait("    ");
}

/// lookInGroup() by subgroups, each of which folds the results that it sees, up to the first that is missing or includes all tiles
/// before. sk_knowns are their numbers, and 64 if there is such a result.
void TileScanText::lookInSubgroups() {
  program_.variable("shared int", fmt::format("sk_knowns[{}]", lookingSubgroups));
  statement(fmt::format("    if (sk_i < {}) {{", lookingSubgroups * subgroupSize));
  readResult("max(sk_at - sk_i, 0)", "      ");
  statement("      uint sk_lacking = subgroupBallot(sk_flag == 0u || sk_i > sk_at).x;");
  statement("      uint sk_totals = subgroupBallot(sk_flag == 2u && sk_i <= sk_at).x;");
  statement(fmt::format("      int sk_end = sk_lacking == 0u ? {} : findLSB(sk_lacking);", subgroupSize));
  statement(fmt::format("      int sk_last = sk_totals == 0u ? {} : findLSB(sk_totals);", subgroupSize));
  statement("      int sk_known = min(sk_last + 1, sk_end);");
  statement(fmt::format("      for (int sk_s = 1; sk_s < {}; sk_s *= 2) {{", subgroupSize));
  for (const Parameter* accumulator : accumulators_) {
    statement(fmt::format("        {} {} = subgroupShuffleDown({}, uint(sk_s));", accumulator->element->glsl,
                          held("sk_earlier", *accumulator), held("sk_seen", *accumulator)));
  }
  statement("        if (sk_lane + sk_s < sk_known) {");
  combineInto("sk_earlier", "sk_seen", "          ");
  assign("sk_seen", "sk_earlier", "          ");
  statement("        }");
  statement("      }");
  statement("      if (sk_lane == 0) {");
  statement("        sk_knowns[sk_i >> 5] = sk_known | (sk_last < sk_end ? 64 : 0);");
  for (const Parameter* accumulator : accumulators_)
    statement(
        fmt::format("        {}[sk_i >> 5] = {};", rowsOf(*accumulator), held("sk_seen", *accumulator)));
  statement("      }");
  statement("    }");
  wait("    ");
  statement("    int sk_ready = 0;");
  statement("    bool sk_isFound = false;");
  statement(fmt::format("    for (int sk_r = 0; sk_r < {}; ++sk_r) {{", lookingSubgroups));
  statement(fmt::format("      if (!sk_isFound && sk_ready == sk_r * {}) {{", subgroupSize));
  statement("        int sk_known = sk_knowns[sk_r] & 63;");
  statement("        sk_isFound = sk_knowns[sk_r] >= 64;");
  statement("        sk_ready += sk_known;");
  statement("        if (sk_known > 0) {");
  for (const Parameter* accumulator : accumulators_) {
    statement(fmt::format("          {} {} = {}[sk_r];", accumulator->element->glsl,
                          held("sk_earlier", *accumulator), rowsOf(*accumulator)));
  }
  joinEarlier("          ");
  statement("        }");
  statement("      }");
  statement("    }");
  wait("    ");
  statement("    if (sk_isFound) break;");
  statement("    sk_at -= sk_ready;");
  statement("    sk_tries = sk_ready > 0 ? 0 : sk_tries + 1;");
}

/// Folds the first sk_ready results of the window, of which later ones are of earlier tiles, to the first.
void TileScanText::foldWindow() {
  statement("    for (int sk_s = 1; sk_s < sk_ready; sk_s *= 2) {");
  statement("      if ((sk_i & (2 * sk_s - 1)) == 0 && sk_i + sk_s < sk_ready) {");
  for (const Parameter* accumulator : accumulators_) {
    statement(fmt::format("        {} {} = {}[sk_i + sk_s], {} = {}[sk_i];", accumulator->element->glsl,
                          held("sk_earlier", *accumulator), sharedName(*accumulator),
                          held("sk_later", *accumulator), sharedName(*accumulator)));
  }
  combineInto("sk_earlier", "sk_later", "        ");
  for (const Parameter* accumulator : accumulators_) {
    statement(
        fmt::format("        {}[sk_i] = {};", sharedName(*accumulator), held("sk_earlier", *accumulator)));
  }
  statement("      }");
  wait("      ");
  statement("    }");
}

/// Puts a result in shared memory before sk_before.
void TileScanText::takeBefore(std::string_view at, std::string_view indent) {
  for (const Parameter* accumulator : accumulators_) {
    statement(fmt::format("{}{} {} = {}[{}];", indent, accumulator->element->glsl,
                          held("sk_earlier", *accumulator), sharedName(*accumulator), at));
  }
  joinEarlier(indent);
}

/// Puts sk_earlier before sk_before.
void TileScanText::joinEarlier(std::string_view indent) {
  statement(fmt::format("{}if (sk_hasBefore) {{", indent));
  combineInto("sk_earlier", "sk_before", fmt::format("{}  ", indent));
  statement(fmt::format("{}}}", indent));
  assign("sk_before", "sk_earlier", indent);
  statement(fmt::format("{}sk_hasBefore = true;", indent));
}

}  // namespace sk::assemble
