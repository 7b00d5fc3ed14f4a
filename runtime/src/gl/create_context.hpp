// SPDX-License-Identifier: MIT
//
// Making a context without a window on one EGL display.
#pragma once

#include <optional>
#include <string>

#include "gl/context.hpp"

namespace sk::gl {

/// A context of the highest version that an initialised display gives: core GL from 3.3, or ES from
/// 3.0. Where there is none, `why` says so. It is not made current.
std::optional<Context> createContext(EGLDisplay display, Api api, std::string& why);

}  // namespace sk::gl
