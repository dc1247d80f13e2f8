#include "runners/command/manual.hpp"

#include <fmt/format.h>

#include <ostream>

#include "runners/command/subcommand.hpp"
#include "runners/run/build_facts.hpp"
#include "runners/study/check_object.hpp"
#include "runners/study/fields.hpp"

namespace ricochet {
namespace {

/// A text as roff: a line that begins with a control character is none, hyphens and backslashes stay what they are.
std::string roff(const std::string& text) {
  std::string out;
  bool begins = true;
  for (const char c : text) {
    if (begins && (c == '.' || c == '\'')) out += "\\&";
    begins = c == '\n';
    if (c == '\\')
      out += "\\e";
    else if (c == '-')
      out += "\\-";
    else
      out += c;
  }
  return out;
}

std::string head(const char* name, const char* section, const char* summary) {
  return fmt::format(".TH \"{}\" \"{}\" \"\" \"ricochet {}\" \"Ricochet\"\n.SH NAME\n{} \\- {}\n", name, section,
                     build_facts().version, roff(name), roff(summary));
}

std::string item(const std::string& name, const std::string& text) {
  return fmt::format(".TP\n.B {}\n{}\n", roff(name), roff(text));
}

std::string program_page() {
  std::string page =
      head("ricochet", "1", "numerical analysis of nonsmooth dynamics") +
      ".SH SYNOPSIS\n.B ricochet\n.I COMMAND\n[\\fIargument\\fR \\&...]\n.br\n.B ricochet \\-\\-version\n"
      ".SH DESCRIPTION\n" +
      roff(
          "Takes a study in JSON (ricochet-study(5)), runs every combination of its mass matrices, "
          "contact laws, time schemes, steps and meshes, and says what each choice is worth against "
          "what step and mesh leave open. Results are a folder with a report, tables and a store.\n") +
      ".SH COMMANDS\n";
  for (const Subcommand& command : subcommands()) {
    page += fmt::format(".SS {}\n.B ricochet {}\n{}\n.PP\n{}\n", roff(command.name), roff(command.name),
                        roff(command.usage), roff(command.summary));
    for (const Option& option : command.options)
      page += item("--" + option.name + (option.value.empty() ? "" : " " + option.value), option.text);
  }
  page += ".SH EXIT STATUS\n";
  for (const ExitMeaning& meaning : exit_meanings()) page += item(fmt::format("{}", meaning.code), meaning.text);
  page += ".SH ENVIRONMENT\n" +
          item("RICOCHET_PLUGIN_PATH", "folders of plugins beside the program's own, separated by colons") +
          item("RICOCHET_FILE_LIMIT", "the largest file that a study may name, in bytes") +
          item("RICOCHET_BROWSER", "the browser that draws the files of report --figures; else chromium");
  page += ".SH FILES\n" + item("results/NAME", "report.html, tables, results.sqlite and failures of the study NAME");
  page += ".SH EXAMPLES\n.nf\n" + roff("ricochet plan study.json\nricochet run study.json\n") + ".fi\n";
  return page + ".SH SEE ALSO\n.BR ricochet\\-study (5)\n";
}

std::string study_page() {
  std::string page =
      head("ricochet-study", "5", "a study of Ricochet") + ".SH DESCRIPTION\n" +
      roff(
          "A study is one closed JSON object. A misspelt key, a wrong type or an impossible value is an error, and "
          "nothing runs. Where a list is possible, it is a choice to compare. A key that begins with // is a remark. "
          "Units are SI. Parameters of methods are told by `ricochet describe NAME`.\n");
  for (const KeySection& section : study_sections()) {
    page += fmt::format(".SH {}\n{}\n", roff(section.title), roff(section.text + "."));
    for (const KeyRow& row : section.rows) {
      std::string facts = row.type;
      if (!row.unit.empty()) facts += ", " + row.unit;
      if (!row.range.empty()) facts += ", " + row.range;
      const std::string& fallback = row.below.empty() ? row.fallback : row.below;
      facts += fallback == "required" ? "; required" : fallback.empty() ? "; default: empty" : "; default: " + fallback;
      page += fmt::format(".TP\n.B {}\n{}\n.br\n{}\n", roff(row.key), roff(facts), roff(row.meaning));
    }
  }
  return page + ".SH SEE ALSO\n.BR ricochet (1)\n";
}

struct Page {
  const char* name;
  std::string (*make)();
};
constexpr Page pages[] = {{"ricochet.1", program_page},
                          {"ricochet-study.5", study_page},
                          {"bash", bash_completion},
                          {"zsh", zsh_completion},
                          {"fish", fish_completion}};

}  // namespace

const std::vector<ExitMeaning>& exit_meanings() {
  static const std::vector<ExitMeaning> all = {
      {exit_done, "all done"},
      {exit_bug, "an error of Ricochet itself"},
      {exit_bad_input, "bad study or usage"},
      {exit_some_failed, "some cases failed or none could run"},
      {exit_plugin, "plugin missing or incompatible"},
      {exit_store, "store unusable, output not written or memory at an end"},
      {exit_not_met, "an ask with \"require\": true has no yes"},
      {exit_interrupted, "interrupted (resumable)"},
  };
  return all;
}

std::vector<std::string> manual_pages() {
  std::vector<std::string> names;
  for (const Page& page : pages) names.emplace_back(page.name);
  return names;
}

std::string manual_page(const std::string& name) {
  for (const Page& page : pages)
    if (name == page.name) return page.make();
  throw UsageError("there is no page \"" + name + "\"" + did_you_mean(name, manual_pages()) +
                   " (expected: " + quoted_list(manual_pages()) + ")");
}

int command_manual(const Arguments& arguments, std::ostream& out) {
  out << manual_page(arguments.operands.front());
  return exit_done;
}

}  // namespace ricochet
