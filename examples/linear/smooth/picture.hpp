// SPDX-License-Identifier: MIT
//
// Surfaces as shaded pictures, drawn on the host by a depth buffer.
#pragma once

#include "support/image.hpp"
#include "surface.hpp"

namespace smooth {

/// Seen from the front and above, as large as `frame` fills a picture of size x size; one brightness for each face, so that noise is seen.
examples::Image pictureOf(const Surface& surface, const Surface& frame, int size);

}  // namespace smooth
