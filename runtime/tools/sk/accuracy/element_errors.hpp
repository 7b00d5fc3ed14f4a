// SPDX-License-Identifier: MIT
//
// Errors of kernels that compute each element independently.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "accuracy/experiment.hpp"

namespace sk_tool {

/// A named input stream, for reporting the element with the largest error.
struct NamedInput {
  std::string name;
  const std::vector<float>* values;
};

/// Computes the largest relative error, the largest and the mean error in ulp, and how many results are
/// infinite or NaN where the reference is not, or vice versa ("wrong class": these make the relative error
/// infinite and are in no other figure); also the inputs of the largest error, with their bits. References
/// below the smallest normal float count as that number in relative errors.
Grade gradeElements(const std::vector<float>& results, const std::vector<double>& reference,
                    const std::vector<NamedInput>& inputs);

}  // namespace sk_tool
