// SPDX-License-Identifier: MIT
//
// A weather station that never was. Its numbers have what makes statistics hard: a large mean beside a small
// spread (pressure), many equal values (rain), skew (wind) and gaps.
#include <algorithm>
#include <chrono>
#include <cmath>
#include <fstream>
#include <numbers>
#include <random>
#include <stdexcept>

#include <fmt/format.h>

#include "data.hpp"

namespace examples {
namespace {

/// Random numbers that are the same with every standard library.
class Dice {
 public:
  double uniform() { return (random_() + 0.5) / 4294967296.0; }
  double normal() {
    return std::sqrt(-2.0 * std::log(uniform())) * std::cos(2.0 * std::numbers::pi * uniform());
  }

 private:
  std::mt19937 random_{2014};
};

/// Slow weather: each hour remembers most of the one before.
struct Front {
  double warm = 0.0;
  double pressure = 0.0;

  void nextHour(Dice& dice) {
    warm = 0.992 * warm + 0.42 * dice.normal();
    pressure = 0.996 * pressure + 0.72 * dice.normal();
  }
};

std::string number(double value, bool gap) { return gap ? std::string() : fmt::format("{:.1f}", value); }

std::string reading(int hour, const Front& front, Dice& dice) {
  const double year = 2.0 * std::numbers::pi * hour / (24.0 * 365.25);
  const double day = 2.0 * std::numbers::pi * (hour % 24) / 24.0;
  const double temperature = 9.8 - 9.4 * std::cos(year - 0.28) - 3.1 * std::cos(day - 0.6) + front.warm;
  const double humidity =
      std::clamp(78.0 - 1.7 * (temperature - 9.8) - 0.4 * front.pressure + 5.0 * dice.normal(), 12.0, 100.0);
  const double wind = 3.4 * std::sqrt(-std::log(dice.uniform())) + 0.15 * std::max(0.0, -front.pressure);
  const bool wet = humidity > 80.0 && dice.uniform() < 0.22;
  const double rain = wet ? 0.1 + 1.6 * std::pow(-std::log(dice.uniform()), 1.4) : 0.0;
  const bool windOut = hour % 24'000 > 23'870;  // five days of ice on the cups
  return fmt::format("{},{},{},{},{}", number(temperature, dice.uniform() < 0.001),
                     number(1013.2 + front.pressure, false), number(humidity, dice.uniform() < 0.004),
                     number(wind, windOut), number(rain, dice.uniform() < 0.002));
}

}  // namespace

void writeWeather(const std::filesystem::path& file) {
  constexpr int hours = 87'648;
  std::error_code ignored;
  if (file.has_parent_path()) std::filesystem::create_directories(file.parent_path(), ignored);
  std::ofstream stream(file, std::ios::binary);
  stream << "time,temperature (C),pressure (hPa),humidity (%),wind (m/s),rain (mm)\n";
  Dice dice;
  Front front;
  const auto begin = std::chrono::sys_days(std::chrono::year{2014} / 1 / 1);
  for (int hour = 0; hour < hours; ++hour) {
    front.nextHour(dice);
    const std::chrono::year_month_day date(begin + std::chrono::days(hour / 24));
    stream << fmt::format("{}-{:02}-{:02} {:02}:00,{}\n", static_cast<int>(date.year()),
                          static_cast<unsigned>(date.month()), static_cast<unsigned>(date.day()), hour % 24,
                          reading(hour, front, dice));
  }
  if (!stream.flush()) throw std::runtime_error(fmt::format("cannot write '{}'", file.string()));
}

}  // namespace examples
