// SPDX-License-Identifier: MIT
//
// assign-rows: writes to a part of a matrix's row go through a variable, which is then assigned to the whole row, if the row's
// index, or that of the matrix in an array, is computed.
//
//   m[i].x = 1.0;        float3 m_row = m[i];
//                        m_row.x = 1.0;
//                        m[i] = m_row;
//
// It preserves the meaning of kernels. NVIDIA's GLSL compiler (seen on an H100) loses the write on the left
// if the same function reads a component at two computed indices, `m[i][j]`, and stores `a[i][1].x = 1.0` in an array of
// matrices outside of the program's memory (580, seen on an H200); it keeps writes of whole rows.
#pragma once

#include "ir/ir.hpp"
#include "support/diagnostics.hpp"

namespace skc {

void assignRows(ir::Module& module, Diagnostics& diagnostics);

}  // namespace skc
