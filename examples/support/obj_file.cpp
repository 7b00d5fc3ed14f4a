// SPDX-License-Identifier: MIT
#include "support/obj_file.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <system_error>
#include <utility>

#include "support/triangulation.hpp"

namespace examples {

namespace {

class Parser {
 public:
  Parser(const std::string& name, std::string_view text, const ObjOptions& options)
      : cursor_(name, text, objRules), options_(options) {}

  ObjFile parse() {
    while (cursor_.nextLine()) {
      const std::string_view key = cursor_.word();
      if (key == "v") {
        file_.points.push_back(point());
      } else if (key == "vt") {
        const float u = coordinate("u");
        file_.textures.push_back({u, static_cast<float>(cursor_.number().value_or(0.0))});
      } else if (key == "vn") {
        const float x = coordinate("x"), y = coordinate("y");
        file_.normals.push_back({x, y, coordinate("z")});
      } else if (key == "f") {
        face();
      } else if (key == "usemtl") {
        const auto [found, isNew] =
            materials_.try_emplace(std::string(cursor_.rest()), file_.materials.size());
        if (isNew) file_.materials.push_back(found->first);
        material_ = static_cast<std::int32_t>(found->second);
      } else if (key == "mtllib" && !options_.materialsFolder.empty()) {
        findMaterials();
      }
    }
    return std::move(file_);
  }

 private:
  float coordinate(std::string_view what) { return static_cast<float>(cursor_.needNumber(what)); }

  /// A weight or a colour may follow, which nobody needs.
  Vector point() {
    Vector p;
    p.x = cursor_.needNumber("x");
    p.y = cursor_.needNumber("y");
    p.z = cursor_.needNumber("z");
    if (options_.onlyFinite && !(std::isfinite(p.x) && std::isfinite(p.y) && std::isfinite(p.z)))
      cursor_.fail("a position is not finite");
    for (int i = 0; i < 4; ++i) cursor_.number();
    cursor_.endLine("a position is x y z, and perhaps a weight and a colour");
    return p;
  }

  std::int32_t indexOf(std::string_view word, std::size_t count, std::string_view what) const {
    const std::int64_t index = cursor_.integerOf(word), most = static_cast<std::int64_t>(count);
    if (index == 0) cursor_.fail(fmt::format("0 is no {}; they count from 1", what));
    if (index > most || index < -most)
      cursor_.fail(fmt::format("there is no {} {}; {} are above this line", what, index, most));
    return static_cast<std::int32_t>(index > 0 ? index - 1 : most + index);
  }

  /// POINT, POINT/TEXTURE, POINT//NORMAL or POINT/TEXTURE/NORMAL; what stands behind a slash may be missing.
  ObjCorner cornerOf(std::string_view word) const {
    const std::size_t first = std::min(word.find('/'), word.size());
    const std::size_t second = std::min(word.find('/', std::min(first + 1, word.size())), word.size());
    ObjCorner corner{.point = indexOf(word.substr(0, first), file_.points.size(), "vertex")};
    if (first + 1 < second)
      corner.texture =
          indexOf(word.substr(first + 1, second - first - 1), file_.textures.size(), "texture vertex");
    if (second + 1 < word.size())
      corner.normal = indexOf(word.substr(second + 1), file_.normals.size(), "normal");
    return corner;
  }

  void face() {
    corners_.clear();
    positions_.clear();
    for (std::string_view word = cursor_.word(); !word.empty(); word = cursor_.word()) {
      corners_.push_back(cornerOf(word));
      positions_.push_back(file_.points[static_cast<std::size_t>(corners_.back().point)]);
    }
    if (corners_.size() < 3)
      cursor_.fail(fmt::format("a face has three corners at least, and this one has {}", corners_.size()));
    triangulate(positions_, triangles_);
    for (const auto& [a, b, c] : triangles_)
      file_.triangles.push_back({{corners_[a], corners_[b], corners_[c]}, material_});
  }

  /// Names of files, which may have blanks where there is but one.
  void findMaterials() {
    TextCursor names = cursor_;
    const std::filesystem::path all = options_.materialsFolder / names.rest();
    std::error_code ignored;
    if (std::filesystem::is_regular_file(all, ignored)) {
      file_.materialFiles.push_back(all);
      return;
    }
    for (std::string_view word = cursor_.word(); !word.empty(); word = cursor_.word()) {
      file_.materialFiles.push_back(options_.materialsFolder / word);
      if (!std::filesystem::is_regular_file(file_.materialFiles.back(), ignored))
        cursor_.fail(fmt::format("there is no file '{}'", file_.materialFiles.back().string()));
    }
  }

  TextCursor cursor_;
  const ObjOptions& options_;
  ObjFile file_;
  std::map<std::string, std::size_t> materials_;
  std::int32_t material_ = -1;
  std::vector<ObjCorner> corners_;  // of the face at hand
  std::vector<Vector> positions_;
  std::vector<std::array<std::uint32_t, 3>> triangles_;
};

}  // namespace

ObjFile parseObj(const std::string& name, std::string_view text, const ObjOptions& options) {
  return Parser(name, text, options).parse();
}

}  // namespace examples
