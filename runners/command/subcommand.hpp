#pragma once
#include <filesystem>
#include <functional>
#include <iosfwd>
#include <nlohmann/json.hpp>
#include <optional>
#include <ricochet/contract/parameters.hpp>
#include <ricochet/loader/catalogue.hpp>
#include <stdexcept>
#include <string>
#include <variant>
#include <vector>

#include "runners/command/command.hpp"
#include "runners/study/study.hpp"

namespace ricochet {

class CasePlanner;
struct PlannedCase;

/// The command was used wrongly (exit code 2); the message says how it is used.
class UsageError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// A study is wrong (exit code 2); the message is complete, with file, line and pointer.
class StudyError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// The words of a command line, checked against its command's description.
struct Arguments {
  std::vector<std::string> operands;
  std::vector<std::filesystem::path> plugins;    ///< --plugin
  std::optional<std::filesystem::path> out, to;  ///< --out, --to
  int jobs = 0;                                  ///< --jobs; 0: all that it may use
  bool fresh = false;                            ///< --fresh
  bool table = false;                            ///< --table
  bool cases = false;                            ///< --cases
  bool json = false;                             ///< --json
  bool isolate = false;                          ///< --isolate
  bool here = false;                             ///< --inline
  bool curves = false;                           ///< --curves
  bool compare = false;                          ///< --compare
  std::optional<std::filesystem::path> figures;  ///< --figures
  bool study = false;                            ///< --study
  std::optional<double> parameter;               ///< --parameter
  std::string start;                             ///< --start; "": none given
  std::string cell;                              ///< --cell; "": none given
  std::string branch;                            ///< --branch; "": none given
  std::optional<double> arc;                     ///< --arc
  int periods = 0, samples = 0;                  ///< --periods, --samples; 0: none given
  int snapshots = 0;                             ///< --snapshots; 0: none given
  int workers = 0;                               ///< --workers; 0: none given
  int nodes = 0, cpus = 0;                       ///< --nodes, --cpus; 0: none given
  StudyPart part;                                ///< --part; whole: none given
  std::string time;                              ///< --time; "": none given
  std::string drawn;                             ///< --cases of verify; "": none given
  bool help = false;
  FindHosts hosts;  ///< not a word of the command line: see run_command()
};

/// An option of a command: how it is written, what it says of itself, where its value goes.
struct Option {
  struct Count {
    int Arguments::*value;
    int most;  ///< at least 1
  };
  std::string name, value, text;  ///< value: what the help calls it; "": the option has none
  std::variant<std::monostate, bool Arguments::*, Count, std::optional<double> Arguments::*, std::string Arguments::*,
               std::optional<std::filesystem::path> Arguments::*, std::vector<std::filesystem::path> Arguments::*,
               StudyPart Arguments::*>
      target;
};

/// One command: what it takes, what it says of itself, what it does.
struct Subcommand {
  std::string name;
  std::string usage;  ///< operands and options as the help shows them
  std::string summary;
  std::size_t fewest = 0, most = 0;  ///< number of operands
  std::vector<Option> options;       ///< in the order of the help
  int (*run)(const Arguments& arguments, std::ostream& out);
};

const std::vector<Subcommand>& subcommands();

/// Reads the words after the command's name. Throws UsageError for an unknown option (nearest name), a missing or
/// malformed value, too few or too many operands.
Arguments parse_arguments(const Subcommand& command, const std::vector<std::string>& words);

/// The help of one command, its options included.
std::string help_text(const Subcommand& command);

/// The role that a word names. Throws UsageError (nearest name) for a word that names none; `names`: words that the
/// caller knows too.
Role role_called(const std::string& word, std::vector<std::string> names = {});

// The commands themselves; each returns its exit code.
int command_run(const Arguments& arguments, std::ostream& out);
int command_slurm(const Arguments& arguments, std::ostream& out);
int command_status(const Arguments& arguments, std::ostream& out);
int command_plan(const Arguments& arguments, std::ostream& out);
int command_list(const Arguments& arguments, std::ostream& out);
int command_describe(const Arguments& arguments, std::ostream& out);
int command_new(const Arguments& arguments, std::ostream& out);
int command_check(const Arguments& arguments, std::ostream& out);
int command_report(const Arguments& arguments, std::ostream& out);
int command_merge(const Arguments& arguments, std::ostream& out);
int command_compare(const Arguments& arguments, std::ostream& out);
int command_export(const Arguments& arguments, std::ostream& out);
int command_league(const Arguments& arguments, std::ostream& out);
int command_pack(const Arguments& arguments, std::ostream& out);
int command_verify(const Arguments& arguments, std::ostream& out);
int command_unpack(const Arguments& arguments, std::ostream& out);
int command_point(const Arguments& arguments, std::ostream& out);
int command_case(const Arguments& arguments, std::ostream& out);
int command_schema(const Arguments& arguments, std::ostream& out);
int command_doctor(const Arguments& arguments, std::ostream& out);
int command_manual(const Arguments& arguments, std::ostream& out);

// What they share.

/// A study with the plugins that it opened.
struct OpenStudy {
  Study study;
  Catalogue catalogue;
  Registry registry;
};

/// Loads the study that the first operand names and hands it over. An InputError, from loading or from `use`, is thrown
/// again as a StudyError that names file, line and pointer. A method that no plugin provides and that no near name
/// explains is a PluginError.
int with_study(const Arguments& arguments, const std::function<int(const OpenStudy&)>& use);

/// The exit code of a command that does this. What it throws goes to `err`, as one clear message; no exception leaves.
int exit_code_of(const std::function<int()>& work, std::ostream& err);

/// What `work` prints and returns: in a child process where a third-party library is found, whose code it may run. A
/// child that ends otherwise is told with its cause on stderr: exit_some_failed.
int march_apart(const Arguments& arguments, std::ostream& out, const std::function<int(std::ostream&)>& work);

/// What a reader should know of the plugins before the study runs, a sentence each. Methods of the study that a later
/// library provides too ("time 'newmark' of FILE is shadowed by FILE"), and plugin folders that are none.
std::vector<std::string> plugin_warnings(const OpenStudy& open);

/// What the structures of these cases are, for a person to see a slip of units at a glance. Their numbers, first
/// frequencies, damping ratios, how many steps the study makes of a period, and which modes its steps resolve. On the
/// finest mesh with the first mass matrix; at most a few structures; then their contacts (plan_contacts.cpp). "" where
/// nothing would run.
std::string physics_text(const std::vector<PlannedCase>& cases, const CasePlanner& planner, const Registry& registry);

/// A value of an axis as a person reads it: words bare, numbers in their shortest form, null as "none".
std::string plain(const nlohmann::ordered_json& value);

// The manual of what a study or its results call by a name and no plugin provides.

/// What a plan file registers. Throws InputError where it cannot be read, StudyError with its line where it is no plan.
Registry registry_of_plan(const std::filesystem::path& file);

/// "number", "whole number", "true or false", "word".
const char* type_word(const ParameterSpec& spec);
/// The range of a number, the words of a word.
std::string admissible_values(const ParameterSpec& spec);

/// Prints what is known of a structure, a cross-section, a kind of study (text and keys), a measure, an error or
/// another column of cases.csv (unit and meaning). False where nothing is called so.
bool describe_word(const std::string& name, std::ostream& out);

/// The structures, cross-sections and kinds, each once.
std::vector<std::string> words_of_studies();
/// The measures, the errors and the other columns of cases.csv.
std::vector<std::string> words_of_results();

}  // namespace ricochet
