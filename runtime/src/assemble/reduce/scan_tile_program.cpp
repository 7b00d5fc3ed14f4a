// SPDX-License-Identifier: MIT
#include "assemble/reduce/scan_tile_program.hpp"

#include <algorithm>
#include <utility>

#include <fmt/format.h>

#include "assemble/elements/arguments.hpp"
#include "assemble/reduce/scan_plan.hpp"
#include "assemble/reduce/scan_program.hpp"

namespace sk::assemble {

using program::Kernel;
using program::Parameter;
using program::Reduction;

namespace {

/// The tiles that a group looks at together.
constexpr std::int32_t lookWindow = 64;

class TileScanText : ScanText {
 public:
  TileScanText(const Profile& profile, const Reduction& reduction, const ReduceVariant& variant)
      : ScanText(profile, reduction, variant) {}

  std::string write() {
    const std::vector<Parameter> written = declareParameters();
    if (isTile() && !isOfPartials(variant_.walk)) program_.foreign(reduction_.addition);
    program_.dispatchGroups(tileGroup, 1);
    statement("int sk_i = int(gl_LocalInvocationIndex);");
    if (variant_.chained) return writeChained(written);
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

  /// Fetches the items of all runs, neighbouring ones by neighbouring invocations.
  void loadTile(const Parameter& input) {
    const auto i = static_cast<std::size_t>(&input - kernel_.parameters.data());
    const std::string tile = tileOf(*accumulators_.front());
    statement(fmt::format("for (int sk_k = 0; sk_k < {}; ++sk_k) {{", run()));
    statement(fmt::format("  int sk_n = {};", itemOfInvocation()));
    statement("  if (sk_n < sk_left) {");
    const std::string number = numberOf(fmt::format("sk_tile * {} + sk_n", tileGroup * run()));
    moveTo(number, "    ");
    statement(fmt::format(
        "    {}[{}] = {};", tile, slotOf("sk_n"),
        variant_.packed ? fetch(program_, fourOf(input), numbered(number)) : elementAt(i, number)));
    statement("  }");
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

  /// Replaces the total of each run by the fold of those of all runs up to it (Hillis and Steele, 1986).
  void scanTotals() {
    for (const Parameter* accumulator : accumulators_) {
      program_.variable("shared " + std::string(accumulator->element->glsl),
                        fmt::format("{}[{}]", sharedName(*accumulator), tileGroup));
      statement(fmt::format("{}[sk_i] = {};", sharedName(*accumulator), total(*accumulator)));
    }
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

  // ---- a chain of tiles -------------------------------------------------------------------------

  /// One pass: a tile takes the result of the tiles before from what their work groups publish, first their own total
  /// and then that of all tiles up to theirs (decoupled look-back; D. Merrill and M. Garland, "Single-pass parallel
  /// prefix scan with decoupled look-back", 2016). Groups take their tiles in the order in which they start. A group
  /// that waits too long for a tile folds it, so that the pass ends on every device (T. Smith, R. Levien and J. Owens,
  /// "Decoupled fallback: a portable single-pass GPU scan", 2025).
  std::string writeChained(const std::vector<Parameter>& written) {
    integers({"sk_length", "sk_groups"});
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
  std::string listOf(std::string_view name) const {
    std::string list;
    for (const Parameter* accumulator : accumulators_) list += ", " + held(name, *accumulator);
    return list;
  }
  void declareHeld(std::string_view name, const Parameter& accumulator) {
    statement(fmt::format("{} {};", accumulator.element->glsl, held(name, accumulator)));
  }
  void startFrom(std::string_view name, std::string_view value, std::string_view indent) {
    for (const Parameter* accumulator : accumulators_) {
      statement(fmt::format("{}{} {} = {};", indent, accumulator->element->glsl, held(name, *accumulator),
                            held(value, *accumulator)));
    }
  }
  void assign(std::string_view name, std::string_view value, std::string_view indent) {
    for (const Parameter* accumulator : accumulators_)
      statement(fmt::format("{}{} = {};", indent, held(name, *accumulator), held(value, *accumulator)));
  }
  /// Folds `value`, which comes later, into `name`.
  void combineInto(std::string_view name, std::string_view value, std::string_view indent) {
    const std::string_view folded = std::exchange(folded_, name);
    statement(fmt::format("{}{}", indent, calling(reduction_.combine, [&](std::size_t, std::size_t k) {
                            return held(value, *accumulators_[k]);
                          })));
    folded_ = folded;
  }

  /// Folds tile sk_tile: the shared totals become those of all runs up to each.
  void foldTile(const std::vector<Parameter>& written) {
    findRunOfTile();
    declareTotals();
    loadRun();
    statement("bool sk_isStarted = false;");
    foldRun(false, written);
    scanTotals();
  }

  /// A tile has two words for each accumulator. Each holds 16 bits of the value, and in the highest bits what it is: 1
  /// the tile's total, 2 that of all tiles up to it, 0 nothing yet. Words with different bits are not complete.
  void declareChain() {
    const std::size_t words = 2 * accumulators_.size();
    program_.buffer("coherent volatile buffer sk_chain {\n  uint sk_ticket;\n  uint sk_states[];\n}");
    program_.variable("shared int", "sk_taken");
    program_.variable("shared int", "sk_look_nearest");
    program_.variable("shared int", "sk_missing");
    std::string parameters;
    std::vector<std::string> lines;
    for (std::size_t k = 0; k < accumulators_.size(); ++k) {
      const Parameter& accumulator = *accumulators_[k];
      parameters += fmt::format(", {} sk_v{}", accumulator.element->glsl, k);
      lines.push_back(fmt::format("sk_states[sk_t * {} + {}] = sk_flag << 30 | (uint(sk_v{}) & 0xffffu);",
                                  words, 2 * k, k));
      lines.push_back(fmt::format("sk_states[sk_t * {} + {}] = sk_flag << 30 | uint(sk_v{}) >> 16;", words,
                                  2 * k + 1, k));
    }
    program_.function(fmt::format("void sk_publish(int sk_t, uint sk_flag{})", parameters), lines);
  }

  /// Sets sk_before to the fold of the tiles before. Some invocations look at one of them each: fewer would keep a large GPU
  /// waiting, as the front of tiles whose results are known advances by as many in each look, and with more, the looks of
  /// all groups at the same few words hold up each other. Results take the place of the totals of runs in shared memory.
  void lookBack(const std::vector<Parameter>& written) {
    integers({"sk_patience"});
    statement("  bool sk_hasBefore = false;");
    statement("  for (int sk_at = sk_tile - 1, sk_tries = 0; sk_at >= 0;) {");
    statement(fmt::format("    if (sk_i == 0) sk_look_nearest = sk_missing = {};", lookWindow));
    wait("    ");
    statement(fmt::format("    if (sk_i < min({}, sk_at + 1)) {{", lookWindow));
    readWindow();
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

  void readWindow() {
    const std::size_t words = 2 * accumulators_.size();
    statement(fmt::format("      int sk_word = (sk_at - sk_i) * {};", words));
    statement("      uint sk_flag = sk_states[sk_word] >> 30;");
    for (std::size_t k = 0; k < accumulators_.size(); ++k) {
      statement(fmt::format(
          "      uint sk_low{0} = sk_states[sk_word + {1}], sk_high{0} = sk_states[sk_word + {2}];", k, 2 * k,
          2 * k + 1));
      statement(fmt::format(
          "      if (sk_low{0} >> 30 != sk_flag || sk_high{0} >> 30 != sk_flag) sk_flag = 0u;", k));
      statement(fmt::format("      {}[sk_i] = {}((sk_low{} & 0xffffu) | sk_high{} << 16);",
                            sharedName(*accumulators_[k]), accumulators_[k]->element->glsl, k, k));
    }
    statement("      if (sk_flag == 0u) atomicMin(sk_missing, sk_i);");
    statement("      if (sk_flag == 2u) atomicMin(sk_look_nearest, sk_i);");
  }

  /// Folds the first sk_ready results of the window, of which later ones are of earlier tiles, to the first.
  void foldWindow() {
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
  void takeBefore(std::string_view at, std::string_view indent) {
    for (const Parameter* accumulator : accumulators_) {
      statement(fmt::format("{}{} {} = {}[{}];", indent, accumulator->element->glsl,
                            held("sk_earlier", *accumulator), sharedName(*accumulator), at));
    }
    statement(fmt::format("{}if (sk_hasBefore) {{", indent));
    combineInto("sk_earlier", "sk_before", fmt::format("{}  ", indent));
    statement(fmt::format("{}}}", indent));
    assign("sk_before", "sk_earlier", indent);
    statement(fmt::format("{}sk_hasBefore = true;", indent));
  }

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

}  // namespace

std::string scanTileProgram(const Profile& profile, const Reduction& reduction,
                            const ReduceVariant& variant) {
  return TileScanText(profile, reduction, variant).write();
}

}  // namespace sk::assemble
