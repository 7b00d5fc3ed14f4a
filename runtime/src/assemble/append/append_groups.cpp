// SPDX-License-Identifier: MIT
#include "assemble/append/append_groups.hpp"

#include <algorithm>

#include <fmt/format.h>

#include "assemble/append/append_passes.hpp"
#include "assemble/append/group_functions.hpp"
#include "assemble/append/histo_pyramid.hpp"
#include "assemble/elements/planes.hpp"
#include "assemble/glsl/subgroups.hpp"

namespace sk::assemble {

using program::Field;
using program::Kernel;
using program::Parameter;
using program::Role;
using program::Scalar;
using program::ScatterOp;

namespace {

/// Orders the bits of floats, -0 below 0. A NaN that is stored gives way to any value, and one that is given is ignored.
constexpr std::string_view orderOfFloatBits = R"(
bool sk_is_nan(uint b) { return (b & 0x7fffffffu) > 0x7f800000u; }
uint sk_key(uint b) { return (b & 0x80000000u) != 0u ? ~b : b | 0x80000000u; }
bool sk_below(uint a, uint b) { return sk_is_nan(b) || (!sk_is_nan(a) && sk_key(a) < sk_key(b)); }
bool sk_above(uint a, uint b) { return sk_is_nan(b) || (!sk_is_nan(a) && sk_key(a) > sk_key(b)); }
)";

}  // namespace

std::string_view orderOfFloats() { return orderOfFloatBits; }

GroupText::GroupText(ProgramText& program, DomainText& domain, const Profile& profile, const Kernel& kernel,
                     const Variant& variant)
    : program_(program),
      domain_(domain),
      variant_(variant),
      hasSubgroups_(profile.subgroups),
      plan_(planGroups(kernel, variant.domainPacked, order())) {
  if (variant.task.inOneRound) plan_.rounds = 1;
}

// ---- functions that the body calls ---------------------------------------------------------------

void GroupText::define(const Parameter& appendOutput, const StreamAccess& access) {
  if (!isPushed(appendOutput, order())) return definePut(appendOutput, access);
  if (variant_.task.work == Work::Owners) return program_.function(signatureOf(appendOutput), {});
  if (appendOutput.role == Role::Scatter) return defineRecord(appendOutput, access);
  definePush(appendOutput, signatureOf(appendOutput));
}

void GroupText::definePush(const Parameter& appendOutput, std::string_view signature) {
  const std::size_t first = program_.outputCount();
  const bool isRecord = appendOutput.role == Role::Scatter;
  if (isRecord) program_.output(isPair(appendOutput) ? "uvec2" : "uint", named("record", appendOutput));
  if (!isRecord || !isPair(appendOutput)) declareOutputs(program_, appendOutput);
  program_.storeLater(first);
  const Pushed pushed{&appendOutput, first, program_.outputCount(), isRecord};
  pushed_.push_back(pushed);
  if (plan_.isHeld) return holdPushed(pushed, signature);
  program_.variable("uint", named("at", appendOutput));
  program_.functionOf(fmt::format("void {}({}{} sk_v)", named("keep", appendOutput),
                                  isRecord ? "uint sk_key, " : "", appendOutput.element->glsl),
                      [&] { keepPushed(pushed); });
  program_.function(signature, {fmt::format("if (sk_storing) {}({}sk_v);", named("keep", appendOutput),
                                            isRecord ? "sk_key, " : ""),
                                fmt::format("++{};", named("at", appendOutput))});
}

/// Records hold the number of the texel to combine with, and the value.
void GroupText::defineRecord(const Parameter& scatter, const StreamAccess& access) {
  const std::string add = named("add", scatter);
  definePush(scatter, fmt::format("void {}(uint sk_key, {} sk_v)", add, scatter.element->glsl));
  const std::string texel = targetTexel(program_, scatter, access);
  const std::string owners = program_.uniform("ivec4", named("owners", scatter));
  program_.function(signatureOf(scatter),
                    {fmt::format("if (!({})) return;", isInside(program_, scatter)),
                     fmt::format("ivec2 sk_to = {};", texel),
                     fmt::format("{}(uint(sk_to.y * {}.y + sk_to.x), sk_v);", add, owners)});
}

/// Sets the outputs of a list's entry to `sk_v`, and those of a record to `sk_key`, too.
void GroupText::storePushed(const Pushed& pushed) {
  const Parameter& parameter = *pushed.parameter;
  if (pushed.isRecord && isPair(parameter)) {
    return program_.statement(
        fmt::format("{} = uvec2(sk_key, floatBitsToUint(sk_v));", named("record", parameter)));
  }
  if (pushed.isRecord) program_.statement(named("record", parameter) + " = sk_key;");
  store(program_, parameter, "sk_v");
}

/// The shift of the list's layout. `sk_shift_P` belongs to what a scatter output P combines with.
std::string GroupText::shiftOf(const Pushed& pushed) {
  return named(pushed.isRecord ? "list_shift" : "shift", *pushed.parameter);
}

std::string GroupText::stagedName(const Pushed& pushed, std::size_t plane) {
  return fmt::format("sk_staged{}_{}", plane, pushed.parameter->symbol);
}

void GroupText::declareStaged(const Pushed& pushed) {
  const int entries = std::max(plan_.rounds * appendGroup * elementsOfTexel() * pushed.parameter->pushes, 1);
  for (std::size_t plane = 0; plane < pushed.end - pushed.first; ++plane) {
    program_.variable("shared " + program_.outputAt(pushed.first + plane).type,
                      fmt::format("{}[{}]", stagedName(pushed, plane), entries));
  }
}

/// Holds what the element of `sk_slot` pushes. Slots are constants once loops are unrolled and functions inlined, so that
/// values stay in registers.
void GroupText::holdPushed(const Pushed& pushed, std::string_view signature) {
  const Parameter& parameter = *pushed.parameter;
  program_.require(Function::Texel);
  program_.uniform("int", named("room", parameter));
  program_.uniform("int", shiftOf(pushed));
  declareStaged(pushed);
  program_.variable("int", "sk_slot");
  program_.variable("uint", named("bits", parameter));
  for (std::size_t plane = 0; plane < pushed.end - pushed.first; ++plane) {
    program_.variable(program_.outputAt(pushed.first + plane).type,
                      fmt::format("sk_held{}_{}[{}]", plane, parameter.symbol, slots()));
  }
  program_.functionOf(signature, [&] {
    storePushed(pushed);
    for (std::size_t plane = 0; plane < pushed.end - pushed.first; ++plane) {
      program_.statement(fmt::format("sk_held{}_{}[sk_slot] = {};", plane, parameter.symbol,
                                     program_.outputAt(pushed.first + plane).name));
    }
    program_.statement(fmt::format("{} |= 1u << sk_slot;", named("bits", parameter)));
  });
}

/// Stores `sk_v` to the list, or to shared memory.
void GroupText::keepPushed(const Pushed& pushed) {
  const Parameter& parameter = *pushed.parameter;
  const std::string at = named("at", parameter);
  program_.require(Function::Texel);
  const std::string room = program_.uniform("int", named("room", parameter));
  const std::string shift = program_.uniform("int", shiftOf(pushed));
  if (!plan_.isStaged) program_.statement(fmt::format("if ({} >= uint({})) return;", at, room));
  storePushed(pushed);
  if (!plan_.isStaged) {
    for (const std::string& line :
         program_.storesOf(pushed.first, pushed.end, fmt::format("sk_texel(int({}), {})", at, shift))) {
      program_.statement(line);
    }
    return;
  }
  declareStaged(pushed);
  for (std::size_t plane = 0; plane < pushed.end - pushed.first; ++plane) {
    program_.statement(fmt::format("{}[{}] = {};", stagedName(pushed, plane), at,
                                   program_.outputAt(pushed.first + plane).name));
  }
}

void GroupText::definePut(const Parameter& scatter, const StreamAccess& access) {
  const std::string texel = targetTexel(program_, scatter, access);
  const std::string inside = fmt::format("if (!({})) return;", isInside(program_, scatter));
  const bool isOwned = hasOwners(scatter, order());
  if (isOwned) declareStates();
  if (variant_.task.work == Work::Owners) {
    if (!isOwned) return program_.function(signatureOf(scatter), {});
    return program_.function(signatureOf(scatter), {inside, fmt::format("ivec2 sk_to = {};", texel),
                                                    fmt::format("atomicMax({}, uint({}) + 1u);",
                                                                ownerOf(scatter), domain_.number())});
  }
  const std::size_t first = program_.outputCount();
  if (scatter.scatter == ScatterOp::Store) {
    declareOutputs(program_, scatter);
  } else {
    const Scalar scalar = scatter.element->fields.front().scalar;
    const bool isInt = scalar == Scalar::Int;
    program_.output(isInt ? "int" : "uint", named("atomic", scatter));
    program_.makeAtomic(first, isInt ? "r32i" : "r32ui");
    if (scalar == Scalar::Float && scatter.scatter != ScatterOp::Add) program_.functions(orderOfFloats());
  }
  program_.storeLater(first);
  program_.functionOf(signatureOf(scatter), [&] {
    program_.statement("if (!sk_storing) return;");
    program_.statement(inside);
    program_.statement(fmt::format("ivec2 sk_to = {};", texel));
    if (scatter.scatter != ScatterOp::Store) return putAtomically(scatter, fmt::format("sk_image{}", first));
    if (isOwned) {
      program_.statement(fmt::format("if ({} != uint({}) + 1u) return;", ownerOf(scatter), domain_.number()));
    }
    store(program_, scatter, "sk_v");
    for (const std::string& line : program_.storesOf(first, program_.outputCount(), "sk_to"))
      program_.statement(line);
  });
}

/// Floats are combined by comparing and exchanging.
void GroupText::putAtomically(const Parameter& scatter, const std::string& image) {
  const Scalar scalar = scatter.element->fields.front().scalar;
  if (scalar != Scalar::Float) {
    const std::string_view operation = scatter.scatter == ScatterOp::Add   ? "Add"
                                       : scatter.scatter == ScatterOp::Min ? "Min"
                                                                           : "Max";
    return program_.statement(fmt::format("imageAtomic{}({}, sk_to, sk_v);", operation, image));
  }
  program_.statement(fmt::format("uint sk_old = imageLoad({}, sk_to).x;", image));
  program_.statement("for (;;) {");
  if (scatter.scatter == ScatterOp::Add) {
    program_.statement("  uint sk_new = floatBitsToUint(uintBitsToFloat(sk_old) + sk_v);");
  } else {
    program_.statement("  uint sk_new = floatBitsToUint(sk_v);");
    program_.statement(fmt::format("  if (!{}(sk_new, sk_old)) return;",
                                   scatter.scatter == ScatterOp::Min ? "sk_below" : "sk_above"));
  }
  program_.statement(fmt::format("  uint sk_seen = imageAtomicCompSwap({}, sk_to, sk_old, sk_new);", image));
  program_.statement("  if (sk_seen == sk_old) return;");
  program_.statement("  sk_old = sk_seen;");
  program_.statement("}");
}

/// The word of the texel `sk_to` in the buffer of states.
std::string GroupText::ownerOf(const Parameter& scatter) {
  const std::string owners = program_.uniform("ivec4", named("owners", scatter));
  return fmt::format("sk_state[{0}.x + sk_to.y * {0}.y + sk_to.x]", owners);
}

void GroupText::declareStates() {
  program_.variable(
      "layout(std430, binding = 0) coherent volatile buffer sk_states {\n"
      "  uint sk_begun, sk_ended, sk_state[];\n}",
      "");
}

// ---- main() --------------------------------------------------------------------------------------

template <class Text>
std::string GroupText::ofPushed(Text&& text) const {
  std::string all;
  for (std::size_t k = 0; k < pushed_.size(); ++k) all += text(pushed_[k], k);
  return all;
}

void GroupText::finish() {
  program_.takeManyIterations();  // an invocation runs the kernel for several texels
  program_.variable("bool", "sk_storing");
  if (variant_.task.work == Work::Groups) program_.statement("if (!sk_storing) return;");
  std::string text = fmt::format("\nlayout(local_size_x = {}) in;\n", appendGroup);
  if (!pushed_.empty()) {
    declareStates();
    declareTotals();
    text += meetFunction();
  }
  program_.runFrom(text + (pushed_.empty() ? mainOfTiles() : mainOfPushes()));
}

void GroupText::declareTotals() {
  totals_ = program_.outputCount();
  for (const Pushed& pushed : pushed_) program_.output("ivec4", named("total", *pushed.parameter));
  program_.storeLater(totals_);
}

/// Runs the kernel on the invocation's texels of the tile. sk_rect: texels in a row, texels, rounds.
std::string GroupText::visits(std::string_view before, std::string_view after) const {
  return fmt::format(
      "  for (int sk_r = 0; sk_r < {} && sk_r < sk_rect.z; ++sk_r) {{\n"
      "    uint sk_n = sk_first + uint(sk_r) * {}u;\n"
      "    if (sk_n >= uint(sk_rect.y)) break;\n"
      "    sk_pixel = ivec2(int(sk_n) % sk_rect.x, int(sk_n) / sk_rect.x);\n"
      "{}    sk_run();\n{}  }}\n",
      plan_.rounds, appendGroup, before, after);
}

namespace {

/// `sk_tile` is the tile's number.
constexpr std::string_view findTexels =
    "  uint sk_span = uint(sk_rect.z) * {}u;\n"
    "  uint sk_tiles = (uint(sk_rect.y) + sk_span - 1u) / sk_span;\n"
    "  if (sk_tile >= sk_tiles) return;\n"
    "  uint sk_first = sk_tile * sk_span + sk_t;\n";

constexpr std::string_view ownTile =
    "  uint sk_tile = gl_WorkGroupID.y * gl_NumWorkGroups.x + gl_WorkGroupID.x;\n";

}  // namespace

std::string GroupText::mainOfTiles() const {
  return fmt::format(
      "\nvoid main() {{\n  uint sk_t = gl_LocalInvocationIndex;\n{}{}  sk_storing = true;\n{}}}\n", ownTile,
      fmt::format(fmt::runtime(findTexels), appendGroup), visits(""));
}

/// Copies what is staged to the list. sk_base_r and sk_size_r are the place and the number of a tile's pushes.
std::string GroupText::copiesOfStaged() const {
  return ofPushed([&](const Pushed& pushed, std::size_t) {
    const Parameter& parameter = *pushed.parameter;
    std::string text = fmt::format(
        "  for (uint sk_i = sk_t; sk_i < sk_size_{0}; sk_i += {1}u) {{\n"
        "    uint sk_to = sk_base_{0} + sk_i;\n"
        "    if (sk_to >= uint(sk_room_{0})) break;\n",
        parameter.symbol, appendGroup);
    for (std::size_t plane = 0; plane < pushed.end - pushed.first; ++plane) {
      text += fmt::format("    {} = {}[sk_i];\n", program_.outputAt(pushed.first + plane).name,
                          stagedName(pushed, plane));
    }
    const std::string place = fmt::format("sk_texel(int(sk_to), {})", shiftOf(pushed));
    for (const std::string& line : program_.storesOf(pushed.first, pushed.end, place))
      text += "    " + line + "\n";
    return text + "  }\n";
  });
}

/// Stores the number of pushes to a variable output.
std::string GroupText::totalOf(std::size_t number, std::string_view total) const {
  return fmt::format("    sk_total_{} = ivec4(0, 0, 0, int({}));\n    {}\n",
                     pushed_[number].parameter->symbol, total,
                     program_.storesOf(totals_ + number, totals_ + number + 1, "ivec2(0)").front());
}

/// The function of GroupStep::Scan.
std::string GroupText::scanOfTiles() const {
  std::string text = "\nvoid sk_scan_tiles(uint sk_tiles) {\n  uint sk_t = gl_LocalInvocationIndex;\n";
  for (std::size_t k = 0; k < pushed_.size(); ++k) {
    text += fmt::format(
        "  uint sk_before{0} = 0u;\n"
        "  for (uint sk_first = 0u; sk_first < sk_tiles; sk_first += {1}u) {{\n"
        "    sk_meet();\n"
        "    for (uint sk_i = sk_t; sk_i < {1}u; sk_i += {2}u) {{\n"
        "      uint sk_n = sk_first + sk_i;\n"
        "      sk_counts[sk_i] = sk_n < sk_tiles ? sk_state[sk_n * {3}u + {0}u] : 0u;\n"
        "    }}\n"
        "    sk_meet();\n"
        "    uint sk_all = sk_scan();\n"
        "    for (uint sk_i = sk_t; sk_i < {1}u; sk_i += {2}u) {{\n"
        "      uint sk_n = sk_first + sk_i;\n"
        "      if (sk_n < sk_tiles) sk_state[sk_n * {3}u + {0}u] = sk_sum(sk_before{0}, sk_counts[sk_i]);\n"
        "    }}\n"
        "    sk_before{0} = sk_sum(sk_before{0}, sk_all);\n"
        "  }}\n"
        "  if (sk_t == 0u) {{\n",
        k, plan_.rounds * appendGroup, appendGroup, pushed_.size());
    text += totalOf(k, fmt::format("sk_before{}", k)) + "  }\n";
  }
  return text + "}\n";
}

/// Runs the kernel on all texels of the invocation, and sets the number of pushes of each, sk_own_r. If values are held, the runs
/// are unconditional, on the last texel in place of those past the end, and store nothing there: a fetch within a branch would wait
/// for the one before.
std::string GroupText::runToCount() const {
  if (!plan_.isHeld) {
    return "  sk_storing = false;\n" + visits(forEach("    sk_at_{0} = 0u;\n"),
                                              forEach("    sk_own_{0}[sk_r] = min(sk_at_{0}, {4}u);\n"));
  }
  std::string text = forEach("  sk_bits_{0} = 0u;\n");
  for (int round = 0; round < plan_.rounds; ++round) {
    text += fmt::format(
        "  bool sk_is_inside{0} = sk_first + {1}u < uint(sk_rect.y);\n"
        "  uint sk_n{0} = min(sk_first + {1}u, uint(sk_rect.y) - 1u);\n"
        "  sk_pixel = ivec2(int(sk_n{0}) % sk_rect.x, int(sk_n{0}) / sk_rect.x);\n"
        "  sk_storing = sk_is_inside{0} && sk_rect.w != 0;\n"
        "  sk_slot = {2};\n"
        "  sk_run();\n",
        round, round * appendGroup, round * elementsOfTexel());
  }
  for (int round = 0; round < plan_.rounds; ++round) {
    const unsigned ofRound = ((1u << elementsOfTexel()) - 1) << (round * elementsOfTexel());
    text += ofPushed([&](const Pushed& pushed, std::size_t) {
      return fmt::format(
          "  if (!sk_is_inside{1}) sk_bits_{0} &= {3}u;\n"
          "  sk_own_{0}[{1}] = uint(bitCount(sk_bits_{0} & {2}u));\n",
          pushed.parameter->symbol, round, ofRound, ~ofRound);
    });
  }
  return text;
}

/// Stages or stores the pushes of all texels of the invocation.
std::string GroupText::runToStore() const {
  if (!plan_.isHeld) {
    return "  sk_storing = true;\n" +
           visits(forEach(plan_.isStaged ? "    sk_at_{0} = sk_own_{0}[sk_r];\n"
                                         : "    sk_at_{0} = sk_sum(sk_base_{0}, sk_own_{0}[sk_r]);\n"));
  }
  return ofPushed([&](const Pushed& pushed, std::size_t) {
    const std::string_view symbol = pushed.parameter->symbol;
    std::string text;
    for (int slot = 0; slot < slots(); ++slot) {
      text += fmt::format("  if ((sk_bits_{} >> {} & 1u) != 0u) {{\n", symbol, slot);
      for (std::size_t plane = 0; plane < pushed.end - pushed.first; ++plane) {
        text += fmt::format("    {}[sk_own_{}[{}]] = sk_held{}_{}[{}];\n", stagedName(pushed, plane), symbol,
                            slot / elementsOfTexel(), plane, symbol, slot);
      }
      text += fmt::format("    ++sk_own_{}[{}];\n  }}\n", symbol, slot / elementsOfTexel());
    }
    return text;
  });
}

/// Formats a pattern for each variable output: {0} its symbol, {1} the rounds, {2} the group's invocations, {3} its number, {4} the
/// largest count, {5} the number of variable outputs.
std::string GroupText::forEach(std::string_view pattern) const {
  return ofPushed([&](const Pushed& pushed, std::size_t k) {
    return fmt::format(fmt::runtime(pattern), pushed.parameter->symbol, plan_.rounds, appendGroup, k,
                       countLimit, pushed_.size());
  });
}

std::string GroupText::mainOfPushes() const {
  const bool inAnyOrder = variant_.task.pushesInAnyOrder;
  program_.variable("shared uint", fmt::format("sk_counts[{}]", plan_.rounds * appendGroup));
  program_.variable("shared uint", fmt::format("sk_sums[{}]", appendGroup));
  program_.variable("shared uint", "sk_tile, sk_look_low, sk_look_high, sk_look_nearest");
  if (hasSubgroups_) program_.extensions(subgroupExtensions());
  std::string text = scanOfCounts(plan_.rounds, hasSubgroups_);
  text += inAnyOrder ? std::string(takePlace()) : lookBack(pushed_.size(), hasSubgroups_) + scanOfTiles();
  text += "\nvoid main() {\n  uint sk_t = gl_LocalInvocationIndex;\n";
  text += fmt::format("  bool sk_looks = {};\n", inAnyOrder ? "false" : "sk_rect.w == 1");
  text +=
      "  if (sk_t == 0u && sk_looks) sk_tile = atomicAdd(sk_begun, 1u);\n"
      "  if (sk_t == 0u && !sk_looks) sk_tile = gl_WorkGroupID.y * gl_NumWorkGroups.x + gl_WorkGroupID.x;\n"
      "  sk_meet();\n";
  text += fmt::format(fmt::runtime(findTexels), appendGroup);
  if (!inAnyOrder) text += "  if (sk_rect.w == 2) {\n    sk_scan_tiles(sk_tiles);\n    return;\n  }\n";
  text += forEach(
      "  uint sk_own_{0}[{1}];\n"
      "  for (int sk_r = 0; sk_r < {1}; ++sk_r) sk_own_{0}[sk_r] = 0u;\n");
  text += runToCount();
  text += forEach(
      "  sk_meet();\n"
      "  for (int sk_r = 0; sk_r < {1}; ++sk_r) sk_counts[uint(sk_r) * {2}u + sk_t] = sk_own_{0}[sk_r];\n"
      "  sk_meet();\n"
      "  uint sk_size_{0} = sk_scan();\n"
      "  for (int sk_r = 0; sk_r < {1}; ++sk_r) sk_own_{0}[sk_r] = sk_counts[uint(sk_r) * {2}u + sk_t];\n");
  if (inAnyOrder) {
    text += forEach("  uint sk_base_{0} = sk_take({3}u, sk_size_{0});\n");
    text +=
        "  if (sk_t == 0u) memoryBarrierBuffer();\n  if (sk_t == 0u && atomicAdd(sk_ended, 1u) == sk_tiles - "
        "1u) {\n";
    for (std::size_t k = 0; k < pushed_.size(); ++k) text += totalOf(k, fmt::format("sk_state[{}]", k));
  } else {
    text += forEach(
        "  if (sk_rect.w == 0 && sk_t == 0u) sk_state[sk_tile * {5}u + {3}u] = sk_size_{0};\n"
        "  uint sk_base_{0} = sk_looks ? sk_look({3}u, sk_size_{0}) : sk_state[sk_tile * {5}u + {3}u];\n");
    text += "  if (sk_rect.w == 0) return;\n  if (sk_t == 0u && sk_looks && sk_tile == sk_tiles - 1u) {\n";
    for (std::size_t k = 0; k < pushed_.size(); ++k)
      text += totalOf(k, fmt::format("sk_sum(sk_base_{0}, sk_size_{0})", pushed_[k].parameter->symbol));
  }
  text += "  }\n" + runToStore();
  if (plan_.isStaged) text += "  sk_meet();\n" + copiesOfStaged();
  return text + "}\n";
}

}  // namespace sk::assemble
