// SPDX-License-Identifier: MIT
#include "assemble/elements/tile_gather.hpp"

#include <cassert>
#include <vector>

#include <fmt/format.h>

#include "assemble/elements/planes.hpp"
#include "assemble/elements/texel_window.hpp"

namespace sk::assemble {
namespace {

using program::Boundary;
using program::Parameter;

class TileGatherText {
 public:
  TileGatherText(ProgramText& program, DomainText& domain, const Parameter& gather, const TileArray& array)
      : program_(program), domain_(domain), gather_(gather), array_(array), window_(gather) {
    assert(gather.rank == 2);
  }

  /// An element at any index that lies in the tile after its boundary mode has brought it inside.
  void defineAt() {
    const std::string shape = program_.uniform("ivec4", "sk_domain_shape") + ".xy";
    std::vector<std::string> lines;
    switch (gather_.boundary) {
      case Boundary::Clamp:
        lines.push_back(fmt::format("ivec2 sk_p = clamp(sk_i, ivec2(0), {} - 1);", shape));
        break;
      case Boundary::Mirror:
        program_.require(Function::Mirror);
        lines.push_back(fmt::format("ivec2 sk_n = {};", shape));
        lines.emplace_back("ivec2 sk_p = ivec2(sk_mirror(0, sk_i.x, sk_n.x), sk_mirror(0, sk_i.y, sk_n.y));");
        break;
      case Boundary::Border:
        lines.push_back(fmt::format("if (any(greaterThanEqual(uvec2(sk_i), uvec2({})))) return {};", shape,
                                    gather_.border));
        lines.emplace_back("ivec2 sk_p = sk_i;");
        break;
      case Boundary::Wrap: lines.emplace_back("ivec2 sk_p = sk_i;"); break;
    }
    lines.emplace_back("sk_p -= sk_origin * ivec2(4, 1);");
    if (gather_.boundary == Boundary::Wrap) {  // the tile has at most one period
      program_.require(Function::Wrap);
      lines.push_back(fmt::format("ivec2 sk_n = {};", shape));
      lines.emplace_back("sk_p = ivec2(sk_wrap(0, sk_p.x, sk_n.x), sk_wrap(0, sk_p.y, sk_n.y));");
    }
    lines.push_back(
        fmt::format("sk_p = clamp(sk_p, ivec2(0), ivec2({}, {}));", lanes * columns() - 1, rows() - 1));
    lines.push_back(fmt::format(
        "return {};", fetchedComponent(program_, gather_, texel("sk_p.y", "sk_p.x >> 2"), "sk_p.x & 3")));
    program_.function(fmt::format("{} sk_at_{}(ivec2 sk_i)", gather_.element->glsl, gather_.symbol), lines);
  }

  void defineNear() {
    defineTexel();
    for (int y = -window_.reachInY(); y <= window_.reachInY(); ++y) {
      for (int x = -window_.reachInX(); x <= window_.reachInX(); ++x)
        program_.variable(packedType(gather_), window_.texelName(x, y));
    }
    std::vector<std::string> lines = {
        fmt::format("int sk_x = {} + sk_d.x, sk_c = sk_x >> 2;", domain_.lane())};
    if (gather_.boundary == Boundary::Border) {
      const std::string shape = program_.uniform("ivec4", "sk_domain_shape");
      lines.push_back(fmt::format("ivec2 sk_n = ivec2({0}.x >> 2, {0}.y), sk_p = {1} + ivec2(sk_c, sk_d.y);",
                                  shape, program_.texel()));
      lines.push_back(
          fmt::format("if (any(greaterThanEqual(uvec2(sk_p), uvec2(sk_n)))) return {};", gather_.border));
    }
    window_.chooseTexel(packedType(gather_), lines);
    lines.push_back(fmt::format("return {};", fetchedComponent(program_, gather_, "sk_v", "sk_x & 3")));
    program_.function(fmt::format("{} sk_near_{}(ivec2 sk_d)", gather_.element->glsl, gather_.symbol), lines);
  }

 private:
  int columns() const { return array_.texels[0]; }
  int rows() const { return array_.texels[1]; }
  std::string texel(std::string_view row, std::string_view column) const { return array_.texel(row, column); }

  /// The texel at an offset from the invocation's, which is inside of the stream unless that is periodic.
  void defineTexel() {
    std::vector<std::string> lines = {"ivec2 sk_p = sk_spot + sk_d;"};
    const bool isPlain = gather_.boundary == Boundary::Clamp && array_.isExtended;
    switch (isPlain ? Boundary::Wrap : gather_.boundary) {
      case Boundary::Wrap:
        lines.push_back(
            fmt::format("sk_p = clamp(sk_p, ivec2(0), ivec2({}, {}));", columns() - 1, rows() - 1));
        lines.push_back(fmt::format("return {};", texel("sk_p.y", "sk_p.x")));
        break;
      case Boundary::Border:
        lines.emplace_back("sk_p = clamp(sk_p, sk_low, sk_high);");
        lines.push_back(fmt::format("return {};", texel("sk_p.y", "sk_p.x")));
        break;
      case Boundary::Clamp:
        lines.emplace_back("int sk_x = sk_p.x;");
        lines.emplace_back("sk_p.y = clamp(sk_p.y, sk_low.y, sk_high.y);");
        lines.push_back(fmt::format("if (sk_d.x == 0) return {};", texel("sk_p.y", "sk_spot.x")));
        lines.emplace_back("sk_p.x = clamp(sk_x, sk_low.x, sk_high.x);");
        lines.push_back(fmt::format("{} sk_v = {};", packedType(gather_), texel("sk_p.y", "sk_p.x")));
        lines.emplace_back("return sk_x == sk_p.x ? sk_v : sk_x < sk_p.x ? sk_v.xxxx : sk_v.wwww;");
        break;
      case Boundary::Mirror:
        lines.emplace_back("bool sk_out = sk_p.x < sk_low.x || sk_p.x > sk_high.x;");
        for (const char axis : {'x', 'y'}) {
          lines.push_back(
              fmt::format("sk_p.{0} = sk_p.{0} < sk_low.{0} ? 2 * sk_low.{0} - 1 - sk_p.{0} : sk_p.{0} > "
                          "sk_high.{0} ? 2 * sk_high.{0} + 1 - sk_p.{0} : sk_p.{0};",
                          axis));
        }
        lines.emplace_back("sk_p = clamp(sk_p, sk_low, sk_high);");
        lines.push_back(fmt::format("{} sk_v = {};", packedType(gather_), texel("sk_p.y", "sk_p.x")));
        lines.emplace_back("return sk_out ? sk_v.wzyx : sk_v;");
        break;
    }
    program_.function(fmt::format("{} sk_texel_at_{}(ivec2 sk_d)", packedType(gather_), gather_.symbol),
                      lines);
  }

  ProgramText& program_;
  DomainText& domain_;
  const Parameter& gather_;
  const TileArray& array_;
  const TexelWindow window_;
};

}  // namespace

void TileArray::declare(ProgramText& program) const {
  program.variable(fmt::format("shared {}", type), fmt::format("{}[{}][{}]", name, texels[1], texels[0]));
}

std::string TileArray::texel(std::string_view row, std::string_view column) const {
  return fmt::format("{}[{}][{}]", name, row, column);
}

void defineTileGather(ProgramText& program, DomainText& domain, const Parameter& gather,
                      const TileArray& array) {
  TileGatherText text(program, domain, gather, array);
  if (gather.usesAt) text.defineAt();
  if (gather.usesNear) text.defineNear();
}

}  // namespace sk::assemble
