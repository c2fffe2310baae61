// SPDX-License-Identifier: Apache-2.0
#include "cli/report/ticks.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace hemi::report {
namespace {

std::string superscript(int exponent) {
  constexpr std::array digits = {"⁰", "¹", "²", "³", "⁴", "⁵", "⁶", "⁷", "⁸", "⁹"};
  std::string text = exponent < 0 ? "⁻" : "";
  for (const char c : fmt::format("{}", std::abs(exponent)))
    text += digits[static_cast<std::size_t>(c - '0')];
  return text;
}

/// The minus sign of typography, not the hyphen.
std::string with_minus(std::string text) {
  if (text.starts_with('-')) text.replace(0, 1, "−");
  return text;
}

std::string power_of_ten(double mantissa, int exponent) {
  const std::string ten = "10" + superscript(exponent);
  if (mantissa == 1.0) return ten;
  return with_minus(fmt::format("{:g}·", mantissa)) + ten;
}

std::string decade_label(int mantissa, int exponent) {
  if (exponent >= -3 && exponent <= 4) return fmt::format("{:g}", mantissa * std::pow(10.0, exponent));
  return power_of_ten(mantissa, exponent);
}

}  // namespace

std::string nice_number(double value, int significant) {
  if (value == 0.0) return "0";
  const std::string text = fmt::format("{:.{}e}", value, significant - 1);
  const auto e = text.find('e');
  const double rounded = std::stod(text);
  if (std::abs(rounded) >= 1e-4 && std::abs(rounded) < 1e6)
    return with_minus(fmt::format("{:.{}g}", rounded, std::max(significant, 6)));
  return power_of_ten(std::stod(text.substr(0, e)), std::stoi(text.substr(e + 1)));
}

std::vector<Tick> linear_ticks(double low, double high, int wanted) {
  const double raw = (high - low) / std::max(1, wanted);
  const int exponent = static_cast<int>(std::floor(std::log10(raw)));
  const double base = std::pow(10.0, exponent);
  const double step = base * (raw / base <= 1.0   ? 1.0
                              : raw / base <= 2.0 ? 2.0
                              : raw / base <= 5.0 ? 5.0
                                                  : 10.0);
  const int step_exponent = static_cast<int>(std::floor(std::log10(step) + 1e-9));
  const double largest = std::max(std::abs(low), std::abs(high));
  std::vector<Tick> ticks;
  for (double k = std::ceil(low / step - 1e-9); k * step <= high + 1e-9 * step; k += 1.0) {
    const double value = k == 0.0 ? 0.0 : k * step;
    if (!ticks.empty() && value <= ticks.back().value) break;  // the step is below the numbers' resolution
    // Digits down to the step; powers of ten where plain digits would be long.
    const bool plain = largest < 1e6 && (step_exponent >= -6 || largest >= 1.0);
    ticks.push_back({value, plain ? with_minus(fmt::format("{:.{}f}", value, std::max(0, -step_exponent)))
                                  : nice_number(value, 4)});
  }
  return ticks;
}

std::vector<Tick> log_ticks(double low, double high) {
  const int first = static_cast<int>(std::floor(std::log10(low)));
  const int last = static_cast<int>(std::ceil(std::log10(high)));
  const bool few = std::log10(high / low) < 2.0;
  const int every = std::max(1, (last - first) / 8);
  std::vector<Tick> ticks;
  for (int e = first; e <= last; ++e) {
    for (int m = 1; m <= 9; ++m) {
      const double value = m * std::pow(10.0, e);
      if (value < low * (1 - 1e-12) || value > high * (1 + 1e-12)) continue;
      const bool labelled = (m == 1 && e % every == 0) || (few && (m == 2 || m == 5));
      ticks.push_back({value, labelled ? decade_label(m, e) : ""});
    }
  }
  return ticks;
}

}  // namespace hemi::report
