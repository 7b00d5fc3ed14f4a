// SPDX-License-Identifier: MIT
//
// Items of a level, elements or results of runs, are numbered row-major. Those of a line are sk_inner apart.
#include "assemble/reduce/scan_program.hpp"

#include <fmt/format.h>

#include "assemble/reduce/fold_text.hpp"

namespace sk::assemble {

using program::Kernel;
using program::Parameter;
using program::Reduction;
using program::Role;

ContinuedKernel::ContinuedKernel(const Kernel& kernel)
    : parameters_(kernel.parameters.begin(), kernel.parameters.end()),
      ownParameters_(parameters_.size()),
      kernel_(kernel) {
  for (const Parameter& parameter : kernel.parameters) {
    if (parameter.role != Role::Accumulator) continue;
    parameters_.push_back({.name = parameter.name,
                           .symbol = parameter.symbol,
                           .role = Role::Input,
                           .element = parameter.element});
  }
  kernel_.parameters = parameters_;
}

namespace {

class ScanText : FoldText {
 public:
  ScanText(const Profile& profile, const Reduction& reduction, const ReduceVariant& variant)
      : FoldText(profile, reduction, variant,
                 isOfPartials(variant.walk) ? reduction.combine : reduction.fold),
        continued_(kernel_) {}

  std::string write() {
    if (kernel_.usesLoops) domain_.leaveOutside();
    defineParameters();
    if (variant_.carried) {
      for (const Parameter& carry : continued_.carries())
        declareSamplers(program_, carry, variant_.carryLayered);
    }
    std::vector<Parameter> written = withPlanes(accumulators_, variant_.firstPlane, variant_.planeCount);
    if (keepsLanes()) {
      for (Parameter& parameter : written) parameter = fourOf(parameter);
    }
    for (const Parameter& parameter : written) declareOutputs(program_, parameter);
    statement("int sk_number = " + domain_.number() + ";");
    if (variant_.scan == ScanPass::Folds) {
      findRun();
    } else {
      findPlace();
    }
    const std::string comment =
        fmt::format("{}{}, {}", variant_.packed ? "packed " : "", nameOfItems(), nameOf(variant_.scan));
    if (!variant_.packed) {
      foldRun();
      return finish(written, comment);
    }
    foldTexels();
    if (!keepsLanes()) return finish(written, comment);
    for (const Parameter& parameter : written) store(program_, parameter, keptOf(parameter));
    return finish(comment);
  }

 private:
  static std::string_view nameOf(ScanPass pass) {
    switch (pass) {
      case ScanPass::None: break;
      case ScanPass::Folds: return "a result for each run";
      case ScanPass::Inclusive: return "a result for each";
      case ScanPass::Exclusive: return "a result before each";
    }
    return {};
  }
  std::string_view nameOfItems() const {
    return isOfPartials(variant_.walk)   ? "results of runs"
           : variant_.walk == Walk::Line ? "elements of a line"
                                         : "elements by index";
  }

  bool isOneLine() const { return variant_.runs == Runs::OneBlock; }

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

  std::string_view timesInner() const { return isOneLine() ? "" : " * sk_inner"; }
  /// The number of item sk_k of the run.
  std::string nextNumber() const { return fmt::format("sk_at + sk_k{}", timesInner()); }

  bool isExclusive() const { return variant_.scan == ScanPass::Exclusive; }

  void foldRun() {
    const bool isSeeded = !isExclusive() && (isOfPartials(variant_.walk) || reduction_.seeded);
    if (isSeeded) {
      moveTo("sk_at", "");
      startFromElements([&](std::size_t i) { return elementAt(i, "sk_at"); });
    } else {
      startFromIdentities();
    }
    if (variant_.carried) continueFromCarry(isSeeded);
    statement(fmt::format("for (int sk_k = {}; sk_k < sk_count; ++sk_k) {{", isSeeded ? 1 : 0));
    moveTo(nextNumber(), "  ");
    foldAt(nextNumber(), "  ");
    statement("}");
  }

  // ---- packed elements --------------------------------------------------------------------------

  /// Whether the result is packed, too: the accumulators after, or before, each of the four elements.
  bool keepsLanes() const { return variant_.packed && variant_.scan != ScanPass::Folds; }
  std::string keptOf(const Parameter& accumulator) const { return held("sk_kept", accumulator); }

  /// Folds the texels of a run. Of the last one, the accumulators for each element stay.
  void foldTexels() {
    const bool isSeeded = !isExclusive() && reduction_.seeded;
    if (isSeeded) {
      for (const Parameter* accumulator : accumulators_)
        statement(fmt::format("{} {};", accumulator->element->glsl, total(*accumulator)));
    } else {
      startFromIdentities();
    }
    if (variant_.carried) {
      statement("if (sk_run > 0) {");
      takeCarry();
      statement("}");
    }
    for (const Parameter* accumulator : accumulators_) {
      if (keepsLanes())
        statement(fmt::format("{} {};", fourOf(*accumulator).element->glsl, keptOf(*accumulator)));
    }
    declareLanes();
    statement("for (int sk_k = 0; sk_k < sk_count; ++sk_k) {");
    fetchLanes(numbered(nextNumber()), "  ");
    for (int lane = 0; lane < lanes; ++lane) foldLane(lane, isSeeded);
    statement("}");
  }

  void foldLane(int lane, bool isSeeded) {
    const std::string component = fmt::format(".{}", "xyzw"[lane]);
    const auto keep = [&] {
      if (!keepsLanes()) return;
      for (const Parameter* accumulator : accumulators_)
        statement(fmt::format("  {}{} = {};", keptOf(*accumulator), component, total(*accumulator)));
    };
    if (isExclusive()) keep();
    const std::string fold =
        calling(reduction_.fold, [&](std::size_t i, std::size_t) { return elementOf(i, component); });
    if (isSeeded && lane == 0) {
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
  void continueFromCarry(bool isSeeded) {
    statement("if (sk_run > 0) {");
    takeCarry();
    if (isSeeded) foldAt("sk_at", "  ");
    statement("}");
  }

  void takeCarry() {
    integers({"sk_carry_shift"});
    program_.require(Function::Texel);
    std::string number = "sk_run - 1";
    if (!isOneLine()) {
      integers({"sk_lines"});
      statement("  int sk_line = sk_row / sk_length * sk_inner + sk_number % sk_inner;");
      number = "(sk_run - 1) * sk_lines + sk_line";
    }
    statement(fmt::format("  int sk_carry = {};", number));
    const Texel texel{"sk_texel(sk_carry, sk_carry_shift)", variant_.carryLayered ? "sk_carry_shift" : ""};
    for (std::size_t k = 0; k < accumulators_.size(); ++k) {
      statement(fmt::format("  {} = {};", total(*accumulators_[k]),
                            fetch(program_, continued_.carries()[k], texel)));
    }
  }

  /// Sets the index of the current element.
  void moveTo(std::string_view number, std::string_view indent) {
    if (variant_.walk != Walk::Index) return;
    std::string index = fmt::format("ivec4({}, 0, 0, 0)", number);
    if (variant_.axes > 1) {
      program_.require(variant_.axes == 2   ? Function::Unravel2
                       : variant_.axes == 3 ? Function::Unravel3
                                            : Function::Unravel4);
      vectors({"sk_item_step"});
      index = fmt::format("sk_unravel({}, sk_item_step)", number);
    }
    statement(fmt::format("{}{} = {};", indent, item(), index));
  }

  std::string elementAt(std::size_t i, std::string_view number) {
    return element(i, variant_.walk == Walk::Index ? Texel{} : numbered(number));
  }

  /// The texel of an item. A line of elements begins anywhere in its stream.
  Texel numbered(std::string_view number) {
    if (variant_.walk != Walk::Line) return numberedTexel(number);
    integers({"sk_start"});
    return numberedTexel(fmt::format("sk_start + {}", number));
  }

  void foldAt(std::string_view number, std::string_view indent) {
    const Kernel& kernel = isOfPartials(variant_.walk) ? reduction_.combine : reduction_.fold;
    statement(fmt::format("{}{}", indent,
                          calling(kernel, [&](std::size_t i, std::size_t) { return elementAt(i, number); })));
  }

  ContinuedKernel continued_;
};

}  // namespace

std::string scanProgram(const Profile& profile, const Reduction& reduction, const ReduceVariant& variant) {
  return ScanText(profile, reduction, variant).write();
}

}  // namespace sk::assemble
