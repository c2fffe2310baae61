// SPDX-License-Identifier: Apache-2.0
// hemi doctor: what is here, and what each missing part would enable.
// The library was built for an older language standard than ours; its interface is the same in both.
#define SC_DISABLE_API_VERSION_CHECK
#include <H5public.h>
#include <fmt/format.h>
#include <matio.h>
#include <sndfile.h>
#include <unistd.h>

#include <toml++/toml.h>
#include <Eigen/Core>
#include <array>
#include <boost/version.hpp>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <sstream>
#include <systemc>

#include "cli/commands.hpp"
#include "cli/installed.hpp"
#include "cli/recording/json.hpp"

namespace hemi::cli {
namespace {

namespace fs = std::filesystem;

/// A program of its own that something here calls.
struct Tool {
  const char* name;
  const char* version_option;
  const char* enables;
  const char* remedy;
};

constexpr Tool tools[] = {
    {"verilator", "--version", "building: rtl/ as a C++ model", "apt install verilator"},
    {"iverilog", "-V", "tests: rtl/ and the netlist in a second simulator", "apt install iverilog"},
    {"yosys", "-V", "scripts/synth: area, formal proofs", "apt install yosys"},
    {"nextpnr-ice40", "--version", "scripts/synth up5k, hx8k: place and route, clock",
     "apt install nextpnr-ice40"},
    {"icepack", "", "scripts/synth up5k --board: the bit stream", "apt install fpga-icestorm"},
    {"iceprog", "", "loading the bit stream into a board", "apt install fpga-icestorm"},
    {"gtkwave", "--version", "looking at hemi compare --waves FILE.fst", "apt install gtkwave"},
    {"chromium", "--version", "tests of the HTML reports", "apt install chromium"},
    {"gnuplot", "--version", "scripts/run: plots of the main job", "apt install gnuplot-nox"},
    {"bambu", "--version", "scripts/hls: the kernels through an HLS compiler",
     "docs/hls.md says how it is built"},
};

/// The first executable file of that name on PATH; empty where there is none.
fs::path on_path(const std::string& name) {
  const char* path = std::getenv("PATH");
  std::istringstream directories(path == nullptr ? "" : path);
  for (std::string directory; std::getline(directories, directory, ':');) {
    const fs::path file = fs::path(directory.empty() ? "." : directory) / name;
    std::error_code code;
    if (fs::is_regular_file(file, code) && ::access(file.c_str(), X_OK) == 0) return file;
  }
  return {};
}

/// The first line with a digit that the command prints; empty where it prints none.
std::string line_with_digit(const std::string& command) {
  const auto close = [](std::FILE* stream) { ::pclose(stream); };
  const std::unique_ptr<std::FILE, decltype(close)> stream(::popen(command.c_str(), "r"), close);
  if (!stream) return {};
  std::string found;
  char line[512];
  while (std::fgets(line, sizeof line, stream.get()) != nullptr) {
    const std::string text(line, std::string_view(line).find_last_not_of("\r\n") + 1);
    if (found.empty() && text.find_first_of("0123456789") != std::string::npos) found = text;
  }
  return found;
}

/// What the tool prints of itself within five seconds: on stdout, or else on stderr, where some complain as
/// well.
std::string version_of(const Tool& tool, const fs::path& file) {
  // In single quotes nothing but a quote means anything to the shell.
  if (*tool.version_option == '\0' || file.string().find('\'') != std::string::npos) return {};
  const std::string command = fmt::format("timeout 5 '{}' {} </dev/null", file.string(), tool.version_option);
  const std::string version = line_with_digit(command + " 2>/dev/null");
  return version.empty() ? line_with_digit(command + " 2>&1") : version;
}

/// What is compiled in, by the version that is loaded where it is a shared library.
std::vector<std::pair<std::string, std::string>> libraries() {
  unsigned major = 0, minor = 0, release = 0;
  H5get_libversion(&major, &minor, &release);
  std::array<int, 3> matio{};
  Mat_GetLibraryVersion(&matio[0], &matio[1], &matio[2]);
  char sound[128] = {};
  sf_command(nullptr, SFC_GET_LIB_VERSION, sound, sizeof sound);
  return {{"CLI11", CLI11_VERSION},
          {"Eigen", fmt::format("{}.{}.{}", EIGEN_WORLD_VERSION, EIGEN_MAJOR_VERSION, EIGEN_MINOR_VERSION)},
          {"Boost",
           fmt::format("{}.{}.{}", BOOST_VERSION / 100000, BOOST_VERSION / 100 % 1000, BOOST_VERSION % 100)},
          {"fmt", fmt::format("{}.{}.{}", FMT_VERSION / 10000, FMT_VERSION / 100 % 100, FMT_VERSION % 100)},
          {"nlohmann-json", fmt::format("{}.{}.{}", NLOHMANN_JSON_VERSION_MAJOR, NLOHMANN_JSON_VERSION_MINOR,
                                        NLOHMANN_JSON_VERSION_PATCH)},
          {"toml++", fmt::format("{}.{}.{}", TOML_LIB_MAJOR, TOML_LIB_MINOR, TOML_LIB_PATCH)},
          {"HDF5", fmt::format("{}.{}.{}", major, minor, release)},
          {"matio", fmt::format("{}.{}.{}", matio[0], matio[1], matio[2])},
          {"libsndfile", sound},
          {"uPlot", HEMI_UPLOT_VERSION},
          {"SystemC", sc_core::sc_release()},
          {"Verilator", HEMI_VERILATOR_VERSION}};
}

recording::Json examination() {
  recording::Json json{{"version", HEMI_VERSION}};
  for (const auto& [name, version] : libraries()) json["libraries"][name] = version;
  const fs::path share = share_directory();
  json["share"] = share.empty() ? recording::Json() : recording::Json(share.string());
  json["scenarios"] = shipped_scenarios();
  for (const Tool& tool : tools) {
    const fs::path file = on_path(tool.name);
    recording::Json entry{{"name", tool.name}, {"found", !file.empty()}, {"enables", tool.enables}};
    if (file.empty()) {
      entry["remedy"] = tool.remedy;
    } else {
      entry["path"] = file.string();
      if (const auto version = version_of(tool, file); !version.empty()) entry["version"] = version;
    }
    json["tools"].push_back(std::move(entry));
  }
  return json;
}

void print_text(const recording::Json& json) {
  fmt::print("hemi {}\n\nCompiled in\n", HEMI_VERSION);
  for (const auto& [name, version] : json["libraries"].items())
    fmt::print("  {:<14} {}\n", name, version.get<std::string>());
  fmt::print("\nShipped files\n");
  if (json["share"].is_null())
    fmt::print("  none found: scenarios must be named by their path\n");
  else
    fmt::print("  {}: {} scenarios\n", json["share"].get<std::string>(), json["scenarios"].size());
  fmt::print("\nOther programs; hemi itself needs none of them\n");
  for (const auto& tool : json["tools"]) {
    fmt::print("  {:<14} {:<8} {}\n", tool["name"].get<std::string>(),
               tool["found"].get<bool>() ? "found" : "missing", tool["enables"].get<std::string>());
    if (tool.contains("version")) fmt::print("  {:<23} {}\n", "", tool["version"].get<std::string>());
    if (tool.contains("remedy")) fmt::print("  {:<23} {}\n", "", tool["remedy"].get<std::string>());
  }
}

}  // namespace

void add_doctor(CLI::App& app, Job& job) {
  auto json = std::make_shared<bool>(false);
  auto* command = app.add_subcommand("doctor", "What is installed, and what each missing part would enable");
  command->add_flag("--json", *json, "as JSON");
  command->footer("Example: hemi doctor");
  command->callback([json, &job] {
    job = [json] {
      const auto found = examination();
      if (*json)
        fmt::print("{}\n", recording::json_text(found, 2));
      else
        print_text(found);
      return exit_good;
    };
  });
}

}  // namespace hemi::cli
