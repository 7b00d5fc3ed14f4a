// SPDX-License-Identifier: MIT
//
// Determines the variant of a kernel that a call needs from its streams' layouts: the assembler's choices.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "assemble/assemble.hpp"
#include "assemble/region_layout.hpp"
#include "call/iterator.hpp"
#include "gl_device/memory/render_target.hpp"
#include "sk/call.hpp"
#include "sk/program.hpp"

namespace sk {

/// One argument of a pass. Operands of Uniform and Spec parameters have a value; those of iterators have the
/// first value, the step, and the domain as region layout; all others, and those of uniforms that a stream holds, have
/// a region layout and planes.
struct Operand {
  const void* value = nullptr;
  assemble::RegionLayout regionLayout = {};
  std::span<RenderTarget> planes = {};
  IteratorStep step = {};
  int rank = 0;  ///< iterators: rank of the domain
  bool fitted = false;  ///< inputs with another program::Fit than Same
  /// Fitted inputs: k > 0 if each element serves k consecutive indices, -k if every k-th element is read.
  assemble::Index4 ratio = {1, 1, 1, 1};
  Storage storage = Storage::Single;
};

/// A program's identity among those of loaded kernels: the address of its descriptor, and its variant.
struct ProgramKey {
  const program::Kernel* kernel = nullptr;
  assemble::Variant variant = {};

  bool operator==(const ProgramKey&) const = default;
};

struct ProgramKeyHash {
  std::size_t operator()(const ProgramKey& key) const;
};

/// How an element of a region with this layout is addressed by its index.
assemble::Addressing addressingOf(const assemble::RegionLayout& regionLayout);

/// The operand for a region, an argument of a call over a domain of this shape.
Operand regionOperand(const Argument& argument, const Shape& domain);

/// The layout of a region of one element, with the element's place among the elements of all texels, x and y, as origin.
assemble::RegionLayout texelOf(assemble::RegionLayout element);

/// The operand for a uniform: a value or, if a stream of one element holds it, that element, with the texel as origin
/// (StreamAccess::view).
Operand uniformOperand(const Argument& argument);

/// The operand for an iterator with these ends over a domain of this shape.
Operand iteration(const program::Parameter& iterator, const void* ends, const Shape& domain);

/// The variant of `kernel` for these operands, one per parameter, and this domain. `filtersFloats`: the device can filter
/// 32-bit floats.
assemble::Variant chooseVariant(const program::Kernel& kernel, std::span<const Operand> operands,
                                const assemble::RegionLayout& domain, const assemble::Task& task = {},
                                bool filtersFloats = false);
/// The same, to a variant whose memory is used again.
void chooseVariant(const program::Kernel& kernel, std::span<const Operand> operands,
                   const assemble::RegionLayout& domain, const assemble::Task& task, bool filtersFloats,
                   assemble::Variant& variant);

}  // namespace sk
