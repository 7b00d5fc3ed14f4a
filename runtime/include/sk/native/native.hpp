// SPDX-License-Identifier: MIT
//
// All that the native code in a generated .sk.cpp stands on. Applications have no use for it.
#pragma once

#include <tuple>

// A kernel of any name may be in front of these.
#if defined(__GNUC__)
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wshadow"
#endif

#include "sk/native/exact.hpp"
#include "sk/native/fold.hpp"
#include "sk/native/gather.hpp"
#include "sk/native/hot.hpp"
#include "sk/native/intrinsics.hpp"
#include "sk/native/lanes.hpp"
#include "sk/native/lanes_intrinsics.hpp"
#include "sk/native/lanes_memory.hpp"
#include "sk/native/run.hpp"
#include "sk/native/streams.hpp"

#if defined(__GNUC__)
#pragma GCC diagnostic pop
#endif

// Vectors of lanes are passed between functions of a stub alone, which become one, so that no ABI has a say in it.
#if defined(__GNUC__)
#pragma GCC diagnostic ignored "-Wpsabi"
#endif
