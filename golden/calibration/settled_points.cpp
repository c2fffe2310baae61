// SPDX-License-Identifier: Apache-2.0
#include "golden/calibration/settled_points.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <fstream>
#include <string_view>

namespace hemi::calibration {
namespace {

constexpr std::string_view kTemperature = "settled_degc";
constexpr std::string_view kFrequency = "frequency_hz";

std::string_view trimmed(std::string_view text) {
  constexpr std::string_view kBlank = " \t\r";
  const std::size_t first = text.find_first_not_of(kBlank);
  if (first == std::string_view::npos) return {};
  return text.substr(first, text.find_last_not_of(kBlank) - first + 1);
}

std::vector<std::string_view> cells_of(std::string_view line) {
  std::vector<std::string_view> cells;
  for (std::size_t begin = 0;;) {
    const std::size_t comma = line.find(',', begin);
    cells.push_back(trimmed(line.substr(begin, comma - begin)));
    if (comma == std::string_view::npos) return cells;
    begin = comma + 1;
  }
}

[[noreturn]] void fail(const std::filesystem::path& path, int line, std::string_view column,
                       std::string_view what, std::string_view remedy) {
  throw InputError(fmt::format("{}:{}: {}: {}; {}", path.string(), line, column, what, remedy));
}

// What a message shows of a cell that may hold anything.
std::string printable(std::string_view cell) {
  std::string text;
  for (const char c : cell.substr(0, 24)) text += (c >= ' ' && c <= '~') ? c : '?';
  return text;
}

double number(const std::filesystem::path& path, int line, std::string_view column, std::string_view cell) {
  if (cell.empty()) fail(path, line, column, "the value is missing", "give a number or delete the line");
  double value = 0.0;
  const char* const first = cell.data() + (cell.front() == '+' ? 1 : 0);
  const auto [end, error] = std::from_chars(first, cell.data() + cell.size(), value);
  if (error != std::errc() || end != cell.data() + cell.size()) {
    fail(path, line, column, fmt::format("'{}' is not a number", printable(cell)),
         "write it as in 4424.90, with a point and without a unit");
  }
  if (!std::isfinite(value)) {
    fail(path, line, column, fmt::format("'{}' is not finite", printable(cell)),
         "give a number or delete the line");
  }
  return value;
}

std::size_t find_column(const std::filesystem::path& path, int line,
                        const std::vector<std::string_view>& header, std::string_view name) {
  const auto found = std::find(header.begin(), header.end(), name);
  if (found == header.end()) {
    fail(path, line, name, "there is no such column",
         fmt::format("name the columns {},{}", kTemperature, kFrequency));
  }
  return static_cast<std::size_t>(found - header.begin());
}

struct Rows {
  std::vector<double> temperature_degc;
  std::vector<double> frequency_hz;
  std::vector<std::string> printed_hz;
};

SettledPoints points_of(const Rows& rows) {
  SettledPoints points;
  const auto size = static_cast<Eigen::Index>(rows.frequency_hz.size());
  points.temperature_degc = Eigen::VectorXd::Map(rows.temperature_degc.data(), size);
  points.frequency_hz = Eigen::VectorXd::Map(rows.frequency_hz.data(), size);
  points.resolution_hz = printed_resolution(rows.printed_hz).value_or(0.0);
  return points;
}

}  // namespace

std::optional<double> printed_resolution(const std::vector<std::string>& values) {
  if (values.empty()) return std::nullopt;
  std::size_t decimals = 0;
  for (const std::string& value : values) {
    if (value.find_first_of("eE") != std::string::npos) return std::nullopt;
    const std::size_t point = value.find('.');
    if (point != std::string::npos) decimals = std::max(decimals, value.size() - point - 1);
  }
  return std::pow(10.0, -static_cast<double>(decimals));
}

SettledPoints read_settled_points(const std::filesystem::path& path, int order) {
  std::ifstream file(path, std::ios::binary);
  if (!file || std::filesystem::is_directory(path)) {
    fail(path, 0, "file", "cannot be opened", "check the name and the permissions");
  }
  Rows rows;
  std::size_t temperature_column = 0;
  std::size_t frequency_column = 0;
  std::size_t columns = 0;
  int line_number = 0;
  for (std::string text; std::getline(file, text);) {
    ++line_number;
    std::string_view line = text;
    constexpr std::string_view kByteOrderMark = "\xEF\xBB\xBF";
    if (line_number == 1 && line.starts_with(kByteOrderMark)) line.remove_prefix(kByteOrderMark.size());
    line = trimmed(line);
    if (line.empty() || line.front() == '#') continue;
    const std::vector<std::string_view> cells = cells_of(line);
    if (columns == 0) {
      temperature_column = find_column(path, line_number, cells, kTemperature);
      frequency_column = find_column(path, line_number, cells, kFrequency);
      columns = cells.size();
      continue;
    }
    if (cells.size() != columns) {
      fail(path, line_number, "row",
           fmt::format("{} values where the header names {} columns", cells.size(), columns),
           "complete the line or delete it");
    }
    rows.temperature_degc.push_back(number(path, line_number, kTemperature, cells[temperature_column]));
    rows.frequency_hz.push_back(number(path, line_number, kFrequency, cells[frequency_column]));
    rows.printed_hz.emplace_back(cells[frequency_column]);
    if (!(rows.frequency_hz.back() > 0.0)) {
      fail(path, line_number, kFrequency, "a frequency must be above zero", "give it in hertz");
    }
  }
  if (columns == 0) {
    fail(path, line_number, "file", "holds no header",
         fmt::format("begin with {},{}", kTemperature, kFrequency));
  }
  const auto count = static_cast<int>(rows.frequency_hz.size());
  if (count < order + 2) {
    fail(path, line_number, "row",
         fmt::format("{} settled points, order {} needs {}", count, order, order + 2),
         "record more settled temperatures or ask for a lower order");
  }
  return points_of(rows);
}

}  // namespace hemi::calibration
