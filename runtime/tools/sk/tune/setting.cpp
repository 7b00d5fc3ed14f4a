// SPDX-License-Identifier: MIT
#include "tune/setting.hpp"

#include <algorithm>
#include <sstream>
#include <stdexcept>

#include <fmt/format.h>

#include "toml/read_toml.hpp"

namespace sk_tool::tune {

namespace {

/// A basic string of TOML.
std::string tomlString(const std::string& text) {
  std::string result = "\"";
  for (const char c : text) {
    if (c == '"' || c == '\\') result += '\\';
    if (static_cast<unsigned char>(c) < ' ') {
      result += fmt::format("\\u{:04x}", c);
    } else {
      result += c;
    }
  }
  return result + '"';
}

std::string literalOf(const toml::node& node) {
  if (const auto text = node.value_exact<std::string>()) return tomlString(*text);
  std::ostringstream out;
  node.visit([&](const auto& value) { out << value; });
  return out.str();
}

/// "precision double" is a choice of the key "precision".
bool chooses(const std::vector<std::string>& choices, const std::string& key) {
  return std::ranges::any_of(choices,
                             [&](const std::string& choice) { return choice.starts_with(key + " "); });
}

}  // namespace

std::string describe(const Unit& unit, const std::string& value) {
  const bool isUnnamed = unit.section == "streams" && unit.name == "*";
  return fmt::format("{}: {} {}", isUnnamed ? "streams without a name" : unit.name, unit.key, value);
}

std::string describe(const Setting& setting) {
  std::string text;
  for (const auto& [unit, value] : setting) text += (text.empty() ? "" : "; ") + describe(unit, value);
  return text.empty() ? "nothing changed" : text;
}

Setting with(Setting first, const Setting& second) {
  for (const auto& [unit, value] : second) first[unit] = value;
  return first;
}

Setting without(Setting first, const Setting& second) {
  for (const auto& [unit, value] : second) first.erase(unit);
  return first;
}

BaseFile::BaseFile(const std::string& file) : name_(file) {
  try {
    for (const auto& [section, node] : sk::readToml(file)) {
      const toml::table* named = node.as_table();
      if (named == nullptr) continue;  // the program reports it
      for (const auto& [name, keys] : *named) {
        if (!keys.is_table()) continue;
        for (const auto& [key, value] : *keys.as_table()) {
          sections_[std::string(section.str())][std::string(name.str())][std::string(key.str())] =
              literalOf(value);
        }
      }
    }
  } catch (const toml::parse_error& error) {
    throw std::runtime_error(fmt::format("{}:{}: {}", file, error.source().begin.line, error.description()));
  }
}

std::vector<std::string> BaseFile::namesIn(const std::string& section) const {
  std::vector<std::string> names;
  if (const auto found = sections_.find(section); found != sections_.end()) {
    for (const auto& [name, keys] : found->second) {
      if (name != "*") names.push_back(name);
    }
  }
  return names;
}

std::optional<std::string> BaseFile::valueOf(const Unit& unit) const {
  const auto section = sections_.find(unit.section);
  if (section == sections_.end()) return std::nullopt;
  for (const std::string& name : {unit.name, std::string("*")}) {
    const auto table = section->second.find(name);
    if (table == section->second.end()) continue;
    const auto value = table->second.find(unit.key);
    if (value == table->second.end()) continue;
    std::string text = value->second;
    std::erase_if(text, [](char c) { return c == '"' || c == '\''; });
    return text;
  }
  return std::nullopt;
}

std::string BaseFile::text(const Setting& setting, const ProgramFacts& facts, const FileTexts& texts) const {
  auto sections = sections_;
  if (setting.contains({"streams", "*", "storage"})) {
    for (const auto& [name, storage] : facts.streams)
      sections["streams"][name].try_emplace("storage", tomlString(storage));
  }
  for (const auto& [unit, value] : setting) {
    Keys& keys = sections[unit.section][unit.name];
    keys[unit.key] = tomlString(value);
    const auto own = facts.called.find(unit.name);
    if (unit.section != "kernels" || own == facts.called.end() || !chooses(own->second, unit.key)) continue;
    keys["force"] = "true";
    std::erase_if(keys, [&](const auto& entry) {
      return chooses(own->second, entry.first) && !setting.contains({unit.section, unit.name, entry.first});
    });
  }
  std::string result = texts.head;
  for (const auto& [section, tables] : sections) {
    for (const auto& [name, keys] : tables) {
      result += fmt::format("{}[{}.{}]\n", result.empty() ? "" : "\n", section, tomlString(name));
      for (const auto& [key, value] : keys) {
        const bool isForced = section == "kernels" && key == "force";
        std::string comment = isForced ? "its calls choose by themselves" : "";
        if (!isForced && texts.comment) comment = texts.comment({section, name, key});
        const std::string line = fmt::format("{} = {}", key, value);
        result += comment.empty() ? line + '\n' : fmt::format("{:<30}  # {}\n", line, comment);
      }
    }
  }
  return result;
}

}  // namespace sk_tool::tune
