// SPDX-License-Identifier: MIT
//
// The inputs of each kernel's worst call, for `sk accuracy FILE.sk --inputs FILE.npz`. The file has an array for each parameter:
// "heat::diffuse/u", and for each output its shape: "heat::diffuse/v.shape".
#pragma once

#include <cstddef>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "sk/program.hpp"
#include "sk/shape.hpp"
#include "support/npy_header.hpp"

namespace sk::shadow {

/// The inputs of one call.
class RecordedInputs {
 public:
  /// Adds elements as they are in host memory. A value has a shape without dimensions.
  void add(std::string_view parameter, const program::Element& element, const Shape& shape,
           const std::byte* elements);
  /// Adds the shape of an output.
  void addShape(std::string_view parameter, const Shape& shape);

  struct Array {
    std::string name;  ///< behind the kernel's
    npy::NpyArray array;
    std::vector<std::byte> elements;
  };
  const std::vector<Array>& arrays() const { return arrays_; }

 private:
  std::vector<Array> arrays_;
};

/// The most bytes of one call's inputs that are kept.
inline constexpr std::int64_t mostRecordedBytes = std::int64_t{64} << 20;

/// Whether the elements can be written: not those with arrays in them.
bool isRecordable(const program::Element& element);

/// Writes the inputs of all kernels, by name. Returns what went wrong; empty if nothing did.
std::string writeInputs(const std::string& file, const std::map<std::string, RecordedInputs>& kernels);

}  // namespace sk::shadow
