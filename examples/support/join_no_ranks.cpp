// SPDX-License-Identifier: MIT
//
// Implements joinRanks() where MPI is not installed.
#include <stdexcept>

#include "support/ranks.hpp"

namespace examples {
namespace {

class NoRanks final : public Ranks {
 public:
  std::string_view whyAlone() const override {
    return "it was built without MPI; install one (Debian: libopenmpi-dev) and build it again, or start it "
           "without mpirun";
  }
};

}  // namespace

std::unique_ptr<Ranks> joinRanks() { return std::make_unique<NoRanks>(); }

std::unique_ptr<DividedGrid> divideGrid(const std::string&, const sk::Shape&, Ends) {
  throw std::logic_error("this program was built without MPI");
}

}  // namespace examples
