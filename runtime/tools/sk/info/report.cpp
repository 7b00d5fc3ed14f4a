// SPDX-License-Identifier: MIT
#include "info/report.hpp"

#include <fmt/format.h>

namespace sk_tool {

namespace {

std::string textOf(const Json& value) {
  if (value.is_number_float()) return fmt::format("{:g}", value.get<double>());
  return value.is_string() ? value.get<std::string>() : value.dump();
}

double number(const Json& object, const char* name) { return object.at(name).get<double>(); }

class Report {
 public:
  explicit Report(const Json& info) : info_(info) {}

  std::string text() {
    add("{}\n", textOf(info_.at("name")));
    const bool hasGl = info_.contains("driver");
    hasGl ? driver() : processor();
    operations();
    contraction();
    ownOperations();
    if (hasGl) exactSums();
    functions();
    specialValues();
    if (hasGl) texels();
    indices();
    doubles();
    costs(hasGl);
    traits();
    line("measured", "in {} s, by StreamKernel {}; sk info --refresh measures again",
         number(info_, "measured_in_seconds"), textOf(info_.at("streamkernel")));
    return text_;
  }

 private:
  template <class... Values>
  void add(fmt::format_string<Values...> format, Values&&... values) {
    fmt::format_to(std::back_inserter(text_), format, std::forward<Values>(values)...);
  }
  /// Writes a subject, which may be empty, and its values.
  template <class... Values>
  void line(std::string_view subject, fmt::format_string<Values...> format, Values&&... values) {
    add("  {:<16}", subject);
    add(format, std::forward<Values>(values)...);
    text_ += '\n';
  }

  void driver() {
    line("driver", "{}", textOf(info_.at("driver")));
    line("language", "{}, profile {}", textOf(info_.at("shading_language")), textOf(info_.at("profile")));
    line("renders", "{}", info_.at("software").get<bool>() ? "in software" : "in hardware");
    const Json& limits = info_.at("limits");
    line("promises",
         "textures of {0} x {0} texels, {1} layers; {2} draw buffers, {3} images of compute programs, {4} "
         "texture "
         "units, {5} uniform components",
         textOf(limits.at("texture_side")), textOf(limits.at("texture_layers")),
         textOf(limits.at("draw_buffers")), textOf(limits.at("images")), textOf(limits.at("texture_units")),
         textOf(limits.at("uniform_components")));
    const Json& allocates = info_.at("allocates");
    line("gives", "textures {} texels wide or high, {} layers, {:.3g} GiB in one texture",
         textOf(allocates.at("texture_side")), textOf(allocates.at("texture_layers")),
         number(allocates, "texture_bytes") / (1 << 30));
  }

  void processor() {
    const Json& processor = info_.at("processor");
    line("processor", "{}", textOf(processor.at("name")));
    line("", "{} threads, {}", textOf(processor.at("threads")), textOf(processor.at("simd")));
  }

  void operations() {
    line("operation", "{:<34}{:>10}{:>10}   error in ulp", "[least, most]", "largest", "mean");
    for (const Json& row : info_.at("operations")) {
      add("  {:<16}{:<34}{:>10.3g}{:>10.3g}{}\n", "  " + textOf(row.at("name")),
          fmt::format("[{:.3g}, {:.3g}]", number(row, "min_signed"), number(row, "max_signed")),
          number(row, "max"), number(row, "mean"),
          row.at("correctly_rounded").get<bool>() ? "   correctly rounded" : "");
    }
  }

  void contraction() {
    std::string_view subject = "contraction";
    for (const auto& [what, is] : info_.at("contraction").items()) {
      line(subject, "{} is {}", what, textOf(is));
      subject = "";
    }
  }

  void ownOperations() {
    if (!info_.contains("own_operations")) return;
    const Json& own = info_.at("own_operations");
    const std::string by = textOf(own.at("by"));
    line("as written", "{:.3g} % of a kernel's own operations differ{}", 100 * number(own, "differ_exact"),
         by == "none" ? ", without a barrier"
                      : fmt::format(" behind {}, {:.3g} % with Contraction::Fast", by,
                                    100 * number(own, "differ_fast")));
  }

  void exactSums() {
    const Json& trials = info_.at("exact_sums");
    line("exact sums",
         "sums and products with what they lose, of {} pairs wrong:", textOf(trials.at("pairs")));
    for (const char* barrier : {"none", "xor", "precise"}) {
      const Json& trial = trials.at(barrier);
      if (trial.is_string()) {
        line("", "  {:<9}{}", barrier, textOf(trial));
      } else {
        line("", "  {:<9}{:.3g} % of the sums, {:.3g} % of the products{}", barrier,
             100 * number(trial, "wrong_sums"), 100 * number(trial, "wrong_products"),
             trials.at("taken") == barrier ? "   taken" : "");
      }
    }
  }

  void functions() {
    line("function", "{:<34}{:>10}{:>10}{:>12}", "arguments", "largest", "mean", "absolute");
    for (const Json& row : info_.at("functions")) {
      std::string range = textOf(row.at("range"));
      if (row.contains("range2")) range += ", " + textOf(row.at("range2"));
      add("  {:<16}{:<34}{:>10.3g}{:>10.3g}{:>12.3g}", "  " + textOf(row.at("name")), range,
          number(row, "max"), number(row, "mean"), number(row, "max_absolute"));
      if (row.at("not_finite") != 0) add("   {} are no numbers", textOf(row.at("not_finite")));
      text_ += '\n';
    }
  }

  void specialValues() {
    const Json& list = info_.at("special_values");
    std::string others;
    std::size_t right = 0;
    for (const Json& row : list) {
      if (row.at("gives") == row.at("ieee_754")) {
        ++right;
      } else {
        fmt::format_to(std::back_inserter(others), "  {:<16}{:<34}is {}, not {}\n", "",
                       textOf(row.at("expression")), textOf(row.at("gives")), textOf(row.at("ieee_754")));
      }
    }
    line("special values", "{} of {} as in IEEE 754{}", right, list.size(),
         others.empty() ? "" : "; d is 2^-130");
    text_ += others;
  }

  void texels() {
    const Json& half = info_.at("half_stores");
    line("half stores", "{}; 65520 becomes {}, 1e6 {}, denormals {}", textOf(half.at("rounding")),
         textOf(half.at("65520 becomes")), textOf(half.at("1e6 becomes")), textOf(half.at("denormals")));
    const Json& filter = info_.at("filter");
    line("filter", "{} bits of weight{}, off by {:.3g} at most", textOf(filter.at("weight_bits")),
         filter.at("weight_bits") == 16 ? " or more" : "", number(filter, "max_absolute"));
  }

  void traits() {
    if (info_.contains("kind")) line("known as", "{}", textOf(info_.at("kind")));
    const Json traits = info_.value("traits", Json::array());
    if (!traits.empty())
      line("assumed", "{:<24}{:>10}   [devices] of a configuration file changes it", "", "value");
    for (const Json& trait : traits) {
      add("  {:<16}{:<24}{:>10}   {} ({})\n", "", textOf(trait.at("name")), textOf(trait.at("value")),
          textOf(trait.at("meaning")), textOf(trait.at("reason")));
    }
  }

  void indices() {
    const Json& indices = info_.at("indices");
    std::string wrong;
    for (const char* way : {"row", "column", "linearised"}) {
      if (!indices.at(std::string(way) + "_exact").get<bool>()) wrong += fmt::format(", wrong in a {}", way);
    }
    line("indices", "tried to {} in rows and columns, {} linearised{}; int to float is exact to {}",
         textOf(indices.at("row")), textOf(indices.at("linearised")), wrong.empty() ? ": exact" : wrong,
         textOf(indices.at("int_to_float_exact_to")));
  }

  void doubles() {
    const Json& doubles = info_.at("doubles");
    line("doubles", "{}; right bits of + {}, * {}, / {}, sqrt {}", textOf(doubles.at("form")),
         textOf(doubles.at("bits of +")), textOf(doubles.at("bits of *")), textOf(doubles.at("bits of /")),
         textOf(doubles.at("bits of sqrt")));
  }

  void costs(bool hasGl) {
    const Json& costs = info_.at("costs");
    std::string_view subject = "bandwidth";
    for (const auto& [type, rates] : costs.at("gigabytes_per_second").items()) {
      line(subject, "{:<8}upload {:.3g}, readback {:.3g}, copy on the device {:.3g} GB/s", type,
           number(rates, "upload"), number(rates, "readback"), number(rates, "copy"));
      subject = "";
    }
    line("costs", "a call {:.3g} us, a pass that needs the one before {:.3g} us, with readback {:.3g} us",
         number(costs, "call_us"), number(costs, "pass_us"), number(costs, "pass_and_readback_us"));
    if (hasGl) line("", "a program that the driver has never seen {:.3g} ms", number(costs, "compile_ms"));
    std::string ratios;
    for (const auto& [kernels, ratio] : info_.at("compute_over_fragment").items()) {
      ratios += fmt::format("{}{} {:.3g}", ratios.empty() ? "" : ", ", kernels, ratio.get<double>());
    }
    if (!ratios.empty()) line("", "compute programs over fragment programs: {} times", ratios);
  }

  const Json& info_;
  std::string text_;
};

}  // namespace

std::string report(const Json& info) { return Report(info).text(); }

Json readKept(std::string_view text) {
  constexpr int deepest = 16;  // printing takes stack space for every level
  bool isDeep = false;
  const auto look = [&](int depth, Json::parse_event_t, const Json&) { return !(isDeep |= depth > deepest); };
  const Json info = Json::parse(text, look, false);
  if (isDeep) return {};
  try {
    if (info.is_object() && info.at("schema") == infoSchema && !report(info).empty()) return info;
  } catch (const Json::exception&) {
    return {};  // not written by this program
  }
  return {};
}

}  // namespace sk_tool
