// SPDX-License-Identifier: MIT
//
// Sums over a work group of 256 invocations, in the order of gl_LocalInvocationIndex (W. Hillis and G. Steele, "Data
// parallel algorithms", 1986).

//// groupSums
shared uint sk_partial_sums[256];

// The sum of the values of all invocations before this one; sk_sum becomes that of all. All invocations must call it.
uint sk_sums_before(uint sk_value, out uint sk_sum) {
  uint sk_i = gl_LocalInvocationIndex;
  uint sk_through = sk_value;
  sk_partial_sums[sk_i] = sk_through;
  for (uint sk_s = 1u; sk_s < 256u; sk_s *= 2u) {
    memoryBarrierShared();
    barrier();
    uint sk_left = sk_i >= sk_s ? sk_partial_sums[sk_i - sk_s] : 0u;
    memoryBarrierShared();
    barrier();
    sk_through += sk_left;
    sk_partial_sums[sk_i] = sk_through;
  }
  memoryBarrierShared();
  barrier();
  sk_sum = sk_partial_sums[255];
  memoryBarrierShared();
  barrier();
  return sk_through - sk_value;
}
