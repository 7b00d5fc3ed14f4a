// SPDX-License-Identifier: MIT
//
// Values of several elements in LLVM IR. A Part is one scalar of a value: an LLVM scalar if it is uniform,
// the scalar of the first lane if it is consecutive, else a vector with one entry per lane. With one lane,
// everything is a scalar. Nothing here knows the IR's statements or streams.
#pragma once

#include <cstdint>
#include <string_view>
#include <vector>

#include <llvm/IR/IRBuilder.h>

#include "ir/type.hpp"
#include "sk/native/code.hpp"

namespace skc::native {

/// One scalar component of a value, in all lanes.
struct Part {
  llvm::Value* value = nullptr;
  bool isConsecutive = false;  ///< `value` is the first lane's; lane i has value + i
};
using Parts = std::vector<Part>;

/// What code is generated for: the number of lanes, the type that represents float, the CPU's features.
struct CodegenOptions {
  std::uint32_t lanes = 1;
  sk::native::Real real = sk::native::Real::Float;
  bool hasMaskRegisters = false;  ///< keeping vectors of bool costs nothing (AVX-512)
  bool convertsHalves = false;  ///< in hardware
  /// If loops read gathers in blocks (block_gathers.hpp): 32-bit scalars per vector register; else 0.
  std::uint32_t blockWidth = 0;
  bool isContracted = false;  ///< products and sums in the source may be fused
  bool holdsFloats = false;  ///< arrays hold the language's floats as floats, whatever `real` is
};

class Lanes {
 public:
  Lanes(llvm::IRBuilder<>& builder, const CodegenOptions& options) : b(builder), options_(options) {}

  llvm::IRBuilder<>& b;
  const CodegenOptions& options() const { return options_; }
  std::uint32_t count() const { return options_.lanes; }

  // ---- types ------------------------------------------------------------------------------------

  /// The type in which a scalar is computed. Narrow scalars have the integer type that represents them in
  /// memory.
  llvm::Type* type(ir::Scalar scalar) const;
  llvm::Type* real() const { return type(ir::Scalar::Float); }
  llvm::Type* int32() const { return b.getInt32Ty(); }
  llvm::Type* int64() const { return b.getInt64Ty(); }
  /// The type of a scalar in the array of a stream or a variable: a byte for a bool.
  llvm::Type* stored(ir::Scalar scalar) const;
  /// The size of stored().
  std::uint32_t storedBytes(ir::Scalar scalar) const;
  /// The vector with one entry per lane, or the scalar type itself if there is a single lane.
  llvm::Type* vector(llvm::Type* scalar) const;
  bool isVector(const llvm::Value* value) const { return value->getType()->isVectorTy(); }
  bool isVarying(const Part& part) const { return isVector(part.value); }
  bool isUniform(const Part& part) const { return !isVector(part.value) && !part.isConsecutive; }
  /// `scalar`, or a vector of it if `like` is a vector.
  llvm::Type* sameShape(const llvm::Value* like, llvm::Type* scalar) const;

  // ---- constants and shapes ---------------------------------------------------------------------

  llvm::Value* constant(ir::Scalar scalar, std::int64_t value) const;
  /// A real constant, rounded to `type`, which may be a vector.
  llvm::Value* number(llvm::Type* type, double value) const;
  llvm::Value* integer(llvm::Type* type, std::int64_t value) const;

  /// 0, 1, 2 ..., one entry per lane.
  llvm::Value* laneNumbers(llvm::Type* integer) const;
  /// The value in each lane: a vector, or a scalar if there is one lane.
  llvm::Value* broadcast(const Part& part) const;
  llvm::Value* broadcast(llvm::Value* scalar) const;
  /// A scalar if the value is uniform, else a vector.
  llvm::Value* value(const Part& part) const { return part.isConsecutive ? broadcast(part) : part.value; }
  /// Turns all parts into vectors unless all are uniform.
  void unify(Part& a, Part& c) const;
  void unify(std::vector<Part*> parts) const;

  /// cond ? yes : no, in each lane.
  Part select(const Part& cond, const Part& yes, const Part& no) const;
  /// True if a bool is true in some lane: an i1.
  llvm::Value* any(const Part& mask) const;
  llvm::Value* lane(llvm::Value* vector, std::uint32_t number) const {
    return b.CreateExtractElement(vector, number);
  }

  /// Applies a function of scalars lane by lane; only once if all parts are uniform.
  Part perLane(const std::vector<Part>& parts, llvm::Type* result,
               llvm::function_ref<llvm::Value*(llvm::ArrayRef<llvm::Value*>)> function) const;
  /// Calls a function of the C library or the like, lane by lane.
  Part callPerLane(std::string_view name, llvm::Type* result, const std::vector<Part>& parts) const;

  // ---- memory -----------------------------------------------------------------------------------

  /// The address `index` elements behind `base`; the index is an integer of any width, or a vector.
  llvm::Value* at(llvm::Type* element, llvm::Value* base, llvm::Value* index) const;
  /// One element for all lanes.
  Part loadOne(ir::Scalar scalar, llvm::Value* address) const;
  void storeOne(ir::Scalar scalar, llvm::Value* value, llvm::Value* address) const;
  /// Consecutive elements, one per lane.
  Part loadNeighbors(ir::Scalar scalar, llvm::Value* address) const;
  void storeNeighbors(ir::Scalar scalar, const Part& part, llvm::Value* address) const;
  /// Elements at any index; `index` is a vector.
  Part gather(ir::Scalar scalar, llvm::Value* base, llvm::Value* index) const;
  void scatter(ir::Scalar scalar, const Part& part, llvm::Value* base, llvm::Value* index) const;

  /// Converts between a value and its representation in arrays.
  llvm::Value* toStored(ir::Scalar scalar, llvm::Value* value) const;
  llvm::Value* fromStored(ir::Scalar scalar, llvm::Value* value) const;

 private:
  CodegenOptions options_;
};

}  // namespace skc::native
