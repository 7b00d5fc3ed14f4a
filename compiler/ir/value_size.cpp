// SPDX-License-Identifier: MIT
#include "ir/value_size.hpp"

namespace skc::ir {

std::uint64_t numbersIn(const Module& module, Type type) {
  switch (type.kind) {
    case Type::Kind::Void: return 0;
    case Type::Kind::Scalar:
    case Type::Kind::Vector: return type.width;
    case Type::Kind::Matrix: return std::uint64_t{type.width} * type.width;
    case Type::Kind::Struct: {
      std::uint64_t sum = 0;
      for (const StructField& field : module.structs[type.index].fields) sum += numbersIn(module, field.type);
      return sum;
    }
    case Type::Kind::Array: {
      const Array& array = module.arrays[type.index];
      return array.length * numbersIn(module, array.element);
    }
  }
  return 0;
}

}  // namespace skc::ir
