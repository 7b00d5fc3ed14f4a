// SPDX-License-Identifier: MIT
#include "table_file.hpp"

#include <stdexcept>
#include <system_error>

#include <fmt/format.h>

namespace examples {

TableFile::TableFile(const std::filesystem::path& file) : name_(file.string()) {
  std::error_code ignored;
  if (file.has_parent_path()) std::filesystem::create_directories(file.parent_path(), ignored);
  file_.open(file);
  file_ << "step,time_s,kinetic_J,elastic_J,potential_J,mean_strain,largest_strain,centre_x_m,centre_y_m,"
           "centre_z_m,"
           "fastest_m_per_s,torn_links\n";
  if (!file_) throw std::runtime_error(fmt::format("cannot write '{}'", name_));
}

void TableFile::add(const Simulation& simulation, const Scene& scene) {
  const Observation o = simulation.observe();
  if (simulation.step() == 0) linksAtFirst_ = simulation.links();
  file_ << fmt::format("{},{:.9g},{:.9g},{:.9g},{:.9g},{:.9g},{:.9g},{:.9g},{:.9g},{:.9g},{:.9g},{}\n",
                       simulation.step(), static_cast<double>(simulation.step()) * scene.run.dt, o.kinetic,
                       o.elastic, o.potential, o.strain, o.largest, o.centre.x, o.centre.y, o.centre.z,
                       simulation.census().fastest, linksAtFirst_ - simulation.links());
}

void TableFile::finish() {
  if (!file_.flush()) throw std::runtime_error(fmt::format("cannot write '{}'", name_));
}

}  // namespace examples
