// SPDX-License-Identifier: MIT
//
// forward-continues: makes a `continue` in nested switches leave one switch at a time. Drivers take it for
// the outer switch's break, or run the step of a `for` once too often (Mesa 22.3).
//
//   for (int i = 0; i < n; ++i) {            for (int i = 0; i < n; ++i) {
//     switch (a) {                             switch (a) {
//       case 0: {                                case 0: {
//                                                  bool continues = false;
//         switch (b) {                             switch (b) {
//           case 1: continue;                        case 1: { continues = true; break; }
//         }                                        }
//                                                  if (continues) continue;
//         r = 0;                                   r = 0;
//       }                                        }
//     }                                        }
//   }                                        }
#pragma once

#include "ir/ir.hpp"
#include "support/diagnostics.hpp"

namespace skc {

void forwardContinues(ir::Module& module, Diagnostics& diagnostics);

}  // namespace skc
