// SPDX-License-Identifier: MIT
//
// The programs that copy a box of a stream's plane to words of a buffer, and back (transfer/staging_program.hpp). An
// invocation takes a texel: an element, or the elements of the box among the four of a packed texel.

//// stagingHead
layout(local_size_x = 64) in;

uniform ivec4 sk_origin, sk_extent;  // the box in its stream, x first
uniform ivec4 sk_stride;             // of the stream, if it is linearised
uniform int sk_shift;                // log2 of the texture's width; -1: the stream is a plane
uniform int sk_lane_bits;            // log2 of the elements of a texel
uniform int sk_channels;             // of an element
uniform int sk_first;                // word of the box

#ifdef SK_LAYERED
ivec3 sk_place(ivec2 p) { return ivec3(p.x, p.y & ((1 << sk_shift) - 1), p.y >> sk_shift); }
#else
ivec2 sk_place(ivec2 p) { return p; }
#endif

// Finds the invocation's texel, the first of its elements in x, and the row's first word. False if there is no such texel.
bool sk_find(out ivec2 texel, out int x, out int row) {
  int first = sk_origin.x >> sk_lane_bits;
  int texels = ((sk_origin.x + sk_extent.x - 1) >> sk_lane_bits) - first + 1;
  int n = int(gl_GlobalInvocationID.y * gl_NumWorkGroups.x * 64u + gl_GlobalInvocationID.x);
  int number = n / texels;
  int column = first + n - number * texels;
  int plane = number / sk_extent.y;
  ivec3 outer = ivec3(number - plane * sk_extent.y, plane % sk_extent.z, plane / sk_extent.z) + sk_origin.yzw;
  x = column << sk_lane_bits;
  row = sk_first + number * sk_extent.x - sk_origin.x;
  if (sk_shift < 0) {
    texel = ivec2(column, outer.x);
  } else {
    int at = (x * sk_stride.x + outer.x * sk_stride.y + outer.y * sk_stride.z + outer.z * sk_stride.w) >> sk_lane_bits;
    texel = ivec2(at & ((1 << sk_shift) - 1), at >> sk_shift);
  }
  return number < sk_extent.y * sk_extent.z * sk_extent.w;
}

int sk_count() { return sk_extent.x * sk_extent.y * sk_extent.z * sk_extent.w; }
// Whether the words of a packed texel are a vector of the buffer. Single words of host memory take a transaction each.
bool sk_is_vector(int x, int row) {
  return x >= sk_origin.x && x + 4 <= sk_origin.x + sk_extent.x && ((row + x) & 3) == 0;
}
bool sk_is_inside(int x) { return x >= sk_origin.x && x < sk_origin.x + sk_extent.x; }

//// packTexels
layout(std430, binding = 0) writeonly buffer sk_staging { uint sk_words[]; };
layout(std430, binding = 0) writeonly buffer sk_staged_vectors { uvec4 sk_vectors[]; };
uniform highp SK_SAMPLER sk_texels;

void main() {
  ivec2 texel;
  int x, row;
  if (!sk_find(texel, x, row)) return;
  SK_VECTOR v = texelFetch(sk_texels, sk_place(texel), 0);
  if (sk_lane_bits == 0) {
    for (int c = 0; c < sk_channels; ++c) sk_words[row + x + c * sk_count()] = sk_to_word(v[c]);
  } else if (sk_is_vector(x, row)) {
    sk_vectors[(row + x) >> 2] = sk_to_word(v);
  } else {
    for (int lane = 0; lane < 4; ++lane) {
      if (sk_is_inside(x + lane)) sk_words[row + x + lane] = sk_to_word(v[lane]);
    }
  }
}

//// unpackTexels
layout(std430, binding = 0) readonly buffer sk_staging { uint sk_words[]; };
layout(std430, binding = 0) readonly buffer sk_staged_vectors { uvec4 sk_vectors[]; };
layout(SK_FORMAT) uniform SK_IMAGE sk_texels;

void main() {
  ivec2 texel;
  int x, row;
  if (!sk_find(texel, x, row)) return;
  SK_VECTOR v = SK_VECTOR(0);
  if (sk_lane_bits == 0) {
    for (int c = 0; c < sk_channels; ++c) v[c] = sk_from_word(sk_words[row + x + c * sk_count()]);
  } else if (sk_is_vector(x, row)) {
    v = sk_from_word(sk_vectors[(row + x) >> 2]);
  } else {
    if (!sk_is_inside(x) || !sk_is_inside(x + 3)) v = imageLoad(sk_texels, sk_place(texel));
    for (int lane = 0; lane < 4; ++lane) {
      if (sk_is_inside(x + lane)) v[lane] = sk_from_word(sk_words[row + x + lane]);
    }
  }
  imageStore(sk_texels, sk_place(texel), v);
}
