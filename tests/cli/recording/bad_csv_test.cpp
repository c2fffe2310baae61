// SPDX-License-Identifier: Apache-2.0
#include <sys/stat.h>
#include <unistd.h>

#include <limits>
#include <ostream>

#include "cli/recording/csv_file.hpp"
#include "tests/cli/recording/scratch.hpp"

namespace hemi::recording::testing {
namespace {

struct BadCsv {
  const char* label;
  std::string_view content;
  std::vector<std::string_view> parts;  // of the message, the path aside
};

std::ostream& operator<<(std::ostream& out, const BadCsv& bad) {
  return out << bad.label;
}

using namespace std::string_view_literals;

const BadCsv kBad[] = {
    {"empty", "", {"a.csv: the file is empty"}},
    {"blank", "\n\n", {"no header"}},
    {"header_only", "time_s,rate_dph\n", {":1", "a header and no rows"}},
    {"comment_only", "# made by\n", {"no header"}},
    {"no_header", "0,1\n1,2\n", {":1", "numbers where the channel names should stand"}},
    {"header_in_comment", "# time_s,rate_dph\n0,1\n", {":2", "without '#'"}},
    {"binary",
     "\x7f"
     "ELF\x02\x01\x01\0\0"sv,
     {":1", "binary bytes"}},
    {"utf16", "\xFF\xFEt\0i\0m\0e\0"sv, {":1", "UTF-16", "UTF-8"}},
    {"latin1",
     "time_s,case_temp_degc [\xB0"
     "C]\n0,1\n",
     {":1", "not UTF-8"}},
    {"binary_row",
     "time_s,rate_dph\n0,1\n\x01\x02\xff,3\n",
     {":3", "time_s", "\\x01\\x02", "is not a number"}},
    {"truncated_row", "time_s,rate_dph\n0,1\n1,2\n2", {":4", "1 cells where the header names 2", "cut off"}},
    {"excess_cells", "time_s,rate_dph\n0,1,5\n", {":2", "3 cells where the header names 2"}},
    {"blank_row_inside", "time_s,rate_dph\n0,1\n\n2,3\n", {":3", "1 cells"}},
    {"text_cell", "time_s,rate_dph\n0,1\n1,off\n", {":3: rate_dph", "'off' is not a number"}},
    {"decimal_comma", "time_s;rate_dph\n0,5;1\n", {":1", "not separated by commas"}},
    {"two_signs", "time_s,rate_dph\n0,+-1\n", {":2: rate_dph", "'+-1' is not a number"}},
    {"hexadecimal", "time_s,rate_dph\n0,0x10\n", {":2: rate_dph", "not a number"}},
    {"number_and_text", "time_s,rate_dph\n0,12 V\n", {":2: rate_dph", "'12 V' is not a number"}},
    {"infinity", "time_s,rate_dph\n0,1\n1,-inf\n", {":3: rate_dph", "is infinite", "empty"}},
    {"infinity_word", "time_s,rate_dph\n0,Infinity\n", {":2: rate_dph", "is infinite"}},
    {"overflow", "time_s,rate_dph\n0,1e999\n", {":2: rate_dph", "is infinite"}},
    {"nan_time", "time_s,rate_dph\n0,1\nnan,2\n2,3\n", {":3: time_s", "the time is missing"}},
    {"empty_time", "time_s,rate_dph\n,1\n1,2\n", {":2: time_s", "the time is missing"}},
    {"infinite_time", "time_s,rate_dph\n0,1\ninf,2\n", {":3: time_s", "infinite"}},
    {"backwards", "time_s,rate_dph\n0,1\n2,1\n1,2\n", {":4: time_s", "time runs backwards, from 2 to 1"}},
    {"repeated", "time_s,rate_dph\n0,1\n1,1\n1,2\n", {":4: time_s", "the time 1 is repeated"}},
    {"single_row", "time_s,rate_dph\n0,1\n", {":2: time_s", "sample_rate_hz"}},
    {"no_time_no_rate", "rate_dph\n1\n2\n", {"time_s", "sample_rate_hz", "a.json"}},
    {"all_missing", "time_s,rate_dph\n0,\n1,nan\n", {"every value of every channel is missing"}},
    {"unknown_channel",
     "time_s,rate_dps\n0,1\n1,2\n",
     {":1: rate_dps", "unknown channel", "nearest: 'rate_dph'", "quadrature_trim_v", "columns", "a.json"}},
    {"unknown_far", "time_s,\"gyro z [deg/h]\"\n0,1\n", {":1: gyro z [deg/h]", "unknown channel", "columns"}},
    {"wrong_unit",
     "time_s,rate_dph [deg/s]\n0,1\n1,2\n",
     {":1: rate_dph [deg/s]", "unit 'deg/s' where rate_dph is in deg/h", "\"scale\": 3600"}},
    {"kelvin", "time_s,case_temp_degc (K)\n0,1\n", {"unit 'K'", "\"scale\": 1", "\"offset\": -273.15"}},
    {"strange_unit", "time_s,rate_dph [furlong]\n0,1\n", {"'furlong'", "\"scale\": ..."}},
    {"doubled", "time_s,rate_dph,rate_dph\n0,1,2\n", {":1", "two columns are named 'rate_dph'"}},
    {"doubled_channel", "time_s,rate_dph,rate_dph [deg/h]\n0,1,2\n", {":1: rate_dph", "two columns"}},
    {"nameless", "time_s,,rate_dph\n0,1,2\n", {":1", "column 2 has no name"}},
    {"open_quote", "time_s,\"rate_dph\n0,1\n", {":1", "quote"}},
    {"raw_capture", "time_s,adc_x\n0,1\n1,2\n", {"adc_x", "raw capture", "hemi run"}},
};

class BadCsvTest : public ScratchTest, public ::testing::WithParamInterface<BadCsv> {};

TEST_P(BadCsvTest, NamesFileLineChannelAndRemedy) {
  const std::string csv = file("a.csv", GetParam().content);
  expect_input_error([&] { read_recording(csv); }, {csv});
  for (const std::string_view part : GetParam().parts) {
    expect_input_error([&] { read_recording(csv); }, {part});
  }
}

INSTANTIATE_TEST_SUITE_P(Files, BadCsvTest, ::testing::ValuesIn(kBad),
                         [](const auto& made) { return std::string(made.param.label); });

using BadFile = ScratchTest;

TEST_F(BadFile, Missing) {
  expect_input_error([&] { read_recording(path("none.csv")); }, {path("none.csv"), "No such file"});
}

TEST_F(BadFile, Directory) {
  ASSERT_EQ(::mkdir(path("d.csv").c_str(), 0755), 0);
  expect_input_error([&] { read_recording(path("d.csv")); }, {path("d.csv"), "is a directory"});
}

TEST_F(BadFile, NotReadable) {
  const std::string csv = file("a.csv", "time_s,rate_dph\n0,1\n1,2\n");
  ASSERT_EQ(::chmod(csv.c_str(), 0), 0);
  ASSERT_EQ(::chmod(path("").c_str(), 0755), 0);
  const bool root = ::geteuid() == 0;  // root reads everything: become somebody else meanwhile
  constexpr uid_t kNobody = 65534;
  if (root && ::seteuid(kNobody) != 0) GTEST_SKIP() << "root that may not change its user";
  expect_input_error([&] { read_recording(csv); }, {csv, "Permission denied"});
  if (root) {
    ASSERT_EQ(::seteuid(0), 0);
  }
}

TEST_F(BadFile, SidecarWithSyntaxErrorNamesItsLine) {
  const std::string csv = file("a.csv", "time_s,rate_dph\n0,1\n1,2\n");
  file("a.json", "{\"device\": \"A\",\n\"sample_rate_hz\" 10\n}\n");
  expect_input_error([&] { read_recording(csv); }, {"a.json:2", "not valid JSON"});
}

TEST_F(BadFile, SidecarOfWrongKind) {
  const std::string csv = file("a.csv", "time_s,rate_dph\n0,1\n1,2\n");
  file("a.json", R"({"format": "hemi-model/1"})");
  expect_input_error([&] { read_recording(csv); }, {"a.json", "no sidecar", "hemi-model/1"});
  file("a.json", R"([1, 2])");
  expect_input_error([&] { read_recording(csv); }, {"a.json", "no JSON object"});
  file("a.json", R"({"columns": ["x"]})");
  expect_input_error([&] { read_recording(csv); }, {"a.json: columns", "expected an object"});
  file("a.json", R"({"sample_rate_hz": "fast"})");
  expect_input_error([&] { read_recording(csv); }, {"a.json: sample_rate_hz", "expected a number"});
  file("a.json", R"({"sample_rate_hz": 0})");
  expect_input_error([&] { read_recording(csv); }, {"a.json: sample_rate_hz", "above zero"});
  file("a.json", R"({"sample_rate_hz": 1e999})");
  expect_input_error([&] { read_recording(csv); }, {"a.json", "too large"});
}

TEST_F(BadFile, SoundIsNoTelemetry) {
  const std::string wav = file("a.wav", "RIFF....");
  expect_input_error([&] { read_recording(wav); }, {wav, "raw capture"});
}

TEST_F(BadFile, RequireNamesTheQuestion) {
  const Recording recording = read_recording(file("a.csv", "time_s,rate_dph,supply_v\n0,1,\n1,2,\n"));
  expect_input_error([&] { recording.require("frequency_hz", "the thermometer"); },
                     {"a.csv: frequency_hz", "which the thermometer needs", "columns"});
  // All missing is as good as absent, and said so.
  expect_input_error([&] { recording.require("supply_v", "the supply's effect"); }, {"supply_v"});
  ASSERT_EQ(recording.notes.size(), 1U);
  EXPECT_NE(recording.notes[0].find("supply_v: every value is missing"), std::string::npos);
}

using GoodCsv = ScratchTest;

TEST_F(GoodCsv, ToleratedForms) {
  const std::string csv = file("t.csv",
                               "\xEF\xBB\xBF# made by a bench\r\n#\r\n\"time_s\" , \"a \"\"b\"\", c\"\r\n "
                               "0,+1.5\r\n1,\r\n2,-NaN\r\n3,\"4\"\r\n"
                               "4,1e-400\r\n5,-.5\r\n6,-nan(ind)\r\n\r\n\r\n");
  const Table table = read_csv(csv);
  EXPECT_EQ(table.first_line, 4U);
  ASSERT_EQ(table.columns.size(), 2U);
  EXPECT_EQ(table.columns[0].name, "time_s");
  EXPECT_EQ(table.columns[1].name, "a \"b\", c");
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_TRUE(same_values(table.columns[0].values, {0, 1, 2, 3, 4, 5, 6}));
  EXPECT_TRUE(same_values(table.columns[1].values, {1.5, nan, nan, 4.0, 0.0, -0.5, nan}));
  EXPECT_TRUE(table.notes.empty());
}

TEST_F(GoodCsv, LastLineWithoutEndIsReadAndNoted) {
  const Table table = read_csv(file("t.csv", "time_s,rate_dph\n0,1\n1,25"));
  EXPECT_TRUE(same_values(table.columns[1].values, {1.0, 25.0}));
  ASSERT_EQ(table.notes.size(), 1U);
  EXPECT_NE(table.notes[0].find("t.csv:3"), std::string::npos);
}

}  // namespace
}  // namespace hemi::recording::testing
