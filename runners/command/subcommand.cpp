#include "runners/command/subcommand.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <boost/program_options.hpp>
#include <sstream>

#include "runners/store/curve_files.hpp"

namespace ricochet {
namespace po = boost::program_options;
namespace {

po::options_description described(const Subcommand& command) {
  po::options_description all("Options");
  const auto has = [&](const char* name) {
    return std::find(command.options.begin(), command.options.end(), name) != command.options.end();
  };
  auto add = all.add_options();
  if (has("out") && command.name == "report")
    add("out", po::value<std::string>()->value_name("FILE"),
        "the page that lists several folders (default: index.html in the folder that holds them all); NAME.md: "
        "questions and answers in Markdown");
  else if (has("out") && command.name == "merge")
    add("out", po::value<std::string>()->value_name("DIR"),
        "the folder that is made, whole or not at all: a new or an empty one (required). Folders that one run would "
        "not "
        "have left are refused: of another study, program, plugin or arithmetic, under way, or with another result of "
        "the same case");
  else if (has("out"))
    add("out", po::value<std::string>()->value_name("DIR"), "results folder (default: results/NAME)");
  if (has("jobs"))
    add("jobs", po::value<int>()->value_name("N"),
        "worker processes (default: one for each processor that it may use)");
  if (has("fresh")) add("fresh", "forget earlier results in the folder");
  if (has("table")) add("table", command.name == "compare" ? "print all of it as CSV" : "print a line for every case");
  if (has("workers"))
    add("workers", po::value<int>()->value_name("N"),
        "also say what so many worker processes would take: wall time, what bounds it, memory and store");
  if (has("nodes")) add("nodes", po::value<int>()->value_name("N"), "machines of the job (default: 1)");
  if (has("time"))
    add("time", po::value<std::string>()->value_name("T"),
        "time limit of one start of the job, as Slurm writes it: minutes, H:M:S or D-H:M:S (required)");
  if (has("cpus"))
    add("cpus", po::value<int>()->value_name("N"), "processors of each machine (default: all, no other job beside)");
  if (has("cases")) add("cases", "also print a line for every case");
  if (has("inline"))
    add("inline",
        "run in this process alone, without workers: for a debugger (the default where all cases take less than a "
        "second and every plugin is Ricochet's own)");
  if (has("isolate")) add("isolate", "run in worker processes, however short it is");
  if (has("threads")) add("threads", "accepted for old scripts; changes nothing");
  if (has("part"))
    add("part", po::value<std::string>()->value_name("K/N"),
        command.name == "plan"
            ? "show what part K of N would run"
            : "run part K of N, its share of the cases, with a folder of its own (default: results/NAME-part-K-of-N); "
              "a case is not split; `ricochet merge` joins the parts");
  if (has("to"))
    add("to", po::value<std::string>()->value_name("CSVDIR"), "folder that receives the tables (required)");
  if (has("curves"))
    add("curves", fmt::format("all curves in one curves.csv, with the case before each sample, in place of a file for "
                              "each case; of more than {} cases there are no such files",
                              kMostCurveFiles)
                      .c_str());
  if (has("parameter"))
    add("parameter", po::value<double>()->value_name("VALUE"), "value of a bifurcation study's parameter");
  if (has("start")) add("start", po::value<std::string>()->value_name("NAME"), "start of the orbit, as in values.csv");
  if (has("cell"))
    add("cell", po::value<std::string>()->value_name("X,Y"), "cell of a study of basins, as in cells.csv");
  if (has("periods"))
    add("periods", po::value<int>()->value_name("N"), "forcing periods that are marched (default: 8)");
  if (has("samples"))
    add("samples", po::value<int>()->value_name("N"),
        has("periods") ? "samples per period (default: 200)" : "print the curve instead, at N samples, as CSV");
  if (has("snapshots"))
    add("snapshots", po::value<int>()->value_name("N"),
        "keep N instants of the motion beside the case instead: the next report shows them as a film");
  if (has("study")) add("study", "print the study of this case alone instead, to be run");
  if (has("plugin"))
    add("plugin", po::value<std::vector<std::string>>()->value_name("FILE"),
        "also use this plugin library (repeatable)");
  add("help", "this text");
  return all;
}

std::vector<std::string> option_names(const po::options_description& description) {
  std::vector<std::string> names;
  for (const auto& option : description.options()) names.push_back("--" + option->long_name());
  return names;
}

std::string see_help(const Subcommand& command) {
  return "\nUsage: ricochet " + command.name + " " + command.usage;
}

po::variables_map parse(const Subcommand& command, const po::options_description& named,
                        const std::vector<std::string>& words) {
  po::options_description all = named;
  all.add_options()("operand", po::value<std::vector<std::string>>());
  po::positional_options_description positions;
  positions.add("operand", -1);
  // No guessing: half an option name is an error, not another option.
  namespace style = po::command_line_style;
  constexpr int strict = style::unix_style & ~style::allow_guessing;
  po::variables_map values;
  try {
    po::store(po::command_line_parser(words).options(all).positional(positions).style(strict).run(), values);
  } catch (const po::unknown_option& error) {
    std::string name = error.get_option_name();
    if (!name.starts_with("-")) name = "--" + name;
    const std::string nearest = nearest_name(name, option_names(named));
    throw UsageError(command.name + " has no option " + name +
                     (nearest.empty() ? "" : "; did you mean " + nearest + "?") + see_help(command));
  } catch (const po::invalid_option_value& error) {
    const char* wanted = error.get_option_name() == "--parameter" ? "; expected a number" : "; expected a whole number";
    throw UsageError(error.what() + std::string(wanted) + see_help(command));
  } catch (const po::error& error) {
    throw UsageError(error.what() + see_help(command));
  }
  return values;
}

std::optional<std::filesystem::path> path_of(const po::variables_map& values, const char* name) {
  if (!values.count(name)) return std::nullopt;
  const auto& text = values[name].as<std::string>();
  if (text.empty()) throw UsageError(std::string("--") + name + " was given an empty path");
  return text;
}

// 0 when it is not given.
int count_of(const po::variables_map& values, const char* name, int most) {
  if (!values.count(name)) return 0;
  const int count = values[name].as<int>();
  if (count < 1 || count > most) throw UsageError(fmt::format("--{} {} is outside [1, {}]", name, count, most));
  return count;
}

// All of the study when it is not given.
StudyPart part_given(const po::variables_map& values) {
  if (!values.count("part")) return {};
  const auto& text = values["part"].as<std::string>();
  if (const auto part = part_from(text)) return *part;
  throw UsageError(fmt::format("--part \"{}\": expected K/N, part K of N with 1 ≤ K ≤ N, such as 3/64", text));
}

}  // namespace

Arguments parse_arguments(const Subcommand& command, const std::vector<std::string>& words) {
  const po::options_description named = described(command);
  const po::variables_map values = parse(command, named, words);
  Arguments arguments;
  arguments.help = values.count("help") > 0;
  if (arguments.help) return arguments;
  arguments.out = path_of(values, "out");
  arguments.to = path_of(values, "to");
  arguments.fresh = values.count("fresh") > 0;
  arguments.table = values.count("table") > 0;
  arguments.isolate = values.count("isolate") > 0;
  arguments.here = values.count("inline") > 0;
  if (arguments.isolate && arguments.here) throw UsageError("--inline and --isolate exclude each other");
  arguments.cases = values.count("cases") > 0;
  arguments.curves = values.count("curves") > 0;
  arguments.study = values.count("study") > 0;
  constexpr int most_jobs = 4096, most_samples = 1000000000, most_snapshots = 2000;
  arguments.jobs = count_of(values, "jobs", most_jobs);
  arguments.periods = count_of(values, "periods", most_samples);
  arguments.samples = count_of(values, "samples", most_samples);
  arguments.snapshots = count_of(values, "snapshots", most_snapshots);
  constexpr int most_workers = 1000000, most_nodes = 100000;
  arguments.workers = count_of(values, "workers", most_workers);
  arguments.nodes = count_of(values, "nodes", most_nodes);
  arguments.cpus = count_of(values, "cpus", most_jobs);
  if (values.count("time")) arguments.time = values["time"].as<std::string>();
  arguments.part = part_given(values);
  if (values.count("parameter")) arguments.parameter = values["parameter"].as<double>();
  if (values.count("start")) arguments.start = values["start"].as<std::string>();
  if (values.count("cell")) arguments.cell = values["cell"].as<std::string>();
  if (values.count("plugin"))
    for (const std::string& file : values["plugin"].as<std::vector<std::string>>())
      arguments.plugins.emplace_back(file);
  if (values.count("operand")) arguments.operands = values["operand"].as<std::vector<std::string>>();
  if (arguments.operands.size() < command.fewest)
    throw UsageError("an argument of " + command.name + " is missing" + see_help(command));
  if (arguments.operands.size() > command.most)
    throw UsageError(command.name + " does not expect \"" + arguments.operands[command.most] + "\"" +
                     see_help(command));
  return arguments;
}

std::string help_text(const Subcommand& command) {
  std::ostringstream text;
  text << "Usage: ricochet " << command.name << (command.usage.empty() ? "" : " ") << command.usage << "\n\n"
       << command.summary << "\n\n"
       << described(command);
  return text.str();
}

}  // namespace ricochet
