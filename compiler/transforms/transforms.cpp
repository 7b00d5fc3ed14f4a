// SPDX-License-Identifier: MIT
#include "transforms/transforms.hpp"

#include <array>
#include <cstdio>
#include <cstdlib>
#include <iterator>
#include <string>
#include <string_view>

#include "ir/print.hpp"
#include "ir/validate.hpp"
#include "split/split_kernels.hpp"
#include "transforms/assign_rows.hpp"
#include "transforms/bound_pushes.hpp"
#include "transforms/compensate_sums.hpp"
#include "transforms/derive_combine.hpp"
#include "transforms/find_neighbors.hpp"
#include "transforms/fold_constants.hpp"
#include "transforms/forward_continues.hpp"
#include "transforms/guard_streams.hpp"
#include "transforms/inline_folds.hpp"
#include "transforms/remove_unused.hpp"
#include "transforms/round_halves.hpp"
#include "transforms/specialize_gathers.hpp"
#include "transforms/sum_exactly.hpp"
#include "transforms/tabulate.hpp"
#include "transforms/unroll_loops.hpp"
#include "transforms/widen_floats.hpp"

namespace skc {
namespace {

struct Transform {
  std::string_view name;
  void (*run)(ir::Module&, Diagnostics&, const TransformOptions&);
};

/// Most transforms have no options.
template <void (*transform)(ir::Module&, Diagnostics&)>
void plain(ir::Module& module, Diagnostics& diagnostics, const TransformOptions&) {
  transform(module, diagnostics);
}

/// One that makes forms of kernels for other precisions.
template <void (*transform)(ir::Module&, Diagnostics&)>
void ofPrecisions(ir::Module& module, Diagnostics& diagnostics, const TransformOptions& options) {
  if (options.precisions) return transform(module, diagnostics);
  for (ir::Kernel& kernel : module.kernels) {
    if (!kernel.isMade) kernel.forms.whyNotWide = kernel.forms.whyNotHalf = "skc was told to leave it out";
  }
}

// First the gathers: from then on a function belongs to one kernel, and every later transform may
// change it without looking at other callers.
// Tables at any time before forms for other precisions, which do without.
// Folding before deriving, so that what a branch on a literal switches off does not hide the pattern
// of a fold.
// Unrolling after folding, which makes constants of bounds; and before all that look at what a kernel does, because a round
// whose number is known has decided branches, constant offsets and components with names. It folds what it creates.
// Finding neighbours after unrolling, which makes constants of their offsets; and before whatever asks how streams are used.
// Folding before guarding, too: a branch that is gone needs no stream.
// Bounding the pushes after folding, which makes loops of a known number of rounds and takes out what
// never runs.
// Inlining before deriving, which then sees through helper functions.
// Deriving before removing, because it makes functions that use structs.
// Forms for other precisions after deriving, so that they combine likewise; and before compensating, which
// is not for them.
// Compensating and summing exactly after deriving, which finds identities and how the rest combines.
// Assigning rows at any time before splitting, which follows variables.
// Forwarding after bounding and deriving, which know what the author wrote.
// Removing after these, because all of them leave things without use; and before splitting, so that
// nobody plans for what is not needed.
constexpr Transform transforms[] = {
    {"specialize-gathers", plain<specializeGathers>},
    {"tabulate", plain<tabulate>},
    {"fold-constants", plain<foldConstants>},
    {"unroll-loops", plain<unrollLoops>},
    {"find-neighbors", plain<findNeighbors>},
    {"guard-streams", plain<guardStreams>},
    {"bound-pushes", plain<boundPushes>},
    {"inline-folds", plain<inlineFolds>},
    {"derive-combine", plain<deriveCombine>},
    {"widen-floats", ofPrecisions<widenFloats>},
    {"round-halves", ofPrecisions<roundHalves>},
    {"compensate-sums", plain<compensateSums>},
    {"sum-exactly", plain<sumExactly>},
    {"assign-rows", plain<assignRows>},
    {"forward-continues", plain<forwardContinues>},
    {"remove-unused", plain<removeUnused>},
    {"split-kernels", [](ir::Module& module, Diagnostics&,
                         const TransformOptions& options) { split::splitKernels(module, options.limits); }},
};

/// A violation is a bug of ours: says after which transform it appeared, and shows the module.
void validateOrAbort(const ir::Module& module, ir::Stage stage, std::string_view after) {
  if (!validatesTransforms()) return;
  const std::string violation = ir::validate(module, stage);
  if (violation.empty()) return;
  std::fprintf(stderr, "skc: internal error: invalid IR after %s: %s\n\n%s", std::string(after).c_str(),
               violation.c_str(), ir::print(module).c_str());
  std::abort();
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
    transform.run(module, diagnostics, options);
    if (diagnostics.hasErrors()) return;
    validateOrAbort(module, ir::Stage::Specialized, transform.name);
    if (options.after) options.after(transform.name, module);
  }
}

}  // namespace skc
