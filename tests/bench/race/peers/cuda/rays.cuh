// SPDX-License-Identifier: MIT
//
// Rays through hierarchies of boxes, as one writes them in CUDA: the algorithms of examples/applications/rays, with the watertight test of Woop, Benthin and
// Wald (2013) in each. Two children to a node, or eight whose boxes are bytes.
#pragma once

#include "rays_layout.hpp"

namespace race {
namespace {

struct CudaRay {
  float3 origin, direction, inverse, shear;
  float least;
  int axis;
};

struct CudaHit {
  float t;
  int id;
};

constexpr float beyond = 3e38f;

__device__ float3 operator-(float3 a, float3 b) { return make_float3(a.x - b.x, a.y - b.y, a.z - b.z); }
__device__ float3 firstThree(float4 a) { return make_float3(a.x, a.y, a.z); }
__device__ int numberIn(float f) { return __float_as_int(f) - rayIntBias; }
__device__ float3 permuted(float3 v, int axis) {
  return axis == 0 ? make_float3(v.y, v.z, v.x) : axis == 1 ? make_float3(v.z, v.x, v.y) : v;
}
__device__ float boxInverse(float d) { return 1 / (fabsf(d) < 0x1p-80f ? (d < 0 ? -0x1p-80f : 0x1p-80f) : d); }

__device__ CudaRay prepared(float4 from, float4 along) {
  CudaRay r;
  r.origin = firstThree(from);
  r.direction = firstThree(along);
  r.least = from.w;
  r.inverse = make_float3(boxInverse(along.x), boxInverse(along.y), boxInverse(along.z));
  const float x = fabsf(along.x), y = fabsf(along.y), z = fabsf(along.z);
  r.axis = x >= y && x >= z ? 0 : y >= z ? 1 : 2;
  const float3 d = permuted(r.direction, r.axis);
  r.shear = make_float3(d.x / d.z, d.y / d.z, 1 / d.z);
  return r;
}

/// Sides of an edge: 0 where rounding could have the wrong sign.
__device__ float edgeOf(float a, float b, float c, float d) {
  const float p = a * d, q = b * c, e = p - q;
  return fabsf(e) <= 0x1p-22f * (fabsf(p) + fabsf(q)) ? 0 : e;
}
__device__ float exactEdge(float a, float b, float c, float d) {
  return static_cast<float>(double(a) * double(d) - double(b) * double(c));
}

__device__ void testTriangle(const CudaRay& r, const float4* shapes, int shape, CudaHit& best) {
  const float4 first = __ldg(shapes + 3 * shape);
  const float3 a = permuted(firstThree(first) - r.origin, r.axis);
  const float3 b = permuted(firstThree(__ldg(shapes + 3 * shape + 1)) - r.origin, r.axis);
  const float3 c = permuted(firstThree(__ldg(shapes + 3 * shape + 2)) - r.origin, r.axis);
  const float ax = a.x - r.shear.x * a.z, ay = a.y - r.shear.y * a.z;
  const float bx = b.x - r.shear.x * b.z, by = b.y - r.shear.y * b.z;
  const float cx = c.x - r.shear.x * c.z, cy = c.y - r.shear.y * c.z;
  float u = edgeOf(cx, cy, bx, by), v = edgeOf(ax, ay, cx, cy), w = edgeOf(bx, by, ax, ay);
  if (u == 0 || v == 0 || w == 0) {
    u = exactEdge(cx, cy, bx, by);
    v = exactEdge(ax, ay, cx, cy);
    w = exactEdge(bx, by, ax, ay);
  }
  if ((u < 0 || v < 0 || w < 0) && (u > 0 || v > 0 || w > 0)) return;
  const float sum = u + v + w;
  if (sum == 0) return;
  const float t = (u * a.z + v * b.z + w * c.z) * r.shear.z / sum;
  const int id = numberIn(first.w);
  if (t >= r.least && (t < best.t || (t == best.t && id < best.id))) best = {t, id};
}

__device__ void testLeaf(const CudaRay& r, const float4* shapes, int leaf, CudaHit& best) {
  const int first = leaf >> 3, end = first + (leaf & 7);
  for (int shape = first; shape < end; ++shape) testTriangle(r, shapes, shape, best);
}

__device__ float entryOf(const CudaRay& r, float4 low, float4 high, float most) {
  const float ax = (low.x - r.origin.x) * r.inverse.x, bx = (high.x - r.origin.x) * r.inverse.x;
  const float ay = (low.y - r.origin.y) * r.inverse.y, by = (high.y - r.origin.y) * r.inverse.y;
  const float az = (low.z - r.origin.z) * r.inverse.z, bz = (high.z - r.origin.z) * r.inverse.z;
  const float from = fmaxf(fmaxf(fminf(ax, bx), fminf(ay, by)), fmaxf(fminf(az, bz), r.least));
  const float to = fminf(fminf(fmaxf(ax, bx), fmaxf(ay, by)), fminf(fmaxf(az, bz), most));
  return from <= to + 0x1p-20f * fabsf(to) ? from : beyond;
}

__device__ int nodeIn(float4 low, float4 high) {
  const int first = numberIn(low.w), count = numberIn(high.w);
  return count > 0 ? -(8 * first + count) : first;
}

__device__ void store(float* hits, std::int64_t n, std::int64_t i, const CudaHit& best) {
  hits[i] = static_cast<float>(best.id);
  hits[n + i] = best.id < 0 ? -1.0f : best.t;
}

__global__ void nearestByPairs(const float4* from, const float4* along, const float4* nodes, const float4* shapes, float* hits,
                               std::int64_t n) {
  const std::int64_t i = std::int64_t{blockIdx.x} * blockDim.x + threadIdx.x;
  if (i >= n) return;
  const CudaRay r = prepared(from[i], along[i]);
  CudaHit best = {along[i].w, -1};
  int stack[32];
  int top = 0, node = nodeIn(nodes[0], nodes[1]);
  bool goesOn = entryOf(r, nodes[0], nodes[1], best.t) < beyond;
  while (goesOn) {
    bool pops = false;
    if (node >= 0) {
      const float4 low0 = __ldg(nodes + 2 * node), high0 = __ldg(nodes + 2 * node + 1);
      const float4 low1 = __ldg(nodes + 2 * node + 2), high1 = __ldg(nodes + 2 * node + 3);
      const float t0 = entryOf(r, low0, high0, best.t), t1 = entryOf(r, low1, high1, best.t);
      const int node0 = nodeIn(low0, high0), node1 = nodeIn(low1, high1);
      node = t1 < t0 ? node1 : node0;
      if (fmaxf(t0, t1) < beyond) stack[top++] = t1 < t0 ? node0 : node1;
      pops = fminf(t0, t1) == beyond;
    } else {
      testLeaf(r, shapes, -node, best);
      pops = true;
    }
    if (pops) {
      goesOn = top > 0;
      if (goesOn) node = stack[--top];
    }
  }
  store(hits, n, i, best);
}

__device__ unsigned byteOf(int word, int k) { return static_cast<unsigned>(word) >> (8 * k) & 255u; }

__device__ int meetFour(const float3& slope, const float3& start, float least, float most, const int* nears, const int* fars) {
  int met = 0;
#pragma unroll
  for (int k = 0; k < 4; ++k) {
    const float ax = byteOf(nears[0], k) * slope.x + start.x, bx = byteOf(fars[0], k) * slope.x + start.x;
    const float ay = byteOf(nears[1], k) * slope.y + start.y, by = byteOf(fars[1], k) * slope.y + start.y;
    const float az = byteOf(nears[2], k) * slope.z + start.z, bz = byteOf(fars[2], k) * slope.z + start.z;
    const float from = fmaxf(fmaxf(ax, ay), fmaxf(az, least)), to = fminf(fminf(bx, by), fminf(bz, most));
    if (from <= to + 0x1p-19f * fabsf(to)) met |= 1 << k;
  }
  return met;
}

__device__ int meetNode(const CudaRay& r, int octant, float most, int node, const int4* wide) {
  const int4 head = __ldg(wide + 4 * node), a = __ldg(wide + 4 * node + 1), b = __ldg(wide + 4 * node + 2), c = __ldg(wide + 4 * node + 3);
  const float3 slope = make_float3(__int_as_float(byteOf(head.w, 0) << 23) * r.inverse.x, __int_as_float(byteOf(head.w, 1) << 23) * r.inverse.y,
                                   __int_as_float(byteOf(head.w, 2) << 23) * r.inverse.z);
  const float3 start = make_float3((__int_as_float(head.x) - r.origin.x) * r.inverse.x, (__int_as_float(head.y) - r.origin.y) * r.inverse.y,
                                   (__int_as_float(head.z) - r.origin.z) * r.inverse.z);
  const bool x = octant & 1, y = octant & 2, z = octant & 4;
  int met = 0;
  const int low[2][3] = {{a.x, a.z, b.x}, {a.y, a.w, b.y}}, high[2][3] = {{b.z, c.x, c.z}, {b.w, c.y, c.w}};
#pragma unroll
  for (int half = 0; half < 2; ++half) {
    const int nears[3] = {x ? high[half][0] : low[half][0], y ? high[half][1] : low[half][1], z ? high[half][2] : low[half][2]};
    const int fars[3] = {x ? low[half][0] : high[half][0], y ? low[half][1] : high[half][1], z ? low[half][2] : high[half][2]};
    met |= meetFour(slope, start, r.least, most, nears, fars) << (4 * half);
  }
  if (x) met = (met & 0x55) << 1 | (met >> 1 & 0x55);
  if (y) met = (met & 0x33) << 2 | (met >> 2 & 0x33);
  if (z) met = (met & 0x0f) << 4 | met >> 4;
  return node << 8 | met;
}

__global__ void nearestByEights(const float4* from, const float4* along, const int4* wide, const int* children, const float4* shapes,
                                float* hits, std::int64_t n) {
  const std::int64_t i = std::int64_t{blockIdx.x} * blockDim.x + threadIdx.x;
  if (i >= n) return;
  const CudaRay r = prepared(from[i], along[i]);
  CudaHit best = {along[i].w, -1};
  const int octant = (r.inverse.x < 0 ? 1 : 0) | (r.inverse.y < 0 ? 2 : 0) | (r.inverse.z < 0 ? 4 : 0);
  int stack[32];
  int top = 0, group = meetNode(r, octant, best.t, 0, wide);
  for (;;) {
    if ((group & 255) == 0) {
      if (top == 0) break;
      group = stack[--top];
    }
    const int slot = (__ffs(group & 255) - 1) ^ octant;
    const int child = __ldg(children + 8 * (group >> 8) + slot);
    group &= group - 1;
    if (child < 0) {
      testLeaf(r, shapes, -child, best);
    } else {
      if ((group & 255) != 0) stack[top++] = group;
      group = meetNode(r, octant, best.t, child, wide);
    }
  }
  store(hits, n, i, best);
}

/// A kernel over all rays of a problem.
class RayTask final : public Task {
 public:
  RayTask(const Problem& p, bool byEights)
      : n_(p.size()),
        byEights_(byEights),
        from_(p.floats[rayOrigins]),
        along_(p.floats[rayDirections]),
        nodes_(p.floats[rayNodes]),
        shapes_(p.floats[rayShapes]),
        wide_(p.ints[rayWideNodes]),
        children_(p.ints[rayWideChildren]),
        hits_(2 * sizeOf(p)) {}

  void run(int times) override {
    constexpr int threads = 128;
    const auto blocks = static_cast<unsigned>((n_ + threads - 1) / threads);
    const auto *from = reinterpret_cast<const float4*>(from_.data()), *along = reinterpret_cast<const float4*>(along_.data());
    const auto* shapes = reinterpret_cast<const float4*>(shapes_.data());
    for (int k = 0; k < times; ++k) {
      if (byEights_)
        nearestByEights<<<blocks, threads>>>(from, along, reinterpret_cast<const int4*>(wide_.data()), children_.data(), shapes,
                                             hits_.data(), n_);
      else
        nearestByPairs<<<blocks, threads>>>(from, along, reinterpret_cast<const float4*>(nodes_.data()), shapes, hits_.data(), n_);
    }
    check(cudaGetLastError());
    check(cudaDeviceSynchronize());
  }
  std::vector<float> result() override { return hits_.read(); }

 private:
  std::int64_t n_;
  bool byEights_;
  Array<float> from_, along_, nodes_, shapes_;
  Array<std::int32_t> wide_, children_;
  Array<float> hits_;
};

void addRays(std::vector<Contender>& contenders) {
  for (const char* program : rayPrograms) {
    contenders.push_back({program, "CUDA", [](const Problem& p) { return std::make_unique<RayTask>(p, false); }});
    contenders.push_back({program, "CUDA eight-wide", [](const Problem& p) { return std::make_unique<RayTask>(p, true); }});
  }
}

}  // namespace
}  // namespace race
