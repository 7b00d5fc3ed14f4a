// SPDX-License-Identifier: MIT
#include "hits_file.hpp"

#include <cmath>
#include <fstream>
#include <iterator>
#include <stdexcept>
#include <string>
#include <system_error>

#include <fmt/format.h>

#include "support/text_cursor.hpp"
#include "support/text_file.hpp"

namespace rays {

using examples::TextCursor;

namespace {

/// The first number of the line has been taken already.
Ray readRay(TextCursor& cursor, double first) {
  const auto coordinate = [&](std::string_view what) {
    const double x = cursor.needNumber(what);
    if (!std::isfinite(static_cast<float>(x)))
      cursor.fail(fmt::format("{} must be finite, as a float is", what));
    return static_cast<float>(x);
  };
  Ray ray;
  if (!std::isfinite(static_cast<float>(first))) cursor.fail("ox must be finite, as a float is");
  ray.origin.x = static_cast<float>(first);
  ray.origin.y = coordinate("oy");
  ray.origin.z = coordinate("oz");
  ray.direction.x = coordinate("dx");
  ray.direction.y = coordinate("dy");
  ray.direction.z = coordinate("dz");
  if (ray.direction.x == 0 && ray.direction.y == 0 && ray.direction.z == 0)
    cursor.fail("a direction must not be zero");
  if (const auto least = cursor.number()) {
    ray.least = static_cast<float>(*least);
    ray.most = static_cast<float>(cursor.needNumber("tmax"));
    if (std::isnan(ray.least) || std::isnan(ray.most)) cursor.fail("tmin and tmax must be numbers");
  }
  cursor.endLine("a ray is ox oy oz dx dy dz [tmin tmax]");
  return ray;
}

}  // namespace

std::vector<Ray> loadRays(const std::filesystem::path& file) {
  const std::string text = examples::bytesOf(file, "the list of rays");
  TextCursor cursor(file.string(), text, {.comment = '#'});
  std::vector<Ray> rays;
  while (cursor.nextLine()) {
    if (const auto first = cursor.number()) rays.push_back(readRay(cursor, *first));
  }
  return rays;
}

void saveHits(const std::filesystem::path& file, std::span<const Hit> hits, int width) {
  std::error_code ignored;
  if (file.has_parent_path()) std::filesystem::create_directories(file.parent_path(), ignored);
  std::ofstream stream(file, std::ios::binary);
  stream << (width > 0 ? "x,y,id,t,u,v\n" : "ray,id,t,u,v\n");
  std::string text;
  for (std::size_t i = 0; i < hits.size(); ++i) {
    const Hit& hit = hits[i];
    const auto out = std::back_inserter(text);
    if (width > 0)
      fmt::format_to(out, "{},{}", i % std::size_t(width), i / std::size_t(width));
    else
      fmt::format_to(out, "{}", i);
    // A sum with 0 has no negative zero, which says nothing of a hit.
    fmt::format_to(out, ",{},{},{},{}\n", hit.id, hit.t + 0.0f, hit.u + 0.0f, hit.v + 0.0f);
    if (text.size() < 65536 && i + 1 < hits.size()) continue;
    stream << text;
    text.clear();
  }
  if (!stream.flush()) throw std::runtime_error(fmt::format("cannot write '{}'", file.string()));
}

}  // namespace rays
