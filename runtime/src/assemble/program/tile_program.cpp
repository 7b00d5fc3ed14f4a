// SPDX-License-Identifier: MIT
#include "assemble/program/tile_program.hpp"

#include <algorithm>
#include <cassert>
#include <deque>

#include <fmt/format.h>

#include "assemble/elements/arguments.hpp"
#include "assemble/elements/domain.hpp"
#include "assemble/elements/planes.hpp"
#include "assemble/elements/texel_window.hpp"
#include "assemble/elements/tile_gather.hpp"
#include "assemble/glsl/program_text.hpp"

namespace sk::assemble {

using program::Boundary;
using program::Kernel;
using program::Parameter;
using program::Role;

namespace {

class TileText {
 public:
  TileText(const Profile& profile, const Kernel& kernel, const Variant& variant, const TilePlan& plan)
      : profile_(profile),
        kernel_(kernel),
        variant_(variant),
        plan_(plan),
        program_(profile),
        domain_(program_, {.domain = Domain::Plane, .rank = 2, .packed = true}) {
    assert(profile.stage == Stage::Compute && variant.domain == Domain::Plane && variant.domainPacked &&
           !variant.domainView && plan.texels[0] % 8 == 0 && plan.invocations % (4 * plan.texels[0]) == 0);
  }

  std::string write() {
    declare();
    for (const TileCall& call : plan_.calls) defineGathers(call);
    begin();
    load();
    line(fmt::format("for (int sk_step = 1; sk_step <= {}; ++sk_step) {{", plan_.iterations));
    indent_ = "  ";
    shareCarried();
    for (const TileCall& call : plan_.calls) compute(call);
    carry();
    indent_.clear();
    line("}");
    store();
    program_.runFrom(
        fmt::format("\nlayout(local_size_x = {}) in;\n\nvoid main() {{\n{}}}\n", plan_.invocations, main_));
    return program_.finish(profile_,
                           fmt::format("{} for {}: tiles of {} x {} texels, {} iterations", kernel_.name,
                                       profile_.name, plan_.stored()[0], plan_.stored()[1], plan_.iterations),
                           kernel_);
  }

 private:
  int columns() const { return plan_.texels[0]; }
  int rows() const { return plan_.texels[1]; }
  int rowsAtOnce() const { return plan_.invocations / columns(); }
  int texelsOfInvocation() const { return rows() / rowsAtOnce(); }
  std::string_view typeOf(int value) const {
    return fourOf(plan_.elements[static_cast<std::size_t>(value)]->fields.front().scalar).glsl;
  }
  bool isNear(int value) const { return plan_.isNear[static_cast<std::size_t>(value)]; }
  TileArray arrayOf(int value) const {
    return {fmt::format("sk_tile{}", value), typeOf(value), plan_.texels, isExtended(value)};
  }
  /// Whether texels beyond the ends of the stream get what gathers with Boundary::Clamp read there, so that these need not ask
  /// where the ends are.
  bool isExtended(int value) const {
    bool clamps = false, mirrors = false;
    for (const TileCall& call : plan_.calls) {
      for (std::size_t i = 0; i < call.values.size(); ++i) {
        const Parameter& parameter = call.kernel->parameters[i];
        if (parameter.role != Role::Gather || call.values[i] != value) continue;
        clamps = clamps || parameter.boundary == Boundary::Clamp;
        mirrors = mirrors || parameter.boundary == Boundary::Mirror;
      }
    }
    return clamps && !mirrors;
  }
  /// The texel of a value that an invocation holds.
  static std::string held(int value, int k) { return fmt::format("sk_v{}_{}", value, k); }

  void line(std::string_view text) { main_ += fmt::format("  {}{}\n", indent_, text); }
  void synchronize() {
    line("memoryBarrierShared();");
    line("barrier();");
  }
  template <class Do>
  void forEachTexel(Do&& act) const {
    for (int k = 0; k < texelsOfInvocation(); ++k) act(k);
  }

  void declare() {
    program_.variable("ivec2", "sk_origin");
    program_.variable("ivec2", "sk_spot");
    program_.variable("ivec2", "sk_low");
    program_.variable("ivec2", "sk_high");
    for (std::size_t v = 0; v < plan_.elements.size(); ++v) {
      const int value = static_cast<int>(v);
      if (isNear(value)) arrayOf(value).declare(program_);
    }
    for (std::size_t i = 0; i < kernel_.parameters.size(); ++i) {
      const Parameter& parameter = kernel_.parameters[i];
      if (parameter.role == Role::Gather) declareSamplers(program_, parameter, false);
      if (parameter.role == Role::Uniform) uniformValue(program_, parameter, variant_.access[i]);
      if (parameter.role != Role::Output) continue;
      declareOutputs(program_, written_.emplace_back(fourOf(parameter)));
    }
    if (kernel_.usesIndex) domain_.seenIndex();
    if (kernel_.usesExtent)
      program_.function("ivec4 sk_extent()", {fmt::format("return {};", domain_.seenShape())});
    std::vector<std::string> lines = {"sk_spot = sk_s;", "sk_pixel = sk_origin + sk_s;"};
    if (plan_.isPeriodic) {
      program_.require(Function::WrapOnce);
      lines.push_back(fmt::format("ivec2 sk_n = {};", texelsOfDomain()));
      lines.emplace_back("sk_pixel = ivec2(sk_wrap(sk_pixel.x, sk_n.x), sk_wrap(sk_pixel.y, sk_n.y));");
    }
    program_.function("void sk_enter(ivec2 sk_s)", lines);
  }

  std::string texelsOfDomain() {
    const std::string shape = program_.uniform("ivec4", "sk_domain_shape");
    return fmt::format("ivec2({0}.x >> 2, {0}.y)", shape);
  }

  void defineGathers(const TileCall& call) {
    for (std::size_t i = 0; i < call.kernel->parameters.size(); ++i) {
      if (call.kernel->parameters[i].role != Role::Gather) continue;
      const Parameter gather = gatherOf(call, i);
      if (gather.usesExtent)
        program_.function(fmt::format("ivec4 sk_extent_{}()", gather.symbol),
                          {fmt::format("return {};", domain_.seenShape())});
      defineTileGather(program_, domain_, gather, arrayOf(call.values[i]));
    }
  }

  static Parameter gatherOf(const TileCall& call, std::size_t i) {
    Parameter gather = call.kernel->parameters[i];
    gather.symbol = call.symbols[i];
    return gather;
  }

  void begin() {
    const std::array<int, 2> halo = plan_.halo(), stored = plan_.stored();
    line("ivec2 sk_first = sk_rect.xy + ivec2(gl_WorkGroupID.xy) * " +
         fmt::format("ivec2({}, {});", stored[0], stored[1]));
    line(fmt::format("sk_origin = sk_first - ivec2({}, {});", halo[0], halo[1]));
    line(fmt::format("ivec2 sk_n = {};", texelsOfDomain()));
    line("sk_low = max(ivec2(0), -sk_origin);");
    line(fmt::format("sk_high = min(ivec2({}, {}), sk_n - sk_origin) - 1;", columns(), rows()));
    line(fmt::format("bool sk_isAtEnd = sk_low != ivec2(0) || sk_high != ivec2({}, {});", columns() - 1,
                     rows() - 1));
    // Eight invocations after one another read neighbouring texels, which are in different banks of shared memory. An invocation
    // has texels below each other, and so holds most of what it reads above and below them.
    line("int sk_i = int(gl_LocalInvocationIndex), sk_w = sk_i >> 5;");
    line(fmt::format(
        "ivec2 sk_mine = ivec2((sk_i & 7) | sk_w % {0} << 3, ((sk_i >> 3 & 3) | sk_w / {0} << 2) * {1});",
        columns() / 8, texelsOfInvocation()));
  }

  static std::string spotOf(int k) { return fmt::format("sk_mine + ivec2(0, {})", k); }

  void load() {
    forEachTexel([&](int k) {
      line(fmt::format("sk_enter({});", spotOf(k)));
      if (!plan_.isPeriodic) line("sk_pixel = clamp(sk_pixel, ivec2(0), sk_n - 1);");
      for (std::size_t c = 0; c < plan_.carried; ++c) {
        const auto value = static_cast<int>(c);
        line(fmt::format("{} {} = {};", typeOf(value), held(value, k), fetched(c)));
      }
      for (std::size_t v = plan_.carried; v < plan_.elements.size(); ++v) {
        const auto value = static_cast<int>(v);
        line(fmt::format("{0} {1} = {0}(0);", typeOf(value), held(value, k)));
      }
    });
  }

  /// Gives the work group what calls read at neighbours.
  void shareCarried() {
    std::vector<int> near;
    for (std::size_t c = 0; c < plan_.carried; ++c) {
      if (plan_.isNear[c]) near.push_back(static_cast<int>(c));
    }
    if (near.empty()) return;
    line("if (sk_step > 1) {");  // all have read what is there
    line("  memoryBarrierShared();");
    line("  barrier();");
    line("}");
    share(near);
  }

  std::string fetched(std::size_t carried) {
    const std::string sampler = samplerName(kernel_.parameters[carried], 0);
    if (variant_.access[carried].packed) return texelIn(program_, sampler, "sk_pixel", false);
    std::string elements;
    for (int lane = 0; lane < lanes; ++lane) {
      const std::string place = fmt::format("ivec2(4 * sk_pixel.x + {}, sk_pixel.y)", lane);
      elements += fmt::format("{}{}.x", lane == 0 ? "" : ", ", texelIn(program_, sampler, place, false));
    }
    return fmt::format("{}({})", typeOf(static_cast<int>(carried)), elements);
  }

  /// Stores what invocations hold of some values to shared memory, for all of the work group.
  void share(const std::vector<int>& values) {
    bool isAnyExtended = false;
    for (const int value : values) {
      const TileArray array = arrayOf(value);
      forEachTexel([&](int k) {
        line(fmt::format("{} = {};", array.texel(fmt::format("sk_mine.y + {}", k), "sk_mine.x"),
                         held(value, k)));
      });
      isAnyExtended = isAnyExtended || isExtended(value);
    }
    synchronize();
    if (!isAnyExtended) return;
    line("if (sk_isAtEnd) {");
    for (const int value : values) {
      if (isExtended(value)) extend(value);
    }
    line("  memoryBarrierShared();");
    line("  barrier();");
    line("}");
  }

  /// Gives texels beyond the ends of the stream what clamped indices give.
  void extend(int value) {
    const TileArray array = arrayOf(value);
    forEachTexel([&](int k) {
      line("  {");
      line(fmt::format("    ivec2 sk_s = {}, sk_p = clamp(sk_s, sk_low, sk_high);", spotOf(k)));
      line("    if (sk_s != sk_p) {");
      line(fmt::format("      {} sk_v = {};", typeOf(value), array.texel("sk_p.y", "sk_p.x")));
      line(fmt::format("      {} = sk_s.x == sk_p.x ? sk_v : sk_s.x < sk_p.x ? sk_v.xxxx : sk_v.wwww;",
                       held(value, k)));
      line(fmt::format("      {} = {};", array.texel("sk_s.y", "sk_s.x"), held(value, k)));
      line("    }");
      line("  }");
    });
  }

  /// Computes a call. What depends on texels outside of the tile is wrong, and nothing that is stored depends on it.
  void compute(const TileCall& call) {
    forEachTexel([&](int k) {
      line(fmt::format("sk_enter({});", spotOf(k)));
      for (std::size_t i = 0; i < call.kernel->parameters.size(); ++i) {
        const Parameter& parameter = call.kernel->parameters[i];
        if (parameter.role == Role::Gather && parameter.usesNear)
          fillWindow(gatherOf(call, i), call.values[i], k);
      }
      for (int lane = 0; lane < lanes; ++lane) {
        if (domain_.usesLane()) line(fmt::format("sk_lane = {};", lane));
        line(sk::assemble::call(call.entry, argumentsOf(call, k, "xyzw"[lane]), "      ") + ";");
      }
    });
    std::vector<int> near;
    for (std::size_t i = 0; i < call.kernel->parameters.size(); ++i) {
      if (call.kernel->parameters[i].role == Role::Output && isNear(call.values[i]))
        near.push_back(call.values[i]);
    }
    if (near.empty()) return;
    synchronize();  // all have read what was there
    share(near);
  }

  /// Fetches the texels around texel k, unless the invocation holds them.
  void fillWindow(const Parameter& gather, int value, int k) {
    const TexelWindow window(gather);
    for (int y = -window.reachInY(); y <= window.reachInY(); ++y) {
      for (int x = -window.reachInX(); x <= window.reachInX(); ++x) {
        const bool isHeld =
            x == 0 && k + y >= 0 && k + y < texelsOfInvocation() &&
            (y == 0 || gather.boundary == Boundary::Wrap || gather.boundary == Boundary::Border ||
             (gather.boundary == Boundary::Clamp && isExtended(value)));
        line(fmt::format(
            "{} = {};", window.texelName(x, y),
            isHeld ? held(value, k + y) : fmt::format("sk_texel_at_{}(ivec2({}, {}))", gather.symbol, x, y)));
      }
    }
  }

  static std::vector<std::string> argumentsOf(const TileCall& call, int k, char component) {
    std::vector<std::string> arguments;
    for (std::size_t i = 0; i < call.kernel->parameters.size(); ++i) {
      const Role role = call.kernel->parameters[i].role;
      if (role == Role::Gather) continue;
      arguments.push_back(role == Role::Input || role == Role::Output
                              ? fmt::format("{}.{}", held(call.values[i], k), component)
                              : call.arguments[i]);
    }
    return arguments;
  }

  /// Gives the streams the values that they have after an iteration.
  void carry() {
    std::vector<int> changed;
    for (std::size_t c = 0; c < plan_.carried; ++c) {
      if (plan_.next[c] != static_cast<int>(c)) changed.push_back(static_cast<int>(c));
    }
    const auto isRotated = [&](int value) {  // another stream takes what it has
      return std::ranges::any_of(changed,
                                 [&](int c) { return plan_.next[static_cast<std::size_t>(c)] == value; });
    };
    forEachTexel([&](int k) {
      for (const int c : changed) {
        if (isRotated(c)) line(fmt::format("{} sk_old{}_{} = {};", typeOf(c), c, k, held(c, k)));
      }
      for (const int c : changed) {
        const int from = plan_.next[static_cast<std::size_t>(c)];
        const bool isOld = std::ranges::find(changed, from) != changed.end();
        line(
            fmt::format("{} = {};", held(c, k), isOld ? fmt::format("sk_old{}_{}", from, k) : held(from, k)));
      }
    });
  }

  void store() {
    const std::array<int, 2> halo = plan_.halo(), stored = plan_.stored();
    forEachTexel([&](int k) {
      line("{");
      line(fmt::format("  ivec2 sk_s = {} - ivec2({}, {}), sk_at = sk_first + sk_s;", spotOf(k), halo[0],
                       halo[1]));
      line(fmt::format(
          "  if (all(lessThan(uvec2(sk_s), uvec2({}, {}))) && all(lessThan(sk_at - sk_rect.xy, sk_rect.zw))) "
          "{{",
          stored[0], stored[1]));
      std::size_t output = 0;
      for (std::size_t c = 0; c < plan_.carried; ++c) {
        if (plan_.next[c] == static_cast<int>(c)) continue;
        const std::string value = held(static_cast<int>(c), k);
        for (const std::string& statement :
             program_.linesOf([&] { assemble::store(program_, written_[output], value); }))
          line("    " + statement);
        ++output;
      }
      for (const std::string& statement : program_.storing("sk_at", false)) line("    " + statement);
      line("  }");
      line("}");
    });
  }

  const Profile& profile_;
  const Kernel& kernel_;
  const Variant& variant_;
  const TilePlan& plan_;
  ProgramText program_;
  DomainText domain_;
  std::deque<Parameter> written_;  ///< of packed texels
  std::string main_, indent_;
};

}  // namespace

std::array<int, 2> TilePlan::reach() const {
  std::array<int, 2> sum{};
  for (const TileCall& call : calls) {
    sum[0] += call.reach[0];
    sum[1] += call.reach[1];
  }
  return sum;
}

std::array<int, 2> TilePlan::halo() const {
  const std::array<int, 2> one = reach();
  return {(iterations * one[0] + lanes - 1) / lanes, iterations * one[1]};
}

std::size_t TilePlan::sharedBytes() const {
  const auto arrays = static_cast<std::size_t>(std::ranges::count(isNear, true));
  return arrays * static_cast<std::size_t>(texels[0] * texels[1]) * lanes * sizeof(float);
}

std::string describe(const TilePlan& plan) {
  std::string text =
      fmt::format("// {} iterations of {} x {} texels by {}{}: {} carried, next {}\n", plan.iterations,
                  plan.texels[0], plan.texels[1], plan.invocations, plan.isPeriodic ? ", periodic" : "",
                  plan.carried, fmt::join(plan.next, " "));
  for (std::size_t v = 0; v < plan.elements.size(); ++v)
    text += fmt::format("// {}{}\n", plan.elements[v]->name, plan.isNear[v] ? " near" : "");
  for (const TileCall& call : plan.calls) {
    text += fmt::format("// {}({}) of values {}, reach {} {}\n", call.entry, fmt::join(call.arguments, ", "),
                        fmt::join(call.values, " "), call.reach[0], call.reach[1]);
  }
  return text;
}

std::string tileProgram(const Profile& profile, const Kernel& kernel, const Variant& variant,
                        const TilePlan& plan) {
  return TileText(profile, kernel, variant, plan).write();
}

}  // namespace sk::assemble
