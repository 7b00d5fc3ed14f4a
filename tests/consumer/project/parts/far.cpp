// SPDX-License-Identifier: MIT
//
// A library whose users call its kernels.
#include "parts/far.sk.hpp"

float farthest(const parts::Hit& hit) { return parts::later(hit.t); }
