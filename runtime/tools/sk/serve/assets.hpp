// SPDX-License-Identifier: MIT
//
// The files of the page, all in memory: no request reads a file.
#pragma once

#include <filesystem>
#include <map>
#include <string>

namespace sk_tool {

struct Asset {
  std::string text;
  std::string type;   ///< its media type
};

struct Assets {
  std::map<std::string, Asset> files;            ///< by path of the request: "/index.html"
  std::map<std::string, std::string> programs;   ///< that one may start with: "heat.sk"
  bool hasPackage = false;   ///< the npm package, without which there is no picture
  bool hasEditor = false;    ///< CodeMirror
};

/// Reads FOLDER/playground, FOLDER/package/dist and FOLDER/editor; the last two may be missing. Throws std::runtime_error if
/// the first is.
Assets readAssets(const std::filesystem::path& folder);

}  // namespace sk_tool
