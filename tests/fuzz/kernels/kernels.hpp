// SPDX-License-Identifier: MIT
//
// Random kernels: the text of a program, its arguments, and the results that it must compute.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "kernels/expressions.hpp"
#include "kernels/model.hpp"
#include "kernels/types.hpp"
#include "random.hpp"

namespace fuzz {

using Role = sk::program::Role;

struct Parameter {
  Role role;
  Variable variable;             ///< a gather uses only its name and type
  std::vector<Value>
      values;     ///< for a uniform, one per element of its array; for an iterator, its begin and step
};

class RandomKernel {
 public:
  RandomKernel(std::uint64_t seed, std::uint64_t number);
  RandomKernel(const RandomKernel&) = delete;
  RandomKernel& operator=(const RandomKernel&) = delete;

  const std::string& text() const { return text_; }
  const Records& records() const { return records_; }
  const std::vector<Parameter>& parameters() const { return parameters_; }
  const std::vector<std::int64_t>& domain() const { return domain_; }
  /// One per parameter: the elements of inputs, gathers and scatter outputs before the call; empty for others.
  const std::vector<HostStream>& streams() const { return streams_; }

  /// One per parameter: the expected elements of outputs; empty for others.
  std::vector<HostStream> results() const;

 private:
  class Generator;

  Records records_;
  std::vector<Parameter> parameters_;
  std::vector<std::int64_t> domain_;
  std::vector<HostStream> streams_;
  std::vector<std::pair<int, Value>> constants_;  ///< slots and values of global constants
  std::function<Flow(Frame&)> body_;
  int slots_ = 0;
  std::string text_;
};

}  // namespace fuzz
