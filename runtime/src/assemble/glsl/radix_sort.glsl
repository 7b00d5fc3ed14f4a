// SPDX-License-Identifier: MIT
//
// The programs of a radix sort by one digit of 8 bits (sort/radix_program.hpp). Words lie in linearised textures. Between
// two digits, pairs lie in a buffer, if it is large enough (SK_FROM_BUFFER, SK_TO_BUFFER): the pairs of a tile that have
// the same digit go to few neighbouring places, which fill whole sectors of memory there, but one row of each in a texture.
//
//   for each tile of 4096 keys: counts[digit, tile] = how many keys have this digit
//   sums = the counts before, digit by digit and tile by tile
//   for each tile: the key of rank r among those of its digit goes to sums[digit, tile] + r
//
// Ranks keep the order of keys. A row of 32 invocations holds consecutive keys; each sets its bit in the mark of its
// digit, and the bits below it count the equal digits before it. Invocations wait for each other explicitly, so that
// nothing depends on how devices group them.

//// radixHead
#pragma optionNV(unroll all)

layout(local_size_x = 256) in;

uniform ivec4 sk_rect;
uniform int sk_length;       // keys
uniform int sk_tiles;
uniform int sk_keys_shift;   // log2 of the textures' widths: of keys and places,
uniform int sk_counts_shift;  // of counts and their sums,
uniform int sk_totals_shift;  // and of the sums' totals
uniform int sk_digit;        // the digit's lowest bit

const int sk_run = 16, sk_tile = 4096;

ivec2 sk_texel(int n, int shift) { return ivec2(n & ((1 << shift) - 1), n >> shift); }
int sk_group() { return (sk_rect.y + int(gl_WorkGroupID.y)) << 15 | (sk_rect.x + int(gl_WorkGroupID.x)); }

void sk_wait() {
  memoryBarrierShared();
  barrier();
}

#if defined(SK_FROM_BUFFER) || defined(SK_TO_BUFFER)
layout(std430, binding = 0) buffer sk_buffer { uvec2 sk_stored[]; };
uniform int sk_from;  // the number of the first pair that is read
uniform int sk_to;    // and written
#endif
#ifdef SK_FROM_BUFFER
uvec2 sk_wordAt(int n) { return sk_stored[sk_from + n]; }
#else
uniform usampler2D sk_keys;
uvec2 sk_wordAt(int n) { return texelFetch(sk_keys, sk_texel(n, sk_keys_shift), 0).xy; }
#endif

//// countDigits
layout(binding = 0) writeonly uniform uimage2D sk_counts;

shared uint sk_count[256];

void main() {
  int i = int(gl_LocalInvocationIndex), tile = sk_group();
  if (tile >= sk_tiles) return;
  sk_count[i] = 0u;
  sk_wait();
  for (int k = 0; k < sk_run; ++k) {
    int n = tile * sk_tile + k * 256 + i;
    if (n < sk_length) {
      atomicAdd(sk_count[sk_wordAt(n).x >> sk_digit & 255u], 1u);
    }
  }
  sk_wait();
  imageStore(sk_counts, sk_texel(i * sk_tiles + tile, sk_counts_shift), uvec4(sk_count[i]));
}

//// sumCounts
// The sums before each of sk_length counts within its tile, and the totals of tiles.
uniform usampler2D sk_counts;
layout(binding = 0) writeonly uniform uimage2D sk_sums;
layout(binding = 1) writeonly uniform uimage2D sk_totals;

shared uint sk_kept[4096 + 128];

int sk_slot(int n) { return n + (n >> 5); }

void main() {
  int i = int(gl_LocalInvocationIndex), tile = sk_group();
  if (tile >= sk_tiles) return;
  int first = tile * sk_tile;
  for (int k = 0; k < sk_run; ++k) {
    int n = k * 256 + i;
    sk_kept[sk_slot(n)] =
        first + n < sk_length ? texelFetch(sk_counts, sk_texel(first + n, sk_counts_shift), 0).x : 0u;
  }
  sk_wait();
  uint sum = 0u, total;
  for (int k = 0; k < sk_run; ++k) sum += sk_kept[sk_slot(i * sk_run + k)];
  sum = sk_sums_before(sum, total);
  for (int k = 0; k < sk_run; ++k) {
    int slot = sk_slot(i * sk_run + k);
    uint count = sk_kept[slot];
    sk_kept[slot] = sum;
    sum += count;
  }
  sk_wait();
  for (int k = 0; k < sk_run; ++k) {
    int n = k * 256 + i;
    if (first + n < sk_length)
      imageStore(sk_sums, sk_texel(first + n, sk_counts_shift), uvec4(sk_kept[sk_slot(n)]));
  }
  if (i == 0) imageStore(sk_totals, sk_texel(tile, sk_totals_shift), uvec4(total));
}

//// moveKeys
// With SK_PAIRS, a key goes with the place where it was at first. GPUs scatter few texels a cycle, so that one of
// two words takes less time than two of one. With SK_FIRST, only keys are read, and the place of each is its number.
uniform usampler2D sk_sums;
uniform usampler2D sk_totals;  // of the tiles of sums, themselves summed
#ifndef SK_TO_BUFFER
layout(binding = 0) writeonly uniform uimage2D sk_moved;
#endif

void sk_put(int n, uvec2 word) {
#ifdef SK_TO_BUFFER
  sk_stored[sk_to + n] = word;
#else
  imageStore(sk_moved, sk_texel(n, sk_keys_shift), uvec4(word, 0u, 0u));
#endif
}

// Marks of 8 rows and 256 digits, for even and odd steps; later the tile's words in the order of their ranks.
shared uint sk_words[4096];
shared uint sk_counts[8 * 256];
shared uint sk_starts[256];  // of the digits among the tile's ranks
shared uint sk_moves[256];  // from a rank to a number

uint sk_digitOf(uint key) { return key >> sk_digit & 255u; }

void main() {
  int i = int(gl_LocalInvocationIndex), tile = sk_group();
  if (tile >= sk_tiles) return;
  int row = i >> 5, lane = i & 31;
  int first = tile * sk_tile + row * (32 * sk_run) + lane;
  int count = min(sk_length - tile * sk_tile, sk_tile);
  uint keys[sk_run];
  uint ranks[sk_run];
#ifdef SK_PAIRS
  uint places[sk_run];
#endif
  for (int k = 0; k < sk_run; ++k) {
    int n = first + k * 32;
    uvec2 word = n < sk_length ? sk_wordAt(n) : uvec2(0xffffffffu);
    keys[k] = word.x;
#ifdef SK_FIRST
    places[k] = uint(n);
#elif defined(SK_PAIRS)
    places[k] = word.y;
#endif
    sk_words[k * 256 + i] = 0u;
  }
  for (int r = 0; r < 8; ++r) sk_counts[r * 256 + i] = 0u;
  sk_wait();
  for (int k = 0; k < sk_run; ++k) {
    int slot = row * 256 + int(sk_digitOf(keys[k]));
    int marked = (k & 1) * 2048 + slot;
    atomicOr(sk_words[marked], 1u << lane);
    sk_wait();
    uint marks = sk_words[marked], before = sk_counts[slot];
    ranks[k] = before + uint(bitCount(marks & ((1u << lane) - 1u)));
    sk_wait();
    if (marks >> lane == 1u) {
      sk_counts[slot] = before + uint(bitCount(marks));
      sk_words[marked] = 0u;
    }
  }
  sk_wait();
  uint sum = 0u, total;
  for (int r = 0; r < 8; ++r) {
    uint inRow = sk_counts[r * 256 + i];
    sk_counts[r * 256 + i] = sum;
    sum += inRow;
  }
  uint start = sk_sums_before(sum, total);
  int number = i * sk_tiles + tile;
  sk_starts[i] = start;
  sk_moves[i] = texelFetch(sk_sums, sk_texel(number, sk_counts_shift), 0).x +
                texelFetch(sk_totals, sk_texel(number / sk_tile, sk_totals_shift), 0).x - start;
  sk_wait();
  for (int k = 0; k < sk_run; ++k) {
    uint digit = sk_digitOf(keys[k]);
    ranks[k] += sk_counts[row * 256 + int(digit)] + sk_starts[digit];
  }
  for (int k = 0; k < sk_run; ++k) sk_words[ranks[k]] = keys[k];
  sk_wait();
  for (int k = 0; k < sk_run; ++k) keys[k] = sk_words[k * 256 + i];
#ifdef SK_PAIRS
  sk_wait();
  for (int k = 0; k < sk_run; ++k) sk_words[ranks[k]] = places[k];
  sk_wait();
  for (int k = 0; k < sk_run; ++k) places[k] = sk_words[k * 256 + i];
#endif
  for (int k = 0; k < sk_run; ++k) {
    int rank = k * 256 + i;
    if (rank >= count) continue;
    int to = int(sk_moves[sk_digitOf(keys[k])]) + rank;
#ifdef SK_PAIRS
    sk_put(to, uvec2(keys[k], places[k]));
#else
    sk_put(to, uvec2(keys[k]));
#endif
  }
}

//// storePairs
// From the buffer to a texture, two rows at once where tiles consist of pairs of rows (sk_paired).
layout(binding = 0) writeonly uniform uimage2D sk_moved;

void main() {
  int i = int(gl_LocalInvocationIndex), tile = sk_group();
  if (tile >= sk_tiles) return;
  bool isPaired = sk_keys_shift >= 2 && sk_tile % (2 << sk_keys_shift) == 0;
  for (int k = 0; k < sk_run; ++k) {
    int n = tile * sk_tile + k * 256 + i;
    if (isPaired) n = sk_paired(n, sk_keys_shift);
    if (n < sk_length) imageStore(sk_moved, sk_texel(n, sk_keys_shift), uvec4(sk_wordAt(n), 0u, 0u));
  }
}
