// SPDX-License-Identifier: MIT
//
// The public face of StreamKernel: devices, streams, element types, errors. Kernels come from the
// headers that `skc` writes.
#pragma once

#include "sk/arithmetic.hpp"
#include "sk/device.hpp"
#include "sk/error.hpp"
#include "sk/iter.hpp"
#include "sk/limits.hpp"
#include "sk/shape.hpp"
#include "sk/stream.hpp"
#include "sk/table.hpp"
#include "sk/types.hpp"
