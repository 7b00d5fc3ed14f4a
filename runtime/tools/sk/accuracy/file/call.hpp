// SPDX-License-Identifier: MIT
//
// A kernel or reduction with its arguments on a device, ready to be called. It neither draws inputs nor
// judges results.
#pragma once

#include <vector>

#include "accuracy/file/inputs.hpp"
#include "sk/device.hpp"

namespace sk_tool {

/// A scalar component of a result.
struct ResultScalar {
  std::string name;  ///< "r.x"
  sk::program::Scalar scalar;
};
std::vector<ResultScalar> resultScalars(const Subject& subject);

/// The results of a call: for each of resultScalars(), its values in all results, row-major.
using Results = std::vector<std::vector<double>>;

class Call {
 public:
  /// Creates the streams and writes the inputs, which must outlive this object. Throws sk::Error if memory is
  /// exhausted.
  Call(sk::Device& device, const Subject& subject, const Inputs& inputs);

  /// Runs with the host values of one draw. Throws sk::Error.
  void run(const sk::CallOptions& options, int draw);
  /// The results of the last run.
  Results results() const;
  /// The results of a __float128 reference device, with reals rounded to double.
  Results exactResults() const;

 private:
  const Subject& subject_;
  const Inputs& inputs_;
  std::vector<sk::detail::StreamOwner> streams_;  ///< one per parameter, null for host values
};

}  // namespace sk_tool
