// SPDX-License-Identifier: Apache-2.0
#include "cli/recording/csv_file.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <optional>

#include "cli/recording/csv_cells.hpp"
#include "cli/recording/interrupt.hpp"
#include "cli/recording/progress.hpp"

namespace hemi::recording {
namespace {

// Lines of a file (or pipe) in large blocks; a line is valid until the next call.
class LineReader {
 public:
  explicit LineReader(const std::string& path) : path_(path) {
    require_readable(path);
    descriptor_ = ::open(path.c_str(), O_RDONLY | O_CLOEXEC);
    if (descriptor_ < 0) throw InputError({.path = path}, std::strerror(errno), "check the file");
    struct stat status {};
    if (::fstat(descriptor_, &status) == 0) size_ = static_cast<double>(status.st_size);
  }
  ~LineReader() { ::close(descriptor_); }
  LineReader(const LineReader&) = delete;
  LineReader& operator=(const LineReader&) = delete;

  std::optional<std::string_view> next() {
    std::size_t searched = 0;
    for (;;) {
      const std::string_view rest(buffer_.data() + begin_, end_ - begin_);
      const auto newline = rest.find('\n', searched);
      if (newline != std::string_view::npos) {
        begin_ += newline + 1;
        return finished(rest.substr(0, newline));
      }
      searched = rest.size();
      if (!fill()) break;
    }
    if (begin_ == end_) return std::nullopt;
    ends_with_newline_ = false;
    const std::string_view last(buffer_.data() + begin_, end_ - begin_);
    begin_ = end_;
    return finished(last);
  }

  std::size_t line() const { return line_; }
  bool ends_with_newline() const { return ends_with_newline_; }
  double bytes_read() const { return total_; }
  double size() const { return size_; }

 private:
  std::string_view finished(std::string_view text) {
    ++line_;
    if (line_ == 1 && text.starts_with("\xEF\xBB\xBF")) text.remove_prefix(3);
    if (text.ends_with('\r')) text.remove_suffix(1);
    return text;
  }

  // Moves what is left to the front and reads more behind it; false at the end.
  bool fill() {
    constexpr std::size_t kBlock = std::size_t{1} << 20;
    constexpr std::size_t kLongestLine = std::size_t{1} << 24;
    check_interrupt();
    if (end_ - begin_ > kLongestLine) {
      throw InputError({.path = path_, .line = line_ + 1}, "a line of more than 16 MiB: this is no CSV file",
                       "give a comma-separated text file");
    }
    std::copy(buffer_.begin() + static_cast<std::ptrdiff_t>(begin_),
              buffer_.begin() + static_cast<std::ptrdiff_t>(end_), buffer_.begin());
    end_ -= begin_;
    begin_ = 0;
    if (buffer_.size() < end_ + kBlock) buffer_.resize(end_ + kBlock);
    ssize_t count = 0;
    do {
      count = ::read(descriptor_, buffer_.data() + end_, kBlock);
    } while (count < 0 && errno == EINTR);
    if (count < 0) throw InputError({.path = path_}, std::strerror(errno), "check the file and its disk");
    end_ += static_cast<std::size_t>(count);
    total_ += static_cast<double>(count);
    return count > 0;
  }

  std::string path_;
  int descriptor_ = -1;
  std::vector<char> buffer_;
  std::size_t begin_ = 0, end_ = 0, line_ = 0;
  double total_ = 0.0, size_ = 0.0;
  bool ends_with_newline_ = true;
};

// The header's names; the reader then stands before the first row.
std::vector<std::string> header(LineReader& reader, const std::string& path) {
  while (const auto line = reader.next()) {
    if (is_blank(*line) || line->starts_with('#')) continue;
    return parse_header(*line, {.path = path, .line = reader.line()});
  }
  throw InputError({.path = path, .line = reader.line()}, "no header", "the first line names the channels");
}

struct Rows {
  const std::vector<std::string>& names;
  std::vector<Column*> sinks;  // nullptr: not wanted
  Place place;

  void append(std::string_view line) {
    std::size_t begin = 0;
    for (std::size_t i = 0; i < sinks.size(); ++i) {
      if (begin > line.size()) wrong_count(line);
      const auto comma = std::min(line.find(',', begin), line.size());
      if (sinks[i] != nullptr) {
        const CellResult cell = parse_cell(line.substr(begin, comma - begin));
        if (cell.problem != nullptr) {
          place.channel = names[i];
          throw InputError(place, in_quotes(line.substr(begin, comma - begin)) + " " + cell.problem,
                           cell.remedy);
        }
        sinks[i]->values.push_back(cell.value);
      }
      begin = comma + 1;
    }
    if (begin <= line.size()) wrong_count(line);
  }

  [[noreturn]] void wrong_count(std::string_view line) const {
    const auto found = static_cast<std::size_t>(std::ranges::count(line, ',')) + 1;
    throw InputError(
        place, fmt::format("{} cells where the header names {}", found, names.size()),
        found < names.size() ? "the row is cut off: remove or complete it" : "remove the cells in excess");
  }
};

// All rows; blank lines count as missing values in a file of one column, and as nothing at the end.
void read_rows(LineReader& reader, Rows& rows) {
  Progress progress("reading " + rows.place.path, std::max(reader.size(), 1.0));
  std::size_t blanks = 0, pending = 0;
  while (const auto line = reader.next()) {
    if (is_blank(*line)) {
      ++blanks;
      continue;
    }
    rows.place.line = reader.line() - blanks;
    for (; blanks > 0; --blanks, ++rows.place.line) rows.append("");
    rows.append(*line);
    if ((++pending & 0xfff) == 0) progress.update(reader.bytes_read());
  }
}

}  // namespace

Table read_csv(const std::string& path, const ColumnChooser& chooser) {
  LineReader reader(path);
  const std::vector<std::string> names = header(reader, path);
  const Place place{.path = path, .line = reader.line()};
  const std::vector<bool> wanted = chooser ? chooser(names, place) : std::vector<bool>(names.size(), true);
  Table table{.path = path, .first_line = reader.line() + 1};
  table.columns.reserve(names.size());
  Rows rows{names, {}, place};
  for (std::size_t i = 0; i < names.size(); ++i) {
    if (wanted[i]) table.columns.push_back({names[i], {}});
    rows.sinks.push_back(wanted[i] ? &table.columns.back() : nullptr);
  }
  read_rows(reader, rows);
  if (table.columns.empty()) {
    throw InputError(place, "no column is left to read", "map at least one column to a channel");
  }
  if (table.rows() == 0) {
    throw InputError(place, "a header and no rows", "record or export the file again");
  }
  if (!reader.ends_with_newline()) {
    table.notes.push_back(fmt::format("{}:{}: the last line has no line end: its last number may be cut off",
                                      path, reader.line()));
  }
  return table;
}

std::vector<std::string> read_csv_header(const std::string& path) {
  LineReader reader(path);
  return header(reader, path);
}

}  // namespace hemi::recording
