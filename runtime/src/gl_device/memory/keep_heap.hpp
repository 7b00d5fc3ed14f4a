// SPDX-License-Identifier: MIT
//
// What a software renderer needs of the C library's heap.
#pragma once

namespace sk {

/// llvmpipe takes tens of KiB from the heap for each draw whose uniforms differ from those before, and gives them back when
/// it has drawn. glibc returns what is free at the heap's end to the system from 128 KiB on, so that every draw gets new
/// pages, which costs several times what the rest of a call does. From the first large block on that a program frees, it
/// keeps more: twice as much as this was (mallopt(3), M_TRIM_THRESHOLD). So one is freed, of which no page was ever there.
/// Where MALLOC_TRIM_THRESHOLD_ or mallopt() says how much to keep, and in other C libraries, this does nothing.
void keepHeap() noexcept;

}  // namespace sk
