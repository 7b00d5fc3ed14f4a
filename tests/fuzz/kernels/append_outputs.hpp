// SPDX-License-Identifier: MIT
//
// Variable and scatter outputs of random kernels. Each scatter output is written at computed indices by one operation.
// Their elements are exact: floats are only stored or compared.
#pragma once

#include <string>

#include "kernels/expressions.hpp"
#include "kernels/model.hpp"
#include "random.hpp"

namespace fuzz {

using sk::program::ScatterOp;

/// The smallest extent of a scatter output; most indices are below it.
inline constexpr int leastScattered = 8;

struct AppendOutput {
  std::string name;
  Type type;
  int stream = 0;  ///< index into Frame::appendOutputs
  int rank = 0;  ///< rank of a scatter output; 0 for a variable output
  ScatterOp op = ScatterOp::Store;
};

/// A random operation that the type allows.
ScatterOp randomScatterOp(const Type& type, Random& random);

/// `push(r, v);`, `r[i] = v;`, `r[i] += v;`, `r[i] = min(r[i], v);` ...
Statement writeTo(const AppendOutput& output, Expressions& expressions, const Records& records,
                  Random& random, const std::string& indent);

}  // namespace fuzz
