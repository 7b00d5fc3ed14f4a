// SPDX-License-Identifier: MIT
//
// GLSL for an element's planes: samplers and outputs, fetching an element from its planes and storing it.
// Deals only with expressions, not with addresses.
//
// Streams whose planes hold floats in another precision than the kernel declares (sk::Storage): their
// elements, and the kernels that read and write them.
#pragma once

#include <cstddef>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "assemble/assemble.hpp"
#include "assemble/glsl/program_text.hpp"
#include "sk/program.hpp"

namespace sk::assemble {

/// A stream's element, with halves or doubles instead of floats: the same order in host memory, without gaps.
/// Not movable, because `element` refers to `fields`.
struct HeldElement {
  HeldElement(const program::Element& declared, Storage storage);
  HeldElement(const HeldElement&) = delete;
  HeldElement& operator=(const HeldElement&) = delete;

  std::vector<program::Field> fields;
  program::Element element;
};

/// Whether an element has floats, which a stream may store differently.
bool holdsFloats(const program::Element& element);

/// A kernel for streams with the storage in `access`, one entry per parameter; the kernel itself if that is
/// as declared.
class HeldKernel {
 public:
  HeldKernel(const program::Kernel& kernel, std::span<const StreamAccess> access);
  HeldKernel(const HeldKernel&) = delete;
  HeldKernel& operator=(const HeldKernel&) = delete;

  const program::Kernel& kernel() const { return kernel_; }

 private:
  program::Kernel kernel_;
  std::vector<program::Parameter> parameters_;
  std::vector<std::unique_ptr<HeldElement>> elements_;
};

/// Whether an element, a struct or a matrix, is assembled from parts; otherwise it is a single plane.
bool isStruct(const program::Element& element);

/// The location of an element in its textures.
struct Texel {
  std::string at;  ///< an ivec2 expression; if packed, x counts elements instead of texels
  std::string shift = {};  ///< in layered textures, an int expression: log2 of the rows of a layer
  bool packed = false;
  bool filtered = false;  ///< the bound sampler interpolates: only texelFetch() returns texels
};

/// The texel as an argument of texelFetch(): an ivec2 expression, or an ivec3 for a layered texture.
std::string place(ProgramText& program, const Texel& texel);

/// An expression that fetches the texel at place() from a sampler of 2-D textures or array textures.
std::string texelIn(ProgramText& program, std::string_view sampler, const std::string& place, bool isArray);

/// The type of a sampler of 2-D textures ("isampler2D") or array textures.
std::string samplerType(std::string_view sampler, bool isArray);

/// Declares the samplers of the parameter's planes.
void declareSamplers(ProgramText& program, const program::Parameter& parameter, bool layered);

/// Declares the outputs of the parameter's planes.
void declareOutputs(ProgramText& program, const program::Parameter& parameter);

/// Returns the outputs that own any of the `count` planes from number `first` on, counted over all outputs,
/// with these planes selected. A count of 0 selects all planes.
std::vector<program::Parameter> withPlanes(const std::vector<const program::Parameter*>& outputs,
                                           std::size_t first, std::size_t count);

/// An expression for the element at a texel. Structs are fetched by a function, which the first such
/// expression of a parameter defines.
std::string fetch(ProgramText& program, const program::Parameter& parameter, const Texel& texel);

/// Component `component`, an int expression, of a packed texel, an expression of packedType().
std::string fetchedComponent(ProgramText& program, const program::Parameter& parameter,
                             std::string_view texel, std::string_view component);

/// The type of a fetched packed texel: "vec4".
std::string packedType(const program::Parameter& parameter);

/// The contents of a packed stream's texel (RegionLayout::packed) as an element: four of `scalar`.
const program::Element& fourOf(program::Scalar scalar);
/// A parameter for the packed texels of another.
program::Parameter fourOf(const program::Parameter& parameter);

/// An lvalue of the element's type for the parameter's new element: its output if that has the same type,
/// else a local variable that this declares.
std::string resultVariable(ProgramText& program, const program::Parameter& parameter);

/// Declares samplers and outputs for the parameter's planes, and copies the texels at `texel` unchanged.
void copyPlanes(ProgramText& program, const program::Parameter& parameter, const Texel& texel);

/// Adds statements that copy a variable of the element's type to the parameter's outputs, unless it is the
/// output.
void store(ProgramText& program, const program::Parameter& parameter, std::string_view variable,
           std::string_view indent = "");

}  // namespace sk::assemble
