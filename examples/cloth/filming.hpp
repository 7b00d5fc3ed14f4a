// SPDX-License-Identifier: MIT
//
// A run's frames, drawn, titled and put on file: a film, numbered pictures, or one picture of the end. What was filmed before a run
// breaks stays.
#pragma once

#include <optional>
#include <string>

#include <sk/sk.hpp>

#include "drawing.hpp"
#include "scene.hpp"
#include "simulation.hpp"
#include "support/film.hpp"

namespace examples {

struct PictureSize {
  int width, height;
};

/// How frames look.
struct Look {
  PictureSize size;
  int samples = 2;  ///< samples x samples to a pixel
  bool isTitled = true;
};

class Filming {
 public:
  /// To scene.record.film. Throws before anything is simulated where that cannot be written, or nothing can draw.
  Filming(sk::Device& device, const Scene& scene, const Look& look, const std::string& precision);
  ~Filming();
  Filming(const Filming&) = delete;
  Filming& operator=(const Filming&) = delete;

  void add(Simulation& simulation);
  void finish(Simulation& simulation);
  /// One line on what was written, and how long drawing took.
  std::string report() const;

 private:
  Image frameOf(Simulation& simulation);

  Scene scene_;
  Look look_;
  std::string where_;
  Drawing drawing_;
  std::optional<Film> film_;  ///< none: one picture
  int frames_ = 0;
  double milliseconds_ = 0;
};

}  // namespace examples
