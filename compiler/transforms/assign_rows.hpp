// SPDX-License-Identifier: MIT
//
// assign-rows: writes to a part of a matrix's row at a computed index go through a variable, which is then
// assigned to the whole row.
//
//   m[i].x = 1.0;        float3 m_row = m[i];
//                        m_row.x = 1.0;
//                        m[i] = m_row;
//
// It preserves the meaning of kernels. NVIDIA's GLSL compiler (seen on an H100) loses the write on the left
// if the same function reads a component at two computed indices, `m[i][j]`; it keeps writes of whole rows.
#pragma once

#include "ir/ir.hpp"
#include "support/diagnostics.hpp"

namespace skc {

void assignRows(ir::Module& module, Diagnostics& diagnostics);

}  // namespace skc
