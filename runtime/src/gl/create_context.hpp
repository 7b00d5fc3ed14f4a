// SPDX-License-Identifier: MIT
//
// Creates contexts without windows on an EGL display.
#pragma once

#include <optional>
#include <string>

#include "gl/context.hpp"

namespace sk::gl {

/// Creates a context of the highest version that an initialised display supports: core GL from 3.3, or ES
/// from 3.0. If it fails, `why` gives the reason. Does not make the context current.
std::optional<Context> createContext(EGLDisplay display, Api api, std::string& why);

}  // namespace sk::gl
