// SPDX-License-Identifier: Apache-2.0
// A report as a document: text first, then tables, the chain and plots; write_report makes one HTML file of
// it.
#ifndef HEMI_CLI_REPORT_REPORT_HPP
#define HEMI_CLI_REPORT_REPORT_HPP

#include <string>
#include <string_view>
#include <utility>
#include <variant>
#include <vector>

#include "cli/report/chain.hpp"
#include "cli/report/envelope.hpp"

namespace hemi::report {

struct Axis {
  std::string label{};  ///< what it is, "time"
  std::string unit{};   ///< "s"; "1" for a plain number
  bool log = false;     ///< points at or below zero are left out
};

enum class Style { kLine, kPoints };

/// One curve. `points` are real samples: an envelope (envelope.hpp) where there are many.
struct Series {
  std::string name{};
  Style style = Style::kLine;
  Points points{};
  /// Confidence interval, one value a point, or both empty.
  std::vector<double> lower{}, upper{};

  /// Samples (x ascending for lines; NaN in y: a break) as an envelope of at most `buckets` buckets. A step
  /// of x above `longest_step` breaks the line too.
  static Series line(std::string name, const std::vector<double>& x, const std::vector<double>& y,
                     double longest_step = 0.0, std::size_t buckets = kBuckets);
  /// Dots; put in the order of x, thinned to the extremes of kBuckets buckets where there are more.
  static Series dots(std::string name, const std::vector<double>& x, const std::vector<double>& y);
};

/// A stretch of x that the text speaks of.
struct Shade {
  double from = 0.0, to = 0.0;
  std::string label{};
  bool quiet = false;  ///< context (rows left out), not a finding
};

/// A horizontal or sloped straight line for the eye (straight on the axes as drawn): a level, a slope -1/2.
struct Guide {
  std::string name{};
  double x0 = 0.0, y0 = 0.0, x1 = 0.0, y1 = 0.0;
};

struct Plot {
  std::string title{};
  Axis x{}, y{};
  std::vector<Series> series{};
  std::vector<Shade> shades{};
  std::vector<Guide> guides{};
  std::string link{};  ///< plots of one name share their x axis
  std::string note{};  ///< a sentence below
  /// Command that shows a stretch at full resolution, with {from} and {to} for its ends; the page prints it
  /// with the ends in view. Empty: none.
  std::string stretch_command{};
};

struct Fact {
  std::string name{}, value{};
};

struct Table {
  std::string title{};
  std::vector<std::string> columns{};
  std::vector<std::vector<std::string>> rows{};  ///< cells that are numbers are set to the right
  std::string note{};
};

/// Figures with intervals on one common scale from `low` to `high`, targets as ticks: a table with a drawing
/// a row.
struct Intervals {
  struct Row {
    std::string name{};
    double value = 0.0, low = 0.0, high = 0.0;  ///< NaN: nothing to measure
    std::string count{}, target{};
    std::vector<double> target_marks{};
    std::string outcome{};              ///< "held", "missed", ...
    bool stands_out = false;            ///< the row is marked
    std::vector<std::string> others{};  ///< one cell a name in `others`
  };
  double low = 0.0, high = 1.0;
  std::vector<std::string> others{};  ///< further columns
  std::vector<Row> rows{};
  std::string note{};
};

/// Counts of what was said (columns) for what was true (rows); each row shaded by its shares.
struct Matrix {
  std::string title{};
  std::vector<std::string> rows{}, columns{};
  std::vector<std::vector<int>> counts{};  ///< rows x columns
  std::string note{};
};

struct Paragraph {
  std::string text{};
};

/// Text with its own line breaks, as on a terminal.
struct Verbatim {
  std::string text{};
};

struct Section {
  std::string heading{};
  std::vector<std::variant<Paragraph, Verbatim, Table, Plot, Chain, Intervals, Matrix>> parts{};
};

/// Colours the edge of the verdict; the words carry the meaning.
enum class Tone { kGood, kAttention, kNeutral };

struct Report {
  std::string kind{};     ///< "calibration", "run", ...
  std::string subject{};  ///< device or recording
  std::string verdict{};  ///< one sentence
  Tone tone = Tone::kNeutral;
  std::vector<Fact> facts{};  ///< few: they stand beside the verdict
  std::vector<Section> sections{};
  std::string command{};  ///< that makes this page
  /// The curves as they are, however large the page; otherwise they are thinned to two megabytes together.
  bool every_point = false;
};

/// The page as HTML: UTF-8, no reference to anything outside itself.
std::string to_html(const Report& report);

/// to_html into a file that appears whole or not at all. OutputError where it cannot be written.
void write_report(const std::string& path, const Report& report);

/// `target` is a file where it ends in .html or .htm, else a directory, which is made, with the page
/// `name`.html in it. OutputError where it cannot be made.
std::string report_path(const std::string& target, std::string_view name);

/// A command line as one would type it again: words quoted where a shell needs it.
std::string command_line(const std::vector<std::string>& words);

}  // namespace hemi::report

#endif  // HEMI_CLI_REPORT_REPORT_HPP
