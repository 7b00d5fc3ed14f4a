// SPDX-License-Identifier: MIT
//
// Combines records, sorted by their targets, with the elements of a scatter output (append/scatter_programs.hpp). A work group has
// a tile of records. Where a target's first record is, one invocation combines all of them, one after the other. The tile's last
// target may have records in the tiles behind, which the whole group then fetches for it.

//// combineRecords
layout(local_size_x = 256) in;

uniform ivec4 sk_rect;
uniform int sk_length;      // the records that there may be
uniform int sk_tiles;
uniform int sk_keys_shift;  // log2 of the textures' widths: of the sorted pairs,
uniform int sk_list_shift;  // and of the list of values
uniform int sk_width;       // texels in a row of the target

uniform usampler2D sk_keys;   // pairs of a target, and of a value or its place in the list
uniform isampler2D sk_count;  // the number of records, in the fourth component of its texel
#ifndef SK_PAIRS
uniform SK_SAMPLER sk_values;
#endif
#ifdef GL_ES  // which reads no image that it writes, unless of one component; no texel is read after it is written
uniform SK_SAMPLER sk_elements;
layout(binding = 0, SK_FORMAT) writeonly uniform SK_IMAGE sk_target;
#define SK_ELEMENT(at) texelFetch(sk_elements, at, 0)
#else
layout(binding = 0, SK_FORMAT) coherent uniform SK_IMAGE sk_target;
#define SK_ELEMENT(at) imageLoad(sk_target, at)
#endif

const int sk_run = 4, sk_tile = 1024;

shared uint sk_targets[sk_tile];
shared SK_VALUE sk_value[sk_tile];
shared uint sk_left;    // the target whose records go on behind the tile, or none
shared uint sk_end[2];  // the first record of a tile that has another target

const uint sk_none = 0xffffffffu;

ivec2 sk_texel(int n, int shift) { return ivec2(n & ((1 << shift) - 1), n >> shift); }
int sk_group() { return (sk_rect.y + int(gl_WorkGroupID.y)) << 15 | (sk_rect.x + int(gl_WorkGroupID.x)); }

void sk_wait() {
  memoryBarrierShared();
  barrier();
}

int sk_records() {
#ifdef SK_COUNTED
  return min(texelFetch(sk_count, ivec2(0), 0).w, sk_length);
#else
  return sk_length;
#endif
}

uvec2 sk_recordAt(int n, int length) {
  return n >= 0 && n < length ? texelFetch(sk_keys, sk_texel(n, sk_keys_shift), 0).xy : uvec2(sk_none);
}

SK_VALUE sk_valueOf(uvec2 record) {
#ifdef SK_PAIRS
  return uintBitsToFloat(record.y);
#else
  return record.x != sk_none ? texelFetch(sk_values, sk_texel(int(record.y), sk_list_shift), 0)SK_SWIZZLE : SK_VALUE(0);
#endif
}

ivec2 sk_targetOf(uint key) { return ivec2(int(key) % sk_width, int(key) / sk_width); }

SK_VALUE sk_combined(SK_VALUE value, int from, int to) {
  for (; from + 8 <= to; from += 8) {
    SK_VALUE v0 = sk_value[from], v1 = sk_value[from + 1], v2 = sk_value[from + 2], v3 = sk_value[from + 3];
    SK_VALUE v4 = sk_value[from + 4], v5 = sk_value[from + 5], v6 = sk_value[from + 6], v7 = sk_value[from + 7];
    value = sk_combine(sk_combine(sk_combine(sk_combine(value, v0), v1), v2), v3);
    value = sk_combine(sk_combine(sk_combine(sk_combine(value, v4), v5), v6), v7);
  }
  for (; from < to; ++from) value = sk_combine(value, sk_value[from]);
  return value;
}

void main() {
  int i = int(gl_LocalInvocationIndex), tile = sk_group();
  if (tile >= sk_tiles) return;
  int first = tile * sk_tile, length = sk_records();
  uvec2 records[sk_run];
  for (int k = 0; k < sk_run; ++k) records[k] = sk_recordAt(first + k * 256 + i, length);
  uint before = i == 0 ? sk_recordAt(first - 1, length).x : sk_none;
  for (int k = 0; k < sk_run; ++k) {
    sk_targets[k * 256 + i] = records[k].x;
    sk_value[k * 256 + i] = sk_valueOf(records[k]);
  }
  if (i == 0) {
    sk_left = sk_none;
    sk_end[0] = uint(sk_tile);
  }
  sk_wait();
  SK_VALUE left = SK_VALUE(0);
  bool combinesLeft = false;
  for (int k = 0; k < sk_run; ++k) {
    int n = k * 256 + i;
    uint key = records[k].x;
    if (key == sk_none || key == (n > 0 ? sk_targets[n - 1] : before)) continue;
    int end = n + 1;
    while (end < sk_tile && sk_targets[end] == key) ++end;
    ivec2 to = sk_targetOf(key);
    SK_VALUE value = sk_combined(SK_VALUE(SK_ELEMENT(to)SK_SWIZZLE), n, end);
    if (end < sk_tile) {
      imageStore(sk_target, to, SK_TEXEL(value));
    } else {
      left = value;
      combinesLeft = true;
      sk_left = key;
    }
  }
  sk_wait();
  uint key = sk_left;
  if (key == sk_none) return;
  for (int k = 0; k < sk_run; ++k) records[k] = sk_recordAt(first + sk_tile + k * 256 + i, length);
  for (int round = 0;; ++round) {
    first += sk_tile;
    for (int k = 0; k < sk_run; ++k) {
      int n = k * 256 + i;
      sk_value[n] = sk_valueOf(records[k]);
      if (records[k].x != key) atomicMin(sk_end[round & 1], uint(n));
    }
    sk_wait();
    uint end = sk_end[round & 1];
    if (i == 0) sk_end[(round + 1) & 1] = uint(sk_tile);
    if (end == uint(sk_tile)) {
      for (int k = 0; k < sk_run; ++k) records[k] = sk_recordAt(first + sk_tile + k * 256 + i, length);
    }
    if (combinesLeft) left = sk_combined(left, 0, int(end));
    if (end < uint(sk_tile)) break;
    sk_wait();
  }
  if (combinesLeft) imageStore(sk_target, sk_targetOf(key), SK_TEXEL(left));
}
