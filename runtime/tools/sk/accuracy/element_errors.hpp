// SPDX-License-Identifier: MIT
//
// Errors of kernels that compute each element by itself.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "accuracy/experiment.hpp"

namespace sk_tool {

/// An input stream by name, so that the element with the largest error can be told.
struct NamedInput {
  std::string name;
  const std::vector<float>* values;
};

/// The largest relative error, the largest and the mean error in ulp, how many results are infinite or no numbers where they
/// should not be, or the other way round ("wrong class", in none of the others, but the relative error is infinite then),
/// and the inputs of the largest error, also as bits. Numbers of which the reference has fewer than floats can hold count from
/// the smallest normal one on.
Grade gradeElements(const std::vector<float>& results, const std::vector<double>& reference,
                    const std::vector<NamedInput>& inputs);

}  // namespace sk_tool
