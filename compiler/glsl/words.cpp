// SPDX-License-Identifier: MIT
#include "glsl/words.hpp"

#include <algorithm>
#include <cstdint>
#include <iterator>

#include <fmt/format.h>

namespace skc::emit {
namespace {

// clang-format off: as many on a line as fit

constexpr std::string_view words[] = {
    "active", "asm", "atomic_uint", "attribute", "bool", "break", "buffer", "bvec2", "bvec3", "bvec4",
    "case", "cast", "centroid", "class", "coherent", "common", "const", "continue", "default", "discard",
    "dmat2", "dmat2x2", "dmat2x3", "dmat2x4", "dmat3", "dmat3x2", "dmat3x3", "dmat3x4", "dmat4", "dmat4x2",
    "dmat4x3", "dmat4x4", "do", "double", "dvec2", "dvec3", "dvec4", "else", "enum", "extern", "external",
    "false", "filter", "fixed", "flat", "float", "for", "fvec2", "fvec3", "fvec4", "goto", "half", "highp",
    "hvec2", "hvec3", "hvec4", "if", "iimage1D", "iimage1DArray", "iimage2D", "iimage2DArray", "iimage2DMS",
    "iimage2DMSArray", "iimage2DRect", "iimage3D", "iimageBuffer", "iimageCube", "iimageCubeArray",
    "image1D", "image1DArray", "image1DArrayShadow", "image1DShadow", "image2D", "image2DArray",
    "image2DArrayShadow", "image2DMS", "image2DMSArray", "image2DRect", "image2DShadow", "image3D",
    "imageBuffer", "imageCube", "imageCubeArray", "in", "inline", "inout", "input", "int", "interface",
    "invariant", "isampler1D", "isampler1DArray", "isampler2D", "isampler2DArray", "isampler2DMS",
    "isampler2DMSArray", "isampler2DRect", "isampler3D", "isamplerBuffer", "isamplerCube",
    "isamplerCubeArray", "isubpassInput", "isubpassInputMS", "itexture1D", "itexture1DArray", "itexture2D",
    "itexture2DArray", "itexture2DMS", "itexture2DMSArray", "itexture2DRect", "itexture3D",
    "itextureBuffer", "itextureCube", "itextureCubeArray", "ivec2", "ivec3", "ivec4", "layout", "long",
    "lowp", "main", "mat2", "mat2x2", "mat2x3", "mat2x4", "mat3", "mat3x2", "mat3x3", "mat3x4", "mat4",
    "mat4x2", "mat4x3", "mat4x4", "mediump", "namespace", "noinline", "noperspective", "out", "output",
    "packed", "partition", "patch", "precise", "precision", "public", "readonly", "resource", "restrict",
    "return", "row_major", "sample", "sampler", "sampler1D", "sampler1DArray", "sampler1DArrayShadow",
    "sampler1DShadow", "sampler2D", "sampler2DArray", "sampler2DArrayShadow", "sampler2DMS",
    "sampler2DMSArray", "sampler2DRect", "sampler2DRectShadow", "sampler2DShadow", "sampler3D",
    "sampler3DRect", "samplerBuffer", "samplerCube", "samplerCubeArray", "samplerCubeArrayShadow",
    "samplerCubeShadow", "samplerShadow", "shared", "short", "sizeof", "smooth", "static", "struct",
    "subpassInput", "subpassInputMS", "subroutine", "superp", "switch", "template", "texture1D",
    "texture1DArray", "texture2D", "texture2DArray", "texture2DMS", "texture2DMSArray", "texture2DRect",
    "texture3D", "textureBuffer", "textureCube", "textureCubeArray", "this", "true", "typedef", "uimage1D",
    "uimage1DArray", "uimage2D", "uimage2DArray", "uimage2DMS", "uimage2DMSArray", "uimage2DRect",
    "uimage3D", "uimageBuffer", "uimageCube", "uimageCubeArray", "uint", "uniform", "union", "unsigned",
    "usampler1D", "usampler1DArray", "usampler2D", "usampler2DArray", "usampler2DMS", "usampler2DMSArray",
    "usampler2DRect", "usampler3D", "usamplerBuffer", "usamplerCube", "usamplerCubeArray", "using",
    "usubpassInput", "usubpassInputMS", "utexture1D", "utexture1DArray", "utexture2D", "utexture2DArray",
    "utexture2DMS", "utexture2DMSArray", "utexture2DRect", "utexture3D", "utextureBuffer", "utextureCube",
    "utextureCubeArray", "uvec2", "uvec3", "uvec4", "varying", "vec2", "vec3", "vec4", "void", "volatile",
    "while", "writeonly"};

// `average` and the like belong to GL_INTEL_shader_integer_functions2: glslang rejects them in ESSL 3.00 even
// if the extension is off.
constexpr std::string_view functions[] = {
    "EmitStreamVertex", "EmitVertex", "EndPrimitive", "EndStreamPrimitive", "abs", "absoluteDifference",
    "acos", "acosh", "addSaturate", "all", "allInvocations", "allInvocationsEqual", "any", "anyInvocation",
    "asin", "asinh", "atan", "atanh", "atomicAdd", "atomicAnd", "atomicCompSwap", "atomicCounter",
    "atomicCounterAdd", "atomicCounterAnd", "atomicCounterCompSwap", "atomicCounterDecrement",
    "atomicCounterExchange", "atomicCounterIncrement", "atomicCounterMax", "atomicCounterMin",
    "atomicCounterOr", "atomicCounterSubtract", "atomicCounterXor", "atomicExchange", "atomicMax",
    "atomicMin", "atomicOr", "atomicXor", "average", "averageRounded", "barrier", "bitCount",
    "bitfieldExtract", "bitfieldInsert", "bitfieldReverse", "ceil", "clamp", "controlBarrier", "cos",
    "cosh", "countLeadingZeros", "countTrailingZeros", "cross", "dFdx", "dFdxCoarse", "dFdxFine", "dFdy",
    "dFdyCoarse", "dFdyFine", "degrees", "determinant", "distance", "dot", "equal", "exp", "exp2",
    "faceforward", "findLSB", "findMSB", "floatBitsToInt", "floatBitsToUint", "floor", "fma", "fract",
    "frexp", "ftransform", "fwidth", "fwidthCoarse", "fwidthFine", "greaterThan", "greaterThanEqual",
    "groupMemoryBarrier", "imageAtomicAdd", "imageAtomicAnd", "imageAtomicCompSwap", "imageAtomicExchange",
    "imageAtomicMax", "imageAtomicMin", "imageAtomicOr", "imageAtomicXor", "imageLoad", "imageSamples",
    "imageSize", "imageStore", "imulExtended", "intBitsToFloat", "interpolateAtCentroid",
    "interpolateAtOffset", "interpolateAtSample", "inverse", "inversesqrt", "isinf", "isnan", "ldexp",
    "length", "lessThan", "lessThanEqual", "log", "log2", "matrixCompMult", "max", "memoryBarrier",
    "memoryBarrierAtomicCounter", "memoryBarrierBuffer", "memoryBarrierImage", "memoryBarrierShared", "min",
    "mix", "mod", "modf", "multiply32x16", "noise1", "noise2", "noise3", "noise4", "normalize", "not",
    "notEqual", "outerProduct", "packDouble2x32", "packHalf2x16", "packSnorm2x16", "packSnorm4x8",
    "packUnorm2x16", "packUnorm4x8", "pow", "radians", "reflect", "refract", "round", "roundEven",
    "shadow1D", "shadow1DLod", "shadow1DProj", "shadow1DProjLod", "shadow2D", "shadow2DLod", "shadow2DProj",
    "shadow2DProjLod", "sign", "sin", "sinh", "smoothstep", "sqrt", "step", "subpassLoad",
    "subtractSaturate", "tan", "tanh", "texelFetch", "texelFetchOffset", "texture", "texture1DLod",
    "texture1DProj", "texture1DProjLod", "texture2DLod", "texture2DProj", "texture2DProjLod",
    "texture3DLod", "texture3DProj", "texture3DProjLod", "textureCubeLod", "textureGather",
    "textureGatherOffset", "textureGatherOffsets", "textureGrad", "textureGradOffset", "textureLod",
    "textureLodOffset", "textureOffset", "textureProj", "textureProjGrad", "textureProjGradOffset",
    "textureProjLod", "textureProjLodOffset", "textureProjOffset", "textureQueryLevels", "textureQueryLod",
    "textureSamples", "textureSize", "transpose", "trunc", "uaddCarry", "uintBitsToFloat", "umulExtended",
    "unpackDouble2x32", "unpackHalf2x16", "unpackSnorm2x16", "unpackSnorm4x8", "unpackUnorm2x16",
    "unpackUnorm4x8", "usubBorrow"};

// clang-format on

static_assert(std::ranges::is_sorted(words) && std::ranges::is_sorted(functions), "for binary search");

bool isLetterOrDigit(char c) {
  return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_';
}

/// The code point that starts at `name[i]` (UTF-8); moves `i` to its last byte.
std::uint32_t codePoint(std::string_view name, std::size_t& i) {
  const auto lead = static_cast<unsigned char>(name[i]);
  const int more = lead >= 0xf0 ? 3 : lead >= 0xe0 ? 2 : lead >= 0xc0 ? 1 : 0;
  std::uint32_t point = lead & (more == 0 ? 0x7fU : 0x3fU >> more);
  for (int k = 0; k < more && i + 1 < name.size(); ++k) {
    point = point << 6 | (static_cast<unsigned char>(name[++i]) & 0x3fU);
  }
  return point;
}

}  // namespace

bool isGlslWord(std::string_view name) {
  return std::binary_search(std::begin(words), std::end(words), name);
}

bool isGlslFunction(std::string_view name) {
  return std::binary_search(std::begin(functions), std::end(functions), name);
}

std::string glslSafe(std::string_view name) {
  std::string safe;
  for (std::size_t i = 0; i < name.size(); ++i) {
    const char c = name[i];
    if (c == '_' && !safe.empty() && safe.back() == '_') continue;   // `__` is reserved everywhere
    if (isLetterOrDigit(c)) {
      safe += c;
    } else {
      safe += fmt::format("u{:04x}", codePoint(name, i));
    }
  }
  const std::string_view start = std::string_view(safe).substr(0, 3);
  if (start == "sk_" || start == "gl_" || start == "GL_") safe = "user_" + safe;
  if (isGlslWord(safe)) safe += '_';
  return safe;
}

std::string glslSafeGlobal(std::string_view name) {
  std::string safe = glslSafe(name);
  if (isGlslFunction(safe)) safe += '_';
  return safe;
}

}  // namespace skc::emit
