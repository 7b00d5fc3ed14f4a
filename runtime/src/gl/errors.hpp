// SPDX-License-Identifier: MIT
//
// GL's error flags. They are read where something can fail for want of memory and where results
// arrive, never on the path of a call.
#pragma once

#include <epoxy/gl.h>

namespace sk::gl {

/// The first pending error; clears all of them. Ends even on a lost context, which never runs dry.
GLenum takeError();
inline void dropErrors() { (void)takeError(); }

/// "GL_OUT_OF_MEMORY"
const char* errorName(GLenum error);

}  // namespace sk::gl
