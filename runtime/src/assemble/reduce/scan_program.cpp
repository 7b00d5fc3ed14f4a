// SPDX-License-Identifier: MIT
#include "assemble/reduce/scan_program.hpp"

#include <fmt/format.h>

#include "assemble/reduce/scan_text.hpp"
#include "assemble/reduce/scan_tile_program.hpp"

namespace sk::assemble {

using program::Kernel;
using program::Parameter;
using program::Reduction;

namespace {

/// Programs whose invocations compute one result each.
class ItemScanText : ScanText {
 public:
  ItemScanText(const Profile& profile, const Reduction& reduction, const ReduceVariant& variant)
      : ScanText(profile, reduction, variant) {}

  std::string write() {
    if (kernel_.usesLoops) domain_.leaveOutside();
    const std::vector<Parameter> written = declareParameters();
    statement("int sk_number = " + domain_.number() + ";");
    if (variant_.scan == ScanPass::Folds) {
      findRun();
    } else {
      findPlace();
    }
    if (!variant_.packed) {
      foldRun();
      return finish(written, comment());
    }
    foldTexels();
    if (!keepsLanes()) return finish(written, comment());
    for (const Parameter& parameter : written) store(program_, parameter, keptOf(parameter));
    return finish(comment());
  }

 private:
  /// Finds the run whose result this invocation computes: sk_at is the number of its first item.
  void findRun() {
    integers({"sk_length"});
    if (isOneLine()) {
      statement(
          fmt::format("int sk_at = sk_number * {0}, sk_count = min({0}, sk_length - sk_at);", variant_.run));
      return;
    }
    integers({"sk_inner", "sk_lines"});
    statement("int sk_run = sk_number / sk_lines, sk_line = sk_number - sk_run * sk_lines;");
    statement(
        fmt::format("int sk_first = sk_run * {0}, sk_count = min({0}, sk_length - sk_first);", variant_.run));
    statement("int sk_at = (sk_line / sk_inner * sk_length + sk_first) * sk_inner + sk_line % sk_inner;");
  }

  /// Finds the run of this invocation's item, and how many of its items to fold.
  void findPlace() {
    std::string place = "sk_number";
    if (!isOneLine()) {
      integers({"sk_inner", "sk_length"});
      statement("int sk_row = sk_number / sk_inner;");
      place = "sk_row % sk_length";
    }
    statement(fmt::format("int sk_place = {0}, sk_run = sk_place / {1}, sk_before = sk_place - sk_run * {1};",
                          place, variant_.run));
    statement(fmt::format("int sk_count = sk_before{};", isExclusive() && !variant_.packed ? "" : " + 1"));
    statement(fmt::format("int sk_at = sk_number - sk_before{};", timesInner()));
  }

  /// The number of item sk_k of the run.
  std::string nextNumber() const { return fmt::format("sk_at + sk_k{}", timesInner()); }

  void foldRun() {
    if (isSeeded()) {
      moveTo("sk_at", "");
      startFromElements([&](std::size_t i) { return elementAt(i, "sk_at"); });
    } else {
      startFromIdentities();
    }
    if (variant_.carried) continueFromCarry();
    statement(fmt::format("for (int sk_k = {}; sk_k < sk_count; ++sk_k) {{", isSeeded() ? 1 : 0));
    moveTo(nextNumber(), "  ");
    foldAt(nextNumber(), "  ");
    statement("}");
  }

  // ---- packed elements --------------------------------------------------------------------------

  /// Folds the texels of a run. Of the last one, the accumulators for each element stay.
  void foldTexels() {
    if (isSeeded()) {
      for (const Parameter* accumulator : accumulators_)
        statement(fmt::format("{} {};", accumulator->element->glsl, total(*accumulator)));
    } else {
      startFromIdentities();
    }
    if (variant_.carried) {
      statement("if (sk_run > 0) {");
      continueInside();
      statement("}");
    }
    for (const Parameter* accumulator : accumulators_) {
      if (keepsLanes())
        statement(fmt::format("{} {};", fourOf(*accumulator).element->glsl, keptOf(*accumulator)));
    }
    declareLanes();
    statement("for (int sk_k = 0; sk_k < sk_count; ++sk_k) {");
    fetchLanes(numbered(nextNumber()), "  ");
    for (int lane = 0; lane < lanes; ++lane) foldLane(lane);
    statement("}");
  }

  void foldLane(int lane) {
    const std::string component = fmt::format(".{}", "xyzw"[lane]);
    const auto keep = [&] {
      if (!keepsLanes()) return;
      for (const Parameter* accumulator : accumulators_)
        statement(fmt::format("  {}{} = {};", keptOf(*accumulator), component, total(*accumulator)));
    };
    if (isExclusive()) keep();
    const std::string fold =
        calling(reduction_.fold, [&](std::size_t i, std::size_t) { return elementOf(i, component); });
    if (isSeeded() && lane == 0) {
      statement(variant_.carried ? "  if (sk_k == 0 && sk_run == 0) {" : "  if (sk_k == 0) {");
      for (std::size_t k = 0; k < accumulators_.size(); ++k) {
        const auto i = static_cast<std::size_t>(inputs_[k] - kernel_.parameters.data());
        statement(fmt::format("    {} = {};", total(*accumulators_[k]), elementOf(i, component)));
      }
      statement("  } else {");
      statement("    " + fold);
      statement("  }");
    } else {
      statement("  " + fold);
    }
    if (!isExclusive()) keep();
  }

  /// Runs other than the first of a line start from the result of those before.
  void continueFromCarry() {
    statement("if (sk_run > 0) {");
    continueInside();
    if (isSeeded()) foldAt("sk_at", "  ");
    statement("}");
  }

  void continueInside() {
    if (isOneLine()) return takeCarry("sk_run - 1", "  ");
    integers({"sk_lines"});
    statement("  int sk_line = sk_row / sk_length * sk_inner + sk_number % sk_inner;");
    takeCarry("(sk_run - 1) * sk_lines + sk_line", "  ");
  }

  void foldAt(std::string_view number, std::string_view indent) {
    const Kernel& kernel = isOfPartials(variant_.walk) ? reduction_.combine : reduction_.fold;
    statement(fmt::format("{}{}", indent,
                          calling(kernel, [&](std::size_t i, std::size_t) { return elementAt(i, number); })));
  }
};

}  // namespace

std::string scanProgram(const Profile& profile, const Reduction& reduction, const ReduceVariant& variant) {
  if (variant.unit != ScanUnit::Item) return scanTileProgram(profile, reduction, variant);
  return ItemScanText(profile, reduction, variant).write();
}

}  // namespace sk::assemble
