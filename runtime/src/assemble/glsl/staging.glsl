// SPDX-License-Identifier: MIT
//
// The programs that copy boxes of a stream's plane to words of a buffer, and back (transfer/staging_program.hpp). An
// invocation takes texels of one box: an element, or the elements of the box among the four of a packed texel.

//// stagingHead
layout(local_size_x = 64) in;

uniform ivec4 sk_origin[4], sk_extent[4];  // boxes in their stream, x first
uniform int sk_first[4];                   // and their first words
uniform ivec4 sk_stride;                   // of the stream, if it is linearised
uniform int sk_shift;                      // log2 of the texture's width; -1: the stream is a plane
uniform int sk_lane_bits;                  // log2 of the elements of a texel
uniform int sk_channels;                   // of an element

#ifdef SK_LAYERED
ivec3 sk_place(ivec2 p) { return ivec3(p.x, p.y & ((1 << sk_shift) - 1), p.y >> sk_shift); }
#else
ivec2 sk_place(ivec2 p) { return p; }
#endif

// Finds texel number n of a box, the first of its elements in x, and the row's first word, counted from the box's. False if
// there is no such texel.
bool sk_find(ivec4 origin, ivec4 extent, int n, out ivec2 texel, out int x, out int row) {
  int first = origin.x >> sk_lane_bits;
  int texels = ((origin.x + extent.x - 1) >> sk_lane_bits) - first + 1;
  int number = n / texels;
  int column = first + n - number * texels;
  int plane = number / extent.y;
  ivec3 outer = ivec3(number - plane * extent.y, plane % extent.z, plane / extent.z) + origin.yzw;
  x = column << sk_lane_bits;
  row = number * extent.x - origin.x;
  if (sk_shift < 0) {
    texel = ivec2(column, outer.x);
  } else {
    int at = (x * sk_stride.x + outer.x * sk_stride.y + outer.y * sk_stride.z + outer.z * sk_stride.w) >> sk_lane_bits;
    texel = ivec2(at & ((1 << sk_shift) - 1), at >> sk_shift);
  }
  return number < extent.y * extent.z * extent.w;
}

// Whether the words of a packed texel are a vector of the buffer. Single words of host memory take a transaction each.
bool sk_is_vector(int word, int begin, int end) { return end - begin == 4 && (word & 3) == 0; }

//// packTexels
layout(std430, binding = 0) writeonly buffer sk_staging { uint sk_words[]; };
layout(std430, binding = 0) writeonly buffer sk_staged_vectors { uvec4 sk_vectors[]; };
uniform highp SK_SAMPLER sk_texels;

void sk_copy(ivec2 texel, int word, int count, int begin, int end) {
  SK_VECTOR v = texelFetch(sk_texels, sk_place(texel), 0);
  if (sk_lane_bits == 0) {
    for (int c = 0; c < sk_channels; ++c) sk_words[word + c * count] = sk_to_word(v[c]);
  } else if (sk_is_vector(word, begin, end)) {
    sk_vectors[word >> 2] = sk_to_word(v);
  } else {
    for (int lane = begin; lane < end; ++lane) sk_words[word + lane] = sk_to_word(v[lane]);
  }
}

//// unpackTexels
layout(std430, binding = 0) readonly buffer sk_staging { uint sk_words[]; };
layout(std430, binding = 0) readonly buffer sk_staged_vectors { uvec4 sk_vectors[]; };
layout(SK_FORMAT) uniform SK_IMAGE sk_texels;

void sk_copy(ivec2 texel, int word, int count, int begin, int end) {
  SK_VECTOR v = SK_VECTOR(0);
  if (sk_lane_bits == 0) {
    for (int c = 0; c < sk_channels; ++c) v[c] = sk_from_word(sk_words[word + c * count]);
  } else if (sk_is_vector(word, begin, end)) {
    v = sk_from_word(sk_vectors[word >> 2]);
  } else {
    if (end - begin < 4) v = imageLoad(sk_texels, sk_place(texel));
    for (int lane = begin; lane < end; ++lane) v[lane] = sk_from_word(sk_words[word + lane]);
  }
  imageStore(sk_texels, sk_place(texel), v);
}

//// stagingMain
void main() {
  ivec4 origin = sk_origin[gl_WorkGroupID.y], extent = sk_extent[gl_WorkGroupID.y];
  int count = extent.x * extent.y * extent.z * extent.w, step = int(gl_NumWorkGroups.x) * 64;
  ivec2 texel;
  int x, row;
  for (int n = int(gl_GlobalInvocationID.x); sk_find(origin, extent, n, texel, x, row); n += step) {
    int begin = max(origin.x - x, 0), end = min(origin.x + extent.x - x, 1 << sk_lane_bits);
    sk_copy(texel, sk_first[gl_WorkGroupID.y] + row + x, count, begin, end);
  }
}
