// SPDX-License-Identifier: MIT
//
// The library's interface.
#pragma once

/// value + 0.5, computed on a device.
float shifted(float value);
