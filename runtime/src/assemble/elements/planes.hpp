// SPDX-License-Identifier: MIT
//
// How the planes of an element are spelled in GLSL: samplers and outputs, fetching an element from
// its planes and storing it to them. It knows expressions only, nothing of addresses.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include "assemble/assemble.hpp"
#include "assemble/glsl/program_text.hpp"

namespace sk::assemble {

/// Whether an element, a struct or a matrix, is rebuilt part by part; else it is its only plane.
bool isStruct(const program::Element& element);

/// Where an element lies in its textures.
struct Texel {
  std::string at;           ///< an ivec2 expression; where packed, with elements instead of texels in x
  std::string shift = {};   ///< of layered textures, an int expression: log2 of the rows of a layer
  bool packed = false;
  bool filtered = false;    ///< the sampler that is bound interpolates: only texelFetch() gives texels
};

/// The texel as texelFetch() takes it: an ivec2 expression, or an ivec3 of a layered texture.
std::string place(ProgramText& program, const Texel& texel);

/// An expression for the texel at place() in a sampler of 2-D textures, or of array textures.
std::string texelIn(ProgramText& program, std::string_view sampler, const std::string& place, bool isArray);

/// The type of a sampler of 2-D textures ("isampler2D"), or of array textures.
std::string samplerType(std::string_view sampler, bool isArray);

/// Declares the samplers of the parameter's planes.
void declareSamplers(ProgramText& program, const program::Parameter& parameter, bool layered);

/// Declares the outputs of the parameter's planes.
void declareOutputs(ProgramText& program, const program::Parameter& parameter);

/// Those of the outputs that have some of `count` planes from number `first` on, of the planes of all, and say which. A count
/// of 0 is all of them.
std::vector<program::Parameter> withPlanes(const std::vector<const program::Parameter*>& outputs,
                                           std::size_t first, std::size_t count);

/// An expression for the element at a texel. Structs are fetched by a function, which the first such
/// expression of a parameter defines.
std::string fetch(ProgramText& program, const program::Parameter& parameter, const Texel& texel);

/// The element in component `component`, an int expression, of a packed texel, an expression of packedType().
std::string fetchedComponent(ProgramText& program, const program::Parameter& parameter,
                             std::string_view texel, std::string_view component);

/// The type of a packed texel as it is fetched: "vec4".
std::string packedType(const program::Parameter& parameter);

/// What a texel of a packed stream holds (RegionLayout::packed), as an element of its own: four of `scalar`.
const program::Element& fourOf(program::Scalar scalar);
/// A parameter of the packed texels of another.
program::Parameter fourOf(const program::Parameter& parameter);

/// An lvalue of the element's type to which main() may compute the parameter's new element: its
/// output itself where that has the same type, else a local variable that is declared here.
std::string resultVariable(ProgramText& program, const program::Parameter& parameter);

/// Declares the samplers and outputs of the parameter's planes, and copies the texels at `texel` from the one to
/// the other as they are.
void copyPlanes(ProgramText& program, const program::Parameter& parameter, const Texel& texel);

/// Statements that copy an element-typed variable to the parameter's outputs; none where the
/// variable is the output.
void store(ProgramText& program, const program::Parameter& parameter, std::string_view variable);

}  // namespace sk::assemble
