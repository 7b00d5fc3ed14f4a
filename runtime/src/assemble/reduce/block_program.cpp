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
    program_.dispatchGroups(groupSize, 1);
    defineParameters();
    program_.foreign(reduction_.addition);
    const std::vector<Parameter> written =
        withPlanes(accumulators_, variant_.firstPlane, variant_.planeCount);
    for (const Parameter& parameter : written) declareOutputs(program_, parameter);
    declareShared();
    findPart();
    foldItems();
    statement(fmt::format("int sk_runs = {};", groupSize));
    foldShared();
    return finish(written, fmt::format("{}blocks by work groups", variant_.packed ? "packed " : ""));
  }

 private:
  /// Finds the group's items: sk_count from number sk_first on, in the block whose first item has index sk_corner.
  void findPart() {
    integers({"sk_blocks", "sk_fan", "sk_block_length"});
    vectors({"sk_block_shape"});
    statement("int sk_i = int(gl_LocalInvocationIndex), sk_number = " + domain_.number() + ";");
    statement("int sk_run = sk_number / sk_blocks, sk_block = sk_number - sk_run * sk_blocks;");
    statement("int sk_first = sk_run * sk_fan, sk_count = min(sk_fan, sk_block_length - sk_first);");
    statement(fmt::format("ivec4 sk_corner = {} * sk_block_shape;", unravel("sk_block", "sk_blocks_step")));
  }

  /// If order matters, an invocation folds consecutive items.
  void foldItems() {
    startFromIdentities();
    if (reduction_.commutative) {
      statement(fmt::format("for (int sk_k = sk_i; sk_k < sk_count; sk_k += {}) {{", groupSize));
    } else {
      statement(
          fmt::format("int sk_each = (sk_count + {}) / {}, sk_end = min((sk_i + 1) * sk_each, sk_count);",
                      groupSize - 1, groupSize));
      statement("for (int sk_k = sk_i * sk_each; sk_k < sk_end; ++sk_k) {");
    }
    const std::string_view inElements = variant_.packed ? " * ivec4(4, 1, 1, 1)" : "";
    statement(fmt::format("  {} = (sk_corner + {}){};", item(), unravel("sk_first + sk_k", "sk_block_step"),
                          inElements));
    if (variant_.packed) {
      foldTexel();
    } else {
      statement("  " + calling(kernel_, [&](std::size_t i, std::size_t) { return element(i, {}); }));
    }
    statement("}");
  }

  void foldTexel() {
    for (std::size_t i = 0; i < kernel_.parameters.size(); ++i) {
      const Parameter& input = kernel_.parameters[i];
      if (input.role != Role::Input || !isNeeded(input, variant_.specs)) continue;
      const Parameter four = fourOf(input);
      const Texel element = inputTexel(program_, input, access(i));
      statement(fmt::format("  ivec2 sk_at_{} = {};", input.symbol, element.at));
      const Texel texel{fmt::format("ivec2(sk_at_{0}.x >> 2, sk_at_{0}.y)", input.symbol), element.shift};
      statement(
          fmt::format("  {} sk_in_{} = {};", four.element->glsl, input.symbol, fetch(program_, four, texel)));
    }
    for (int lane = 0; lane < lanes; ++lane) {
      const std::string component = fmt::format(".{}", "xyzw"[lane]);
      const std::string fold =
          calling(kernel_, [&](std::size_t i, std::size_t) { return elementOf(i, component); });
      statement("  " + fold);
    }
  }
};

}  // namespace

std::string blockProgram(const Profile& profile, const Reduction& reduction, const ReduceVariant& variant) {
  return BlockText(profile, reduction, variant).write();
}

}  // namespace sk::assemble
