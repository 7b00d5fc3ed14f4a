// SPDX-License-Identifier: MIT
//
// Programs that are assembled ahead, since browsers have no assembler: those that calls with whole streams need. Each has
// a key, which runtime/web/src computes from a call in the same way (variant.ts, reduce_plan.ts).
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "assemble/assemble.hpp"
#include "assemble/reduce/reduce_program.hpp"
#include "sk/program.hpp"

namespace skc::web {

/// GLSL by key. Several keys may have the same program.
using Programs = std::map<std::string, std::string>;

/// Which programs of a kernel there are.
struct Wanted {
  bool packed = true;  ///< those for packed streams, which passes of plans do not read
  bool views = false;  ///< those that [[variants(views)]] asks for
};

/// The programs of a kernel that fits one pass.
///
/// Streams are whole, in planes or linearised, either all packed that can be or none. Inputs have the shape of the domain.
/// A Spec parameter's value is any: `const T sk_spec_P = VALUE;` stands in the program for the runtime to replace.
/// A kernel with append outputs counts its pushes beside writing its other outputs.
Programs kernelPrograms(const sk::assemble::Profile& profile, const sk::program::Kernel& kernel,
                        const Wanted& wanted);

/// Those of them that [[variants(views)]] adds.
Programs viewPrograms(const sk::assemble::Profile& profile, const sk::program::Kernel& kernel);

/// What a program has instead of `uniform T sk_arg_k;` if a stream of one element, or an element of one, holds the value.
/// Empty if no stream may.
struct HeldValue {
  std::string uniforms;
  std::string statements;  ///< at the beginning of main()
};
HeldValue heldValue(const sk::assemble::Profile& profile, const sk::program::Parameter& uniform);
/// Whether the runtime finds that text itself: for floats, ints and uints, and their vectors.
bool isPlain(const sk::program::Parameter& uniform);

/// The programs of the list of an append output (assemble/append/append_passes.hpp), for streams that are not packed.
Programs listPrograms(const sk::assemble::Profile& profile, const sk::program::Kernel& kernel,
                      std::size_t appendOutput);

/// How a reduction is called.
struct ReductionCalls {
  bool byIndex;  ///< elements are always found by their index
  bool scans = false;  ///< it gives a result for each element, else values and streams
  bool mayBeEmpty = true;  ///< there may be no elements
};

/// The programs that fold whole streams to a value or to streams, or that scan them.
Programs reducePrograms(const sk::assemble::Profile& profile, const sk::program::Reduction& reduction,
                        const ReductionCalls& calls);

/// The key of a kernel's variant: "plane packed; u:plane packed nearby".
std::string keyOf(const sk::program::Kernel& kernel, const sk::assemble::Variant& variant);
/// The key of a pass of a reduction: "rows run8 column packed".
std::string keyOf(const sk::program::Kernel& kernel, const sk::assemble::ReduceVariant& variant);

/// How streams of a call lie.
struct Lie {
  sk::assemble::Domain domain;
  std::uint8_t rank;  ///< Variant::domainRank
  bool packed;  ///< all streams that can be
};

/// The domains that calls may have, packed and not: all, unless the kernel reads neighbours, when one of these gathers has the
/// rank of the domain. Streams of two dimensions are planes; all others are linearised.
std::vector<Lie> liesOf(const sk::program::Kernel& kernel);

/// All choices of accesses of a kernel's streams over such a domain.
std::vector<std::vector<sk::assemble::StreamAccess>> accessChoices(const sk::program::Kernel& kernel,
                                                                   const Lie& lie, bool domainPacked);

}  // namespace skc::web
