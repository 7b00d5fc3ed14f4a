// SPDX-License-Identifier: MIT
//
// The program of one pass of a reduction. main() finds its run, that is, a block and the place in it
// where the run starts, and folds the run's elements with one loop.
#include "assemble/reduce_program.hpp"

#include <initializer_list>

#include <fmt/format.h>

#include "assemble/domain.hpp"
#include "assemble/planes.hpp"
#include "assemble/program_text.hpp"

namespace sk::assemble {
namespace {

using program::Parameter;
using program::Reduction;

std::string_view name(Walk walk) {
  switch (walk) {
    case Walk::Line: return "elements of a line";
    case Walk::Plane: return "elements of a plane";
    case Walk::Box: return "elements of a box";
    case Walk::Partials: return "partial results";
  }
  return {};
}

std::string_view name(Runs runs) {
  switch (runs) {
    case Runs::OneBlock: return "one block";
    case Runs::WholeBlocks: return "a run for each block";
    case Runs::Split: return "several runs for each block";
  }
  return {};
}

class ReductionText {
 public:
  ReductionText(const Reduction& reduction, const ReduceVariant& variant)
      : reduction_(reduction),
        variant_(variant),
        source_(reduction.fold.parameters[variant.walk == Walk::Partials ? 1 : 0]),
        accumulator_(reduction.fold.parameters[1]),
        domain_(program_, variant.domain, variant.domainView, variant.domainRank) {}

  std::string write(const Profile& profile) {
    if (reduction_.fold.usesLoops) domain_.leaveOutside();
    declareSamplers(program_, source_);
    declareOutputs(program_, accumulator_);
    findRun();
    startWalk();
    foldRun();
    const std::string comment = fmt::format("{} for {}: {}, {}", reduction_.fold.name, profile.name,
                                            name(variant_.walk), name(variant_.runs));
    return program_.finish(profile, comment, reduction_.fold);
  }

 private:
  /// Defines sk_block (its number), sk_first (the run's first element in it) and sk_count, as far as
  /// they are not constants.
  void findRun() {
    const std::string number = domain_.number();
    switch (variant_.runs) {
      case Runs::OneBlock:
        integers({"sk_fan", "sk_length"});
        statement("int sk_first = (" + number + ") * sk_fan;");
        statement("int sk_count = min(sk_fan, sk_length - sk_first);");
        return;
      case Runs::WholeBlocks:
        integers({"sk_length"});
        if (variant_.walk != Walk::Plane) statement("int sk_block = " + number + ";");
        statement("int sk_count = sk_length;");
        return;
      case Runs::Split:
        integers({"sk_blocks", "sk_fan", "sk_length"});
        statement("int sk_number = " + number + ";");
        statement("int sk_run = sk_number / sk_blocks;");
        statement("int sk_block = sk_number - sk_run * sk_blocks;");
        statement("int sk_first = sk_run * sk_fan;");
        statement("int sk_count = min(sk_fan, sk_length - sk_first);");
        return;
    }
  }

  void startWalk() {
    switch (variant_.walk) {
      case Walk::Line: startLine(); return;
      case Walk::Plane: startPlane(); return;
      case Walk::Box: startBox(); return;
      case Walk::Partials: startPartials(); return;
    }
  }

  bool manyBlocks() const { return variant_.runs != Runs::OneBlock; }
  bool startsInside() const { return variant_.runs != Runs::WholeBlocks; }

  void startLine() {
    integers({"sk_start"});
    const std::string_view block = manyBlocks() ? " + sk_block * sk_length" : "";
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

  /// sk_corner is the block's first texel, sk_p the texel of the element.
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
    first_ = next_ = "sk_p";
  }

  std::string blockIndex() {
    if (variant_.runs == Runs::WholeBlocks) return domain_.index();
    program_.require(Function::Unravel2);
    vectors({"sk_blocks_step"});
    return "sk_unravel(sk_block, sk_blocks_step)";
  }

  /// sk_at is the number of the block's first element, sk_p the element's index in the block.
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
    statement("ivec4 sk_p = " + (startsInside() ? unravel("sk_first", "sk_block_step") : "ivec4(0)") + ";");
    step_ = {"++sk_p.x;"};
    for (std::size_t axis = 0; axis + 1 < variant_.axes; ++axis) {
      step_.push_back(fmt::format("if (sk_p.{0} == sk_block_shape.{0}) {{ sk_p.{0} = 0; ++sk_p.{1}; }}",
                                  "xyzw"[axis], "xyzw"[axis + 1]));
    }
    first_ = next_ = numberedTexel("sk_at + sk_ravel(sk_p, sk_stride)");
  }

  std::string unravel(std::string_view number, std::string_view strides) {
    if (variant_.axes == 1) return fmt::format("ivec4({}, 0, 0, 0)", number);
    program_.require(variant_.axes == 2   ? Function::Unravel2
                     : variant_.axes == 3 ? Function::Unravel3
                                          : Function::Unravel4);
    vectors({strides});
    return fmt::format("sk_unravel({}, {})", number, strides);
  }

  /// A run starts from its first element, or else from the identity.
  void foldRun() {
    const bool partials = variant_.walk == Walk::Partials;
    const std::string_view type = accumulator_.element->glsl;
    const std::string_view function = partials ? reduction_.combine : reduction_.fold.entry;
    const std::string fold = fmt::format("  {}({}, sk_total);", function, fetch(program_, source_, next_));
    if (partials || reduction_.seeded) {
      statement(fmt::format("{} sk_total = {};", type, fetch(program_, source_, first_)));
      statement("for (int sk_k = 1; sk_k < sk_count; ++sk_k) {");
      for (const std::string& line : step_) statement("  " + line);
      statement(fold);
    } else {
      statement(fmt::format("{} sk_total = {};", type, accumulator_.identity));
      statement("for (int sk_k = 0; sk_k < sk_count; ++sk_k) {");
      statement(fold);
      for (const std::string& line : step_) statement("  " + line);
    }
    statement("}");
    store(program_, accumulator_, "sk_total");
  }

  std::string numberedTexel(std::string_view number) {
    program_.require(Function::Texel);
    integers({"sk_shift"});
    return fmt::format("sk_texel({}, sk_shift)", number);
  }

  void integers(std::initializer_list<std::string_view> uniforms) {
    for (const std::string_view uniform : uniforms) program_.uniform("int", uniform);
  }
  void vectors(std::initializer_list<std::string_view> uniforms) {
    for (const std::string_view uniform : uniforms) program_.uniform("ivec4", uniform);
  }
  void statement(std::string_view line) { program_.statement(line); }

  const Reduction& reduction_;
  const ReduceVariant& variant_;
  const Parameter& source_;
  const Parameter& accumulator_;
  ProgramText program_;
  DomainText domain_;
  std::string first_;                 ///< texel of the run's first element
  std::string next_;                  ///< texel of its element sk_k
  std::vector<std::string> step_;     ///< statements that go from one element to the next
};

}  // namespace

std::string reduceProgram(const Profile& profile, const Reduction& reduction, const ReduceVariant& variant) {
  return ReductionText(reduction, variant).write(profile);
}

}  // namespace sk::assemble
