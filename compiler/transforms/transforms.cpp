// SPDX-License-Identifier: MIT
#include "transforms/transforms.hpp"

#include <array>
#include <cstdlib>
#include <iterator>
#include <string>
#include <string_view>

#include "ir/validate.hpp"
#include "split/passes.hpp"
#include "support/internal_error.hpp"
#include "transforms/passes.hpp"

namespace skc {
namespace {

struct Transform {
  std::string_view name;
  void (*run)(ir::Module&, Diagnostics&, const TransformOptions&);
};

/// Most transforms have no options.
template <void (*transform)(ir::Module&, Diagnostics&)>
void withoutOptions(ir::Module& module, Diagnostics& diagnostics, const TransformOptions&) {
  transform(module, diagnostics);
}

/// A transform that adds variants for other precisions, if the options ask for them.
template <void (*transform)(ir::Module&, Diagnostics&)>
void ifPrecisions(ir::Module& module, Diagnostics& diagnostics, const TransformOptions& options) {
  if (options.precisions) return transform(module, diagnostics);
  for (ir::Kernel& kernel : module.kernels) {
    if (!kernel.isSynthesized)
      kernel.variants.whyNotWide = kernel.variants.whyNotHalf = "skc was told to leave it out";
  }
}

// The reasons for this order:
//
// * specialize-gathers is first: from then on a function belongs to one kernel, and later transforms may
//   change it without looking at other callers.
// * expand-powers precedes what recognises products, such as the terms of sums.
// * tabulate precedes the variants for other precisions, which do not use tables.
// * fold-constants precedes derive-combine, so that a branch that a literal disables does not hide the
//   pattern of a fold; and guard-streams, because a removed branch needs no stream.
// * slice-assertions follows folding, which removes branches, and precedes all that treats its kernels like others.
// * unroll-loops needs the constant bounds that folding finds, and folds what it creates. It precedes
//   everything that inspects kernels: known iterations have known branches, constant offsets and named
//   components.
// * unroll-spec-loops precedes unroll-loops, which notes the loops that stay in declared kernels, and like it needs
//   folded bounds.
// * find-neighbors needs the constant offsets of unrolled loops, and precedes the analyses of stream uses.
// * find-reach follows folding, which removes reads, and precedes the transforms that synthesize kernels of declared ones.
// * bound-pushes follows folding, which finds trip counts and removes unreachable pushes.
// * inline-folds lets derive-combine see through helper functions.
// * derive-combine precedes remove-unused, because it adds functions that use structs.
// * split-folds needs derive-combine's identities and combining reduces, and precedes the variants, which its
//   kernels have, too.
// * widen-floats and round-halves follow derive-combine, so that variants combine in the same way, and
//   precede compensate-sums, which does not apply to them.
// * compensate-sums, sum-exactly and sum-in-doubles need derive-combine's identities and combining reduces, the last
//   also split-folds' parts.
// * assign-rows precedes split-kernels, which tracks variables.
// * forward-continues and copy-parts follow bound-pushes and derive-combine, which analyse the code as written.
// * expand-selects follows all transforms that copy code or synthesize it, so that nothing adds a `?:` after it. It precedes
//   split-kernels, which sees a branch as such.
// * remove-unused follows these, because all of them leave unused entries, and precedes split-kernels, so
//   that no pass is planned for unused values.
constexpr Transform transforms[] = {
    {"specialize-gathers", withoutOptions<specializeGathers>},
    {"expand-powers", withoutOptions<expandPowers>},
    {"tabulate", withoutOptions<tabulate>},
    {"fold-constants", withoutOptions<foldConstants>},
    {"slice-assertions", withoutOptions<split::sliceAssertions>},
    {"unroll-spec-loops", withoutOptions<unrollSpecLoops>},
    {"unroll-loops", withoutOptions<unrollLoops>},
    {"find-neighbors", withoutOptions<findNeighbors>},
    {"find-reach", withoutOptions<findReach>},
    {"guard-streams", withoutOptions<guardStreams>},
    {"bound-pushes", withoutOptions<boundPushes>},
    {"inline-folds", withoutOptions<inlineFolds>},
    {"derive-combine", withoutOptions<deriveCombine>},
    {"split-folds", withoutOptions<split::splitFolds>},
    {"widen-floats", ifPrecisions<widenFloats>},
    {"round-halves", ifPrecisions<roundHalves>},
    {"compensate-sums", withoutOptions<compensateSums>},
    {"sum-exactly", withoutOptions<sumExactly>},
    {"sum-in-doubles", withoutOptions<sumInDoubles>},
    {"assign-rows", withoutOptions<assignRows>},
    {"forward-continues", withoutOptions<forwardContinues>},
    {"copy-parts", withoutOptions<copyParts>},
    {"expand-selects",
     [](ir::Module& module, Diagnostics&, const TransformOptions& options) {
       if (options.expandsSelects) expandSelects(module);
     }},
    {"remove-unused", withoutOptions<removeUnused>},
    {"split-kernels", [](ir::Module& module, Diagnostics&,
                         const TransformOptions& options) { split::splitKernels(module, options.limits); }},
};

/// A violation is a bug of skc: names the transform after which it appeared.
void validateOrAbort(const ir::Module& module, ir::Stage stage, std::string_view after) {
  if (!validatesTransforms()) return;
  const std::string violation = ir::validate(module, stage);
  if (!violation.empty()) internalError("invalid IR after " + std::string(after) + ": " + violation);
}

}  // namespace

std::span<const std::string_view> transformNames() {
  static constexpr auto names = [] {
    std::array<std::string_view, std::size(transforms)> list;
    for (std::size_t i = 0; i < list.size(); ++i) list[i] = transforms[i].name;
    return list;
  }();
  return names;
}

bool validatesTransforms() {
#ifdef NDEBUG
  return false;
#else
  static const char* const chosen = std::getenv("SKC_VALIDATE");
  return chosen == nullptr || std::string_view(chosen) != "off";
#endif
}

void runTransforms(ir::Module& module, Diagnostics& diagnostics, const TransformOptions& options) {
  validateOrAbort(module, ir::Stage::Lowered, "the frontend");
  for (const Transform& transform : transforms) {
    noteActivity(transform.name);
    transform.run(module, diagnostics, options);
    if (diagnostics.hasErrors()) return;
    if (options.after)
      options.after(transform.name, module);  // first, so that an invalid module can be printed
    validateOrAbort(module, ir::Stage::Specialized, transform.name);
  }
}

}  // namespace skc
