// SPDX-License-Identifier: MIT
//
// A piece has consecutive items. RowPass::Groups first folds each element of many pieces by itself, to shared memory, so
// that neighbouring invocations fetch neighbouring elements, or texels, and then combines those of each piece in an
// invocation of its own (CSR-Stream: J. L. Greathouse and M. Daga, "Efficient sparse matrix-vector multiplication on GPUs
// using the CSR storage format", 2014).
#include "assemble/reduce/row_program.hpp"

#include <algorithm>
#include <array>
#include <cassert>
#include <utility>

#include <fmt/format.h>

#include "assemble/elements/arguments.hpp"
#include "assemble/reduce/fold_text.hpp"
#include "assemble/reduce/reduce_plan.hpp"
#include "assemble/reduce/scan_program.hpp"
#include "sk/scalar_bytes.hpp"
#include "sk/types.hpp"

namespace sk::assemble {

using program::Kernel;
using program::Parameter;
using program::Reduction;
using program::Role;

RowKernel::RowKernel(const Kernel& kernel, RowPass pass)
    : parameters_(kernel.parameters.begin(), kernel.parameters.end()),
      ownParameters_(parameters_.size()),
      kernel_(kernel) {
  const auto add = [&](std::string_view name, const program::Element& element) {
    parameters_.push_back({.name = name, .symbol = name, .role = Role::Input, .element = &element});
  };
  add("sk_rows", ElementTraits<int2>::element());
  if (pass == RowPass::Groups) add("sk_groups", ElementTraits<int4>::element());
  kernel_.parameters = parameters_;
}

namespace {

class RowText : FoldText {
 public:
  RowText(const Profile& profile, const Reduction& reduction, const ReduceVariant& variant)
      : FoldText(profile, reduction, variant,
                 isOfPartials(variant.walk) ? reduction.combine : reduction.fold),
        continued_(kernel_),
        inRows_(kernel_, variant.rows) {}

  std::string write() {
    if (variant_.rows != RowPass::Groups) domain_.leaveOutside();  // loops end where tables say
    defineParameters();
    if (variant_.carried) {
      for (const Parameter& carry : continued_.carries())
        declareSamplers(program_, carry, variant_.carryLayered);
    }
    declareSamplers(program_, inRows_.table(), variant_.tableLayered);
    const std::vector<Parameter> written =
        withPlanes(accumulators_, variant_.firstPlane, variant_.planeCount);
    for (const Parameter& parameter : written) declareOutputs(program_, parameter);
    switch (variant_.rows) {
      case RowPass::None: break;
      case RowPass::Folds: foldPiece(); break;
      case RowPass::Groups: return foldGroup(written);
      case RowPass::Inclusive:
      case RowPass::Exclusive: scanItem(); break;
    }
    return finish(written,
                  fmt::format("{} of rows", isOfPartials(variant_.walk) ? "partial results" : "elements"));
  }

 private:
  std::string tableEntry(std::string_view number) {
    program_.require(Function::Texel);
    integers({"sk_rows_shift"});
    return fetch(
        program_, inRows_.table(),
        {fmt::format("sk_texel({}, sk_rows_shift)", number), variant_.tableLayered ? "sk_rows_shift" : ""});
  }

  /// Sets the index of the current element, if anything reads it.
  void moveTo(std::string_view number, std::string_view indent) {
    if (usesItem_) statement(fmt::format("{}{} = ivec4({}, 0, 0, 0);", indent, item(), number));
  }
  std::string elementAt(std::size_t i, std::string_view number) {
    if (isOfPartials(variant_.walk)) return element(i, numberedTexel(number));
    const Parameter& input = kernel_.parameters[i];
    if (!isNeeded(input, variant_.specs)) return absentElement(input);
    Texel texel = texelOf(i, fmt::format("{} + {}", origin(i), number), access(i).packed ? " + 2" : "");
    texel.packed = access(i).packed;  // then x counts elements
    return fetch(program_, input, texel);
  }
  /// The number of an input's first element in its stream.
  std::string origin(std::size_t i) {
    if (!access(i).view) return "0";
    return parameterUniform(program_, "ivec4", "origin", kernel_.parameters[i]) + ".x";
  }
  /// The texel with a number in a one-dimensional stream; `inTexel` is added to log2 of its width.
  Texel texelOf(std::size_t i, const std::string& number, std::string_view inTexel = "") {
    if (access(i).addressing == Addressing::Plane) return {fmt::format("ivec2({}, 0)", number)};
    program_.require(Function::Texel);
    const std::string shift = parameterUniform(program_, "int", "shift", kernel_.parameters[i]);
    return {fmt::format("sk_texel({}, {}{})", number, shift, inTexel),
            access(i).addressing == Addressing::Layered ? shift : ""};
  }
  std::string foldAt(std::string_view number) {
    return calling(kernel_, [&](std::size_t i, std::size_t) { return elementAt(i, number); });
  }

  bool startsFromElement() const {
    return isOfPartials(variant_.walk) ? !variant_.ofDigits : reduction_.seeded;
  }
  bool hasIdentities() const {
    return std::ranges::none_of(accumulators_,
                                [](const Parameter* accumulator) { return accumulator->identity.empty(); });
  }

  /// Folds the items of sk_run, of which the first k are at(k).
  void foldItems(const std::function<std::string(std::size_t i, std::string_view k)>& at,
                 std::string_view first) {
    if (!startsFromElement()) {
      startFromIdentities();
    } else if (isOfPartials(variant_.walk) || !hasIdentities()) {  // each row has a partial result
      moveTo(first, "");
      startFromElements([&](std::size_t i) { return at(i, "0"); });
    } else {
      startFromIdentities();
      statement("if (sk_run.y > 0) {");
      moveTo(first, "  ");
      for (std::size_t k = 0; k < accumulators_.size(); ++k) {
        const auto i = static_cast<std::size_t>(inputs_[k] - kernel_.parameters.data());
        statement(fmt::format("  {} = {};", total(*accumulators_[k]), at(i, "0")));
      }
      statement("}");
    }
    statement(fmt::format("for (int sk_k = {}; sk_k < sk_run.y; ++sk_k) {{", startsFromElement() ? 1 : 0));
    moveTo(fmt::format("{} + sk_k", first), "  ");
    statement("  " + calling(kernel_, [&](std::size_t i, std::size_t) { return at(i, "sk_k"); }));
    statement("}");
  }

  void foldPiece() {
    statement("int sk_number = " + domain_.number() + ";");
    statement("ivec2 sk_run = " + tableEntry("sk_number") + ";");
    foldItems(
        [&](std::size_t i, std::string_view k) { return elementAt(i, fmt::format("sk_run.x + {}", k)); },
        "sk_run.x");
  }

  // ---- groups -----------------------------------------------------------------------------------

  /// Folds each element of the group by itself, then combines those of each piece.
  std::string foldGroup(const std::vector<Parameter>& written) {
    program_.dispatchGroups(rowGroupSize, 1, /*storesApart=*/true);
    program_.foreign(reduction_.addition);
    declareSamplers(program_, inRows_.groups(), false);
    vectors({"sk_group_shape"});
    integers({"sk_groups_shift"});
    statement(
        "int sk_i = int(gl_LocalInvocationIndex), sk_group = sk_pixel.y * sk_group_shape.x + sk_pixel.x;");
    const std::string entry = fetch(program_, inRows_.groups(), {"sk_texel(sk_group, sk_groups_shift)"});
    statement(fmt::format("ivec4 sk_some = sk_group < sk_group_shape.y ? {} : ivec4(0);", entry));
    for (const Parameter* accumulator : accumulators_) {
      program_.variable(fmt::format("shared {}", accumulator->element->glsl),
                        fmt::format("{}[{}]", nameOfFolded(*accumulator), rowGroupItems));
    }
    variant_.packed ? foldTexels() : foldElements();
    statement("memoryBarrierShared();");
    statement("barrier();");
    statement("if (sk_i >= sk_some.y) return;");
    statement("ivec2 sk_run = " + tableEntry("sk_some.x + sk_i") + ";");
    combinePiece();
    for (const Parameter& parameter : written) store(program_, parameter, total(parameter));
    program_.storeAt(place(program_, result()), variant_.domainLayered);
    return program_.finish(profile_,
                           fmt::format("{} for {}: {}groups of rows", reduction_.fold.name, profile_.name,
                                       variant_.packed ? "packed " : ""),
                           kernel_);
  }

  static std::string nameOfFolded(const Parameter& accumulator) {
    return fmt::format("sk_folded_{}", accumulator.symbol);
  }
  void keepFolded(std::string_view number, std::string_view indent) {
    for (const Parameter* accumulator : accumulators_)
      statement(
          fmt::format("{}{}[{}] = {};", indent, nameOfFolded(*accumulator), number, total(*accumulator)));
  }

  void foldElements() {
    statement(fmt::format("for (int sk_k = sk_i; sk_k < sk_some.w; sk_k += {}) {{", rowGroupSize));
    moveTo("sk_some.z + sk_k", "  ");
    startFromIdentities("  ");
    statement("  " + foldAt("sk_some.z + sk_k"));
    keepFolded("sk_k", "  ");
    statement("}");
  }

  /// The first texel may begin with elements of the group before, the last one end with those of the next; they are
  /// folded, and not kept. The elements of a texel are folded before any is kept, so that their gathers overlap.
  void foldTexels() {
    static constexpr std::array<std::string_view, lanes> names = {"sk_of_x", "sk_of_y", "sk_of_z", "sk_of_w"};
    bool isFirst = true;
    for (std::size_t i = 0; i < kernel_.parameters.size(); ++i) {
      if (!isFetched(i)) continue;
      const std::string_view symbol = kernel_.parameters[i].symbol;
      statement(fmt::format("int sk_first_{} = {} + sk_some.z;", symbol, origin(i)));
      // the same for all inputs
      if (std::exchange(isFirst, false))
        statement(fmt::format("int sk_skip = sk_first_{} & {};", symbol, lanes - 1));
    }
    statement(fmt::format("for (int sk_k = sk_i; sk_k * {} < sk_some.w + sk_skip; sk_k += {}) {{", lanes,
                          rowGroupSize));
    for (std::size_t i = 0; i < kernel_.parameters.size(); ++i) {
      if (!isFetched(i)) continue;
      const Parameter& input = kernel_.parameters[i];
      const Parameter four = fourOf(input);
      const std::string number = fmt::format("(sk_first_{} >> 2) + sk_k", input.symbol);
      statement(fmt::format("  {} sk_in_{} = {};", four.element->glsl, input.symbol,
                            fetch(program_, four, texelOf(i, number))));
    }
    statement(fmt::format("  int sk_at = sk_k * {} - sk_skip;", lanes));
    for (int lane = 0; lane < lanes; ++lane) {
      folded_ = names[static_cast<std::size_t>(lane)];
      moveTo(fmt::format("sk_some.z + sk_at + {}", lane), "  ");
      startFromIdentities("  ");
      const std::string component = fmt::format(".{}", "xyzw"[lane]);
      statement("  " + calling(kernel_, [&](std::size_t i, std::size_t) { return elementOf(i, component); }));
    }
    for (int lane = 0; lane < lanes; ++lane) {
      folded_ = names[static_cast<std::size_t>(lane)];
      statement(fmt::format("  if (uint(sk_at + {}) < uint(sk_some.w)) {{", lane));
      keepFolded(fmt::format("sk_at + {}", lane), "    ");
      statement("  }");
    }
    statement("}");
    folded_ = "sk_total";
  }
  bool isFetched(std::size_t i) const {
    return kernel_.parameters[i].role == Role::Input && isNeeded(kernel_.parameters[i], variant_.specs);
  }

  void combinePiece() {
    statement("int sk_at = sk_run.x - sk_some.z;");
    startFromIdentities();
    statement("if (sk_run.y > 0) {");
    for (const Parameter* accumulator : accumulators_)
      statement(fmt::format("  {} = {}[sk_at];", total(*accumulator), nameOfFolded(*accumulator)));
    statement("}");
    statement("for (int sk_k = 1; sk_k < sk_run.y; ++sk_k) {");
    statement("  " + calling(reduction_.combine, [&](std::size_t, std::size_t k) {
                return fmt::format("{}[sk_at + sk_k]", nameOfFolded(*accumulators_[k]));
              }));
    statement("}");
  }

  /// The texel of the result of this invocation's piece.
  Texel result() {
    vectors({"sk_domain_origin"});
    const std::string number = "sk_some.x + sk_i + sk_domain_origin.x";
    if (variant_.domain == Domain::Plane) return {fmt::format("ivec2({}, sk_domain_origin.y)", number)};
    program_.require(Function::Texel);
    integers({"sk_domain_shift"});
    return {fmt::format("sk_texel({}, sk_domain_shift)", number),
            variant_.domainLayered ? "sk_domain_shift" : ""};
  }

  // ---- scans ------------------------------------------------------------------------------------

  /// Folds the items of a piece up to this one, after the pieces before.
  void scanItem() {
    const bool isExclusive = variant_.rows == RowPass::Exclusive;
    const bool isSeeded = !isExclusive && startsFromElement();
    statement("int sk_number = " + domain_.number() + ";");
    statement("ivec2 sk_run = " + tableEntry("sk_number") + ";");
    statement(
        fmt::format("int sk_at = sk_number - sk_run.x, sk_count = sk_run.x{};", isExclusive ? "" : " + 1"));
    if (isSeeded) {
      moveTo("sk_at", "");
      startFromElements([&](std::size_t i) { return elementAt(i, "sk_at"); });
    } else {
      startFromIdentities();
    }
    if (variant_.carried) continueFromCarry(isSeeded);
    const bool mustSettle = variant_.ofDigits && variant_.carried && !isOfPartials(variant_.walk);
    if (mustSettle) program_.foreign(reduction_.addition);
    statement(fmt::format("for (int sk_k = {}; sk_k < sk_count; ++sk_k) {{", isSeeded ? 1 : 0));
    if (mustSettle) settleDigits();
    moveTo("sk_at + sk_k", "  ");
    statement("  " + foldAt("sk_at + sk_k"));
    statement("}");
  }

  /// Combines digits with zero where a piece has used the room that its carry leaves.
  void settleDigits() {
    assert(!reduction_.addition.empty());
    const auto zero = [&](std::size_t, std::size_t k) { return std::string(identityOf(*accumulators_[k])); };
    statement(
        fmt::format("  if (sk_k == {}) {}", program::longestContinuedRun, calling(reduction_.combine, zero)));
  }

  void continueFromCarry(bool isSeeded) {
    integers({"sk_carry_shift"});
    program_.require(Function::Texel);
    statement("if (sk_run.y >= 0) {");
    const Texel texel{"sk_texel(sk_run.y, sk_carry_shift)", variant_.carryLayered ? "sk_carry_shift" : ""};
    for (std::size_t k = 0; k < accumulators_.size(); ++k) {
      statement(fmt::format("  {} = {};", total(*accumulators_[k]),
                            fetch(program_, continued_.carries()[k], texel)));
    }
    if (isSeeded) statement("  " + foldAt("sk_at"));
    statement("}");
  }

  ContinuedKernel continued_;
  RowKernel inRows_;
  const bool usesItem_ = !isOfPartials(variant_.walk) && readsElementIndex(kernel_);
};

}  // namespace

bool mayGroupRows(const Reduction& reduction) {
  if (!foldsInGroups(reduction)) return false;
  std::size_t bytes = 0;  // of the accumulators of an element
  for (const Parameter& parameter : reduction.fold.parameters) {
    if (parameter.role != Role::Accumulator) continue;
    for (const program::Field& field : parameter.element->fields) {
      const std::size_t aligned = field.width == 3 ? 4 : field.width;
      bytes += aligned * (program::is64Bit(field.scalar) ? sizeof(double) : sizeof(float));
    }
  }
  return bytes * rowGroupItems <= groupBytes;
}

std::string rowProgram(const Profile& profile, const Reduction& reduction, const ReduceVariant& variant) {
  return RowText(profile, reduction, variant).write();
}

}  // namespace sk::assemble
