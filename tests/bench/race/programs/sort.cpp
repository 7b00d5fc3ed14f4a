// SPDX-License-Identifier: MIT
//
// Sorted floats, alone and with a value for each: twice the key. floats: keys.
#include <algorithm>

#include "our_task.hpp"
#include "programs/all.hpp"

namespace race {
namespace {

std::vector<float> twice(std::vector<float> keys) {
  for (float& key : keys) key *= 2;
  return keys;
}

class Sort final : public OurTask {
 public:
  Sort(sk::Device& device, const Problem& p)
      : OurTask(device),
        keys_(filled<float>({p.size()}, p.floats[0])),
        sorted_(device.stream<float>({p.size()})) {}

  std::vector<float> result() override { return sorted_.read(); }

 private:
  void once() override {
    keys_.copyTo(sorted_);
    sk::sort(sorted_);
  }

  sk::Stream<float> keys_, sorted_;
};

class SortPairs final : public OurTask {
 public:
  SortPairs(sk::Device& device, const Problem& p)
      : OurTask(device),
        keys_(filled<float>({p.size()}, p.floats[0])),
        values_(filled<float>({p.size()}, twice(p.floats[0]))),
        sortedKeys_(device.stream<float>({p.size()})),
        sortedValues_(device.stream<float>({p.size()})) {}

  std::vector<float> result() override { return sortedValues_.read(); }

 private:
  void once() override {
    keys_.copyTo(sortedKeys_);
    values_.copyTo(sortedValues_);
    sk::sort(sortedKeys_, sortedValues_);
  }

  sk::Stream<float> keys_, values_, sortedKeys_, sortedValues_;
};

}  // namespace

Problem sortProblem(int log2) {
  Problem p = grid(log2);
  p.floats = {numbers(p.size(), 1, -1000, 1000)};
  return p;
}

Check sortCheck(const Problem& p) {
  std::vector<float> keys = p.floats[0];
  std::sort(keys.begin(), keys.end());
  return {{}, {keys.begin(), keys.end()}, 0};
}

Check sortPairsCheck(const Problem& p) {
  std::vector<float> values = twice(p.floats[0]);
  std::sort(values.begin(), values.end());
  return {{}, {values.begin(), values.end()}, 0};
}

// There are no kernels to give options to.
std::unique_ptr<Task> sortOurs(sk::Device& device, const sk::CallOptions&, const Problem& p) {
  return std::make_unique<Sort>(device, p);
}

std::unique_ptr<Task> sortPairsOurs(sk::Device& device, const sk::CallOptions&, const Problem& p) {
  return std::make_unique<SortPairs>(device, p);
}

}  // namespace race
