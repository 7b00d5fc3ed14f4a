// SPDX-License-Identifier: MIT
//
// Generates sk_at_p, sk_near_p and sk_sample_p. An index that the body computes may be any int; the current
// index is not negative, and like every extent it is at most sk::mostExtent.
#include "assemble/elements/gather.hpp"

#include <algorithm>
#include <array>
#include <cassert>
#include <span>

#include <fmt/format.h>

#include "assemble/elements/arguments.hpp"
#include "assemble/elements/planes.hpp"
#include "assemble/elements/texel_window.hpp"

namespace sk::assemble {
namespace {

using program::Boundary;
using program::Parameter;

constexpr std::int32_t largestSafeReach = 1 << 30;

bool isLayered(const StreamAccess& access) { return access.addressing == Addressing::Layered; }

class GatherText {
 public:
  GatherText(ProgramText& program, const Position& here, const Parameter& parameter,
             const StreamAccess& access)
      : program_(program),
        here_(here),
        parameter_(parameter),
        access_(access),
        rank_(parameter.rank),
        window_(parameter) {
    assert(rank_ >= 1 && rank_ <= 4 && access.addressing != Addressing::Aligned);
  }

  void defineAt() {
    std::vector<std::string> lines;
    bringInside(lines);
    if (access_.placed) keepHeld(lines);
    finish(fmt::format("{} sk_at_{}({} sk_i)", parameter_.element->glsl, parameter_.symbol, vector()), lines);
  }

  /// Interpolates neighbours pair by pair, x first. Floats from 2^24 on are integers, so that weights are
  /// numbers unless the position is NaN.
  void defineSample() {
    if (holdsDoubles()) return defineSampleOfDoubles();
    const std::string floats = rank_ == 1 ? "float" : fmt::format("vec{}", rank_);
    const std::string weights =
        rank_ == 1
            ? "abs(sk_x) >= 16777216.0 ? 0.0 : sk_x - sk_f"
            : fmt::format("mix(sk_x - sk_f, {0}(0.0), greaterThanEqual(abs(sk_x), {0}(16777216.0)))", floats);
    defineLerp();
    program_.function(
        fmt::format("{} sk_sample_{}({} sk_x)", parameter_.element->glsl, parameter_.symbol, floats),
        {fmt::format("{} sk_f = floor(sk_x);", floats), fmt::format("{} sk_t = {};", floats, weights),
         fmt::format("{0} sk_i = {0}(clamp(sk_f, -2147483648.0, 2147483520.0));", vector()),
         fmt::format("return {};", weighted(rank_, {}))});
  }

  /// Like defineSample, in doubles.
  void defineSampleOfDoubles() {
    const std::string place = rank_ == 1 ? "sk_double" : fmt::format("sk_double{}", rank_);
    std::vector<std::string> lines, wholes;
    for (int d = 0; d < rank_; ++d) {
      const std::string x = rank_ == 1 ? "sk_x" : fmt::format("sk_x.{}", "xyzw"[d]);
      lines.push_back(
          fmt::format("sk_double sk_f{0} = sk_floor({1}), sk_t{0} = sk_sub({1}, sk_f{0});", d, x));
      lines.push_back(fmt::format(
          "if (sk_less_equal(sk_to_double(16777216.0), sk_abs({1}))) sk_t{0} = sk_to_double(0.0);", d, x));
      wholes.push_back(fmt::format("min(sk_to_int(sk_f{}), 2147483520)", d));
    }
    lines.push_back(fmt::format("{0} sk_i = {0}({1});", vector(), fmt::join(wholes, ", ")));
    lines.push_back(fmt::format("return {};", weighted(rank_, {})));
    defineLerpOfDoubles();
    program_.function(
        fmt::format("{} sk_sample_{}({} sk_x)", parameter_.element->glsl, parameter_.symbol, place), lines);
  }

  /// Uses the device's filter, with the boundary mode in the sampler.
  void defineFiltered() {
    static constexpr std::array<std::string_view, 4> swizzles = {".x", ".xy", ".xyz", ""};
    const std::string place = rank_ == 1 ? fmt::format("vec2((sk_x + 0.5) / float({}), 0.5)", shape())
                                         : fmt::format("(sk_x + 0.5) / vec2({})", shape());
    program_.function(fmt::format("{} sk_sample_{}({} sk_x)", parameter_.element->glsl, parameter_.symbol,
                                  rank_ == 1 ? "float" : "vec2"),
                      {fmt::format("return textureLod({}, {}, 0.0){};", samplerName(parameter_, 0), place,
                                   swizzles[parameter_.element->fields.front().width - 1u])});
  }

  /// A neighbour in the current element's texel, or one above or below it, has no boundary in x. What depends
  /// only on the offset is a constant for the driver's compiler. main() fetches each texel in reach once for
  /// all four elements; compilers remove unused ones.
  void defineNearByTexels(DomainText& domain) {
    const bool isRow = rank_ == 1;
    const std::string extents = isRow
                                    ? fmt::format("int sk_n = {}.x >> 2;", uniform("shape"))
                                    : fmt::format("ivec2 sk_n = ivec2({0}.x >> 2, {0}.y);", uniform("shape"));
    const std::string here = texelHere(domain);
    const std::string p = isRow ? "sk_p" : "sk_p.x";
    const std::string n = isRow ? "sk_n" : "sk_n.x";
    defineTexels(extents, here);
    std::vector<std::string> lines = {
        fmt::format("int sk_x = {} + {}, sk_c = sk_x >> 2;", domain.lane(), isRow ? "sk_d" : "sk_d.x")};
    if (parameter_.boundary == Boundary::Border) {
      lines.push_back(extents);
      lines.push_back(isRow ? fmt::format("int sk_p = {} + sk_c;", here)
                            : fmt::format("ivec2 sk_p = {} + ivec2(sk_c, sk_d.y);", here));
      lines.push_back(fmt::format("bool sk_out = sk_c != 0 && uint({}) >= uint({});", p, n));
      if (!isRow) lines.emplace_back("sk_out = sk_out || (sk_d.y != 0 && uint(sk_p.y) >= uint(sk_n.y));");
      lines.push_back(fmt::format("if (sk_out) return {};", parameter_.border));
    }
    window_.chooseTexel(packedType(parameter_), lines);
    lines.push_back(fmt::format("return {};", fetchedComponent(program_, parameter_, "sk_v", "sk_x & 3")));
    program_.function(
        fmt::format("{} sk_near_{}({} sk_d)", parameter_.element->glsl, parameter_.symbol, vector()), lines);
  }

  void defineNear() {
    std::vector<std::string> lines;
    bringNeighbourInside(lines);
    if (access_.placed) keepHeld(lines);
    finish(fmt::format("{} sk_near_{}({} sk_d)", parameter_.element->glsl, parameter_.symbol, vector()),
           lines);
  }

 private:
  std::string vector() const { return rank_ == 1 ? "int" : fmt::format("ivec{}", rank_); }
  std::string zero() const { return rank_ == 1 ? "0" : fmt::format("ivec{}(0)", rank_); }

  std::string_view swizzle() const {
    static constexpr std::array<std::string_view, 4> swizzles = {".x", ".xy", ".xyz", ""};
    return swizzles[static_cast<std::size_t>(rank_ - 1)];
  }
  std::string uniform(std::string_view kind) {
    return program_.uniform("ivec4", fmt::format("sk_{}_{}", kind, parameter_.symbol));
  }
  std::string shape() { return fmt::format("{}{}", uniform("shape"), swizzle()); }

  /// Ignores a neighbour of weight 0, whatever its value.
  void defineLerp() {
    const std::string signature =
        fmt::format("{0} sk_lerp({0} sk_a, {0} sk_b, float sk_t)", parameter_.element->glsl);
    if (program_.isDefined(signature)) return;
    program_.function(signature, {"if (sk_t <= 0.0) return sk_a;", "if (sk_t >= 1.0) return sk_b;",
                                  "return sk_a * (1.0 - sk_t) + sk_b * sk_t;"});
  }

  void defineLerpOfDoubles() {
    program_.function(
        "sk_double sk_lerp(sk_double sk_a, sk_double sk_b, sk_double sk_t)",
        {"sk_double sk_one = sk_to_double(1.0);", "if (sk_less_equal(sk_t, sk_to_double(0.0))) return sk_a;",
         "if (sk_less_equal(sk_one, sk_t)) return sk_b;",
         "return sk_add(sk_mul(sk_a, sk_sub(sk_one, sk_t)), sk_mul(sk_b, sk_t));"});
    const std::string_view type = parameter_.element->glsl;
    std::vector<std::string> components;
    for (const program::Field& field : parameter_.element->fields) {
      for (int c = 0; c < field.width; ++c) {
        components.push_back(fmt::format("sk_lerp(sk_a.{0}, sk_b.{0}, sk_t)", "xyzw"[components.size()]));
      }
    }
    if (components.size() == 1) return;
    program_.function(fmt::format("{0} sk_lerp({0} sk_a, {0} sk_b, sk_double sk_t)", type),
                      {fmt::format("return {}({});", type, fmt::join(components, ", "))});
  }

  bool holdsDoubles() const { return parameter_.element->fields.front().scalar == program::Scalar::Double; }

  /// The weight along a dimension.
  std::string weight(std::size_t dimension) const {
    if (holdsDoubles()) return fmt::format("sk_t{}", dimension);
    return rank_ == 1 ? "sk_t" : fmt::format("sk_t.{}", "xyzw"[dimension]);
  }

  /// The interpolation in the first `dimensions`, at offset `ahead` (0 or 1) from sk_i in each of the others.
  std::string weighted(int dimensions, std::array<int, 4> ahead) const {
    if (dimensions == 0) return fmt::format("sk_at_{}({})", parameter_.symbol, stepped(ahead));
    const auto last = static_cast<std::size_t>(dimensions - 1);
    const std::string low = weighted(dimensions - 1, ahead);
    ahead[last] = 1;
    return fmt::format("sk_lerp({}, {}, {})", low, weighted(dimensions - 1, ahead), weight(last));
  }

  /// For example "sk_i + ivec2(1, 0)".
  std::string stepped(const std::array<int, 4>& ahead) const {
    const std::span steps(ahead.data(), static_cast<std::size_t>(rank_));
    if (std::count(steps.begin(), steps.end(), 0) == rank_) return "sk_i";
    return rank_ == 1 ? "sk_i + 1" : fmt::format("sk_i + {}({})", vector(), fmt::join(steps, ", "));
  }

  /// Applies `function` to each component of the operands; "0" and other constants have none.
  std::string componentwise(std::string_view function, const std::vector<std::string>& operands) const {
    std::vector<std::string> components;
    for (int c = 0; c < rank_; ++c) {
      std::vector<std::string> arguments;
      for (const std::string& operand : operands) {
        const bool isVector = rank_ > 1 && operand != "0";
        arguments.push_back(isVector ? fmt::format("{}.{}", operand, "xyzw"[c]) : operand);
      }
      components.push_back(fmt::format("{}({})", function, fmt::join(arguments, ", ")));
    }
    return rank_ == 1 ? components.front() : call(vector(), components, "      ");
  }

  /// The shape, as an operand of componentwise().
  std::string shapeOperand() { return rank_ == 1 ? shape() : uniform("shape"); }

  /// Maps any index `sk_i` to an index `sk_p` in bounds, or returns the border.
  void bringInside(std::vector<std::string>& lines) {
    switch (parameter_.boundary) {
      case Boundary::Clamp:
        lines.push_back(fmt::format("{} sk_p = clamp(sk_i, {}, {} - 1);", vector(), zero(), shape()));
        return;
      case Boundary::Wrap:
        program_.require(Function::Wrap);
        define(lines, componentwise("sk_wrap", {"0", "sk_i", shapeOperand()}));
        return;
      case Boundary::Mirror:
        program_.require(Function::Mirror);
        define(lines, componentwise("sk_mirror", {"0", "sk_i", shapeOperand()}));
        return;
      case Boundary::Border:
        define(lines, "sk_i");
        returnBorderOutside(lines);
        return;
    }
  }

  /// The index in the gather of the current element.
  std::string elementHere() {
    if (!access_.shifted) return here_(rank_);
    return fmt::format("({} + {}{})", here_(rank_), uniform("low"), swizzle());
  }

  /// Maps any offset `sk_d` to the index `sk_p` of that neighbour of the current element, in bounds.
  void bringNeighbourInside(std::vector<std::string>& lines) {
    const std::string here = elementHere();
    switch (parameter_.boundary) {
      case Boundary::Clamp:
        if (parameter_.reach >= 0 && parameter_.reach <= largestSafeReach) {
          define(lines, fmt::format("clamp({} + sk_d, {}, {} - 1)", here, zero(), shape()));
        } else {
          lines.push_back(fmt::format("{} sk_i = {};", vector(), here));
          define(lines, fmt::format("sk_i + clamp(sk_d, -sk_i, {} - 1 - sk_i)", shape()));
        }
        return;
      case Boundary::Wrap: fold(lines, here, "sk_wrap", Function::WrapOnce, Function::Wrap); return;
      case Boundary::Mirror: fold(lines, here, "sk_mirror", Function::MirrorOnce, Function::Mirror); return;
      case Boundary::Border:
        // A sum that overflows is negative, hence out of bounds like the exact sum.
        define(lines, fmt::format("{} + sk_d", here));
        returnBorderOutside(lines);
        return;
    }
  }

  void fold(std::vector<std::string>& lines, const std::string& here, std::string_view name, Function once,
            Function any) {
    program_.require(access_.nearby ? once : any);
    if (access_.nearby) {
      define(lines, fmt::format("{} + sk_d", here));
      lines.push_back(fmt::format("sk_p = {};", componentwise(name, {"sk_p", shapeOperand()})));
    } else {
      lines.push_back(fmt::format("{} sk_i = {};", vector(), here));
      define(lines, componentwise(name, {"sk_i", "sk_d", shapeOperand()}));
    }
  }

  /// Brings an index `sk_p` in the whole to the element that is held for it; what is not held reads the nearest one.
  void keepHeld(std::vector<std::string>& lines) {
    const std::string low = fmt::format("{}{}", uniform("low"), swizzle());
    const std::string high = fmt::format("{}{}", uniform("high"), swizzle());
    if (parameter_.boundary != Boundary::Wrap) {
      lines.push_back(fmt::format("sk_p = clamp(sk_p, {}, {} - 1);", low, high));
      return;
    }
    // low is above -n and at most 0, so that the distance from it is less than 2 n
    program_.require(Function::WrapOnce);
    lines.push_back(fmt::format("sk_p -= {};", low));
    lines.push_back(fmt::format("sk_p = min({} + {}, {} - 1);",
                                componentwise("sk_wrap", {"sk_p", shapeOperand()}), low, high));
  }

  void define(std::vector<std::string>& lines, std::string_view value) const {
    lines.push_back(fmt::format("{} sk_p = {};", vector(), value));
  }

  /// As unsigned integers, negative indices are too large.
  void returnBorderOutside(std::vector<std::string>& lines) {
    const std::string outside =
        rank_ == 1 ? fmt::format("uint(sk_p) >= uint({})", shape())
                   : fmt::format("any(greaterThanEqual(uvec{0}(sk_p), uvec{0}({1})))", rank_, shape());
    lines.push_back(fmt::format("if ({}) return {};", outside, parameter_.border));
  }

  /// The index in the gather of the current texel: in a plane, in a row, or the number in a linearised stream.
  std::string texelHere(DomainText& domain) {
    const bool isRow = rank_ == 1;
    const std::string here = access_.addressing == Addressing::Plane
                                 ? domain.texelPosition(rank_)
                                 : fmt::format("({})", domain.texelNumber());
    if (!access_.shifted) return here;
    return isRow ? fmt::format("({} + ({}.x >> 2))", here, uniform("low"))
                 : fmt::format("({} + ({}.xy >> ivec2(2, 0)))", here, uniform("low"));
  }

  int reachInX() const { return window_.reachInX(); }
  int reachInY() const { return window_.reachInY(); }
  std::string texelName(int x, int y) const { return window_.texelName(x, y); }

  /// Whether the work group fetches all texels in reach of its invocations into shared memory. A GPU fetches
  /// only a few texels per clock, and each is needed by as many invocations as it has neighbours.
  bool sharesTile() {
    return program_.sharesTexels() && rank_ == 2 && access_.addressing == Addressing::Plane &&
           mayFillTile() && program_.takeShared(tileTexels() * 4 * sizeof(float));
  }
  int tileWidth() const { return groupOfWideTexels.first + 2 * reachInX(); }
  int tileHeight() const { return groupOfWideTexels.second + 2 * reachInY(); }
  std::size_t tileTexels() const { return static_cast<std::size_t>(tileWidth() * tileHeight()); }

  int texelsAround() const {
    return static_cast<int>(tileTexels()) - groupOfWideTexels.first * groupOfWideTexels.second;
  }
  /// Whether fillTile can be used: one column on either side, and no more surrounding texels than
  /// invocations.
  bool mayFillTile() const {
    return reachInX() == 1 && texelsAround() <= groupOfWideTexels.first * groupOfWideTexels.second;
  }

  /// Each invocation fetches its own texel, and the first ones also a surrounding one, before waiting for
  /// either. `at` is the function that fetches a texel.
  void fillTile(std::string_view at) {
    const auto [width, height] = groupOfWideTexels;
    const int inRows = tileWidth() * 2 * reachInY();  // surrounding texels above and below
    const int around = texelsAround();
    assert(mayFillTile());
    const std::string_view symbol = parameter_.symbol;
    const std::string isFirst = fmt::format("if (gl_LocalInvocationIndex < {}u) ", around);
    program_.variable(fmt::format("shared {}", packedType(parameter_)),
                      fmt::format("sk_tile_{}[{}][{}]", symbol, tileHeight(), tileWidth()));
    program_.together(fmt::format("{} = {}(ivec2(0, 0));", texelName(0, 0), at));
    program_.together(fmt::format("ivec2 sk_place_{};", symbol));
    program_.together(fmt::format("{} sk_around_{};", packedType(parameter_), symbol));
    program_.together(isFirst + "{");
    program_.together("  int sk_k = int(gl_LocalInvocationIndex);");
    program_.together(fmt::format("  ivec2 sk_t = ivec2(sk_k % {0}, sk_k / {0} + (sk_k < {1} ? 0 : {2}));",
                                  tileWidth(), inRows / 2, height));
    program_.together(
        fmt::format("  if (sk_k >= {0}) sk_t = ivec2((sk_k - {0}) / {1} * {2}, (sk_k - {0}) % {1} + {3});",
                    inRows, height, width + 1, reachInY()));
    program_.together(fmt::format("  sk_place_{} = sk_t;", symbol));
    program_.together(fmt::format("  sk_around_{} = {}(sk_t - ivec2({}, {}) - sk_local());", symbol, at,
                                  reachInX(), reachInY()));
    program_.together("}");
    program_.keepTogether(fmt::format("{} = {};", texelOfTile(0, 0), texelName(0, 0)));
    program_.keepTogether(
        fmt::format("{0}sk_tile_{1}[sk_place_{1}.y][sk_place_{1}.x] = sk_around_{1};", isFirst, symbol));
  }
  std::string texelOfTile(int x, int y) const {
    return fmt::format("sk_tile_{}[sk_local().y + {}][sk_local().x + {}]", parameter_.symbol, y + reachInY(),
                       x + reachInX());
  }

  /// Declares variables that main() fills with these texels; the values of those beyond a border are never
  /// used.
  void defineTexels(const std::string& extents, const std::string& here) {
    const bool isRow = rank_ == 1;
    const bool isTiled = sharesTile();
    const std::string name = fmt::format("sk_texel_at_{}", parameter_.symbol);
    std::vector<std::string> lines = {extents, isRow ? fmt::format("int sk_p = {} + sk_d;", here)
                                                     : fmt::format("ivec2 sk_p = {} + sk_d;", here)};
    const bool endsRows = parameter_.boundary == Boundary::Clamp || parameter_.boundary == Boundary::Mirror;
    if (endsRows) lines.emplace_back(isRow ? "int sk_x = sk_p;" : "int sk_x = sk_p.x;");
    if (isRow) {
      lines.push_back(fmt::format("if (sk_d != 0) sk_p = {};", broughtOnce("sk_p", "sk_n")));
    } else if (isTiled) {  // also for invocations outside of the domain, whose texels are neighbours
      lines.push_back(fmt::format("sk_p = ivec2({}, {});", broughtOnce("sk_p.x", "sk_n.x"),
                                  broughtOnce("sk_p.y", "sk_n.y")));
    } else {
      lines.push_back(fmt::format("if (sk_d.x != 0) sk_p.x = {};", broughtOnce("sk_p.x", "sk_n.x")));
      lines.push_back(fmt::format("if (sk_d.y != 0) sk_p.y = {};", broughtOnce("sk_p.y", "sk_n.y")));
    }
    const std::string texel =
        texelIn(program_, samplerName(parameter_, 0), place(program_, texelAt("sk_p")), isLayered(access_));
    if (endsRows) {
      lines.push_back(fmt::format("{} sk_v = {};", packedType(parameter_), texel));
      lines.push_back(fmt::format("return {};", arranged(isRow, isTiled)));
    } else {
      lines.push_back(fmt::format("return {};", texel));
    }
    program_.function(fmt::format("{} {}({} sk_d)", packedType(parameter_), name, vector()), lines);
    for (int y = -reachInY(); y <= reachInY(); ++y) {
      for (int x = -reachInX(); x <= reachInX(); ++x) {
        program_.variable(packedType(parameter_), texelName(x, y));
        if (isTiled && x == 0 && y == 0) continue;  // fillTile() stores it
        program_.prologue(isTiled ? fmt::format("{} = {};", texelName(x, y), texelOfTile(x, y))
                          : isRow ? fmt::format("{} = {}({});", texelName(x, y), name, x)
                                  : fmt::format("{} = {}(ivec2({}, {}));", texelName(x, y), name, x, y));
      }
    }
    if (isTiled) fillTile(name);
  }

  /// Clamp or Mirror: arranges sk_v, the texel fetched for column sk_x, which may be out of bounds, as the
  /// boundary mode requires. With an x offset of 0, sk_x is in bounds, except in a tile, which also covers
  /// invocations outside of the domain.
  std::string arranged(bool isRow, bool isTiled) const {
    const std::string_view inColumn = isTiled ? "" : isRow ? "sk_d == 0 || " : "sk_d.x == 0 || ";
    const std::string isInside = fmt::format("{}uint(sk_x) < uint({})", inColumn, isRow ? "sk_n" : "sk_n.x");
    return parameter_.boundary == Boundary::Clamp
               ? fmt::format("{} ? sk_v : sk_x < 0 ? sk_v.xxxx : sk_v.wwww", isInside)
               : fmt::format("{} ? sk_v : sk_v.wzyx", isInside);
  }

  /// Maps a texel index that is less than an extent out of bounds into bounds.
  std::string broughtOnce(std::string_view index, std::string_view extent) {
    switch (parameter_.boundary) {
      case Boundary::Clamp: return fmt::format("clamp({}, 0, {} - 1)", index, extent);
      case Boundary::Wrap:
        program_.require(Function::WrapOnce);
        return fmt::format("sk_wrap({}, {})", index, extent);
      case Boundary::Mirror:
        program_.require(Function::MirrorOnce);
        return fmt::format("sk_mirror({}, {})", index, extent);
      case Boundary::Border: return fmt::format("clamp({}, 0, {} - 1)", index, extent);
    }
    return std::string(index);
  }

  /// The texel with a texel index.
  Texel texelAt(const std::string& index) {
    if (access_.addressing == Addressing::Plane)
      return {rank_ == 1 ? fmt::format("ivec2({}, 0)", index) : index};
    program_.require(Function::Texel);
    const std::string shift = program_.uniform("int", fmt::format("sk_shift_{}", parameter_.symbol));
    return {fmt::format("sk_texel({}, {})", index, shift), isLayered(access_) ? shift : ""};
  }

  Texel texel(std::vector<std::string>& lines) {
    if (access_.strided) {
      const bool isPlane = access_.addressing == Addressing::Plane;
      return stridedTexel(program_, parameter_, access_, isPlane ? insidePlane() : number());
    }
    if (access_.addressing != Addressing::Plane) {
      if (access_.view) lines.push_back(fmt::format("sk_p += {}{};", uniform("origin"), swizzle()));
      program_.require(Function::Texel);
      const std::string shift = program_.uniform("int", fmt::format("sk_shift_{}", parameter_.symbol));
      return {fmt::format("sk_texel({}, {}{})", number(), shift, access_.packed ? " + 2" : ""),
              isLayered(access_) ? shift : "", access_.packed};
    }
    const std::string inside = insidePlane();
    return {access_.view ? fmt::format("{} + {}.xy", inside, uniform("origin")) : inside, "", access_.packed};
  }

  std::string insidePlane() const { return rank_ == 1 ? "ivec2(sk_p, 0)" : rank_ == 2 ? "sk_p" : "sk_p.xy"; }

  std::string number() {
    if (rank_ == 1) return access_.strided ? fmt::format("sk_p * {}.x", uniform("stride")) : "sk_p";
    const std::string stride = uniform("stride");
    std::string sum = access_.strided ? fmt::format("sk_p.x * {}.x", stride) : "sk_p.x";
    for (int c = 1; c < rank_; ++c) sum += fmt::format(" + sk_p.{0} * {1}.{0}", "xyzw"[c], stride);
    return sum;
  }

  void finish(const std::string& signature, std::vector<std::string>& lines) {
    Texel place = texel(lines);
    place.filtered = access_.filtered;
    lines.push_back(fmt::format("return {};", fetch(program_, parameter_, place)));
    program_.function(signature, lines);
  }

  ProgramText& program_;
  const Position& here_;
  const Parameter& parameter_;
  const StreamAccess& access_;
  int rank_;
  const TexelWindow window_;
};

}  // namespace

bool mayFilter(const Parameter& gather) {
  const program::Scalar scalar = gather.element->fields.front().scalar;
  return gather.filter && gather.usesSample && gather.rank <= 2 && gather.boundary != Boundary::Border &&
         gather.layers.empty() && (scalar == program::Scalar::Float || scalar == program::Scalar::Half);
}

void defineGather(ProgramText& program, const Position& here, const Parameter& parameter,
                  const StreamAccess& access, DomainText* domain) {
  declareSamplers(program, parameter, isLayered(access));
  GatherText gather(program, here, parameter, access);
  const bool interpolates = parameter.usesSample && !access.filtered;
  if (parameter.usesAt || interpolates) gather.defineAt();
  if (parameter.usesNear && domain != nullptr) gather.defineNearByTexels(*domain);
  if (parameter.usesNear && domain == nullptr) gather.defineNear();
  if (interpolates) gather.defineSample();
  if (access.filtered) gather.defineFiltered();
}

}  // namespace sk::assemble
