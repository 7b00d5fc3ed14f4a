// SPDX-License-Identifier: MIT
//
// All that the native code in a generated .sk.cpp stands on. Applications have no use for it.
#pragma once

#include <tuple>

#include "sk/native/exact.hpp"
#include "sk/native/fold.hpp"
#include "sk/native/gather.hpp"
#include "sk/native/hot.hpp"
#include "sk/native/intrinsics.hpp"
#include "sk/native/run.hpp"
#include "sk/native/streams.hpp"
