// SPDX-License-Identifier: MIT
#include "unloading/three.sk.hpp"

#include "library.hpp"
