// SPDX-License-Identifier: MIT
//
// The native form of a kernel: a struct template over its real type, as sk/native/run.hpp wants it, with the
// kernel's parameters as members and its functions as they are.
//
//   template <class sk_real>
//   struct sk_scale {
//     native::Uniform<sk_real> sk_arg_k;
//     native::Input<sk_real> sk_arg_x;
//     native::Output<sk_real> sk_arg_r;
//     native::Index sk_index, sk_extent;
//     int sk_i;
//     explicit sk_scale(const native::Call& call) : ...
//     auto sk_streams() { return std::tie(sk_arg_x, sk_arg_r); }
//     void scale(sk_real k, sk_real x, sk_real& r) { r = k * x; }
//     void sk_element() { ... }
//   };
//
// Where a gather's neighbours are known to be near, it has a second template parameter, for the elements whose neighbours
// are all in their own row. Where its elements are worth computing side by side, it has another form of its functions and of
// sk_element, sk_lanes (native_lanes.hpp).
#pragma once

#include <cstdint>
#include <string>

#include "emit/program.hpp"
#include "emit/variant_names.hpp"
#include "ir/ir.hpp"

namespace skc::emit {

/// The real types that a kernel's native code is made for.
enum class Reals : std::uint8_t {
  Single,  ///< forms that have a meaning for floats alone
  Double,  ///< the reference's, too
  Quad,  ///< and that of the widest reference
};

/// How much is done for the speed of a kernel's native code, which takes compilers long.
enum class Speed : std::uint8_t {
  Any,  ///< nothing: it computes one element of results, or shows what another device would compute
  OfFloats,  ///< its loops are compiled as a whole, for each generation of CPUs; not those of wider real types
  Best,  ///< those of doubles are also compiled as a whole
};

struct NativeForm {
  Reals reals;
  Speed speed;
};

/// The definitions of a whole module, in a namespace of their own. Kernels bear the names of their
/// descriptors (descriptorNames); what combines the partial results of a reduce and is no kernel of the module, the
/// reduce's with "Combine".
std::string nativeListing(const ir::Module& module, const Program& program, Reals reals);

/// The constants NAMENative of type sk::program::NativeKernel and NativeReduction, after the functions that they name.
/// `combine` is the name of what combines.
std::string nativeKernelDescriptor(const std::string& name, NativeForm form);
std::string nativeReductionDescriptor(const std::string& name, const std::string& combine,
                                      const ir::Kernel& reduce, NativeForm form);

}  // namespace skc::emit
