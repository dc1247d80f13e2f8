#pragma once
#include <string>
#include <vector>

namespace ricochet {

/// \file
/// The program's own manual, made of the table of its commands (subcommand.hpp) and of the study format (fields.hpp).

/// A key of the study format as a manual shows it.
struct KeyRow {
  std::string key, type, unit;
  std::string fallback;  ///< what an absent key means, "required", or "see below"
  std::string range, meaning;
  std::string below;  ///< a default too long for a table, else ""
};

/// The keys of every study, or those of one kind.
struct KeySection {
  std::string title, text;
  std::vector<KeyRow> rows;
};

/// The whole study format, kind by kind.
std::vector<KeySection> study_sections();

/// The exit codes with their meanings.
struct ExitMeaning {
  int code;
  const char* text;
};
const std::vector<ExitMeaning>& exit_meanings();

/// The names that manual_page() knows: ricochet.1, ricochet-study.5, bash, zsh, fish.
std::vector<std::string> manual_pages();

/// A page for man(1) as roff, or completions for a shell. Throws UsageError (nearest name) for a name that is none.
std::string manual_page(const std::string& name);

// The completions, one function for each shell.
std::string bash_completion();
std::string zsh_completion();
std::string fish_completion();

}  // namespace ricochet
