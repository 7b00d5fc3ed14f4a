// SPDX-License-Identifier: MIT
//
// Tunes the C library's heap for software renderers.
#pragma once

namespace sk {

/// Makes glibc keep free memory at the end of the heap instead of returning it to the system. llvmpipe
/// allocates tens of KiB for each draw whose uniforms have changed, and frees them after drawing. By default,
/// glibc trims the heap from 128 KiB on, so that every draw faults in new pages, which takes several times as
/// long as the rest of a call. When a program frees a large block, glibc raises the limit to twice the
/// block's size (mallopt(3), M_TRIM_THRESHOLD): this function frees one whose pages were never touched. It
/// has no effect with other C libraries, or if MALLOC_TRIM_THRESHOLD_ or mallopt() sets the limit.
void keepHeap() noexcept;

}  // namespace sk
