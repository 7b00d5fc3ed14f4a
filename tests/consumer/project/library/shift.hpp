// SPDX-License-Identifier: MIT
//
// What the library offers.
#pragma once

/// value + 0.5, computed on a device.
float shifted(float value);
