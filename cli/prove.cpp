// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>
#include <sys/utsname.h>
#include <unistd.h>

#include <cerrno>
#include <chrono>
#include <cstdlib>
#include <ctime>
#include <filesystem>
#include <random>
#include <system_error>
#include <thread>

#include "cli/commands.hpp"
#include "cli/options.hpp"
#include "cli/prove/report.hpp"
#include "cli/prove/trial.hpp"
#include "cli/prove/write.hpp"
#include "cli/recording/error.hpp"
#include "cli/recording/interrupt.hpp"
#include "cli/recording/progress.hpp"
#include "cli/recording/write.hpp"
#include "cli/report/prove_report.hpp"
#include "golden/concealed/cases.hpp"

namespace hemi::cli {
namespace {

namespace fs = std::filesystem;

struct ProveOptions {
  int cases = 1300;
  unsigned jobs = std::max(1u, std::thread::hardware_concurrency());
  std::uint64_t seed = 1;
  bool fresh = false;
  std::string cls{}, keep{}, program{}, directory = "proof", write_only{};
  bool baselines = false, json = false;
  double time_limit_s = 120.0, memory_mib = 4096.0;
};

/// A directory of its own that goes with the object.
class ScratchDirectory {
 public:
  ScratchDirectory() {
    std::string path = (fs::temp_directory_path() / "hemi-prove-XXXXXX").string();
    if (::mkdtemp(path.data()) == nullptr)
      throw recording::OutputError(path, std::generic_category().message(errno), "set TMPDIR");
    path_ = path;
  }
  ~ScratchDirectory() {
    std::error_code ignored;
    fs::remove_all(path_, ignored);
  }
  ScratchDirectory(const ScratchDirectory&) = delete;
  ScratchDirectory& operator=(const ScratchDirectory&) = delete;
  const std::string& path() const { return path_; }

 private:
  std::string path_;
};

void make_directory(const std::string& path) {
  std::error_code code;
  fs::create_directories(path, code);
  if (code) throw recording::OutputError(path, code.message(), "name another directory");
}

std::string machine() {
  utsname name{};
  ::uname(&name);
  return fmt::format("{} {}, {} processors", name.sysname, name.machine, std::thread::hardware_concurrency());
}

std::string today() {
  const std::time_t now = std::time(nullptr);
  std::array<char, 16> text{};
  std::strftime(text.data(), text.size(), "%Y-%m-%d", std::gmtime(&now));
  return text.data();
}

/// Recordings in one directory, truths in its subdirectory `truth`.
int write_only(const ProveOptions& options, const std::vector<prove::Task>& tasks) {
  const std::string truths = (fs::path(options.write_only) / "truth").string();
  make_directory(truths);
  recording::Progress progress("concealing", static_cast<double>(tasks.size()));
  for (std::size_t i = 0; i < tasks.size(); ++i) {
    recording::check_interrupt();
    const auto hidden = concealed::make_case(tasks[i].cls, options.seed, tasks[i].index);
    prove::write_concealed(hidden, options.write_only, tasks[i].name);
    recording::write_text((fs::path(truths) / (tasks[i].name + ".truth.json")).string(),
                          recording::json_text(prove::truth_json(hidden, tasks[i].name), 1) + "\n");
    progress.update(static_cast<double>(i + 1));
  }
  if (options.json)
    fmt::print("{}\n",
               recording::json_text(
                   {{"recordings", tasks.size()}, {"directory", options.write_only}, {"truths", truths}}, 2));
  return exit_good;
}

int prove_all(const ProveOptions& options, const std::vector<prove::Task>& tasks) {
  make_directory(options.directory);
  if (!options.keep.empty()) make_directory(options.keep);
  const ScratchDirectory scratch;
  prove::TrialOptions trial;
  trial.seed = options.seed;
  trial.own_program = options.program.empty();
  trial.program = trial.own_program ? fs::read_symlink("/proc/self/exe").string() : options.program;
  if (::access(trial.program.c_str(), X_OK) != 0)
    throw recording::InputError({trial.program}, "cannot be run", "name an executable file");
  trial.limits = {options.time_limit_s, options.memory_mib};
  trial.directory = scratch.path();
  trial.keep = options.keep;
  trial.rivals = options.baselines;
  std::vector<prove::Trial> trials(tasks.size());
  const double start_s = recording::steady_seconds();
  {
    recording::Progress progress("proving", static_cast<double>(tasks.size()));
    std::size_t count = 0;
    prove::run_trials(tasks, trial, options.jobs, [&](std::size_t task, prove::Trial&& done) {
      trials[task] = std::move(done);
      progress.update(static_cast<double>(++count));
    });
  }
  prove::Score score;
  prove::Report report;
  for (const auto& one : trials) {  // in the order of the tasks, so that jobs do not change the report
    score.add(one.truth, one.answer);
    if (one.experiment) score.add_experiment(one.truth, *one.experiment);
    for (const auto& [method, answer] : one.rivals) report.rivals[method].add(one.truth, answer);
  }
  report.command = fmt::format("hemi prove --cases {} --seed {}{}", options.cases, options.seed,
                               options.cls.empty() ? "" : " --class " + options.cls);
  report.machine = machine();
  report.date = today();
  report.seconds = recording::steady_seconds() - start_s;
  report.seed = options.seed;
  report.recordings = static_cast<int>(tasks.size());
  report.own = &score;
  const std::string markdown = prove::to_markdown(report);
  const recording::Json json = prove::to_json(report);
  recording::write_text((fs::path(options.directory) / "prove.json").string(),
                        recording::json_text(json, 1) + "\n");
  recording::write_text((fs::path(options.directory) / "prove.md").string(), markdown);
  report::write_prove_report((fs::path(options.directory) / "prove.html").string(), json);
  if (options.json)
    fmt::print("{}\n", recording::json_text(json, 2));
  else
    fmt::print("{}", markdown);
  return prove::all_held(report) ? exit_good : exit_difference;
}

int prove_command(ProveOptions options) {
  if (options.fresh) {
    std::random_device device;
    options.seed = device();
    fmt::print(stderr, "seed {}\n", options.seed);
  }
  const auto tasks = prove::plan(options.cases, options.cls);
  if (options.write_only.empty()) return prove_all(options, tasks);
  make_directory(options.write_only);
  return write_only(options, tasks);
}

}  // namespace

void add_prove(CLI::App& app, Job& job) {
  auto options = std::make_shared<ProveOptions>();
  auto* command =
      app.add_subcommand("prove", "Conceal effects in recordings, diagnose them, open the truth, score");
  command->add_option("--cases", options->cases, "recordings in all; with --class of that class")
      ->check(CLI::Range(1, 1000000))
      ->capture_default_str();
  command->add_option("-j,--jobs", options->jobs, "recordings at a time")->check(CLI::Range(1, 1024));
  auto* seed =
      command->add_option("--seed", options->seed, "the same seed conceals the same")->capture_default_str();
  command->add_flag("--fresh", options->fresh, "a seed that nobody has seen; it is printed")->excludes(seed);
  command->add_option(
      "--class", options->cls,
      "null, params, single_strong, single_moderate, weak, pair, unknown, poor or confounder");
  command->add_option("--keep", options->keep,
                      "directory for the recordings, the diagnoses and, afterwards, the truths");
  command->add_flag("--baselines", options->baselines, "other methods on the same recordings, beside");
  command->add_option("--diagnose-with", options->program,
                      "score another program, called as PROGRAM RECORDING --model MODEL -o DIR");
  command->add_option("--write-only", options->write_only,
                      "conceal only: recordings into this directory, truths into its subdirectory truth");
  command->add_option("--time-limit", options->time_limit_s, "seconds for one diagnosis")
      ->check(positive_number())
      ->capture_default_str();
  command->add_option("--memory-limit", options->memory_mib, "address space of one diagnosis [MiB], 0: none")
      ->check(number_between(0.0, 1e7))
      ->capture_default_str();
  command->add_option("-o,--output", options->directory, "directory for prove.json, prove.md and prove.html")
      ->capture_default_str();
  command->add_flag("--json", options->json, "the figures as JSON instead of the tables");
  command->footer(
      "Example: hemi prove --cases 130 --jobs 2 --baselines -o proof\n"
      "Exit code 0 where every figure is at its target, 1 where not.");
  command->callback([options, &job] { job = [options] { return prove_command(*options); }; });
}

}  // namespace hemi::cli
