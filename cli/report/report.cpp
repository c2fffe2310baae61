// SPDX-License-Identifier: Apache-2.0
#include "cli/report/report.hpp"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <numeric>
#include <stdexcept>

#include "cli/recording/error.hpp"
#include "cli/recording/write.hpp"

namespace hemi::report {

Series Series::line(std::string name, const std::vector<double>& x, const std::vector<double>& y,
                    double longest_step, std::size_t buckets) {
  return {std::move(name), Style::kLine, envelope(x, y, buckets, longest_step), {}, {}};
}

Series Series::dots(std::string name, const std::vector<double>& x, const std::vector<double>& y) {
  if (x.size() != y.size()) throw std::invalid_argument("a curve needs one y for each x");
  std::vector<std::size_t> order;
  for (std::size_t i = 0; i < x.size(); ++i)
    if (!std::isnan(x[i]) && !std::isnan(y[i])) order.push_back(i);
  std::ranges::stable_sort(order, {}, [&](std::size_t i) { return x[i]; });
  std::vector<double> sorted_x, sorted_y;
  for (const std::size_t i : order) {
    sorted_x.push_back(x[i]);
    sorted_y.push_back(y[i]);
  }
  return {std::move(name), Style::kPoints, envelope(sorted_x, sorted_y), {}, {}};
}

void write_report(const std::string& path, const Report& report) {
  recording::write_text(path, to_html(report));
}

std::string report_path(const std::string& target, std::string_view name) {
  namespace fs = std::filesystem;
  const fs::path path(target);
  if (path.extension() == ".html" || path.extension() == ".htm") return target;
  std::error_code code;
  fs::create_directories(path, code);
  if (code || !fs::is_directory(path)) {
    throw recording::OutputError(target, code ? code.message() : "is no directory",
                                 "name a directory, or a file that ends in .html");
  }
  return (path / (std::string(name) + ".html")).string();
}

std::string command_line(const std::vector<std::string>& words) {
  constexpr std::string_view plain =
      "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_-./=,:+@%{}";
  std::string line;
  for (const auto& word : words) {
    if (!line.empty()) line += ' ';
    if (!word.empty() && word.find_first_not_of(plain) == std::string::npos) {
      line += word;
      continue;
    }
    line += '\'';
    for (const char c : word) line += c == '\'' ? std::string("'\\''") : std::string(1, c);
    line += '\'';
  }
  return line;
}

}  // namespace hemi::report
