#include <fmt/format.h>

#include <algorithm>

#include "runners/command/manual.hpp"
#include "runners/command/subcommand.hpp"
#include "runners/table/text.hpp"

namespace ricochet {
namespace {

/// What a shell offers for a word of the command line.
enum class Offer { nothing, files, folders, studies, methods, words };

struct Operand {
  Offer offer = Offer::nothing;
  std::vector<std::string> words;  ///< of Offer::words
};

Offer offer_of(const std::string& name) {
  if (name.starts_with("NAME|")) return Offer::methods;
  if (name == "FILE" || name.find("PLUGIN") != std::string::npos) return Offer::files;
  if (name.find(".json") != std::string::npos) return Offer::studies;
  return name == "A" || name.find("DIR") != std::string::npos ? Offer::folders : Offer::nothing;
}

/// The first operand, by the first word of the usage: "STUDY.json", "DIR…", "[mass|contact]".
Operand operand_of(const Subcommand& command) {
  if (command.most == 0) return {};
  std::string first = command.usage.substr(0, command.usage.find(' '));
  std::erase_if(first, [](char c) { return c == '[' || c == ']'; });
  if (first.find('|') == std::string::npos || first.find_first_of("ABCDEFGHIJKLMNOPQRSTUVWXYZ") != std::string::npos)
    return {offer_of(first), {}};
  Operand operand{Offer::words, {}};
  for (std::size_t at = 0; at != std::string::npos;) {
    const std::size_t bar = first.find('|', at);
    operand.words.push_back(first.substr(at, bar == std::string::npos ? bar : bar - at));
    at = bar == std::string::npos ? bar : bar + 1;
  }
  return operand;
}

/// The options of a command, --help with them.
std::vector<Option> options_of(const Subcommand& command) {
  std::vector<Option> all = command.options;
  all.push_back({"help", "", "this text", {}});
  return all;
}

/// The words that may stand in the place of a command.
std::vector<std::pair<std::string, std::string>> first_words() {
  std::vector<std::pair<std::string, std::string>> words;
  for (const Subcommand& command : subcommands()) words.emplace_back(command.name, command.summary);
  words.emplace_back("help", "Show the commands, or what one of them takes.");
  words.emplace_back("--help", "Show the commands.");
  words.emplace_back("--version", "Show the version, and what the program was built with.");
  return words;
}

std::string command_names() {
  std::string names;
  for (const Subcommand& command : subcommands()) names += (names.empty() ? "" : " ") + command.name;
  return names;
}

std::string replaced(std::string text, std::string_view what, std::string_view with) {
  replace_all(text, what, with);
  return text;
}

constexpr const char* generated = "# Made by `ricochet manual {}`.\n";

/// How a shell writes offers: `words` with {} for the words. Methods are those that the program finds there and then,
/// and files.
struct Shell {
  const char *nothing, *files, *folders, *studies, *methods, *words;
};
constexpr Shell bash{
    "COMPREPLY=()",
    "compopt -o filenames; mapfile -t COMPREPLY < <(compgen -f -- \"$word\")",
    "compopt -o filenames; mapfile -t COMPREPLY < <(compgen -d -- \"$word\")",
    "compopt -o filenames; mapfile -t COMPREPLY < <(compgen -f -X '!*.json' -- \"$word\"; compgen -d -- \"$word\")",
    "compopt -o filenames; mapfile -t COMPREPLY < <(compgen -W \"$(ricochet list 2>/dev/null | awk 'NR > 1 {print "
    "$2}')\" "
    "-- \"$word\"; compgen -f -- \"$word\")",
    "COMPREPLY=($(compgen -W '{}' -- \"$word\"))"};
constexpr Shell zsh{" ",
                    "_files",
                    "_files -/",
                    "_files -g \"*.json\"",
                    "{compadd -- $(ricochet list 2>/dev/null | awk \"NR > 1 {print \\$2}\"); _files}",
                    "({})"};
constexpr Shell fish{"-f",
                     "-F",
                     "-f -a '(__fish_complete_directories)'",
                     "-f -a '(__fish_complete_suffix .json)'",
                     "-F -a '(ricochet list 2>/dev/null | awk \"NR > 1 {print \\$2}\")'",
                     "-f -a '{}'"};

std::string offer(const Shell& shell, const Operand& operand) {
  switch (operand.offer) {
    case Offer::nothing:
      return shell.nothing;
    case Offer::files:
      return shell.files;
    case Offer::folders:
      return shell.folders;
    case Offer::studies:
      return shell.studies;
    case Offer::methods:
      return shell.methods;
    case Offer::words:
      break;
  }
  return fmt::format(fmt::runtime(shell.words), fmt::join(operand.words, " "));
}

/// A text within an entry of _arguments.
std::string zsh_text(const std::string& text) {
  return replaced(replaced(replaced(replaced(text, "\\", "\\\\"), "[", "\\["), "]", "\\]"), ":", "\\:");
}

}  // namespace

std::string bash_completion() {
  std::string text = fmt::format(fmt::runtime(generated), "bash") +
                     "_ricochet() {\n"
                     "  local word=${COMP_WORDS[COMP_CWORD]} before=${COMP_WORDS[COMP_CWORD-1]} IFS=$' \\t\\n'\n"
                     "  if [ \"$COMP_CWORD\" -eq 1 ]; then\n";
  std::string words;
  for (const auto& [word, summary] : first_words()) words += (words.empty() ? "" : " ") + word;
  text += fmt::format("    COMPREPLY=($(compgen -W '{}' -- \"$word\"))\n    return\n  fi\n", words) +
          "  case ${COMP_WORDS[1]} in\n";
  for (const Subcommand& command : subcommands()) {
    std::string names;
    text += fmt::format("    {})\n      case $before in\n", command.name);
    for (const Option& option : options_of(command)) {
      names += (names.empty() ? "--" : " --") + option.name;
      if (!option.value.empty())
        text += fmt::format("        --{}) {}; return ;;\n", option.name, offer(bash, {offer_of(option.value), {}}));
    }
    text += fmt::format(
        "      esac\n      case $word in\n        -*) COMPREPLY=($(compgen -W '{}' -- \"$word\")) ;;\n        *) {} "
        ";;\n"
        "      esac ;;\n",
        names, offer(bash, operand_of(command)));
  }
  return text + fmt::format("    help) COMPREPLY=($(compgen -W '{}' -- \"$word\")) ;;\n", command_names()) +
         "  esac\n}\ncomplete -F _ricochet ricochet\n";
}

std::string zsh_completion() {
  std::string text = "#compdef ricochet\n" + fmt::format(fmt::runtime(generated), "zsh") +
                     "_ricochet() {\n  local -a first\n  first=(\n";
  for (const auto& [word, summary] : first_words())
    text += fmt::format("    {}\n", shell_quoted(word + ":" + replaced(summary, ":", "\\:")));
  text +=
      "  )\n  if (( CURRENT == 2 )); then\n    _describe command first\n    return\n  fi\n"
      "  local command=$words[2]\n  shift words\n  (( CURRENT-- ))\n  case $command in\n";
  for (const Subcommand& command : subcommands()) {
    text += fmt::format("    {})\n      _arguments", command.name);
    for (const Option& option : options_of(command)) {
      const bool repeats = std::holds_alternative<std::vector<std::filesystem::path> Arguments::*>(option.target);
      std::string entry = fmt::format("{}--{}[{}]", repeats ? "*" : "", option.name, zsh_text(option.text));
      if (!option.value.empty()) entry += ":" + zsh_text(option.value) + ":" + offer(zsh, {offer_of(option.value), {}});
      text += " \\\n        " + shell_quoted(entry);
    }
    if (command.most > 0)
      text += " \\\n        " +
              shell_quoted((command.most > 1 ? "*:operand:" : "1:operand:") + offer(zsh, operand_of(command)));
    text += " ;;\n";
  }
  return text + fmt::format("    help) _arguments '1:command:({})' ;;\n", command_names()) +
         "  esac\n}\nif [ \"$funcstack[1]\" = _ricochet ]; then\n  _ricochet \"$@\"\nelse\n  compdef _ricochet "
         "ricochet\nfi\n";
}

std::string fish_completion() {
  std::string text = fmt::format(fmt::runtime(generated), "fish") + "complete -c ricochet -f\n";
  for (const auto& [word, summary] : first_words()) {
    if (word.starts_with("--"))
      text += fmt::format("complete -c ricochet -n __fish_use_subcommand -l {} -d {}\n", word.substr(2),
                          shell_quoted(summary));
    else
      text += fmt::format("complete -c ricochet -n __fish_use_subcommand -a {} -d {}\n", word, shell_quoted(summary));
  }
  for (const Subcommand& command : subcommands()) {
    const std::string here = fmt::format("complete -c ricochet -n '__fish_seen_subcommand_from {}'", command.name);
    for (const Option& option : options_of(command)) {
      text += fmt::format("{} -l {} -d {}", here, option.name, shell_quoted(option.text));
      if (!option.value.empty()) text += " -r " + offer(fish, {offer_of(option.value), {}});
      text += "\n";
    }
    if (const Operand operand = operand_of(command); operand.offer != Offer::nothing)
      text += here + " " + offer(fish, operand) + "\n";
  }
  return text + fmt::format("complete -c ricochet -n '__fish_seen_subcommand_from help' -f -a '{}'\n", command_names());
}

}  // namespace ricochet
