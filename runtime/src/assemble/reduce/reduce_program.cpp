// SPDX-License-Identifier: MIT
//
// Assembles the program of one pass of a reduction: main() finds its run in a block and folds it in one loop.
#include "assemble/reduce/reduce_program.hpp"

#include <algorithm>
#include <array>
#include <initializer_list>
#include <string>

#include <fmt/format.h>

#include "assemble/assemble.hpp"
#include "assemble/elements/arguments.hpp"
#include "assemble/elements/planes.hpp"
#include "assemble/glsl/program_text.hpp"
#include "assemble/reduce/fold_text.hpp"
#include "assemble/reduce/row_program.hpp"
#include "assemble/reduce/scan_program.hpp"
#include "sk/program.hpp"

namespace sk::assemble {

namespace {

// The program of a pass in which each work group folds a block of elements, or a part of one, to one result: neighbouring
// invocations read neighbouring elements, or texels, and the group combines what they have folded.

/// Whether a variant is of such a pass.
inline bool isByGroupsOfBlocks(const ReduceVariant& variant) {
  return variant.grouped && variant.walk == Walk::Index;
}

using program::Kernel;
using program::Parameter;
using program::Reduction;
using program::Role;

class BlockText : FoldText {
 public:
  BlockText(const Profile& profile, const Reduction& reduction, const ReduceVariant& variant)
      : FoldText(profile, reduction, variant, reduction.fold) {}

  std::string write() {
    program_.dispatchGroups(groupSize, 1, /*storesApart=*/variant_.twoBlocks);
    program_.functions("#pragma optionNV(unroll all)\n");
    defineParameters();
    program_.foreign(reduction_.addition);
    const std::vector<Parameter> written =
        withPlanes(accumulators_, variant_.firstPlane, variant_.planeCount);
    for (const Parameter& parameter : written) declareOutputs(program_, parameter);
    declareShared();
    findPart();
    foldItems();
    statement(fmt::format("int sk_runs = {};", groupSize));
    foldShared(blocks());
    if (variant_.twoBlocks) statement("if (sk_i > 1) return;");
    return finish(written, fmt::format("{}blocks by work groups", variant_.packed ? "packed " : ""));
  }

 private:
  /// The blocks of a group. Invocation i is one of those that fold block i % blocks().
  int blocks() const { return variant_.twoBlocks ? 2 : 1; }

  /// Finds the group's items: sk_count from number sk_first on, in the block whose first item has index sk_corner.
  void findPart() {
    integers({"sk_blocks", "sk_fan", "sk_block_length"});
    vectors({"sk_block_shape"});
    statement("int sk_i = int(gl_LocalInvocationIndex);");
    if (variant_.twoBlocks) statement("sk_pixel.y = sk_rect.y + 2 * int(gl_WorkGroupID.y) + (sk_i & 1);");
    statement("int sk_number = " + domain_.number() + ";");
    statement("int sk_run = sk_number / sk_blocks, sk_block = sk_number - sk_run * sk_blocks;");
    statement("int sk_first = sk_run * sk_fan, sk_count = min(sk_fan, sk_block_length - sk_first);");
    statement(fmt::format("ivec4 sk_corner = {} * sk_block_shape;", unravel("sk_block", "sk_blocks_step")));
  }

  /// If order matters, an invocation folds consecutive items.
  void foldItems() {
    startFromIdentities();
    if (!reduction_.commutative) {
      statement(
          fmt::format("int sk_each = (sk_count + {}) / {}, sk_end = min((sk_i + 1) * sk_each, sk_count);",
                      groupSize - 1, groupSize));
      statement("for (int sk_k = sk_i * sk_each; sk_k < sk_end; ++sk_k) {");
      foldItem("  ");
      return statement("}");
    }
    const int step = groupSize / blocks();
    statement(fmt::format("int sk_k = sk_i / {};", blocks()));
    if (variant_.packed) foldSeveral(step);
    statement(fmt::format("for (; sk_k < sk_count; sk_k += {}) {{", step));
    foldItem("  ");
    statement("}");
  }

  /// Folds several texels in each round, all of which are fetched before any is waited for.
  void foldSeveral(int step) {
    constexpr int texels = 4;
    statement(fmt::format("for (; sk_k + {} < sk_count; sk_k += {}) {{", (texels - 1) * step, texels * step));
    for (const Parameter* input : inputs_) {
      if (isNeeded(*input, variant_.specs))
        statement(fmt::format("  {} sk_some_{}[{}];", fourOf(*input).element->glsl, input->symbol, texels));
    }
    statement(fmt::format("  for (int sk_u = 0; sk_u < {}; ++sk_u) {{", texels));
    fetchTexel(fmt::format("sk_k + sk_u * {}", step), "    ",
               [](const Parameter& input) { return fmt::format("sk_some_{}[sk_u]", input.symbol); });
    statement("  }");
    statement(fmt::format("  for (int sk_u = 0; sk_u < {}; ++sk_u) {{", texels));
    for (const Parameter* input : inputs_) {
      if (isNeeded(*input, variant_.specs))
        statement(fmt::format("    {} sk_in_{} = sk_some_{}[sk_u];", fourOf(*input).element->glsl,
                              input->symbol, input->symbol));
    }
    foldLanes("    ");
    statement("  }");
    statement("}");
  }

  void foldItem(std::string_view indent) {
    if (variant_.packed) {
      fetchTexel("sk_k", indent, [&](const Parameter& input) {
        return fmt::format("{} sk_in_{}", fourOf(input).element->glsl, input.symbol);
      });
      return foldLanes(indent);
    }
    moveTo("sk_k", indent);
    statement(fmt::format("{}{}", indent,
                          calling(kernel_, [&](std::size_t i, std::size_t) { return element(i, {}); })));
  }

  /// Sets the index of the element, or of a texel's first element, with this number among the group's items.
  void moveTo(std::string_view number, std::string_view indent) {
    const std::string_view inElements = variant_.packed ? " * ivec4(4, 1, 1, 1)" : "";
    statement(fmt::format("{}{} = (sk_corner + {}){};", indent, item(),
                          unravel(fmt::format("sk_first + {}", number), "sk_block_step"), inElements));
  }

  /// Fetches the texel of each input to to(input).
  template <class To>
  void fetchTexel(std::string_view number, std::string_view indent, To&& to) {
    moveTo(number, indent);
    for (std::size_t i = 0; i < kernel_.parameters.size(); ++i) {
      const Parameter& input = kernel_.parameters[i];
      if (input.role != Role::Input || !isNeeded(input, variant_.specs)) continue;
      const Parameter four = fourOf(input);
      const Texel element = inputTexel(program_, input, access(i));
      statement(fmt::format("{}ivec2 sk_at_{} = {};", indent, input.symbol, element.at));
      const Texel texel{fmt::format("ivec2(sk_at_{0}.x >> 2, sk_at_{0}.y)", input.symbol), element.shift};
      statement(fmt::format("{}{} = {};", indent, to(input), fetch(program_, four, texel)));
    }
  }

  void foldLanes(std::string_view indent) {
    for (int lane = 0; lane < lanes; ++lane) {
      const std::string component = fmt::format(".{}", "xyzw"[lane]);
      const std::string fold =
          calling(kernel_, [&](std::size_t i, std::size_t) { return elementOf(i, component); });
      statement(fmt::format("{}{}", indent, fold));
    }
  }
};

/// The program of one pass. Its outputs, and the values of its uniforms, are as in reduceProgram().
std::string blockProgram(const Profile& profile, const Reduction& reduction, const ReduceVariant& variant) {
  return BlockText(profile, reduction, variant).write();
}

/// The kernel that a walk calls: none for the identities, which have no elements.
Kernel kernelOf(const Reduction& reduction, Walk walk) {
  if (isOfPartials(walk)) return reduction.combine;
  Kernel kernel = reduction.fold;
  if (walk == Walk::Nothing) {
    kernel.body = {};
    kernel.usesIndex = kernel.usesExtent = kernel.usesLoops = false;
    kernel.tables = {};
  }
  return kernel;
}

class ReductionText : FoldText {
 public:
  ReductionText(const Profile& profile, const Reduction& reduction, const ReduceVariant& variant)
      : FoldText(profile, reduction, variant, kernelOf(reduction, variant.walk)) {}

  std::string write() {
    if (kernel_.usesLoops && !isByRows() && variant_.walk != Walk::GroupedPartials) domain_.leaveOutside();
    if (variant_.walk != Walk::Nothing) defineParameters();
    if (variant_.grouped || variant_.part > 0) program_.foreign(reduction_.addition);
    const std::vector<Parameter> written =
        withPlanes(accumulators_, variant_.firstPlane, variant_.planeCount);
    for (const Parameter& parameter : written) declareOutputs(program_, parameter);
    if (variant_.walk == Walk::Nothing) {
      startFromIdentities();
    } else if (variant_.walk == Walk::GroupedPartials) {
      foldGroup();
    } else {
      findRun();
      startWalk();
      foldRun();
      if (variant_.grouped) combineInGroup();
    }
    return finish(written, fmt::format("{}{}, {}", variant_.packed ? "packed " : "", nameOf(variant_.walk),
                                       nameOf(variant_.runs)));
  }

 private:
  // ---- the walk ---------------------------------------------------------------------------------

  /// Defines sk_block (its number), sk_first (the run's first element in it) and sk_count, unless constant.
  void findRun() {
    if (isByRows()) return;
    const bool isByBlock = variant_.runs == Runs::WholeBlocks && variant_.walk == Walk::Plane;
    const std::string number = isByBlock && !variant_.reshaped ? std::string() : domain_.number();
    switch (variant_.runs) {
      case Runs::OneBlock:
        integers({"sk_fan", "sk_block_length"});
        statement("int sk_first = (" + number + ") * sk_fan;");
        statement("int sk_count = min(sk_fan, sk_block_length - sk_first);");
        return;
      case Runs::WholeBlocks:
        integers({"sk_block_length"});
        if (!number.empty()) statement("int sk_block = " + number + ";");
        statement("int sk_count = sk_block_length;");
        return;
      case Runs::Split:
        integers({"sk_blocks", "sk_fan", "sk_block_length"});
        statement("int sk_number = " + number + ";");
        statement("int sk_run = sk_number / sk_blocks;");
        statement("int sk_block = sk_number - sk_run * sk_blocks;");
        statement("int sk_first = sk_run * sk_fan;");
        statement("int sk_count = min(sk_fan, sk_block_length - sk_first);");
        return;
    }
  }

  void startWalk() {
    switch (variant_.walk) {
      case Walk::Line: startLine(); return;
      case Walk::Plane: startPlane(); return;
      case Walk::Box: startBox(); return;
      case Walk::Index: startIndex(); return;
      case Walk::Rows:
      case Walk::PartialRows: startRows(); return;
      case Walk::Partials: startPartials(); return;
      case Walk::GroupedPartials:
      case Walk::Nothing: return;
    }
  }

  bool isByRows() const { return variant_.walk == Walk::Rows || variant_.walk == Walk::PartialRows; }

  bool manyBlocks() const { return variant_.runs != Runs::OneBlock; }
  bool startsInside() const { return variant_.runs != Runs::WholeBlocks; }

  void startLine() {
    integers({"sk_start"});
    const std::string_view block = manyBlocks() ? " + sk_block * sk_block_length" : "";
    const std::string_view first = startsInside() ? " + sk_first" : "";
    statement(fmt::format("int sk_at = sk_start{}{};", block, first));
    walkNumbers("sk_at", "sk_k");
  }

  void startPartials() {
    if (!manyBlocks()) return walkNumbers("sk_first", "sk_k");
    integers({"sk_blocks"});
    if (!startsInside()) return walkNumbers("sk_block", "sk_k * sk_blocks");
    statement("int sk_at = sk_first * sk_blocks + sk_block;");
    walkNumbers("sk_at", "sk_k * sk_blocks");
  }

  void walkNumbers(std::string_view start, std::string_view distance) {
    first_ = numberedTexel(start);
    next_ = numberedTexel(fmt::format("{} + {}", start, distance));
  }

  /// Sets sk_corner to the block's first texel and sk_p to the element's texel.
  void startPlane() {
    vectors({"sk_origin", "sk_block_shape"});
    const std::string block = manyBlocks() ? " + " + blockIndex() + ".xy * sk_block_shape.xy" : "";
    statement("ivec2 sk_corner = sk_origin.xy" + block + ";");
    if (startsInside()) {
      statement("int sk_y = sk_first / sk_block_shape.x;");
      statement("ivec2 sk_p = sk_corner + ivec2(sk_first - sk_y * sk_block_shape.x, sk_y);");
    } else {
      statement("ivec2 sk_p = sk_corner;");
    }
    statement("int sk_end = sk_corner.x + sk_block_shape.x;");
    step_ = {"++sk_p.x;", "if (sk_p.x == sk_end) sk_p = ivec2(sk_corner.x, sk_p.y + 1);"};
    first_ = next_ = {"sk_p"};
  }

  /// Sets sk_corner to the run's first texel and sk_p to the element's texel.
  void startRows() {
    vectors({"sk_origin", "sk_target"});
    if (variant_.grouped) program_.dispatchGroups(groupSide, groupSide);
    const std::string run = variant_.run == 0 ? "sk_run_shape.xy"
                            : variant_.column ? fmt::format("ivec2(1, {})", variant_.run)
                                              : fmt::format("ivec2({}, 1)", variant_.run);
    const std::string number =
        variant_.grouped ? fmt::format("(({} - sk_target.xy) * {} + ivec2(gl_LocalInvocationID.xy))",
                                       domain_.texel().at, groupSide)
                         : fmt::format("({} - sk_target.xy)", domain_.texel().at);
    statement(fmt::format("ivec2 sk_corner = {} * {};", number, run));
    if (variant_.grouped) {
      vectors({"sk_source"});
      statement("bool sk_isInside = all(lessThan(sk_corner, sk_source.xy));");
    } else if (kernel_.usesLoops) {  // see DomainText::leaveOutside()
      vectors({"sk_source"});
      statement("if (any(greaterThanEqual(uvec2(sk_corner), uvec2(sk_source.xy)))) return;");
    }
    if (variant_.run > 0) {
      statement("ivec2 sk_p = sk_origin.xy + sk_corner;");
      first_ = {"sk_p"};
      next_ = {variant_.column ? "sk_p + ivec2(0, sk_k)" : "sk_p + ivec2(sk_k, 0)"};
      return;
    }
    vectors({"sk_source", "sk_run_shape"});
    if (variant_.column) {
      statement("ivec2 sk_p = sk_origin.xy + sk_corner;");
      statement("int sk_left = sk_source.y - sk_corner.y;");
      statement(
          "int sk_count = sk_left > sk_run_shape.y ? sk_run_shape.y : sk_left + int(sk_corner.x < "
          "sk_source.z);");
      first_ = {"sk_p"};
      next_ = {"sk_p + ivec2(0, sk_k)"};
      return;
    }
    statement("ivec2 sk_shape = max(min(sk_run_shape.xy, sk_source.xy - sk_corner), 0);");
    statement("sk_corner += sk_origin.xy;");
    statement("ivec2 sk_p = sk_corner;");
    statement("int sk_count = sk_shape.x * sk_shape.y, sk_end = sk_corner.x + sk_shape.x;");
    step_ = {"++sk_p.x;", "if (sk_p.x == sk_end) sk_p = ivec2(sk_corner.x, sk_p.y + 1);"};
    first_ = next_ = {"sk_p"};
  }

  /// Each invocation folds some partial results, maybe none in the last group; the group then folds their
  /// results in order.
  void foldGroup() {
    integers({"sk_fan", "sk_block_length", "sk_source_width"});
    declareShared();
    program_.function("ivec2 sk_place(int sk_n)", {"int sk_y = sk_n / sk_source_width;",
                                                   "return ivec2(sk_n - sk_y * sk_source_width, sk_y);"});
    vectors({"sk_target"});
    integers({"sk_domain_shift"});
    program_.dispatchGroups(groupSize, 1);
    const std::string texel = domain_.texel().at;
    statement(fmt::format("int sk_group = ({0}.y - sk_target.y) << sk_domain_shift | ({0}.x - sk_target.x);",
                          texel));
    statement("int sk_i = int(gl_LocalInvocationIndex);");
    statement(fmt::format("int sk_base = sk_group * {} * sk_fan;", groupSize));
    statement(fmt::format("int sk_left = min({} * sk_fan, sk_block_length - sk_base);", groupSize));
    if (variant_.strided) {
      statement(fmt::format("int sk_runs = min({0}, sk_left), sk_count = (sk_left - sk_i + {1}) / {0};",
                            groupSize, groupSize - 1));
      statement("sk_base += sk_i;");
      next_ = {fmt::format("sk_place(sk_base + sk_k * {})", groupSize)};
    } else {
      statement(
          "int sk_runs = (sk_left + sk_fan - 1) / sk_fan, sk_count = min(sk_fan, sk_left - sk_i * sk_fan);");
      statement("sk_base += sk_i * sk_fan;");
      next_ = {"sk_place(sk_base + sk_k)"};
    }
    for (const Parameter* accumulator : accumulators_) {
      statement(fmt::format("{} {};", accumulator->element->glsl, total(*accumulator)));
    }
    first_ = {"sk_place(sk_base)"};
    statement("if (sk_i < sk_runs) {");
    for (std::size_t k = 0; k < accumulators_.size(); ++k) {
      const auto i = static_cast<std::size_t>(inputs_[k] - kernel_.parameters.data());
      statement(fmt::format("  {} = {};", total(*accumulators_[k]), firstOf(i)));
    }
    statement("  for (int sk_k = 1; sk_k < sk_count; ++sk_k) {");
    statement("    " + foldingNext());
    statement("  }");
    statement("}");
    foldShared();
  }

  /// Invocations without elements contribute identities.
  void combineInGroup() {
    declareShared();
    statement(fmt::format("int sk_i = int(gl_LocalInvocationIndex), sk_runs = {};", groupSize));
    foldShared();
  }

  std::string blockIndex() {
    if (variant_.runs == Runs::WholeBlocks && !variant_.reshaped) return domain_.index();
    program_.require(Function::Unravel2);
    vectors({"sk_blocks_step"});
    return "sk_unravel(sk_block, sk_blocks_step)";
  }

  /// Sets sk_at to the number of the block's first element and sk_p to the element's index in the block.
  void startBox() {
    program_.require(Function::Ravel);
    integers({"sk_start"});
    vectors({"sk_stride", "sk_block_shape"});
    std::string block;
    if (manyBlocks()) {
      const std::string index = unravel("sk_block", "sk_blocks_step");
      block = fmt::format(" + sk_ravel({} * sk_block_shape, sk_stride)", index);
    }
    statement("int sk_at = sk_start" + block + ";");
    walkBox();
    first_ = next_ = numberedTexel("sk_at + sk_ravel(sk_p, sk_stride)");
  }

  /// Advances sk_p through the indices in a block.
  void walkBox() {
    vectors({"sk_block_shape"});
    statement("ivec4 sk_p = " + (startsInside() ? unravel("sk_first", "sk_block_step") : "ivec4(0)") + ";");
    step_ = {"++sk_p.x;"};
    for (std::size_t axis = 0; axis + 1 < variant_.axes; ++axis) {
      step_.push_back(fmt::format("if (sk_p.{0} == sk_block_shape.{0}) {{ sk_p.{0} = 0; ++sk_p.{1}; }}",
                                  "xyzw"[axis], "xyzw"[axis + 1]));
    }
  }

  /// Sets sk_item to the element's index and sk_corner to the index of the block's first element.
  void startIndex() {
    std::string place = "sk_p";
    if (manyBlocks()) {
      vectors({"sk_block_shape"});
      statement(fmt::format("ivec4 sk_corner = {} * sk_block_shape;", unravel("sk_block", "sk_blocks_step")));
      place = "sk_corner + sk_p";
    }
    walkBox();
    const std::string here = fmt::format("{} = {};", item(), place);
    statement(here);
    step_.push_back(here);
  }

  // ---- the fold ---------------------------------------------------------------------------------

  /// Folds an element, or the elements of a packed texel from component `first` on.
  void foldTexel(std::string_view indent, int first = 0) {
    if (!variant_.packed) return statement(fmt::format("{}{}", indent, foldingNext()));
    for (int lane = first; lane < lanes; ++lane) {
      const std::string component = fmt::format(".{}", "xyzw"[lane]);
      const std::string fold =
          calling(kernel_, [&](std::size_t i, std::size_t) { return elementOf(i, component); });
      statement(fmt::format("{}{}", indent, fold));
    }
  }

  std::string foldingNext() {
    return calling(kernel_, [&](std::size_t i, std::size_t) { return element(i, next_); });
  }

  std::string firstOf(std::size_t i) { return variant_.packed ? elementOf(i, ".x") : element(i, first_); }

  /// Starts a run from its first element or from the identity.
  void foldRun() {
    const bool isSeeded = isOfPartials(variant_.walk) || reduction_.seeded;
    const std::string count = variant_.run > 0 ? fmt::format("{}", variant_.run) : "sk_count";
    if (isSeeded) {
      if (variant_.packed) declareLanes();
      if (variant_.packed) fetchLanes(first_, "");
      startFromElements([&](std::size_t i) { return firstOf(i); });
      if (variant_.packed) foldTexel("", 1);
    } else {
      startFromIdentities();
      if (variant_.packed) declareLanes();
    }
    if (variant_.part > 0) foldParts();
    if (variant_.part > 0 && variant_.run > 0) return;
    const std::string_view bound = variant_.grouped ? "sk_isInside && sk_k" : "sk_k";
    statement(fmt::format("for (int sk_k = {}; {} < {}; ++sk_k) {{", isSeeded ? 1 : 0, bound, count));
    if (isSeeded) step();
    if (variant_.packed) fetchLanes(next_, "  ");
    foldTexel("  ");
    if (!isSeeded) step();
    statement("}");
  }

  /// Folds the parts of a run. What remains are sk_count elements or texels from sk_p on.
  void foldParts() {
    const int part = variant_.part;
    const std::string loop =
        variant_.run > 0 ? fmt::format("for (int sk_i = 0; sk_i < {}; ++sk_i) {{", variant_.run / part)
                         : fmt::format("for (; sk_count >= {0}; sk_count -= {0}) {{", part);
    statement((variant_.grouped ? "if (sk_isInside) " : "") + loop);
    folded_ = "sk_part";
    startFromIdentities("  ");
    statement(fmt::format("  for (int sk_k = 0; sk_k < {}; ++sk_k) {{", part));
    if (variant_.packed) fetchLanes(next_, "    ");
    foldTexel("    ");
    folded_ = "sk_total";
    statement("  }");
    statement("  " + calling(reduction_.combine,
                             [&](std::size_t, std::size_t k) { return held("sk_part", *accumulators_[k]); }));
    statement(fmt::format("  sk_p.y += {};", part));
    statement("}");
  }

  void step() {
    for (const std::string& line : step_) statement("  " + line);
  }

  Texel first_;  ///< of the run's first element
  Texel next_;  ///< of its element sk_k
  std::vector<std::string> step_;  ///< statements that advance to the next element
};

}  // namespace

std::string reduceProgram(const Profile& profile, const Reduction& reduction, const ReduceVariant& variant) {
  if (isByGroupsOfBlocks(variant)) return blockProgram(profile, reduction, variant);
  if (variant.rows != RowPass::None) return rowProgram(profile, reduction, variant);
  if (variant.scan != ScanPass::None) return scanProgram(profile, reduction, variant);
  return ReductionText(profile, reduction, variant).write();
}

std::string_view nameOf(Walk walk) {
  switch (walk) {
    case Walk::Line: return "elements of a line";
    case Walk::Plane: return "elements of a plane";
    case Walk::Box: return "elements of a box";
    case Walk::Index: return "elements by index";
    case Walk::Rows: return "elements of rows";
    case Walk::Partials: return "partial results";
    case Walk::PartialRows: return "partial results in rows";
    case Walk::GroupedPartials: return "partial results of groups";
    case Walk::Nothing: return "no elements";
  }
  return {};
}

std::string_view nameOf(Runs runs) {
  switch (runs) {
    case Runs::OneBlock: return "one block";
    case Runs::WholeBlocks: return "a run for each block";
    case Runs::Split: return "several runs for each block";
  }
  return {};
}

}  // namespace sk::assemble
