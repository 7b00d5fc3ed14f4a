// SPDX-License-Identifier: MIT
#include "assemble/append/group_functions.hpp"

#include <fmt/format.h>

#include "assemble/append/append_passes.hpp"
#include "assemble/append/histo_pyramid.hpp"

namespace sk::assemble {

namespace {

constexpr std::string_view meeting = R"(
void sk_meet() {
  memoryBarrierShared();
  barrier();
}
)";

constexpr std::string_view sumsOfGroup = R"(
// Replaces sk_sums, which is sk_all of each invocation, by the sums of all up to it.
void sk_add_up(uint sk_all) {{
  uint sk_t = gl_LocalInvocationIndex;
  sk_sums[sk_t] = sk_all;
  sk_meet();
  for (uint sk_d = 1u; sk_d < {group}u; sk_d <<= 1) {{
    uint sk_other = sk_t >= sk_d ? sk_sums[sk_t - sk_d] : 0u;
    sk_meet();
    sk_all = sk_sum(sk_all, sk_other);
    sk_sums[sk_t] = sk_all;
    sk_meet();
  }}
}}
)";

// The first additions take each invocation's place in its subgroup, which need not be that in the group, from sk_sums.
constexpr std::string_view sumsOfSubgroups = R"(
shared uint sk_row_sums[{subgroups}];

void sk_add_up(uint sk_all) {{
  sk_sums[gl_LocalInvocationIndex] = sk_all;
  sk_meet();
  uint sk_lane = gl_SubgroupInvocationID, sk_t = gl_SubgroupID << 5 | sk_lane;
  sk_all = sk_sums[sk_t];
  for (uint sk_d = 1u; sk_d < 32u; sk_d <<= 1) {{
    uint sk_other = subgroupShuffleUp(sk_all, sk_d);
    sk_all = sk_lane >= sk_d ? sk_sum(sk_all, sk_other) : sk_all;
  }}
  if (sk_lane == 31u) sk_row_sums[gl_SubgroupID] = sk_all;
  sk_meet();
  for (uint sk_r = 0u; sk_r < {subgroups}u; ++sk_r) {{
    if (sk_r < gl_SubgroupID) sk_all = sk_sum(sk_all, sk_row_sums[sk_r]);
  }}
  sk_sums[sk_t] = sk_all;
  sk_meet();
}}
)";

constexpr std::string_view saturatingSum = R"(
uint sk_sum(uint a, uint b) {{ return min(a + b, {limit}u); }}
)";

constexpr std::string_view scan = R"(
uint sk_scan() {{
  uint sk_t = gl_LocalInvocationIndex;
  uint sk_all = 0u;
  for (uint sk_i = sk_t * {rounds}u; sk_i < (sk_t + 1u) * {rounds}u; ++sk_i) {{
    uint sk_one = sk_counts[sk_i];
    sk_counts[sk_i] = sk_all;
    sk_all = sk_sum(sk_all, sk_one);
  }}
  sk_add_up(sk_all);
  uint sk_before = sk_t > 0u ? sk_sums[sk_t - 1u] : 0u;
  for (uint sk_i = sk_t * {rounds}u; sk_i < (sk_t + 1u) * {rounds}u; ++sk_i) {{
    sk_counts[sk_i] = sk_sum(sk_before, sk_counts[sk_i]);
  }}
  sk_meet();
  return sk_sums[{group} - 1];
}}
)";

constexpr std::string_view lookOfGroup = R"(
uint sk_look(uint sk_k, uint sk_own) {{
  uint sk_t = gl_LocalInvocationIndex;
  uint sk_mine = sk_tile * {outputs}u + sk_k;
  if (sk_t == 0u && sk_tile > 0u) atomicExchange(sk_state[sk_mine], sk_own | 0x40000000u);
  uint sk_before = 0u;
  for (uint sk_end = sk_tile; sk_end > 0u; sk_end -= {group}u) {{
    if (sk_t == 0u) {{
      sk_look_low = 0u;
      sk_look_high = 0u;
      sk_look_nearest = {group}u;
    }}
    sk_meet();
    uint sk_seen = 0u;
    if (sk_t < sk_end) {{
      do {{
        sk_seen = sk_state[(sk_end - 1u - sk_t) * {outputs}u + sk_k];
      }} while (sk_seen == 0u);
      if (sk_seen >= 0x80000000u) atomicMin(sk_look_nearest, sk_t);
    }}
    sk_meet();
    if (sk_t < sk_end && sk_t <= sk_look_nearest) {{
      atomicAdd(sk_look_low, sk_seen & 0xffffu);
      atomicAdd(sk_look_high, sk_seen >> 16 & 0x3fffu);
    }}
    sk_meet();
    sk_before = sk_sum(sk_before, sk_look_high < 0x2000u ? min((sk_look_high << 16) + sk_look_low, {limit}u) : {limit}u);
    bool sk_done = sk_look_nearest < {group}u;
    sk_meet();
    if (sk_done) break;
  }}
  if (sk_t == 0u) atomicExchange(sk_state[sk_mine], sk_sum(sk_before, sk_own) | 0x80000000u);
  return sk_before;
}}
)";

// The same with sums of subgroups, so that the group waits for itself half as often.
constexpr std::string_view lookOfSubgroups = R"(
uint sk_look(uint sk_k, uint sk_own) {{
  uint sk_lane = gl_SubgroupInvocationID, sk_t = gl_SubgroupID << 5 | sk_lane;
  uint sk_mine = sk_tile * {outputs}u + sk_k;
  if (sk_t == 0u && sk_tile > 0u) atomicExchange(sk_state[sk_mine], sk_own | 0x40000000u);
  uint sk_before = 0u;
  for (uint sk_end = sk_tile; sk_end > 0u; sk_end -= {group}u) {{
    uint sk_seen = 0u;
    if (sk_t < sk_end) {{
      do {{
        sk_seen = sk_state[(sk_end - 1u - sk_t) * {outputs}u + sk_k];
      }} while (sk_seen == 0u);
    }}
    subgroupBarrier();
    uint sk_lasts = subgroupBallot(sk_seen >= 0x80000000u).x;
    bool sk_isCounted = sk_lasts == 0u || int(sk_lane) <= findLSB(sk_lasts);
    uint sk_all = sk_isCounted ? sk_seen & 0x3fffffffu : 0u;
    for (uint sk_d = 16u; sk_d > 0u; sk_d >>= 1) sk_all = sk_sum(sk_all, subgroupShuffleXor(sk_all, sk_d));
    if (sk_lane == 0u) sk_row_sums[gl_SubgroupID] = sk_all | (sk_lasts != 0u ? 0x80000000u : 0u);
    sk_meet();
    bool sk_done = false;
    for (uint sk_r = 0u; sk_r < {subgroups}u; ++sk_r) {{
      uint sk_row = sk_row_sums[sk_r];
      if (!sk_done) sk_before = sk_sum(sk_before, sk_row & 0x3fffffffu);
      sk_done = sk_done || sk_row >= 0x80000000u;
    }}
    sk_meet();
    if (sk_done) break;
  }}
  if (sk_t == 0u) atomicExchange(sk_state[sk_mine], sk_sum(sk_before, sk_own) | 0x80000000u);
  return sk_before;
}}
)";

constexpr std::string_view taking = R"(
uint sk_take(uint sk_k, uint sk_own) {
  if (gl_LocalInvocationIndex == 0u) sk_look_low = atomicAdd(sk_state[sk_k], sk_own);
  sk_meet();
  uint sk_place = sk_look_low;
  sk_meet();
  return sk_place;
}
)";

}  // namespace

std::string_view meetFunction() { return meeting; }

std::string scanOfCounts(int rounds, bool hasSubgroups) {
  const std::string text =
      std::string(saturatingSum).append(hasSubgroups ? sumsOfSubgroups : sumsOfGroup).append(scan);
  return fmt::format(fmt::runtime(text), fmt::arg("limit", countLimit), fmt::arg("rounds", rounds),
                     fmt::arg("group", appendGroup), fmt::arg("subgroups", appendGroup / 32));
}

std::string lookBack(std::size_t lists, bool hasSubgroups) {
  return fmt::format(fmt::runtime(hasSubgroups ? lookOfSubgroups : lookOfGroup),
                     fmt::arg("limit", countLimit), fmt::arg("group", appendGroup),
                     fmt::arg("subgroups", appendGroup / 32), fmt::arg("outputs", lists));
}

std::string_view takePlace() { return taking; }

}  // namespace sk::assemble
