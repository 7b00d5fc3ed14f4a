// SPDX-License-Identifier: MIT
//
// How a kernel's code reads and writes its parameters (sk/native/code.hpp describes their memory layout). The
// elements that are computed together are neighbours along x. What is constant in a whole chunk is loaded in
// the function's prologue.
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
  /// `value` computes a constant expression: a border value.
  Streams(Lanes& lanes, const ir::Module& module, const ir::Kernel& kernel, const SlotPlan& slots,
          std::function<Parts(const ir::Expr&)> value);

  /// Sets the arguments of the function; `chunk` is null if it takes none. Loads are added to `prologue`.
  void begin(llvm::Value* frame, llvm::Value* chunk, llvm::BasicBlock* prologue);
  /// Code that follows is for row number `row` of a chunk of several rows; what is constant in the row is computed in
  /// `prologue`.
  void beginRow(llvm::Value* row, llvm::BasicBlock* prologue);
  /// Code that follows is for the elements of the chunk from number `element` on.
  void moveTo(llvm::Value* element) { element_ = element; }
  /// If the function takes chunks of several rows: code that follows is for this row.
  void selectRow(std::size_t row) { row_ = row; }

  /// Makes records carry the numbers of their elements.
  void numberRecords() { numbersRecords_ = true; }

  llvm::Value* chunkFirst() { return first(0); }
  llvm::Value* chunkCount() { return chunkField(offsetof(sk::native::Chunk, count)); }
  llvm::Value* chunkRows() { return chunkField(offsetof(sk::native::Chunk, rows)); }

  Parts uniform(std::uint32_t param);
  Parts input(std::uint32_t param);
  Parts iterator(std::uint32_t param);
  void storeOutput(std::uint32_t param, const Parts& value);
  /// Fetches the memory that storeOutput() will write into the nearest cache.
  void prefetchOutput(std::uint32_t param);

  Parts index(const ir::StreamRef& stream);
  Parts extent(const ir::StreamRef& stream);
  /// `index` has one int per dimension, x first.
  Parts gather(std::uint32_t param, const Parts& index);
  /// The number of consecutive elements along x in a block, a cache line. Blocks need 4 lanes or more.
  static constexpr std::uint32_t blockLength = 16;
  /// A block of a gather in all lanes: for each component, vectors of lanes in memory.
  struct Block {
    std::uint32_t param;
    std::vector<llvm::Value*> components;
  };
  /// True if the block from `index` on is in bounds in all lanes.
  llvm::Value* isBlockInside(std::uint32_t param, const Parts& index);
  /// `counter` is a uniform summand of the index.
  Block readBlock(std::uint32_t param, const Parts& index, llvm::Value* counter);
  Parts elementOf(const Block& block, llvm::Value* number);
  /// The elements of a gather that a loop reads one after the other (unchecked_gathers.hpp).
  struct Walk {
    std::uint32_t param;
    std::vector<llvm::Value*> components;  ///< addresses of the first iteration's element
    llvm::Value* step;  ///< in elements, from one iteration to the next
    bool isConsecutive;  ///< lanes read neighbours along x; else all read the same element
  };
  /// True if no iteration reads out of bounds, in any lane. `index` is that of the first iteration: x is uniform or
  /// consecutive, the others are uniform, and those of which `grows` is true grow by one.
  llvm::Value* isWalkInside(std::uint32_t param, const Parts& index, const std::vector<bool>& grows,
                            llvm::Value* iterations);
  Walk walk(std::uint32_t param, const Parts& index, const std::vector<bool>& grows);
  Parts elementOf(const Walk& walk, llvm::Value* iteration);
  /// `constant` is the offset, if it is known.
  Parts neighbor(std::uint32_t param, const Parts& offset,
                 const std::optional<std::vector<std::int32_t>>& constant);
  Parts sample(std::uint32_t param, const Parts& position);

  /// Appends records of what the lanes of the mask push.
  void push(std::uint32_t param, const Parts& value, llvm::Value* mask);
  /// Appends records of what the lanes of the mask store or combine, if their indices are in bounds. Carries
  /// them out immediately if the output has no append buffer.
  void scatter(std::uint32_t param, const Parts& index, const Parts& value, llvm::Value* mask);
  /// Carries out the records of a scatter output, in their order.
  void apply(std::uint32_t param, llvm::Value* appendBuffer);

  /// The border value of a gather with Boundary::Border.
  Parts border(std::uint32_t param);
  /// The address of the call's tables, one sk::native::Table per tabulated function; null if it has none.
  llvm::Value* tables();
  /// 1 if the call prints nothing, else 0.
  llvm::Value* isSilent();

 private:
  llvm::Value* inPrologue(const std::function<llvm::Value*()>& emit) { return emitIn(prologue_, emit); }
  llvm::Value* emitIn(llvm::BasicBlock* prologue, const std::function<llvm::Value*()>& emit);
  llvm::Value* ramp(llvm::Value* begin, llvm::Value* way, llvm::Value* steps, llvm::Value* k);
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
    llvm::Value* isOutside;  ///< Boundary::Border only; else null
  };
  Inside inside(std::uint32_t param, std::size_t dimension, llvm::Value* index);
  llvm::Value* low(std::uint32_t param, std::size_t dimension);
  llvm::Value* high(std::uint32_t param, std::size_t dimension);
  llvm::Value* heldCount(std::uint32_t param, std::size_t dimension);
  llvm::Value* unlessHeld(std::uint32_t param, std::size_t dimension, llvm::Value* index,
                          const std::function<llvm::Value*()>& remap);
  llvm::Value* clamped(std::uint32_t param, std::size_t dimension, llvm::Value* index);
  llvm::Value* areAllHeld(std::uint32_t param, const Parts& index);
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
  llvm::BasicBlock* prologue_ = nullptr;  ///< of the function
  llvm::DebugLoc start_;  ///< of the function
  llvm::BasicBlock* rowPrologue_ = nullptr;  ///< of a row of the chunk
  llvm::Value* rowNumber_ = nullptr;  ///< in the chunk; null if it has one row
  llvm::Value* element_ = nullptr;
  bool numbersRecords_ = false;
  std::size_t row_ = 0;
  std::map<std::pair<llvm::Value*, std::size_t>, llvm::Value*> loads_;
  std::map<std::size_t, llvm::Value*> rowArrays_;  ///< of row rowNumber_
  std::map<std::uint32_t, std::vector<ir::Scalar>> scalars_;
  std::map<std::uint32_t, llvm::Function*> laneGathers_;
};

}  // namespace skc::native
