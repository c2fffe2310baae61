// SPDX-License-Identifier: Apache-2.0
#include "cli/completion.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "cli/commands.hpp"

namespace hemi::cli {
namespace {

enum class Value { none, words, number, file };

/// An option, or the positional arguments of a command where `names` is empty.
struct Entry {
  std::vector<std::string> names{};  ///< with their dashes
  std::string help{};
  Value value = Value::none;
  std::vector<std::string> words{};
  bool many = false;
};

struct Command {
  std::string name;
  std::string help;
  std::vector<Entry> options;
  std::vector<Entry> positionals;
};

/// The words of a type such as TEXT:{c,sv,mem}; empty for others.
std::vector<std::string> words_of(const std::string& type) {
  std::vector<std::string> words;
  const auto open = type.find('{'), close = type.find('}');
  if (open == std::string::npos || close == std::string::npos) return words;
  std::string word;
  for (const char c : type.substr(open + 1, close - open - 1) + ",") {
    if (c != ',')
      word += c;
    else if (!word.empty())
      words.push_back(std::exchange(word, {}));
  }
  return words;
}

Entry entry_of(const CLI::Option& option) {
  Entry entry{.help = option.get_description()};
  for (const auto& name : option.get_snames()) entry.names.push_back("-" + name);
  for (const auto& name : option.get_lnames()) entry.names.push_back("--" + name);
  entry.many = option.get_expected_max() > 1;
  if (option.get_items_expected_max() == 0) return entry;
  const std::string type = option.get_type_name();
  entry.words = words_of(type);
  entry.value = !entry.words.empty()                                                         ? Value::words
                : type.find("FLOAT") == 0 || type.find("INT") == 0 || type.find("UINT") == 0 ? Value::number
                                                                                             : Value::file;
  return entry;
}

/// Options of a command and of its groups, which have no name.
void collect(const CLI::App& app, Command& command) {
  for (const CLI::Option* option : app.get_options()) {
    Entry entry = entry_of(*option);
    (entry.names.empty() ? command.positionals : command.options).push_back(std::move(entry));
  }
  for (const CLI::App* part : app.get_subcommands([](const CLI::App* s) { return s->get_name().empty(); }))
    collect(*part, command);
}

std::vector<Command> commands_of(const CLI::App& app) {
  std::vector<Command> commands;
  for (const CLI::App* sub : app.get_subcommands([](const CLI::App* s) { return !s->get_name().empty(); })) {
    Command command{sub->get_name(), sub->get_description(), {}, {}};
    collect(*sub, command);
    commands.push_back(std::move(command));
  }
  return commands;
}

std::vector<std::string> names_of(const std::vector<Entry>& entries) {
  std::vector<std::string> names;
  for (const auto& entry : entries) names.insert(names.end(), entry.names.begin(), entry.names.end());
  return names;
}

/// Inside single quotes of a shell; `also` is escaped with a backslash.
std::string quoted(const std::string& text, std::string_view also = {}) {
  std::string out;
  for (const char c : text) {
    if (c == '\'')
      out += "'\\''";
    else if (also.find(c) != std::string_view::npos)
      out += std::string("\\") + c;
    else
      out += c;
  }
  return "'" + out + "'";
}

std::string bash_reply(const Entry& entry) {
  if (entry.value == Value::words)
    return fmt::format("COMPREPLY=($(compgen -W '{}' -- \"$cur\"))", fmt::join(entry.words, " "));
  return entry.value == Value::number ? "COMPREPLY=()" : "COMPREPLY=($(compgen -f -- \"$cur\"))";
}

/// What _arguments expects behind an option, and as an argument.
std::string zsh_action(const Entry& entry) {
  if (entry.value == Value::words) return fmt::format(":value:({})", fmt::join(entry.words, " "));
  return entry.value == Value::number ? ":number: " : entry.value == Value::file ? ":file:_files" : "";
}

}  // namespace

std::string bash_completion(const CLI::App& app) {
  const auto commands = commands_of(app);
  std::vector<std::string> first;
  for (const auto& command : commands) first.push_back(command.name);
  Command program;
  collect(app, program);
  const auto own = names_of(program.options);
  first.insert(first.end(), own.begin(), own.end());
  std::string text = fmt::format(
      "# bash completion of hemi {}; made by: hemi completion bash\n"
      "_hemi() {{\n"
      "  local cur=${{COMP_WORDS[COMP_CWORD]}} prev=${{COMP_WORDS[COMP_CWORD-1]}}\n"
      "  if ((COMP_CWORD == 1)); then\n"
      "    COMPREPLY=($(compgen -W '{}' -- \"$cur\"))\n"
      "    return\n"
      "  fi\n"
      "  case ${{COMP_WORDS[1]}} in\n",
      HEMI_VERSION, fmt::join(first, " "));
  for (const auto& command : commands) {
    text += fmt::format("    {})\n      case $prev in\n", command.name);
    for (const auto& option : command.options) {
      if (option.value == Value::none) continue;
      text += fmt::format("        {}) {}; return ;;\n", fmt::join(option.names, "|"), bash_reply(option));
    }
    const Entry rest =
        command.positionals.empty() ? Entry{.value = Value::number} : command.positionals.front();
    text += fmt::format(
        "      esac\n"
        "      if [[ $cur == -* ]]; then\n"
        "        COMPREPLY=($(compgen -W '{}' -- \"$cur\"))\n"
        "      else\n"
        "        {}\n"
        "      fi\n"
        "      ;;\n",
        fmt::join(names_of(command.options), " "), bash_reply(rest));
  }
  return text + "  esac\n}\ncomplete -o filenames -F _hemi hemi\n";
}

std::string zsh_completion(const CLI::App& app) {
  const auto commands = commands_of(app);
  std::string text = fmt::format(
      "#compdef hemi\n# zsh completion of hemi {}; made by: hemi completion zsh\n"
      "_hemi() {{\n  local -a commands=(\n",
      HEMI_VERSION);
  for (const auto& command : commands)
    text += fmt::format("    {}\n", quoted(fmt::format("{}:{}", command.name, command.help)));
  text +=
      "  )\n"
      "  if ((CURRENT == 2)); then\n"
      "    _describe command commands\n"
      "    return\n"
      "  fi\n"
      "  case $words[2] in\n";
  for (const auto& command : commands) {
    text += fmt::format("    {})\n      shift words\n      ((CURRENT--))\n      _arguments", command.name);
    for (const auto& option : command.options) {
      for (const auto& name : option.names)
        text += fmt::format(" \\\n        {}{}{}", quoted(fmt::format("{}{}[", option.many ? "*" : "", name)),
                            quoted(option.help, "[]:"), quoted(fmt::format("]{}", zsh_action(option))));
    }
    for (const auto& positional : command.positionals)
      text += fmt::format(" \\\n        {}",
                          quoted(fmt::format("{}{}", positional.many ? "*" : "", zsh_action(positional))));
    text += "\n      ;;\n";
  }
  return text + "  esac\n}\n_hemi \"$@\"\n";
}

std::string fish_completion(const CLI::App& app) {
  const auto commands = commands_of(app);
  std::string text =
      fmt::format("# fish completion of hemi {}; made by: hemi completion fish\n", HEMI_VERSION);
  for (const auto& command : commands) {
    text += fmt::format("complete -c hemi -f -n __fish_use_subcommand -a {} -d {}\n", command.name,
                        quoted(command.help, "\\"));
  }
  for (const auto& command : commands) {
    const std::string when =
        fmt::format("complete -c hemi -n '__fish_seen_subcommand_from {}'", command.name);
    for (const auto& option : command.options) {
      text += when;
      for (const auto& name : option.names)
        text += name.rfind("--", 0) == 0 ? " -l " + name.substr(2) : " -s " + name.substr(1);
      if (option.value == Value::words) text += fmt::format(" -x -a '{}'", fmt::join(option.words, " "));
      if (option.value == Value::number) text += " -x";
      if (option.value == Value::file) text += " -r -F";
      text += " -d " + quoted(option.help, "\\") + "\n";
    }
    if (command.positionals.empty()) text += when + " -f\n";
    for (const auto& positional : command.positionals) {
      if (positional.value == Value::words)
        text += fmt::format("{} -f -a '{}'\n", when, fmt::join(positional.words, " "));
    }
  }
  return text;
}

void add_completion(CLI::App& app, Job& job) {
  auto shell = std::make_shared<std::string>();
  auto* command = app.add_subcommand("completion", "Completion of commands and options for a shell");
  command->add_option("shell", *shell, "which shell")
      ->required()
      ->check(CLI::IsMember({"bash", "zsh", "fish"}));
  command->footer("Example: hemi completion bash > ~/.local/share/bash-completion/completions/hemi");
  command->callback([shell, &app, &job] {
    job = [shell, &app] {
      fmt::print("{}", *shell == "bash"  ? bash_completion(app)
                       : *shell == "zsh" ? zsh_completion(app)
                                         : fish_completion(app));
      return exit_good;
    };
  });
}

}  // namespace hemi::cli
