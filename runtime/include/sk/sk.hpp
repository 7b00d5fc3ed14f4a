// SPDX-License-Identifier: MIT
//
// The public API of StreamKernel: devices, streams, element types and errors. Kernels are declared in the
// headers that `skc` generates.
#pragma once

#include "sk/algorithm.hpp"
#include "sk/arithmetic.hpp"
#include "sk/device.hpp"
#include "sk/error.hpp"
#include "sk/iter.hpp"
#include "sk/limits.hpp"
#include "sk/loop.hpp"
#include "sk/rows.hpp"
#include "sk/scalar.hpp"
#include "sk/shape.hpp"
#include "sk/stream.hpp"
#include "sk/table.hpp"
#include "sk/types.hpp"
