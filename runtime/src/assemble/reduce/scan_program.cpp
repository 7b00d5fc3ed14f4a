// SPDX-License-Identifier: MIT
#include "assemble/reduce/scan_program.hpp"

#include <fmt/format.h>

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

ScanText::ScanText(const Profile& profile, const Reduction& reduction, const ReduceVariant& variant)
    : FoldText(profile, reduction, variant, isOfPartials(variant.walk) ? reduction.combine : reduction.fold),
      continued_(kernel_) {}

std::vector<Parameter> ScanText::declareParameters() {
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
  return written;
}

std::string ScanText::comment() const {
  const std::string_view items = isOfPartials(variant_.walk)    ? "results of runs"
                                 : variant_.walk == Walk::Index ? "elements by index"
                                                                : "elements of a line";
  const std::string_view results = variant_.scan == ScanPass::Folds       ? "a result for each run"
                                   : variant_.scan == ScanPass::Inclusive ? "a result for each"
                                                                          : "a result before each";
  const std::string_view unit = variant_.unit == ScanUnit::Tile  ? ", by tiles"
                                : variant_.unit == ScanUnit::Run ? ", by runs"
                                                                 : "";
  return fmt::format("{}{}, {}{}", variant_.packed ? "packed " : "", items, results, unit);
}

void ScanText::moveTo(std::string_view number, std::string_view indent) {
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

std::string ScanText::elementAt(std::size_t i, std::string_view number) {
  return element(i, variant_.walk == Walk::Index ? Texel{} : numbered(number));
}

Texel ScanText::numbered(std::string_view number) {
  if (variant_.walk == Walk::Plane) {
    integers({"sk_width"});
    vectors({"sk_origin"});
    program_.function(
        "ivec2 sk_in_rows(int sk_n)",
        {"int sk_y = sk_n / sk_width;", "return sk_origin.xy + ivec2(sk_n - sk_y * sk_width, sk_y);"});
    return {fmt::format("sk_in_rows({})", number)};
  }
  if (variant_.walk != Walk::Line) return numberedTexel(number);
  integers({"sk_start"});
  return numberedTexel(fmt::format("sk_start + {}", number));
}

void ScanText::takeCarry(std::string_view number, std::string_view indent) {
  integers({"sk_carry_shift"});
  program_.require(Function::Texel);
  statement(fmt::format("{}int sk_carry = {};", indent, number));
  const Texel texel{"sk_texel(sk_carry, sk_carry_shift)", variant_.carryLayered ? "sk_carry_shift" : ""};
  for (std::size_t k = 0; k < accumulators_.size(); ++k) {
    statement(fmt::format("{}{} = {};", indent, total(*accumulators_[k]),
                          fetch(program_, continued_.carries()[k], texel)));
  }
}

Texel ScanText::resultTexel(const std::string& number) {
  const auto uniform = [&](std::string_view type, std::string_view name) {
    return program_.uniform(type, name);
  };
  switch (variant_.domain) {
    case Domain::Plane: {
      const std::string origin =
          variant_.domainView ? uniform("ivec4", "sk_domain_origin") + ".xy + " : std::string();
      const std::string width = uniform("ivec4", "sk_domain_shape") + ".x";
      program_.function("ivec2 sk_place_of(int sk_n)",
                        {fmt::format("int sk_y = sk_n / {};", width),
                         fmt::format("return {}ivec2(sk_n - sk_y * {}, sk_y);", origin, width)});
      return {fmt::format("sk_place_of({})", number)};
    }
    case Domain::LinearBox: {
      program_.require(variant_.domainRank <= 2   ? Function::Unravel2
                       : variant_.domainRank == 3 ? Function::Unravel3
                                                  : Function::Unravel4);
      program_.require(Function::Ravel);
      program_.require(Function::Texel);
      const std::string shift = uniform("int", "sk_domain_shift");
      const std::string index = variant_.domainRank == 1 ? fmt::format("ivec4({}, 0, 0, 0)", number)
                                                         : fmt::format("sk_unravel({}, {})", number,
                                                                       uniform("ivec4", "sk_domain_step"));
      return {fmt::format("sk_texel(sk_ravel({} + {}, {}), {})", index, uniform("ivec4", "sk_domain_origin"),
                          uniform("ivec4", "sk_domain_stride"), shift),
              variant_.domainLayered ? shift : ""};
    }
    case Domain::Linear:
    case Domain::Entry: break;
    case Domain::Strided:  // of copies only
    case Domain::StridedRows:
    case Domain::StridedLinear: break;
  }
  program_.require(Function::Texel);
  const std::string shift = uniform("int", "sk_domain_shift");
  return {fmt::format("sk_texel({}, {})", number, shift), variant_.domainLayered ? shift : ""};
}

}  // namespace sk::assemble
