// SPDX-License-Identifier: MIT
//
// Values of several elements as LLVM has them. A part is one scalar of a value of the language: an LLVM scalar where all
// lanes share it, or the first of numbers that grow by 1 from lane to lane, or else a vector with one entry for each lane.
// With one lane everything is a scalar. Nothing here knows the IR's statements or streams.
#pragma once

#include <cstdint>
#include <string_view>
#include <vector>

#include <llvm/IR/IRBuilder.h>

#include "ir/type.hpp"
#include "sk/native/code.hpp"

namespace skc::native {

struct Part {
  llvm::Value* value = nullptr;
  bool isConsecutive = false;  ///< `value` is that of the first lane; lane i has i more
};
using Parts = std::vector<Part>;

/// What code is generated for: how many elements together, what stands for float, and what the CPU offers.
struct Form {
  std::uint32_t lanes = 1;
  sk::native::Real real = sk::native::Real::Float;
  bool hasMaskRegisters = false;  ///< vectors of bool cost nothing to keep (AVX-512)
  bool convertsHalves = false;  ///< in hardware
  /// 32-bit scalars of a vector register, where loops read gathers in blocks (block_gathers.hpp); else 0.
  std::uint32_t blockWidth = 0;
  bool isContracted = false;  ///< products and sums of the text may be fused
};

class Lanes {
 public:
  Lanes(llvm::IRBuilder<>& builder, const Form& form) : b(builder), form_(form) {}

  llvm::IRBuilder<>& b;
  const Form& form() const { return form_; }
  std::uint32_t count() const { return form_.lanes; }

  // ---- types ------------------------------------------------------------------------------------

  /// What a scalar is computed in. A narrow one is kept as the integer that stands for it in memory.
  llvm::Type* type(ir::Scalar scalar) const;
  llvm::Type* real() const { return type(ir::Scalar::Float); }
  llvm::Type* int32() const { return b.getInt32Ty(); }
  llvm::Type* int64() const { return b.getInt64Ty(); }
  /// What an array of a stream or of a variable holds: a byte for a bool.
  llvm::Type* stored(ir::Scalar scalar) const;
  /// Bytes of it.
  std::uint32_t storedBytes(ir::Scalar scalar) const;
  /// The vector with one entry per lane, or the scalar type itself if there is a single lane.
  llvm::Type* vector(llvm::Type* scalar) const;
  bool isVector(const llvm::Value* value) const { return value->getType()->isVectorTy(); }
  bool isVarying(const Part& part) const { return isVector(part.value); }
  bool isUniform(const Part& part) const { return !isVector(part.value) && !part.isConsecutive; }
  /// `like` with another scalar type: a vector where `like` is one.
  llvm::Type* sameShape(const llvm::Value* like, llvm::Type* scalar) const;

  // ---- constants and shapes ---------------------------------------------------------------------

  llvm::Value* constant(ir::Scalar scalar, std::int64_t value) const;
  /// A real number in `type` or a vector of it, rounded to it.
  llvm::Value* number(llvm::Type* type, double value) const;
  llvm::Value* integer(llvm::Type* type, std::int64_t value) const;

  /// One entry for each lane: 0, 1, 2 ...
  llvm::Value* laneNumbers(llvm::Type* integer) const;
  /// The value in each lane: a vector, or a scalar where there is one lane.
  llvm::Value* spread(const Part& part) const;
  llvm::Value* spread(llvm::Value* scalar) const;
  /// A scalar where all lanes share the value, else a vector.
  llvm::Value* value(const Part& part) const { return part.isConsecutive ? spread(part) : part.value; }
  /// Both with one shape: vectors where one of them is not the same for all lanes.
  void unify(Part& a, Part& c) const;
  void unify(std::vector<Part*> parts) const;

  /// cond ? yes : no, in each lane.
  Part select(const Part& cond, const Part& yes, const Part& no) const;
  /// Whether a bool is true in some lane: an i1.
  llvm::Value* any(const Part& mask) const;
  llvm::Value* lane(llvm::Value* vector, std::uint32_t number) const {
    return b.CreateExtractElement(vector, number);
  }

  /// function(lane by lane) of scalars: for what has no vector form. With uniform parts only, it is called once.
  Part perLane(const std::vector<Part>& parts, llvm::Type* result,
               llvm::function_ref<llvm::Value*(llvm::ArrayRef<llvm::Value*>)> function) const;
  /// Calls a function of the C library or the like, lane by lane.
  Part callPerLane(std::string_view name, llvm::Type* result, const std::vector<Part>& parts) const;

  // ---- memory -----------------------------------------------------------------------------------

  /// The address `index` elements behind `base`; the index is an integer of any width, or a vector.
  llvm::Value* at(llvm::Type* element, llvm::Value* base, llvm::Value* index) const;
  /// An element that all lanes share.
  Part loadOne(ir::Scalar scalar, llvm::Value* address) const;
  void storeOne(ir::Scalar scalar, llvm::Value* value, llvm::Value* address) const;
  /// Neighbours, one for each lane.
  Part loadNeighbors(ir::Scalar scalar, llvm::Value* address) const;
  void storeNeighbors(ir::Scalar scalar, const Part& part, llvm::Value* address) const;
  /// Elements anywhere: `index` is a vector.
  Part gather(ir::Scalar scalar, llvm::Value* base, llvm::Value* index) const;
  void scatter(ir::Scalar scalar, const Part& part, llvm::Value* base, llvm::Value* index) const;

  /// Between a value and what arrays hold.
  llvm::Value* toStored(ir::Scalar scalar, llvm::Value* value) const;
  llvm::Value* fromStored(ir::Scalar scalar, llvm::Value* value) const;

 private:
  Form form_;
};

}  // namespace skc::native
