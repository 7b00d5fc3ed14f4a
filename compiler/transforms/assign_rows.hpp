// SPDX-License-Identifier: MIT
//
// assign-rows: writes to a part of a matrix's row at a computed index go through a variable, and then to
// the whole row.
//
//   m[i].x = 1.0;        float3 m_row = m[i];
//                        m_row.x = 1.0;
//                        m[i] = m_row;
//
// It changes nothing of what a kernel means. NVIDIA's GLSL compiler (seen on an H100) loses the write on the
// left where the same function reads a component at two computed indices, `m[i][j]`; whole rows it keeps.
#pragma once

#include "ir/ir.hpp"
#include "support/diagnostics.hpp"

namespace skc {

void assignRows(ir::Module& module, Diagnostics& diagnostics);

}  // namespace skc
