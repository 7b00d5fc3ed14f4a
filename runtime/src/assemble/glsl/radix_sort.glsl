// SPDX-License-Identifier: MIT
//
// The programs of a radix sort by one digit of 8 bits (sort/radix_program.hpp). Words lie in linearised textures. Between
// two digits, they lie in a buffer, if it is large enough (SK_FROM_BUFFER, SK_TO_BUFFER): the words of a tile that have
// the same digit go to few neighbouring places, which fill whole sectors of memory there, but one row of each in a texture.
//
//   for each tile: counts[digit, tile] = how many keys have this digit
//   sums = the counts before, digit by digit and tile by tile
//   for each tile: the key of rank r among those of its digit goes to sums[digit, tile] + r
//
// Ranks keep the order of keys. A row of 32 invocations holds consecutive keys. With SK_SUBGROUPS, a row is a subgroup, whose
// votes say which of its keys have the same digit. Without, each key sets its bit in the mark of its digit, and invocations wait
// for each other explicitly, so that nothing depends on how devices group them.
//
// All fetches of a run are unconditional, from the last key on for those past the end: a fetch within a branch would wait for
// the one before.

//// radixHead
#pragma optionNV(unroll all)

layout(local_size_x = SK_GROUP) in;

uniform ivec4 sk_rect;
uniform int sk_length;       // keys
uniform int sk_tiles;
uniform int sk_keys_shift;   // log2 of the textures' widths: of keys and places,
uniform int sk_counts_shift;  // of counts and their sums,
uniform int sk_totals_shift;  // and of the sums' totals
uniform int sk_digit;        // the digit's lowest bit
uniform int sk_flip;         // the bits to invert, so that words compare as keys do

const int sk_run = SK_RUN, sk_tile = SK_GROUP * SK_RUN, sk_rows = SK_GROUP / 32;
const int sk_sum_tile = 4096;

ivec2 sk_texel(int n, int shift) { return ivec2(n & ((1 << shift) - 1), n >> shift); }
int sk_group() { return (sk_rect.y + int(gl_WorkGroupID.y)) << 15 | (sk_rect.x + int(gl_WorkGroupID.x)); }

void sk_wait() {
  memoryBarrierShared();
  barrier();
}

// A number of the invocation, such that those of row r, from 32 * r on, are a subgroup if there are any.
int sk_invocation() {
#ifdef SK_SUBGROUPS
  return int(gl_SubgroupID) << 5 | int(gl_SubgroupInvocationID);
#else
  return int(gl_LocalInvocationIndex);
#endif
}

//// radixKeys
#if defined(SK_FROM_BUFFER) || defined(SK_TO_BUFFER)
#ifdef SK_TO_BUFFER
#define SK_ACCESS
#else
#define SK_ACCESS readonly
#endif
#ifdef SK_PAIRS
layout(std430, binding = 0) SK_ACCESS buffer sk_buffer { uvec2 sk_stored[]; };
#else
layout(std430, binding = 0) SK_ACCESS buffer sk_buffer { uint sk_stored[]; };
#endif
uniform int sk_from;  // the number of the first word that is read
uniform int sk_to;    // and written
#endif

// A word, or a pair.
#ifdef SK_FROM_BUFFER
uvec2 sk_wordAt(int n) {
#ifdef SK_PAIRS
  return sk_stored[sk_from + min(n, sk_length - 1)];
#else
  return uvec2(sk_stored[sk_from + min(n, sk_length - 1)], 0u);
#endif
}
#else
uniform usampler2D sk_keys;

uvec2 sk_wordAt(int n) { return texelFetch(sk_keys, sk_texel(min(n, sk_length - 1), sk_keys_shift), 0).xy; }
#endif

// The digit of a key. With SK_FLOATS, keys are the bits of floats: both zeros are the same, and NaNs come last.
uint sk_digitOf(uint key) {
#ifdef SK_FLOATS
  uint magnitude = key & 0x7fffffffu;
  uint word = (key >> 31) != 0u ? ~key : key | 0x80000000u;
  word = (magnitude == 0u ? 0x80000000u : word) ^ uint(sk_flip);
  word = magnitude > 0x7f800000u ? 0xffffffffu : word;
#else
  uint word = key ^ uint(sk_flip);
#endif
  return word >> sk_digit & 255u;
}

//// countDigits
layout(binding = 0 SK_WORDS) writeonly uniform uimage2D sk_counts;

shared uint sk_count[sk_rows * 256];

void main() {
  int i = sk_invocation(), tile = sk_group();
  if (tile >= sk_tiles) return;
  int first = tile * sk_tile + i;
  uint keys[sk_run];
  for (int k = 0; k < sk_run; ++k) keys[k] = sk_wordAt(first + k * SK_GROUP).x;
  for (int k = i; k < sk_rows * 256; k += SK_GROUP) sk_count[k] = 0u;
  sk_wait();
  int row = (i >> 5) * 256;
  if (sk_length - tile * sk_tile >= sk_tile) {
    for (int k = 0; k < sk_run; ++k) atomicAdd(sk_count[row + int(sk_digitOf(keys[k]))], 1u);
  } else {
    for (int k = 0; k < sk_run; ++k) {
      if (first + k * SK_GROUP < sk_length) atomicAdd(sk_count[row + int(sk_digitOf(keys[k]))], 1u);
    }
  }
  sk_wait();
  if (i >= 256) return;
  uint sum = 0u;
  for (int r = 0; r < sk_rows; ++r) sum += sk_count[r * 256 + i];
  imageStore(sk_counts, sk_texel(i * sk_tiles + tile, sk_counts_shift), uvec4(sum));
}

//// sumCounts
// The sums before each of sk_length counts within its tile, and the totals of tiles.
uniform usampler2D sk_counts;
layout(binding = 0 SK_WORDS) writeonly uniform uimage2D sk_sums;
layout(binding = 1 SK_WORDS) writeonly uniform uimage2D sk_totals;

shared uint sk_kept[4096 + 128];

int sk_slot(int n) { return n + (n >> 5); }

void main() {
  int i = sk_invocation(), tile = sk_group();
  if (tile >= sk_tiles) return;
  int first = tile * sk_tile;
  uint counts[sk_run];
  for (int k = 0; k < sk_run; ++k)
    counts[k] = texelFetch(sk_counts, sk_texel(min(first + k * 256 + i, sk_length - 1), sk_counts_shift), 0).x;
  for (int k = 0; k < sk_run; ++k) {
    int n = k * 256 + i;
    sk_kept[sk_slot(n)] = first + n < sk_length ? counts[k] : 0u;
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
layout(binding = 0 SK_MOVED_WORDS) writeonly uniform uimage2D sk_moved;
#endif

void sk_put(uint n, uvec2 word) {
#ifndef SK_TO_BUFFER
  imageStore(sk_moved, sk_texel(int(n), sk_keys_shift), uvec4(word, 0u, 0u));
#elif defined(SK_PAIRS)
  sk_stored[sk_to + int(n)] = word;
#else
  sk_stored[sk_to + int(n)] = word.x;
#endif
}

shared uint sk_words[sk_tile];  // the tile's words in the order of their ranks, and before, marks of rows and digits
shared uint sk_counts[sk_rows * 256];  // the keys of a row with this digit; later the rank of the first
shared uint sk_moves[256];  // from a rank to a number

#ifdef SK_SUBGROUPS
shared uint sk_row_sums[8];

// The sum of the values of the invocations before this one, of the first 256.
uint sk_digits_before(uint value) {
  int row = int(gl_SubgroupID);
  uint through = subgroupInclusiveAdd(value);
  if (row < 8 && gl_SubgroupInvocationID == 31u) sk_row_sums[row] = through;
  sk_wait();
  uint before = through - value;
  for (int r = 0; r < 8; ++r) before += r < row ? sk_row_sums[r] : 0u;
  return before;
}

// The invocations of the subgroup whose digits are equal to this one's.
uint sk_equal(uint digit) {
  uint marks = 0xffffffffu;
  for (int b = 0; b < 8; ++b) {
    bool isSet = (digit >> b & 1u) != 0u;
    uint vote = subgroupBallot(isSet).x;
    marks &= isSet ? vote : ~vote;
  }
  return marks;
}
#else
uint sk_digits_before(uint value) {
  uint total;
  return sk_sums_before(value, total);
}
#endif

void main() {
  int i = sk_invocation(), tile = sk_group();
  if (tile >= sk_tiles) return;
  int row = i >> 5, lane = i & 31;
  int first = tile * sk_tile + row * (32 * sk_run) + lane;
  int count = min(sk_length - tile * sk_tile, sk_tile);
  uint keys[sk_run];
  uint digits[sk_run];
  uint ranks[sk_run];
#ifdef SK_PAIRS
  uint places[sk_run];
#endif
  for (int k = 0; k < sk_run; ++k) {
    uvec2 word = sk_wordAt(first + k * 32);
    keys[k] = word.x;
#ifdef SK_FIRST
    places[k] = uint(first + k * 32);
#elif defined(SK_PAIRS)
    places[k] = word.y;
#endif
  }
  uint place = 0u;
  if (i < 256) {
    int number = i * sk_tiles + tile;
    place = texelFetch(sk_sums, sk_texel(number, sk_counts_shift), 0).x +
            texelFetch(sk_totals, sk_texel(number / sk_sum_tile, sk_totals_shift), 0).x;
  }
  for (int k = 0; k < sk_run; ++k) digits[k] = first + k * 32 < sk_length ? sk_digitOf(keys[k]) : 255u;
  for (int k = i; k < sk_rows * 256; k += SK_GROUP) sk_counts[k] = 0u;
#ifndef SK_SUBGROUPS
  for (int k = i; k < 2 * sk_rows * 256; k += SK_GROUP) sk_words[k] = 0u;
#endif
  sk_wait();
  for (int k = 0; k < sk_run; ++k) {
    int slot = row * 256 + int(digits[k]);
#ifdef SK_SUBGROUPS
    uint marks = sk_equal(digits[k]);
    uint before = sk_counts[slot];
    uint rank = uint(bitCount(marks & ((1u << lane) - 1u)));
    ranks[k] = before + rank;
    subgroupBarrier();
    if (rank == 0u) sk_counts[slot] = before + uint(bitCount(marks));
    subgroupBarrier();
#else
    int marked = (k & 1) * (sk_rows * 256) + slot;
    atomicOr(sk_words[marked], 1u << lane);
    sk_wait();
    uint marks = sk_words[marked], before = sk_counts[slot];
    ranks[k] = before + uint(bitCount(marks & ((1u << lane) - 1u)));
    sk_wait();
    if (marks >> lane == 1u) {
      sk_counts[slot] = before + uint(bitCount(marks));
      sk_words[marked] = 0u;
    }
#endif
  }
  sk_wait();
  uint sum = 0u;
  if (i < 256) {
    for (int r = 0; r < sk_rows; ++r) {
      uint inRow = sk_counts[r * 256 + i];
      sk_counts[r * 256 + i] = sum;
      sum += inRow;
    }
  }
  uint start = sk_digits_before(sum);
  if (i < 256) {
    for (int r = 0; r < sk_rows; ++r) sk_counts[r * 256 + i] += start;
    sk_moves[i] = place - start;
  }
  sk_wait();
  for (int k = 0; k < sk_run; ++k) {
    ranks[k] += sk_counts[row * 256 + int(digits[k])];
    sk_words[ranks[k]] = keys[k];
  }
  sk_wait();
  uint targets[sk_run];
  for (int k = 0; k < sk_run; ++k) {
    keys[k] = sk_words[k * SK_GROUP + i];
    targets[k] = sk_moves[sk_digitOf(keys[k])] + uint(k * SK_GROUP + i);
  }
#ifdef SK_PAIRS
  sk_wait();
  for (int k = 0; k < sk_run; ++k) sk_words[ranks[k]] = places[k];
  sk_wait();
  for (int k = 0; k < sk_run; ++k) places[k] = sk_words[k * SK_GROUP + i];
#define SK_MOVED uvec2(keys[k], places[k])
#else
#define SK_MOVED uvec2(keys[k])
#endif
  if (count == sk_tile) {
    for (int k = 0; k < sk_run; ++k) sk_put(targets[k], SK_MOVED);
  } else {
    for (int k = 0; k < sk_run; ++k) {
      if (k * SK_GROUP + i < count) sk_put(targets[k], SK_MOVED);
    }
  }
}

//// storeWords
// From the buffer to a texture, two rows at once where tiles consist of pairs of rows (sk_paired).
layout(binding = 0 SK_MOVED_WORDS) writeonly uniform uimage2D sk_moved;

void main() {
  int i = int(gl_LocalInvocationIndex), tile = sk_group();
  if (tile >= sk_tiles) return;
  bool isPaired = sk_keys_shift >= 2 && sk_tile % (2 << sk_keys_shift) == 0;
  uvec2 words[sk_run];
  int numbers[sk_run];
  for (int k = 0; k < sk_run; ++k) {
    int n = tile * sk_tile + k * SK_GROUP + i;
    numbers[k] = isPaired ? sk_paired(n, sk_keys_shift) : n;
    words[k] = sk_wordAt(numbers[k]);
  }
  for (int k = 0; k < sk_run; ++k) {
    if (numbers[k] < sk_length)
      imageStore(sk_moved, sk_texel(numbers[k], sk_keys_shift), uvec4(words[k], 0u, 0u));
  }
}
