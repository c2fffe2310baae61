// SPDX-License-Identifier: Apache-2.0
#include "cli/report/chain.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>

#include "cli/report/markup.hpp"

namespace hemi::report {
namespace {

/// Blocks by their place along the chain (`along`: the way of the signal) and across it. The drawing for wide
/// pages runs to the right, the one for narrow pages down.
struct Block {
  std::string_view id;
  std::string_view first, second;  ///< two lines of the label
  int along, across;
  bool plant;
};
constexpr std::array<Block, 16> kBlocks = {{
    {"electrodes", "electrodes", "", 0, 0, true},
    {"resonator", "resonator", "", 0, 1, true},
    {"thermal", "thermal", "network", 0, 2, true},
    {"modulator", "modulator", "DACs", 1, 0, false},
    {"adc", "pickoffs", "ADC", 1, 1, true},
    {"oscillator", "board", "oscillator", 1, 2, true},
    {"nco", "nco", "", 2, 2, false},
    {"demodulator", "demodulator", "", 2, 1, false},
    {"cic", "cic", "", 3, 1, false},
    {"image_filter", "image", "filter", 4, 1, false},
    {"phase_detector", "phase", "detector", 5, 1, false},
    {"loops", "control", "loops", 5, 0, false},
    {"reference_phase_loop", "reference", "phase loop", 5, 2, false},
    {"frequency_tracker", "frequency", "tracker", 6, 1, false},
    {"thermometer", "thermometer", "", 7, 1, false},
    {"bias_model", "bias", "model", 8, 1, false},
}};
constexpr Block kRateFilter = {"rate_filter", "rate", "filter", 6, 0, false};

struct Arrow {
  std::string_view from, to;
};
constexpr std::array<Arrow, 16> kArrows = {{{"thermal", "resonator"},
                                            {"electrodes", "resonator"},
                                            {"resonator", "adc"},
                                            {"oscillator", "adc"},
                                            {"modulator", "electrodes"},
                                            {"adc", "demodulator"},
                                            {"nco", "demodulator"},
                                            {"demodulator", "cic"},
                                            {"cic", "image_filter"},
                                            {"image_filter", "phase_detector"},
                                            {"phase_detector", "loops"},
                                            {"phase_detector", "reference_phase_loop"},
                                            {"phase_detector", "frequency_tracker"},
                                            {"reference_phase_loop", "nco"},
                                            {"loops", "modulator"},
                                            {"frequency_tracker", "thermometer"}}};
constexpr std::array<Arrow, 2> kLastArrows = {{{"thermometer", "bias_model"}, {"loops", "rate_filter"}}};

/// Other names of the blocks.
struct Alias {
  std::string_view name, id;
};
constexpr std::array<Alias, 45> kAliases = {{{"pickoff", "adc"},
                                             {"pickoffs", "adc"},
                                             {"converter", "adc"},
                                             {"converters", "adc"},
                                             {"electronics", "adc"},
                                             {"adc_x", "adc"},
                                             {"adc_y", "adc"},
                                             {"shell", "resonator"},
                                             {"sensor", "resonator"},
                                             {"chamber", "thermal"},
                                             {"frequency", "resonator"},
                                             {"damping", "resonator"},
                                             {"frequency_hz", "frequency_tracker"},
                                             {"tracker", "frequency_tracker"},
                                             {"derivative", "thermometer"},
                                             {"temperature", "thermometer"},
                                             {"temperature_degc", "thermometer"},
                                             {"thermal_network", "thermal"},
                                             {"housing", "thermal"},
                                             {"case_temp_degc", "thermal"},
                                             {"board_oscillator", "oscillator"},
                                             {"clock", "oscillator"},
                                             {"board_temp_degc", "oscillator"},
                                             {"forcer", "electrodes"},
                                             {"electrode", "electrodes"},
                                             {"actuator", "electrodes"},
                                             {"supply_v", "electrodes"},
                                             {"dac", "modulator"},
                                             {"dacs", "modulator"},
                                             {"amplitude_loop", "loops"},
                                             {"quadrature_loop", "loops"},
                                             {"rebalance_loop", "loops"},
                                             {"start_up", "loops"},
                                             {"control", "loops"},
                                             {"control_loops", "loops"},
                                             {"drive_v", "loops"},
                                             {"quadrature_v", "loops"},
                                             {"amplitude", "loops"},
                                             {"phase_loop", "reference_phase_loop"},
                                             {"rate_dph", "rate_filter"},
                                             {"status", "bias_model"},
                                             {"bias", "bias_model"},
                                             {"drift_model", "bias_model"},
                                             {"force_v", "electrodes"},
                                             {"displacement_v", "resonator"}}};

struct Place {
  double x, y;
};
struct Grid {
  bool down;  ///< narrow page
  double pitch_along, pitch_across, width, height;

  Place centre(const Block& b) const {
    const double a = (b.along + 0.5) * pitch_along, c = (b.across + 0.5) * pitch_across;
    return down ? Place{c, a} : Place{a, c};
  }
};
constexpr Grid kWide = {false, 106.0, 74.0, 90.0, 44.0};
constexpr Grid kNarrow = {true, 62.0, 114.0, 100.0, 40.0};

const Block& block(std::string_view id) {
  if (id == kRateFilter.id) return kRateFilter;
  return *std::ranges::find(kBlocks, id, &Block::id);
}

std::string line(const Grid& grid, const Arrow& arrow) {
  const Place a = grid.centre(block(arrow.from)), b = grid.centre(block(arrow.to));
  const bool level = std::abs(a.y - b.y) < 1.0;
  const double half = 0.5 * (level ? grid.width : grid.height);
  const double way = level ? (b.x > a.x ? 1.0 : -1.0) : (b.y > a.y ? 1.0 : -1.0);
  return level ? fmt::format("M{:.0f} {:.0f}H{:.0f}", a.x + way * half, a.y, b.x - way * (half + 1))
               : fmt::format("M{:.0f} {:.0f}V{:.0f}", a.x, a.y + way * half, b.y - way * (half + 1));
}

/// From the rate filter round the corner into the bias model.
std::string rate_line(const Grid& grid) {
  const Place a = grid.centre(kRateFilter), b = grid.centre(block("bias_model"));
  return grid.down ? fmt::format("M{:.0f} {:.0f}V{:.0f}H{:.0f}", a.x, a.y + grid.height / 2, b.y,
                                 b.x + grid.width / 2 + 1)
                   : fmt::format("M{:.0f} {:.0f}H{:.0f}V{:.0f}", a.x + grid.width / 2, a.y, b.x,
                                 b.y - grid.height / 2 - 1);
}

std::string box(const Grid& grid, const Block& b, bool marked) {
  const Place c = grid.centre(b);
  std::string svg = fmt::format(
      "<g class=\"{}{}\" data-stage=\"{}\"><rect x=\"{:.0f}\" y=\"{:.0f}\" width=\"{:.0f}\" "
      "height=\"{:.0f}\" "
      "rx=\"4\"/>",
      b.plant ? "plant" : "core", marked ? " marked" : "", b.id, c.x - grid.width / 2, c.y - grid.height / 2,
      grid.width, grid.height);
  if (b.second.empty()) {
    svg += fmt::format("<text x=\"{:.0f}\" y=\"{:.0f}\">{}</text>", c.x, c.y + 4, b.first);
  } else {
    svg += fmt::format("<text x=\"{:.0f}\" y=\"{:.0f}\">{}</text><text x=\"{:.0f}\" y=\"{:.0f}\">{}</text>",
                       c.x, c.y - 3, b.first, c.x, c.y + 12, b.second);
  }
  // A flag on the corner: the mark is seen without colour as well.
  if (marked) {
    svg += fmt::format(
        "<path class=\"flag\" d=\"M{0:.0f} {1:.0f}m-9 0a9 9 0 1 0 18 0a9 9 0 1 0 -18 0\"/>"
        "<text class=\"flag\" x=\"{0:.0f}\" y=\"{2:.0f}\">!</text>",
        c.x + grid.width / 2 - 2, c.y - grid.height / 2 + 2, c.y - grid.height / 2 + 7);
  }
  return svg + "</g>";
}

std::string drawing(const Grid& grid, const std::vector<std::string>& marked, std::string_view label) {
  const double along = 9 * grid.pitch_along, across = 3 * grid.pitch_across;
  const char* name = grid.down ? "narrow" : "wide";
  std::string svg = fmt::format(
      "<svg class=\"chain {}\" viewBox=\"0 0 {:.0f} {:.0f}\" role=\"img\" aria-label=\"{}\"><defs><marker "
      "id=\"arrow-{}\" viewBox=\"0 0 8 8\" refX=\"7\" refY=\"4\" markerWidth=\"7\" markerHeight=\"7\" "
      "orient=\"auto\"><path class=\"head\" d=\"M0 0.5L8 4L0 7.5z\"/></marker></defs>",
      name, grid.down ? across : along, grid.down ? along : across, escaped(label), name);
  std::string path;
  const std::string arrow = fmt::format("\" marker-end=\"url(#arrow-{})\"/>", name);
  for (const auto& each : kArrows) path += "<path class=\"wire\" d=\"" + line(grid, each) + arrow;
  for (const auto& each : kLastArrows) path += "<path class=\"wire\" d=\"" + line(grid, each) + arrow;
  path += "<path class=\"wire\" d=\"" + rate_line(grid) + arrow;
  svg += path;
  const auto is_marked = [&](std::string_view id) { return std::ranges::find(marked, id) != marked.end(); };
  for (const auto& b : kBlocks) svg += box(grid, b, is_marked(b.id));
  return svg + box(grid, kRateFilter, is_marked(kRateFilter.id)) + "</svg>";
}

/// Blocks of "resonator, oscillator or chamber".
std::vector<std::string> stages_of(std::string_view names) {
  constexpr std::string_view kBetween[] = {", ", " or "};
  std::vector<std::string> stages;
  while (!names.empty()) {
    std::size_t end = names.size(), next = names.size();
    for (const auto between : kBetween) {
      const std::size_t at = names.find(between);
      if (at >= end) continue;
      end = at;
      next = at + between.size();
    }
    if (const auto stage = stage_of(names.substr(0, end))) stages.push_back(*stage);
    names.remove_prefix(next);
  }
  return stages;
}

}  // namespace

std::optional<std::string> stage_of(std::string_view name) {
  std::string key;
  for (const char c : name)
    key += c == ' ' || c == '-' ? '_' : static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  if (key == kRateFilter.id || std::ranges::find(kBlocks, key, &Block::id) != kBlocks.end()) return key;
  const auto alias = std::ranges::find(kAliases, key, &Alias::name);
  if (alias == kAliases.end()) return std::nullopt;
  return std::string(alias->id);
}

std::string chain_svg(const Chain& chain) {
  std::vector<std::string> marked;
  std::string label = "The signal chain from the resonator to the bias model";
  for (const auto& mark : chain.marks) {
    const auto stages = stages_of(mark.stage);
    if (stages.empty()) continue;
    marked.insert(marked.end(), stages.begin(), stages.end());
    label += fmt::format("; marked: {}", mark.stage);
  }
  return drawing(kWide, marked, label) + drawing(kNarrow, marked, label);
}

}  // namespace hemi::report
