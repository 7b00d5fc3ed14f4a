// SPDX-License-Identifier: MIT
//
// Descriptors as skc would generate them, created on first use.
#include "gl_device/sort/sort_kernels.hpp"

#include <array>
#include <map>
#include <memory>
#include <mutex>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "gl_device/transfer/copy_kernel.hpp"
#include "sk/types.hpp"

namespace sk {

const program::Element& sortWords() { return ElementTraits<std::uint32_t>::element(); }
const program::Element& sortWordPairs() { return ElementTraits<uint2>::element(); }

namespace {

using program::Element;
using program::Kernel;
using program::Parameter;
using program::Role;

/// A kernel and what it refers to. Its entry is the only function `sort_kernel`.
struct SortKernel {
  std::string body;
  std::vector<Parameter> parameters;
  Kernel kernel;
};

Parameter input(std::string_view name, const Element& element) {
  return {.name = name, .symbol = name, .role = Role::Input, .element = &element};
}
Parameter output(std::string_view name, const Element& element) {
  return {.name = name, .symbol = name, .role = Role::Output, .element = &element};
}
Parameter gather(std::string_view name, const Element& element, int rank) {
  return {.name = name,
          .symbol = name,
          .role = Role::Gather,
          .element = &element,
          .rank = static_cast<std::uint8_t>(rank),
          .usesExtent = rank > 1,
          .usesAt = true};
}

/// The kernel with this body and these parameters.
const Kernel& kept(std::string&& body, std::vector<Parameter>&& parameters, bool usesIndex = false) {
  static std::mutex mutex;
  static std::map<std::string, std::unique_ptr<SortKernel>> kernels;  // by their bodies, which have all types
  const std::lock_guard lock(mutex);
  std::unique_ptr<SortKernel>& known = kernels[body];
  if (known) return known->kernel;
  known = std::make_unique<SortKernel>(SortKernel{std::move(body), std::move(parameters), {}});
  known->kernel.name = "sort";
  known->kernel.entry = "sort_kernel";
  known->kernel.body = known->body;
  known->kernel.parameters = known->parameters;
  known->kernel.usesIndex = usesIndex;
  return known->kernel;
}

/// The element of gather `x` at the place of pair `k`.
std::string elementAt(int rank) {
  return rank == 1 ? "sk_at_x(int(k.y))" : "sk_at_x(sort_index(int(k.y), sk_extent_x()))";
}
std::string_view indexFunction(int rank) {
  if (rank == 1) return "";
  return "ivec4 sort_index(int n, ivec4 e) {\n"
         "  int y = n / e.x, z = y / e.y, w = z / e.z;\n"
         "  return ivec4(n - y * e.x, y - z * e.y, z - w * e.z, w);\n"
         "}\n";
}

/// The element of a key or a flag; uint if there is none of this type.
const Element& elementOf(program::Scalar scalar) {
  switch (scalar) {
    case program::Scalar::Int: return ElementTraits<std::int32_t>::element();
    case program::Scalar::Float: return ElementTraits<float>::element();
    case program::Scalar::Bool: return ElementTraits<bool>::element();
    case program::Scalar::Uint:
    case program::Scalar::Double:
    case program::Scalar::Half:
    case program::Scalar::Char:
    case program::Scalar::Uchar:
    case program::Scalar::Short:
    case program::Scalar::Ushort:
    case program::Scalar::Unorm8:
    case program::Scalar::Snorm8:
    case program::Scalar::Unorm16:
    case program::Scalar::Snorm16: break;
  }
  return sortWords();
}

}  // namespace

const Kernel& wordKernel(program::Scalar keys, bool isDescending) {
  const std::string_view inverted = isDescending ? "~" : "";
  if (hasTwoWords(keys)) {
    return kept(fmt::format("void sort_kernel(uvec2 k, out uint lower, out uint upper) {{\n"
                            "  uint m = k.y & 0x7fffffffu;\n"
                            "  if ((m | k.x) == 0u) k = uvec2(0u);\n"
                            "  bool isNan = m > 0x7ff00000u || (m == 0x7ff00000u && k.x != 0u);\n"
                            "  uvec2 r = (k.y >> 31) != 0u ? ~k : uvec2(k.x, k.y | 0x80000000u);\n"
                            "  lower = isNan ? 0xffffffffu : {0}r.x;\n"
                            "  upper = isNan ? 0xffffffffu : {0}r.y;\n"
                            "}}\n",
                            inverted),
                {input("k", sortWordPairs()), output("lower", sortWords()), output("upper", sortWords())});
  }
  const Element& element = elementOf(keys);
  if (keys == program::Scalar::Float) {
    return kept(fmt::format("void sort_kernel(float k, out uint r) {{\n"
                            "  uint b = floatBitsToUint(k), m = b & 0x7fffffffu;\n"
                            "  if (m == 0u) b = 0u;\n"
                            "  b = (b >> 31) != 0u ? ~b : b | 0x80000000u;\n"
                            "  r = m > 0x7f800000u ? 0xffffffffu : {}b;\n"
                            "}}\n",
                            inverted),
                {input("k", element), output("r", sortWords())});
  }
  return kept(fmt::format("void sort_kernel({} k, out uint r) {{ r = {}(uint(k){}); }}\n", element.glsl,
                          inverted, keys == program::Scalar::Int ? " ^ 0x80000000u" : ""),
              {input("k", element), output("r", sortWords())});
}

const Kernel& repeatKernel(program::Scalar keys) {
  const bool isFloating = keys == program::Scalar::Float || keys == program::Scalar::Double;
  const std::string_view isNumber = isFloating ? " && k != 0xffffffffu" : "";
  if (!hasTwoWords(keys)) {
    return kept(fmt::format("void sort_kernel(uint k, out uint r) {{\n"
                            "  int n = sk_index().x;\n"
                            "  r = n > 0 && sk_at_x(n - 1) == k{} ? 1u : 0u;\n"
                            "}}\n",
                            isNumber),
                {input("k", sortWords()), gather("x", sortWords(), 1), output("r", sortWords())}, true);
  }
  return kept(
      "void sort_kernel(uint k, uint l, out uint r) {\n"
      "  int n = sk_index().x;\n"
      "  bool isNan = (k & l) == 0xffffffffu;\n"
      "  r = n > 0 && sk_at_x(n - 1) == k && sk_at_y(n - 1) == l && !isNan ? 1u : 0u;\n"
      "}\n",
      {input("k", sortWords()), gather("x", sortWords(), 1), input("l", sortWords()),
       gather("y", sortWords(), 1), output("r", sortWords())},
      true);
}

const Kernel& flagKernel(program::Scalar flags) {
  const Element& element = elementOf(flags);
  return kept(
      fmt::format("void sort_kernel({0} k, out uint r) {{ r = k == {0}(0) ? 1u : 0u; }}\n", element.glsl),
      {input("k", element), output("r", sortWords())});
}

const Kernel& moveKernel(const program::Field& field, int rank) {
  const Element& element = *copyKernel(field).parameters[0].element;
  return kept(fmt::format("// {}\n{}void sort_kernel(uvec2 k, out {} r) {{ r = {}; }}\n", element.name,
                          indexFunction(rank), element.glsl, elementAt(rank)),
              {input("k", sortWordPairs()), gather("x", element, rank), output("r", element)});
}

const Kernel& upperWordKernel() {
  return kept("void sort_kernel(uvec2 k, out uvec2 r) { r = uvec2(sk_at_x(int(k.y)), k.y); }\n",
              {input("k", sortWordPairs()), gather("x", sortWords(), 1), output("r", sortWordPairs())});
}

const Kernel& restoreKernel(program::Scalar keys, bool isDescending, bool fromPairs, int rank) {
  const Element& element = elementOf(keys);
  const std::string_view inverted = isDescending ? "~" : "";
  if (keys != program::Scalar::Float) {
    const Element& from = fromPairs ? sortWordPairs() : sortWords();
    return kept(fmt::format("void sort_kernel({0} k, out {1} r) {{ r = {1}({2}k{3}{4}); }}\n", from.glsl,
                            element.glsl, inverted, fromPairs ? ".x" : "",
                            keys == program::Scalar::Int ? " ^ 0x80000000u" : ""),
                {input("k", from), output("r", element)});
  }
  return kept(fmt::format("{}void sort_kernel(uvec2 k, out float r) {{\n"
                          "  uint b = {}k.x;\n"
                          "  b = (b >> 31) != 0u ? b & 0x7fffffffu : ~b;\n"
                          "  r = k.x == 0xffffffffu || b == 0u ? {} : uintBitsToFloat(b);\n"
                          "}}\n",
                          indexFunction(rank), inverted, elementAt(rank)),
              {input("k", sortWordPairs()), gather("x", element, rank), output("r", element)});
}

const Kernel& lastWordKernel(const Element& words) {
  return kept(fmt::format("void sort_kernel(out {0} r) {{ r = {0}(0xffffffffu); }}\n", words.glsl),
              {output("r", words)});
}

const Kernel& placeKernel() {
  return kept("void sort_kernel(uvec2 k, out int r) { r = int(k.y); }\n",
              {input("k", sortWordPairs()), output("r", elementOf(program::Scalar::Int))});
}

}  // namespace sk
