// SPDX-License-Identifier: MIT
//
// Sinks of random kernels: variable outputs, which are pushed to, and scatter outputs, which are written at computed
// indices by one operation. What they hold is exact: floats are only stored, or compared.
#pragma once

#include <string>

#include "kernels/expressions.hpp"
#include "kernels/model.hpp"
#include "random.hpp"

namespace fuzz {

using sk::program::ScatterOp;

/// No extent of a scatter output is smaller, and most indices lie within.
inline constexpr int leastScattered = 8;

struct Sink {
  std::string name;
  Type type;
  int stream = 0;  ///< into Frame::sinks
  int rank = 0;  ///< of a scatter output; 0: pushed to
  ScatterOp op = ScatterOp::Store;
};

/// An operation that elements of the type take.
ScatterOp randomScatterOp(const Type& type, Random& random);

/// `push(r, v);`, `r[i] = v;`, `r[i] += v;`, `r[i] = min(r[i], v);` ...
Statement writeTo(const Sink& sink, Expressions& expressions, const Records& records, Random& random,
                  const std::string& indent);

}  // namespace fuzz
