// SPDX-License-Identifier: MIT
#include "unloading/seven.sk.hpp"

#include "library.hpp"
