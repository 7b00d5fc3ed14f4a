// SPDX-License-Identifier: MIT
//
// Items are the elements of a block, numbered row-major, or, of packed inputs, texels.
#include "assemble/reduce/block_program.hpp"

#include <fmt/format.h>

#include "assemble/elements/arguments.hpp"
#include "assemble/reduce/fold_text.hpp"

namespace sk::assemble {

using program::Parameter;
using program::Reduction;
using program::Role;

namespace {

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

}  // namespace

std::string blockProgram(const Profile& profile, const Reduction& reduction, const ReduceVariant& variant) {
  return BlockText(profile, reduction, variant).write();
}

}  // namespace sk::assemble
