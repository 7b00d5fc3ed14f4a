// SPDX-License-Identifier: MIT
#include "support/study.hpp"

#include <algorithm>
#include <stdexcept>

#include <fmt/format.h>

#include "support/application.hpp"
#include "support/stopwatch.hpp"

namespace examples {

StudyOptions::StudyOptions(Application& app, std::string_view purpose, std::span<const Study> studies)
    : app_(app), studies_(studies) {
  std::size_t width = 0;
  for (const Study& study : studies) width = std::max(width, study.name.size() + 1);
  std::string help = fmt::format("{}, and print a table:", purpose);
  for (const Study& study : studies) help += fmt::format("\n  {:<{}} {}", study.name, width, study.asks);
  app.options().add_option("--study", name_, help);
  app.options().add_flag("--small", small_, "a study in seconds, coarser");
}

void StudyOptions::run() const {
  app_.ranks().refuseSeveral("--study", "start it without mpirun");
  const auto study = std::ranges::find(studies_, name_, &Study::name);
  if (study == studies_.end()) {
    std::string names;
    for (const Study& known : studies_) names += fmt::format("{}{}", names.empty() ? "" : ", ", known.name);
    throw std::runtime_error(fmt::format("no study is called '{}'; there are {}", name_, names));
  }
  sk::Device device(app_.device());
  const Stopwatch watch;
  const Findings findings = study->run(device, small_);
  app_.report(fmt::format("{}: {}", study->name, study->asks), device.name(), watch.milliseconds());
  fmt::print("\n{}\n", findings.table);
  for (const Verification& verification : findings.verifications) app_.verified(verification);
}

}  // namespace examples
