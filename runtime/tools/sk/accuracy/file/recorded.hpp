// SPDX-License-Identifier: MIT
//
// The option --inputs: arguments that a program has recorded in a .npz file (support/npz.hpp). Its arrays are named after kernels and
// parameters:
//
//   heat::diffuse/u         a stream: its shape, then the components of a vector or a matrix
//   heat::diffuse/body.mass a member of a stream of structs
//   heat::diffuse/k         a uniform: the same without a shape; of an array, its length comes first; of an iterator, its two ends do
//   heat::diffuse/v.shape   the shape of an output, int64
#pragma once

#include <filesystem>
#include <map>
#include <set>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "accuracy/file/inputs.hpp"
#include "accuracy/file/kernel_library.hpp"
#include "support/npz.hpp"

namespace sk_tool {

class RecordedInputs {
 public:
  /// Throws sk::Error if the file cannot be read.
  explicit RecordedInputs(const std::filesystem::path& file);

  /// Throws std::runtime_error if the file has no inputs for any of the subjects.
  void check(std::span<const Subject> subjects) const;
  /// Whether it has inputs for a kernel of this name.
  bool has(const std::string& kernel) const { return parametersOf_.contains(kernel); }
  /// Says that it has none, and names the kernel whose name is most similar.
  std::string lackOf(const std::string& kernel) const;
  /// The inputs of one call. Throws std::runtime_error, which names the array, if one is missing, is of no parameter, or has another
  /// type or shape than its parameter.
  Inputs of(const Subject& subject) const;

 private:
  const std::string file_;
  std::map<std::string, sk::npy::NpzArray, std::less<>> arrays_;
  std::map<std::string, std::set<std::string>, std::less<>>
      parametersOf_;  ///< what follows a kernel's name in those of arrays
};

}  // namespace sk_tool
