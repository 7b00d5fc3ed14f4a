// SPDX-License-Identifier: MIT
#include "support/ranks.hpp"

#include <cstdio>
#include <cstdlib>
#include <stdexcept>

#include <fmt/format.h>

namespace examples {

int startedProcesses() {
  for (const char* variable :
       {"OMPI_COMM_WORLD_SIZE", "PMI_SIZE", "MPI_LOCALNRANKS", "SLURM_STEP_NUM_TASKS"}) {
    if (const char* const told = std::getenv(variable)) return std::atoi(told);
  }
  return 0;
}

std::unique_ptr<DividedGrid> Ranks::divide(const std::string&, const sk::Shape&, Ends) { return nullptr; }

void Ranks::end(const std::string& error) {
  if (!error.empty()) fmt::print(stderr, "{}\n", error);
}

void Ranks::refuseSeveral(std::string_view what, std::string_view instead) const {
  if (count() == 1) return;
  throw std::runtime_error(fmt::format("{} needs one process, but there are {}; {}", what, count(), instead));
}

OwnedSpace::OwnedSpace(Ranks& ranks, const std::string& device, const sk::Shape& shape, Ends ends)
    : divided_(shape.size() > 0 ? ranks.divide(device, shape, ends) : nullptr) {
  if (divided_)
    space_.emplace(*divided_);
  else
    space_.emplace(device_.emplace(device), shape);
}

std::string placeOf(const Ranks& ranks, std::string_view device) {
  if (ranks.count() == 1) return std::string(device);
  return fmt::format("{} ranks, each on {}", ranks.count(), device);
}

}  // namespace examples
