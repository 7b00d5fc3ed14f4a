// SPDX-License-Identifier: MIT
//
// How a kernel's code reads and writes its parameters (sk/native/code.hpp says how they lie in memory). The elements that
// are computed together are neighbours along x. What is the same for a whole chunk is loaded in the function's prologue.
#pragma once

#include <functional>
#include <map>
#include <optional>
#include <vector>

#include "ir/ir.hpp"
#include "native/lanes.hpp"
#include "native/slots.hpp"
#include "sk/native/code.hpp"

namespace skc::native {

class Streams {
 public:
  /// `value` computes a constant expression: a border.
  Streams(Lanes& lanes, const ir::Module& module, const ir::Kernel& kernel, const SlotPlan& slots,
          std::function<Parts(const ir::Expr&)> value);

  /// The arguments of the function; `chunk` may be null where there is none. Loads are added to `prologue`, which must
  /// have no terminator yet.
  void begin(llvm::Value* frame, llvm::Value* chunk, llvm::BasicBlock* prologue);
  /// From here on, code is for the elements from number `element` of the chunk on.
  void moveTo(llvm::Value* element) { element_ = element; }
  /// Where the function has chunks of several rows, one behind the other: from here on, code is for this one.
  void selectRow(std::size_t row) { row_ = row; }

  /// Records tell from which elements they come.
  void numberRecords() { numbersRecords_ = true; }

  llvm::Value* chunkCount() { return chunkField(offsetof(sk::native::Chunk, count)); }

  Parts uniform(std::uint32_t param);
  Parts input(std::uint32_t param);
  Parts iterator(std::uint32_t param);
  void storeOutput(std::uint32_t param, const Parts& value);

  Parts index(const ir::StreamRef& stream);
  Parts extent(const ir::StreamRef& stream);
  /// Indices x first, one int for each dimension.
  Parts gather(std::uint32_t param, const Parts& index);
  /// What gathers read in blocks: consecutive elements along x, each of a cache line's length. They need 4 lanes or more.
  static constexpr std::uint32_t blockLength = 16;
  /// Elements of a gather in all lanes: for each component, vectors of lanes in memory.
  struct Block {
    std::uint32_t param;
    std::vector<llvm::Value*> components;
  };
  /// Whether a block can be read from the index on, and needs no boundary in any lane.
  llvm::Value* isBlockInside(std::uint32_t param, const Parts& index);
  /// `counter` is a uniform summand of the index.
  Block readBlock(std::uint32_t param, const Parts& index, llvm::Value* counter);
  Parts elementOf(const Block& block, llvm::Value* number);
  /// `constant`: the offset, if it is known.
  Parts neighbor(std::uint32_t param, const Parts& offset,
                 const std::optional<std::vector<std::int32_t>>& constant);
  Parts sample(std::uint32_t param, const Parts& position);

  /// Records that the lanes of the mask push their elements.
  void push(std::uint32_t param, const Parts& value, llvm::Value* mask);
  /// Likewise that they store, or combine, them where their indices are inside; or does so, where records are not asked for.
  void scatter(std::uint32_t param, const Parts& index, const Parts& value, llvm::Value* mask);
  /// Carries out the records of a scatter output, in their order.
  void apply(std::uint32_t param, llvm::Value* appendBuffer);

  /// What the gather has outside, of a Boundary::Border.
  Parts border(std::uint32_t param);
  /// The table for function number `table`: its address, or null.
  llvm::Value* tables();

 private:
  llvm::Value* inPrologue(const std::function<llvm::Value*()>& emit);
  llvm::Value* load(llvm::Value* base, std::size_t offset, llvm::Type* type);
  llvm::Value* argumentField(std::uint32_t param, std::size_t offset, llvm::Type* type);
  llvm::Value* argumentExtent(std::uint32_t param, std::size_t dimension, std::size_t field);
  llvm::Value* frameField(std::size_t offset, llvm::Type* type);
  llvm::Value* chunkField(std::size_t offset);
  llvm::Value* first(std::size_t dimension);
  llvm::Value* component(std::uint32_t param, std::size_t component);
  llvm::Value* array(std::size_t number);
  struct Column;
  void record(std::uint32_t param, llvm::Value* mask, std::vector<Column> columns);
  llvm::Value* loadField(llvm::Value* record, std::size_t offset, llvm::Type* type);
  void makeRoom(llvm::Value* appendBuffer);
  void applyLanes(std::uint32_t param, llvm::Value* number, const Parts& stored, llvm::Value* mask);
  std::vector<llvm::Value*> componentsNow(std::uint32_t param);
  void applySomeLanes(std::uint32_t param, llvm::Value* number, const Parts& stored, llvm::Value* bits,
                      const std::vector<llvm::Value*>& to);
  void applyRecord(std::uint32_t param, llvm::Value* targets, const std::vector<llvm::Value*>& from,
                   const std::vector<llvm::Value*>& to, llvm::Value* i);
  void applyOne(std::uint32_t param, llvm::Value* target, const Parts& value,
                const std::vector<llvm::Value*>& to);
  Parts combined(std::uint32_t param, const Parts& old, const Parts& value);
  llvm::Value* storeRecords(const std::vector<Column>& columns, llvm::Value* bits, llvm::Value* count);

  const std::vector<ir::Scalar>& scalars(std::uint32_t param);

  struct Inside {
    llvm::Value* index;  ///< i64, in range
    llvm::Value* isOutside;  ///< of Border; null else
  };
  Inside inside(std::uint32_t param, std::size_t dimension, llvm::Value* index);
  Parts gatherBounded(std::uint32_t param, const Parts& index);
  Parts gatherOne(std::uint32_t param, const Parts& index);
  Parts gatherNeighbors(std::uint32_t param, const Parts& index);
  Parts gatherAnywhere(std::uint32_t param, const Parts& index);
  Parts gatherByNumbers(std::uint32_t param, const Parts& index);
  Parts gatherByLanes(std::uint32_t param, const Parts& index);
  llvm::Function* laneGather(std::uint32_t param);
  llvm::Value* laneOffsets(std::uint32_t param, const Parts& index, llvm::Value* counter);
  void storeTransposed(llvm::Type* element, const std::vector<llvm::Value*>& addresses,
                       llvm::Value* block) const;
  Parts orBorder(std::uint32_t param, llvm::Value* isOutside, const Parts& value);
  Parts choose(llvm::Value* condition, const std::function<Parts()>& yes, const std::function<Parts()>& no,
               const std::vector<ir::Scalar>& scalars);
  llvm::Value* foldedPosition(llvm::Value* first);
  Part moved(std::uint32_t param, std::size_t dimension, const Part& index, const Part& offset);
  Parts weighted(std::uint32_t param, const Parts& low, const Parts& weights, std::size_t dimensions);

  Lanes& l;
  const ir::Module& module_;
  const ir::Kernel& kernel_;
  const SlotPlan& slots_;
  std::function<Parts(const ir::Expr&)> value_;
  llvm::Value* frame_ = nullptr;
  llvm::Value* chunk_ = nullptr;
  llvm::BasicBlock* prologue_ = nullptr;
  llvm::Value* element_ = nullptr;
  bool numbersRecords_ = false;
  std::size_t row_ = 0;
  std::map<std::pair<llvm::Value*, std::size_t>, llvm::Value*> loads_;
  std::map<std::uint32_t, std::vector<ir::Scalar>> scalars_;
  std::map<std::uint32_t, llvm::Function*> laneGathers_;
};

}  // namespace skc::native
