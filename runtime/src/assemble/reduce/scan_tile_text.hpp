// SPDX-License-Identifier: MIT
//
// Writes the programs of scan_tile_program.hpp.
#pragma once

#include <algorithm>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include <fmt/format.h>

#include "assemble/elements/arguments.hpp"
#include "assemble/reduce/scan_plan.hpp"
#include "assemble/reduce/scan_program.hpp"

namespace sk::assemble {

class TileScanText : ScanText {
  using Kernel = program::Kernel;
  using Parameter = program::Parameter;
  using Reduction = program::Reduction;

 public:
  TileScanText(const Profile& profile, const Reduction& reduction, const ReduceVariant& variant)
      : ScanText(profile, reduction, variant) {}

  std::string write() {
    const std::vector<Parameter> written = declareParameters();
    if (isTile() && !isOfPartials(variant_.walk)) program_.foreign(reduction_.addition);
    program_.dispatchGroups(tileGroup, 1);
    if (variant_.chained) return writeChained(written);
    statement("int sk_i = int(gl_LocalInvocationIndex);");
    if (isTile()) {
      findTile();
    } else {
      findRun();
    }
    declareTotals();
    loadRun();
    startRun();
    if (!isTile()) {
      foldRun(true, written);
      return finish(comment());
    }
    foldRun(false, written);
    declareSharedTotals();
    scanTotals();
    if (variant_.scan == ScanPass::Folds) {
      takeTotalOfTile();
      return finish(written, comment());
    }
    continueFromRunsBefore();
    foldRun(true, written);
    if (keepsTile()) storeTile(written);
    return finish(comment());
  }

 private:
  bool isTile() const { return variant_.unit == ScanUnit::Tile; }
  int run() const { return variant_.run; }

  // ---- where the run is -------------------------------------------------------------------------

  void defineGroup() {
    statement(fmt::format("int sk_group = sk_pixel.y << {} | sk_pixel.x;", groupRowShift));
  }

  /// Sets sk_tile, sk_line, and sk_first, the place in the line of the run's first item.
  void findTile() {
    integers({"sk_length"});
    if (variant_.scan == ScanPass::Folds) {
      statement("int sk_group = " + domain_.number() + ";");
    } else {
      integers({"sk_groups"});
      defineGroup();
      statement("if (sk_group >= sk_groups) return;");
    }
    if (isOneLine()) {
      statement("int sk_tile = sk_group;");
    } else {
      integers({"sk_lines"});
      statement("int sk_tile = sk_group / sk_lines, sk_line = sk_group - sk_tile * sk_lines;");
    }
    findRunOfTile();
  }

  void findRunOfTile() {
    const int items = tileGroup * run();
    statement(fmt::format("int sk_left = sk_length - sk_tile * {};", items));
    statement(fmt::format("int sk_runs = min((sk_left + {}) / {}, {});", run() - 1, run(), tileGroup));
    statement(
        fmt::format("int sk_first = sk_tile * {} + sk_i * {}, sk_count = clamp(sk_length - sk_first, 0, {});",
                    items, run(), run()));
    setStart();
  }

  void findRun() {
    integers({"sk_length", "sk_lines", "sk_groups"});
    defineGroup();
    statement(fmt::format("int sk_tile = (sk_group * {} + sk_i) / sk_lines;", tileGroup));
    statement(fmt::format("int sk_line = sk_group * {} + sk_i - sk_tile * sk_lines;", tileGroup));
    statement(
        fmt::format("int sk_first = sk_tile * {}, sk_count = min(sk_length - sk_first, {});", run(), run()));
    statement("if (sk_count <= 0) return;");
    setStart();
  }

  /// Sets sk_base, the number of the line's first item.
  void setStart() {
    if (isOneLine()) return;
    integers({"sk_inner"});
    statement("int sk_base = sk_line / sk_inner * sk_length * sk_inner + sk_line % sk_inner;");
  }
  /// The number of the item at a place of the line.
  std::string numberOf(std::string_view place) const {
    return isOneLine() ? std::string(place) : fmt::format("sk_base + ({}) * sk_inner", place);
  }

  // ---- the run ----------------------------------------------------------------------------------

  std::string itemsOf(const Parameter& input) const { return fmt::format("sk_run_{}", input.symbol); }

  /// Fetches the items.
  void loadRun() {
    bool isNone = true;
    for (const Parameter* input : inputs_) {
      if (!isNeeded(*input, variant_.specs)) continue;
      const Parameter read = variant_.packed ? fourOf(*input) : *input;
      statement(fmt::format("{} {}[{}];", read.element->glsl, itemsOf(*input), run()));
      isNone = false;
    }
    if (isNone) return;
    if (const Parameter* input = inputThroughTile()) return loadTile(*input);
    statement(fmt::format("for (int sk_k = 0; sk_k < {}; ++sk_k) {{", run()));
    statement("  if (sk_k < sk_count) {");
    const std::string number = numberOf("sk_first + sk_k");
    moveTo(number, "    ");
    for (std::size_t i = 0; i < kernel_.parameters.size(); ++i) {
      const Parameter& input = kernel_.parameters[i];
      if (input.role != program::Role::Input || !isNeeded(input, variant_.specs)) continue;
      statement(fmt::format(
          "    {}[sk_k] = {};", itemsOf(input),
          variant_.packed ? fetch(program_, fourOf(input), numbered(number)) : elementAt(i, number)));
    }
    statement("  }");
    statement("}");
  }

  /// The only input, if its items fit into the shared memory of the results.
  const Parameter* inputThroughTile() const {
    if (!isTile() || run() == 1 || inputs_.size() != 1) return nullptr;
    return inputs_.front()->element == accumulators_.front()->element ? inputs_.front() : nullptr;
  }

  std::string_view typeOfItem(const Parameter& parameter) const {
    return variant_.packed ? fourOf(parameter).element->glsl : parameter.element->glsl;
  }

  /// Declares shared memory for one item of each invocation's run.
  std::string tileOf(const Parameter& accumulator) {
    const int items = tileGroup * run();
    const std::string name = fmt::format("sk_tile_{}", accumulator.symbol);
    program_.variable(fmt::format("shared {}", typeOfItem(accumulator)),
                      fmt::format("{}[{}]", name, items + items / (variant_.packed ? 8 : 16)));
    return name;
  }

  /// The item of the tile that an invocation fetches or stores in step sk_k. Neighbouring ones take neighbouring items,
  /// or, where a tile is of pairs of rows (ScanPlanner), those of both rows.
  std::string itemOfInvocation() {
    const std::string item = fmt::format("sk_k * {} + sk_i", tileGroup);
    if (isOfPartials(variant_.walk) || !isOneLine()) return item;
    integers({"sk_pairs"});
    program_.require(Function::Paired);
    return fmt::format("sk_pairs > 0 ? sk_paired({}, sk_pairs) : {}", item, item);
  }

  /// Fetches the items of all runs, neighbouring ones by neighbouring invocations. Fetches are unconditional, of the last item
  /// in place of those past the end: one within a branch would wait for the one before.
  void loadTile(const Parameter& input) {
    const auto i = static_cast<std::size_t>(&input - kernel_.parameters.data());
    const std::string tile = tileOf(*accumulators_.front());
    statement(fmt::format("{} sk_fetched[{}];", typeOfItem(input), run()));
    statement(fmt::format("for (int sk_k = 0; sk_k < {}; ++sk_k) {{", run()));
    statement(fmt::format("  int sk_n = {};", itemOfInvocation()));
    const std::string number =
        numberOf(fmt::format("sk_tile * {} + min(sk_n, sk_left - 1)", tileGroup * run()));
    moveTo(number, "  ");
    statement(fmt::format("  sk_fetched[sk_k] = {};", variant_.packed
                                                          ? fetch(program_, fourOf(input), numbered(number))
                                                          : elementAt(i, number)));
    statement("}");
    statement(fmt::format("for (int sk_k = 0; sk_k < {}; ++sk_k) {{", run()));
    statement(fmt::format("  int sk_n = {};", itemOfInvocation()));
    statement(fmt::format("  {}[{}] = sk_fetched[sk_k];", tile, slotOf("sk_n")));
    statement("}");
    wait();
    statement(fmt::format("for (int sk_k = 0; sk_k < {}; ++sk_k) {{", run()));
    statement(fmt::format("  int sk_n = sk_i * {} + sk_k;", run()));
    statement(fmt::format("  {}[sk_k] = {}[{}];", itemsOf(input), tile, slotOf("sk_n")));
    statement("}");
  }

  std::string itemOf(std::size_t i, std::string_view lane) const {
    const Parameter& input = kernel_.parameters[i];
    if (!isNeeded(input, variant_.specs)) return absentElement(input);
    return fmt::format("{}[sk_k]{}", itemsOf(input), lane);
  }

  void declareTotals() {
    for (const Parameter* accumulator : accumulators_) {
      const bool hasIdentity = !isSeeded();
      statement(hasIdentity ? fmt::format("{} {} = {};", accumulator->element->glsl, total(*accumulator),
                                          identityOf(*accumulator))
                            : fmt::format("{} {};", accumulator->element->glsl, total(*accumulator)));
    }
  }

  /// The first run of a tile, or any run, starts from the result of what is before; then sk_isStarted is true.
  void startRun() {
    if (!variant_.carried) {
      statement("bool sk_isStarted = false;");
      return;
    }
    statement(isTile() ? "bool sk_isStarted = sk_tile > 0 && sk_i == 0;"
                       : "bool sk_isStarted = sk_tile > 0;");
    statement("if (sk_isStarted) {");
    takeCarry(isOneLine() ? "sk_tile - 1" : "(sk_tile - 1) * sk_lines + sk_line", "  ");
    if (isTile()) keepStart();
    statement("}");
  }

  /// The first run folds its items twice.
  void keepStart() {
    for (const Parameter* accumulator : accumulators_) {
      program_.prologue(fmt::format("{} {};", accumulator->element->glsl, held("sk_carried", *accumulator)));
      statement(fmt::format("  {} = {};", held("sk_carried", *accumulator), total(*accumulator)));
    }
  }

  /// Folds the items. `keeps`: each of them has a result.
  void foldRun(bool keeps, const std::vector<Parameter>& written) {
    if (keeps && variant_.packed) {
      for (const Parameter* accumulator : accumulators_)
        statement(fmt::format("{} {};", fourOf(*accumulator).element->glsl, keptOf(*accumulator)));
    }
    statement(fmt::format("for (int sk_k = 0; sk_k < {}; ++sk_k) {{", run()));
    statement("  if (sk_k < sk_count) {");
    moveTo(numberOf("sk_first + sk_k"), "    ");
    if (keeps && isExclusive() && !variant_.packed) keepItem(written);
    for (int lane = 0; lane < (variant_.packed ? lanes : 1); ++lane) {
      const std::string component = variant_.packed ? fmt::format(".{}", "xyzw"[lane]) : std::string();
      if (keeps && isExclusive() && variant_.packed) keepLane(component);
      foldItem(component, lane == 0);
      if (keeps && !isExclusive() && variant_.packed) keepLane(component);
    }
    if (keeps && (!isExclusive() || variant_.packed)) keepItem(written);
    statement("  }");
    statement("}");
  }

  void foldItem(const std::string& component, bool isFirst) {
    const Kernel& kernel = isOfPartials(variant_.walk) ? reduction_.combine : reduction_.fold;
    const std::string fold =
        calling(kernel, [&](std::size_t i, std::size_t) { return itemOf(i, component); });
    if (!isSeeded() || !isFirst) return statement("    " + fold);
    statement("    if (sk_k == 0 && !sk_isStarted) {");
    for (std::size_t k = 0; k < accumulators_.size(); ++k) {
      const auto i = static_cast<std::size_t>(inputs_[k] - kernel_.parameters.data());
      statement(fmt::format("      {} = {};", total(*accumulators_[k]), itemOf(i, component)));
    }
    statement("    } else {");
    statement("      " + fold);
    statement("    }");
  }

  void keepLane(std::string_view component) {
    for (const Parameter* accumulator : accumulators_)
      statement(fmt::format("    {}{} = {};", keptOf(*accumulator), component, total(*accumulator)));
  }

  // ---- the tile ---------------------------------------------------------------------------------

  static std::string sharedName(const Parameter& accumulator) {
    return fmt::format("sk_shared_{}", accumulator.symbol);
  }

  void wait(std::string_view indent = "") {
    statement(fmt::format("{}memoryBarrierShared();", indent));
    statement(fmt::format("{}barrier();", indent));
  }

  void declareSharedTotals() {
    for (const Parameter* accumulator : accumulators_) {
      program_.variable("shared " + std::string(accumulator->element->glsl),
                        fmt::format("{}[{}]", sharedName(*accumulator), tileGroup));
    }
  }

  /// Replaces the total of each run by the fold of those of all runs up to it (Hillis and Steele, 1986).
  void scanTotals() {
    for (const Parameter* accumulator : accumulators_)
      statement(fmt::format("{}[sk_i] = {};", sharedName(*accumulator), total(*accumulator)));
    statement(fmt::format("for (int sk_s = 1; sk_s < {}; sk_s *= 2) {{", tileGroup));
    wait("  ");
    statement("  bool sk_isJoined = sk_i >= sk_s && sk_i < sk_runs;");
    for (const Parameter* accumulator : accumulators_) {
      statement(fmt::format("  {} {} = {}[sk_isJoined ? sk_i - sk_s : sk_i];", accumulator->element->glsl,
                            held("sk_before", *accumulator), sharedName(*accumulator)));
    }
    wait("  ");
    statement("  if (sk_isJoined) {");
    folded_ = "sk_before";
    statement("    " + calling(reduction_.combine, [&](std::size_t, std::size_t k) {
                return held("sk_total", *accumulators_[k]);
              }));
    folded_ = "sk_total";
    for (const Parameter* accumulator : accumulators_) {
      statement(fmt::format("    {} = {};", total(*accumulator), held("sk_before", *accumulator)));
      statement(fmt::format("    {}[sk_i] = {};", sharedName(*accumulator), total(*accumulator)));
    }
    statement("  }");
    statement("}");
    wait();
  }

  void takeTotalOfTile() {
    for (const Parameter* accumulator : accumulators_)
      statement(fmt::format("{} = {}[sk_runs - 1];", total(*accumulator), sharedName(*accumulator)));
  }

  void continueFromRunsBefore() {
    statement("if (sk_i > 0) {");
    for (const Parameter* accumulator : accumulators_)
      statement(fmt::format("  {} = {}[sk_i - 1];", total(*accumulator), sharedName(*accumulator)));
    statement("  sk_isStarted = true;");
    if (variant_.carried) {
      statement("} else if (sk_isStarted) {");
      for (const Parameter* accumulator : accumulators_)
        statement(fmt::format("  {} = {};", total(*accumulator), held("sk_carried", *accumulator)));
    }
    if (!isSeeded()) {
      statement("} else {");
      for (const Parameter* accumulator : accumulators_)
        statement(fmt::format("  {} = {};", total(*accumulator), identityOf(*accumulator)));
    }
    statement("}");
  }

  // ---- a chain of tiles (scan_chain.cpp) --------------------------------------------------------

  std::string writeChained(const std::vector<Parameter>& written);
  std::string listOf(std::string_view name) const;
  void declareHeld(std::string_view name, const Parameter& accumulator);
  void startFrom(std::string_view name, std::string_view value, std::string_view indent);
  void assign(std::string_view name, std::string_view value, std::string_view indent);
  void combineInto(std::string_view name, std::string_view value, std::string_view indent);
  void foldTile(const std::vector<Parameter>& written);
  void declareChain();
  void scanTotalsOfSubgroups();
  void readResult(std::string_view tile, std::string_view indent);
  void lookBack(const std::vector<Parameter>& written);
  void lookInGroup();
  void lookInSubgroups();
  void foldWindow();
  void takeBefore(std::string_view at, std::string_view indent);
  void joinEarlier(std::string_view indent);
  /// Shared memory for a result of each subgroup.
  std::string rowsOf(const Parameter& accumulator) const { return held("sk_rows", accumulator); }

  // ---- results ----------------------------------------------------------------------------------

  /// Whether results go through shared memory; else each invocation stores its own.
  bool keepsTile() const { return isTile() && run() > 1; }

  const Parameter& accumulatorOf(const Parameter& result) const {
    return **std::ranges::find(accumulators_, result.symbol, &Parameter::symbol);
  }

  /// The variable that holds the result of item sk_k.
  std::string resultOf(const Parameter& accumulator) const {
    return variant_.packed ? keptOf(accumulator) : total(accumulator);
  }
  /// The place of an item in shared memory, where runs are a bank apart.
  std::string slotOf(std::string_view item) const {
    return fmt::format("{0} + ({0} >> {1})", item, variant_.packed ? 3 : 4);
  }

  /// Keeps or stores the results of item sk_k.
  void keepItem(const std::vector<Parameter>& written) {
    if (!keepsTile())
      return storeItem(written, "sk_first + sk_k", "    ",
                       [&](const Parameter& result) { return resultOf(result); });
    statement(fmt::format("    int sk_n = sk_i * {} + sk_k, sk_slot = {};", run(), slotOf("sk_n")));
    for (const Parameter& result : written) {
      statement(fmt::format("    {}[sk_slot] = {};", tileOf(accumulatorOf(result)), resultOf(result)));
    }
  }

  void storeTile(const std::vector<Parameter>& written) {
    wait();
    statement(fmt::format("for (int sk_k = 0; sk_k < {}; ++sk_k) {{", run()));
    statement(fmt::format("  int sk_n = {};", itemOfInvocation()));
    statement("  if (sk_n < sk_left) {");
    const int items = tileGroup * run();
    storeItem(written, fmt::format("sk_tile * {} + sk_n", items), "    ", [&](const Parameter& result) {
      return fmt::format("{}[{}]", tileOf(accumulatorOf(result)), slotOf("sk_n"));
    });
    statement("  }");
    statement("}");
  }

  template <class ValueOf>
  void storeItem(const std::vector<Parameter>& written, std::string_view place, std::string_view indent,
                 ValueOf&& valueOf) {
    for (const Parameter& result : written) store(program_, result, valueOf(result), indent);
    const std::string at = sk::assemble::place(program_, resultTexel(numberOf(place)));
    for (const std::string& line : program_.storing(at, variant_.domainLayered)) {
      statement(fmt::format("{}{}", indent, line));
    }
  }
};

}  // namespace sk::assemble
