// SPDX-License-Identifier: MIT
//
// A kernel or reduce with its arguments on a device, ready to be called. Nothing is drawn or judged here.
#pragma once

#include <vector>

#include "accuracy/file/inputs.hpp"
#include "sk/device.hpp"

namespace sk_tool {

/// A scalar of a result.
struct ResultScalar {
  std::string name;  ///< "r.x"
  sk::program::Scalar scalar;
};
std::vector<ResultScalar> resultScalars(const Subject& subject);

/// Results of a call: for each of resultScalars(), that of each result, row-major.
using Results = std::vector<std::vector<double>>;

class Call {
 public:
  /// Makes the streams and writes the inputs. Throws sk::Error where the device has no room. The inputs must outlive it.
  Call(sk::Device& device, const Subject& subject, const Inputs& inputs);

  /// With the host values of one draw. Throws sk::Error.
  void run(const sk::CallOptions& options, int draw);
  /// Of the last run.
  Results results() const;
  /// The same of a reference device in __float128, whose reals are rounded to doubles.
  Results exactResults() const;

 private:
  const Subject& subject_;
  const Inputs& inputs_;
  std::vector<sk::detail::StreamOwner> streams_;  ///< one a parameter, null for host values
};

}  // namespace sk_tool
