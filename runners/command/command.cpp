#include "runners/command/command.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstdio>
#include <iostream>
#include <new>
#include <ostream>
#include <ricochet/contract/errors.hpp>
#include <ricochet/loader/child.hpp>
#include <system_error>

#include "runners/command/manual.hpp"
#include "runners/command/subcommand.hpp"
#include "runners/march/prepare_case.hpp"
#include "runners/run/environment.hpp"
#include "runners/run/study_cases.hpp"
#include "runners/store/atomic_file.hpp"
#include "runners/store/fingerprint.hpp"
#include "runners/table/plain_output.hpp"
#include "runners/table/text.hpp"
#include "runners/workers/worker_process.hpp"

namespace ricochet {
namespace {

using Args = Arguments;
using Commands = std::vector<Subcommand>;

constexpr int most_jobs = 4096, most_samples = 1000000000, most_snapshots = 2000;
constexpr int most_workers = 1000000, most_nodes = 100000;

Option plugin_option() {
  return {"plugin", "FILE", "also use this library, or plan in JSON (repeatable)", &Args::plugins};
}

// Commands of studies: run them, see what they would do.
Commands study_commands() {
  const Option plugin = plugin_option();
  const Option out{"out", "DIR", "results folder (default: results/NAME)", &Args::out};
  const Option jobs{"jobs", "N", "worker processes (default: one for each processor that it may use)",
                    Option::Count{&Args::jobs, most_jobs}};
  const Option fresh{"fresh", "", "forget earlier results in the folder", &Args::fresh};
  const Option table{"table", "", "print a line for every case", &Args::table};
  const Option in_line{"inline", "",
                       "run in this process alone, without workers: for a debugger. This is the default where all "
                       "cases take less than a second and every plugin is Ricochet's own",
                       &Args::here};
  const Option isolate{"isolate", "", "run in worker processes, however short it is", &Args::isolate};
  const Option threads{"threads", "", "accepted for old scripts; changes nothing", {}};
  const Option part{"part", "K/N",
                    "run part K of N, its share of the cases, with a folder of its own (default: "
                    "results/NAME-part-K-of-N). A case is not split. `ricochet merge` joins the parts",
                    &Args::part};
  const Option part_shown{"part", "K/N", "show what part K of N would run", &Args::part};
  const Option cases{"cases", "", "also print a line for every case", &Args::cases};
  const Option workers{"workers", "N",
                       "also say what so many worker processes would take: wall time, what bounds it, memory and store",
                       Option::Count{&Args::workers, most_workers}};
  const Option nodes{"nodes", "N", "machines of the job (default: 1)", Option::Count{&Args::nodes, most_nodes}};
  const Option time{"time", "T",
                    "time limit of one start of the job, as Slurm writes it: minutes, H:M:S or D-H:M:S (required)",
                    &Args::time};
  const Option cpus{"cpus", "N", "processors of each machine (default: all, no other job beside)",
                    Option::Count{&Args::cpus, most_jobs}};
  return {
      {"run",
       "STUDY.json [--part K/N] [--out DIR] [--jobs N] [--fresh] [--table] [--inline|--isolate]",
       "Run what is missing of a study; write results and report; print its answer.",
       1,
       1,
       {out, jobs, fresh, table, in_line, isolate, threads, part, plugin},
       command_run},
      {"plan",
       "STUDY.json [--cases] [--part K/N] [--workers N]",
       "Show what would run, what is refused and why, the predicted cost, the physics. No results are made.",
       1,
       1,
       {workers, cases, part_shown, plugin},
       command_plan},
      {"status",
       "DIR…",
       "Say how far a run is, from any machine: what is finished, what is under way, who runs it. Changes nothing.",
       1,
       10000,
       {},
       command_status},
      {"slurm",
       "STUDY.json --time T [--nodes N] [--cpus N] [--out DIR]",
       "Print a job script that runs a study on N machines of a Slurm cluster, and goes on after each time limit.",
       1,
       1,
       {out, nodes, time, cpus, plugin},
       command_slurm},
  };
}

// Commands of methods.
Commands method_commands() {
  const Option plugin = plugin_option();
  return {
      {"list", "[mass|contact|friction|time|reference]", "List the methods found.", 0, 1, {plugin}, command_list},
      {"describe",
       "NAME|PLAN.json",
       "Show the manual of a method, a structure, a kind of study, an ask, a measure or an error; or of a scheme "
       "stated in a file.",
       1,
       1,
       {plugin},
       command_describe},
      {"new",
       "plan|time|contact|friction|mass|reference NAME",
       "Make a folder with a working method to start from: a plan in JSON, or source and build file; a study.",
       2,
       2,
       {plugin},
       command_new},
      {"check",
       "NAME|PLUGIN.so|PLAN.json|--plugin FILE",
       "Measure what a method declares: one line per check, a sentence for each that fails.",
       0,
       1,
       {plugin},
       command_check},
  };
}

// Commands of results folders.
Commands result_commands() {
  const Option plugin = plugin_option();
  const Option table_of_all{"table", "", "print all of it as CSV", &Args::table};
  const Option index{"out", "FILE",
                     "the page that lists several folders (default: index.html in the folder that holds them all); "
                     "NAME.md: questions and answers in Markdown",
                     &Args::out};
  const Option json{"json", "",
                    "print what the study asks with its verdicts as JSON (of one folder), or the comparison",
                    &Args::json};
  const Option beside{
      "compare", "",
      "put two results of one kind beside each other, folders or packed: values, intervals and what "
      "changed beyond them, as a page and as CSV (default: comparison.html in the folder that holds both)",
      &Args::compare};
  const Option figures{"figures", "DIR",
                       "also write each figure as SVG and its numbers as CSV into that folder, and all as pages of "
                       "figures.pdf (of one folder). A browser draws them: chromium, or RICOCHET_BROWSER",
                       &Args::figures};
  const Option merged{"out", "DIR",
                      "the folder that is made, whole or not at all: a new or an empty one (required). Folders that "
                      "one run would not have left are refused: of another study, program, plugin or arithmetic, or "
                      "under way. Different results of the same case are refused too",
                      &Args::out};
  const Option to{"to", "CSVDIR", "folder that receives the tables (required)", &Args::to};
  const Option curves{"curves", "",
                      fmt::format("all curves in one curves.csv, with the case before each sample, in place of a file "
                                  "for each case. With more than {} cases there are no such files",
                                  kMostCurveFiles),
                      &Args::curves};
  return {
      {"report",
       "DIR… [--out FILE] [--json] [--figures DIR] | --compare A B [--out FILE] [--json]",
       "Rebuild the report and the tables of a results folder; of several, also a page that lists them; or compare "
       "two.",
       1,
       1000,
       {index, beside, json, figures},
       command_report},
      {"merge",
       "DIR DIR… --out DIR",
       "Join results folders of one study, its parts or runs that were stopped, into the folder that one run leaves.",
       1,
       100000,
       {merged, plugin},
       command_merge},
      {"compare",
       "A B [--table]",
       "Say what two results folders have differently: inputs, cases, results beyond round-off, answer.",
       2,
       2,
       {table_of_all},
       command_compare},
      {"export",
       "DIR --to CSVDIR [--curves]",
       "Write the results as plain CSV tables.",
       1,
       1,
       {to, curves},
       command_export},
      {"league",
       "DIR…",
       "Print time schemes side by side in Markdown: what the studies of these results folders measured of each.",
       1,
       1000,
       {},
       command_league},
  };
}

// Commands of results in one file.
Commands packed_commands() {
  const Option plugin = plugin_option();
  const Option file{"out", "FILE", "the file that is made (default: NAME.ricochet.zip)", &Args::out};
  const Option cases{"cases", "N|all",
                     "compute so many cases again, drawn by chance, or all (default: 3; 0: compare sums alone)",
                     &Args::drawn};
  return {
      {"pack",
       "DIR [--out FILE]",
       "Put a results folder into one file: study with the files that it read, tables, answer, report, what computed "
       "it.",
       1,
       1,
       {file},
       command_pack},
      {"verify",
       "FILE [--cases N|all]",
       "Check a packed result, compute some of its cases again, and say whether they are bit-equal, equal to six "
       "digits, equal within u, or not.",
       1,
       1,
       {cases, plugin},
       command_verify},
      {"unpack",
       "FILE [DIR]",
       "Check a packed result and make its folder, whole or not at all.",
       1,
       2,
       {},
       command_unpack},
  };
}

// Commands of one case or orbit.
Commands case_commands() {
  const Option plugin = plugin_option();
  const Option parameter{"parameter", "VALUE", "value of a bifurcation study's parameter", &Args::parameter};
  const Option start{"start", "NAME", "start of the orbit, as in values.csv", &Args::start};
  const Option cell{"cell", "X,Y", "cell of a study of basins, as in cells.csv", &Args::cell};
  const Option branch{"branch", "NAME", "branch of a continuation study, as in branches.csv", &Args::branch};
  const Option arc{"arc", "S", "length of the branch up to the orbit, m: any, not only those of rows", &Args::arc};
  const Option film{
      "snapshots", "N",
      "also keep N instants of an orbit of a branch beside its case: the next report shows them as a film",
      Option::Count{&Args::snapshots, most_snapshots}};
  const Option period_file{"out", "FILE", "its period as CSV (default: DIR/points/CASE_BRANCH_ARC.csv)", &Args::out};
  const Option periods{"periods", "N", "forcing periods that are marched (default: 8)",
                       Option::Count{&Args::periods, most_samples}};
  const Option samples_of_period{"samples", "N", "samples per period (default: 200)",
                                 Option::Count{&Args::samples, most_samples}};
  const Option samples{"samples", "N", "print the curve instead, at N samples, as CSV",
                       Option::Count{&Args::samples, most_samples}};
  const Option snapshots{"snapshots", "N",
                         "keep N instants of the motion beside the case instead: the next report shows them as a film",
                         Option::Count{&Args::snapshots, most_snapshots}};
  const Option study{"study", "", "print the study of this case alone instead, to be run", &Args::study};
  return {
      {"point",
       "DIR CASE (--parameter VALUE --start NAME | --cell X,Y | --branch NAME --arc S)",
       "March one orbit of a bifurcation study, or one cell of basins, again and print it as CSV; solve one orbit of a "
       "branch again.",
       2,
       2,
       {parameter, start, cell, periods, samples_of_period, branch, arc, film, period_file, plugin},
       command_point},
      {"case",
       "DIR ID [--samples N | --snapshots N | --study]",
       "March one case again: what it measures, compared with what is stored. ID may be the beginning of one.",
       2,
       2,
       {samples, snapshots, study, plugin},
       command_case},
  };
}

// Commands of the program itself.
Commands program_commands() {
  const Option plugin = plugin_option();
  return {
      {"schema",
       "",
       "Print a JSON Schema of studies, with the parameters of every method found.",
       0,
       0,
       {plugin},
       command_schema},
      {"doctor",
       "",
       "Show what is found where: versions, libraries, plugin folders, processor.",
       0,
       0,
       {plugin},
       command_doctor},
      {"manual",
       fmt::format("{}", fmt::join(manual_pages(), "|")),
       "Print a page for man, or the completions of a shell.",
       1,
       1,
       {},
       command_manual},
  };
}

std::vector<Subcommand> all_commands() {
  Commands all;
  for (const auto& some :
       {study_commands(), method_commands(), result_commands(), packed_commands(), case_commands(), program_commands()})
    all.insert(all.end(), some.begin(), some.end());
  return all;
}

std::string overview() {
  std::string text =
      "Ricochet: is this what the beam does, or what the numerical method does?\n\nUsage: ricochet COMMAND …\n\n";
  for (const Subcommand& command : subcommands())
    text += fmt::format("  {:<9} {:<46} {}\n", command.name, command.usage, command.summary);
  text +=
      "\n  ricochet help COMMAND shows the options of one command; ricochet --version the version.\n\nExit codes:\n";
  for (const ExitMeaning& meaning : exit_meanings()) text += fmt::format("  {:>3}  {}\n", meaning.code, meaning.text);
  return text;
}

/// The version and the commit, then what the program was built with.
std::string version_text() {
  const Environment all = describe_environment({});
  TextTable table({"", ""});
  for (const char* name : {"compiler", "contract", "lanes", "libraries"})
    table.add({name, environment_entry(all, name)});
  const std::string rows = table.text();  // below an empty head
  return fmt::format("{}, commit {}{}", environment_entry(all, "program"), environment_entry(all, "commit"), rows);
}

const Subcommand& find_command(const std::string& name) {
  std::vector<std::string> names;
  for (const Subcommand& command : subcommands()) {
    if (command.name == name) return command;
    names.push_back(command.name);
  }
  names.insert(names.end(), {"help", "--help", "--version"});
  if (name.starts_with("-")) {
    const std::string nearest = nearest_name(name, {"--help", "--version"});
    throw UsageError("expected a command before the option " + name +
                     (nearest.empty() ? "" : "; did you mean " + nearest + "?") +
                     "\n`ricochet --help` lists the commands");
  }
  const std::string nearest = nearest_name(name, names);
  throw UsageError("there is no command \"" + name + "\"" +
                   (nearest.empty() ? "" : "; did you mean \"" + nearest + "\"?") +
                   "\n`ricochet --help` lists the commands");
}

int dispatch(const std::vector<std::string>& arguments, std::ostream& out, const FindHosts& hosts) {
  if (arguments.empty()) throw UsageError("expected a command\n\n" + overview());
  const std::string& first = arguments.front();
  const std::vector<std::string> rest(arguments.begin() + 1, arguments.end());
  if (first == "--help" || first == "-h" || first == "help") {
    if (first != "help" || rest.empty())
      out << overview();
    else if (rest.front() == "help")
      out << "Usage: ricochet help [COMMAND]\n\nShow the commands, or what one of them takes and its options.\n";
    else
      out << help_text(find_command(rest.front()));
    return exit_done;
  }
  if (first == "--version") {
    out << version_text();
    return exit_done;
  }
  if (first == "worker" && rest.empty()) return serve_as_worker();  // started by this program, not by a person
  const ForeignCode::InChildrenAlone elsewhere;
  const Subcommand& command = find_command(first);
  Arguments parsed = parse_arguments(command, rest);
  parsed.hosts = hosts;
  if (parsed.help) {
    out << help_text(command);
    return exit_done;
  }
  return command.run(parsed, out);
}

/// Whether the machine has no more memory, processes, threads or descriptors to give.
bool is_at_end(std::error_code code) {
  for (const std::errc one : {std::errc::resource_unavailable_try_again, std::errc::not_enough_memory,
                              std::errc::too_many_files_open, std::errc::too_many_files_open_in_system})
    if (code == one) return true;
  return false;
}

}  // namespace

int exit_code_of(const std::function<int()>& work, std::ostream& err) {
  try {
    return work();
  } catch (const UsageError& error) {
    err << "ricochet: " << error.what() << "\n";
    return exit_bad_input;
  } catch (const StudyError& error) {
    err << error.what() << "\n";
    return exit_bad_input;
  } catch (const InputError& error) {
    err << "ricochet: " << (error.pointer().empty() ? "" : "at " + error.pointer() + ": ") << error.what() << "\n";
    return exit_bad_input;
  } catch (const PartRefused& error) {
    err << "ricochet: " << error.what() << "\n";
    return exit_bad_input;
  } catch (const PluginError& error) {
    err << "ricochet: " << error.what() << "\n";
    return exit_plugin;
  } catch (const StoreError& error) {
    err << "ricochet: " << error.what() << "\n";
    return exit_store;
  } catch (const RunError& error) {
    err << "ricochet: " << error.what() << "\n";
    return error.of_plugin() ? exit_plugin : exit_store;
  } catch (const std::bad_alloc&) {
    err << "ricochet: not enough memory\n";
    return exit_store;
  } catch (const std::system_error& error) {
    if (error.code() == std::errc::no_space_on_device) {
      err << "ricochet: the disk is full; free some space and run the same command again: " << error.what() << "\n";
      return exit_store;
    }
    const bool at_end = is_at_end(error.code());
    err << "ricochet: " << (at_end ? "the system has no more memory, threads or files to give: " : "internal error: ")
        << error.what() << "\n";
    if (at_end) return exit_store;
  } catch (const std::exception& error) {
    err << "ricochet: internal error: " << error.what() << "\n";
  } catch (...) {
    err << "ricochet: internal error of an unknown kind\n";
  }
  return exit_bug;
}

const std::vector<Subcommand>& subcommands() {
  static const std::vector<Subcommand> all = all_commands();
  return all;
}

int run_command(const std::vector<std::string>& arguments, std::ostream& out, std::ostream& err,
                const FindHosts& hosts) {
  const PlainOutput plain_out(out), plain_err(err);
  const int code = exit_code_of([&] { return dispatch(arguments, out, hosts); }, err);
  // Part of it may have gone through the C library.
  const bool standard = &out == &std::cout;
  if (!out.flush() || (standard && (std::fflush(stdout) != 0 || std::ferror(stdout) != 0))) {
    err << "ricochet: the output could not be written completely\n";
    return code == exit_done ? exit_store : code;
  }
  return code;
}

}  // namespace ricochet
