#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cerrno>
#include <csignal>
#include <iostream>
#include <ostream>
#include <ricochet/loader/child.hpp>
#include <set>

#include "runners/command/command.hpp"
#include "runners/command/figure_files.hpp"
#include "runners/command/subcommand.hpp"
#include "runners/kinds/kind.hpp"
#include "runners/march/study_identity.hpp"
#include "runners/pack/pack.hpp"
#include "runners/plan_files/plan_file.hpp"
#include "runners/report/summary_page.hpp"
#include "runners/run/compare_studies.hpp"
#include "runners/run/finish_run.hpp"
#include "runners/run/pair_results.hpp"
#include "runners/run/run_study.hpp"
#include "runners/run/waiting_line.hpp"
#include "runners/store/atomic_file.hpp"
#include "runners/store/read_store.hpp"
#include "runners/store/store.hpp"
#include "runners/store/temporary_folder.hpp"
#include "runners/study/load_study.hpp"
#include "runners/study/product.hpp"
#include "runners/table/text.hpp"
#include "runners/workers/allowed_processors.hpp"

namespace ricochet {
namespace fs = std::filesystem;

int with_study(const Arguments& arguments, const std::function<int(const OpenStudy&)>& use) {
  const std::filesystem::path name = arguments.operands.front();
  OpenStudy open{{}, standard_catalogue(arguments.plugins), {}};
  std::optional<StudyText> given;
  try {
    {
      const WaitingLine waiting("reading " + name.string());
      open.study = load_study(given.emplace(name), open.catalogue, open.registry);
    }
    return use(open);
  } catch (const MissingMethod& error) {
    if (error.near()) throw StudyError(explain(error, *given));
    throw PluginError(explain(error, *given));
  } catch (const InputError& error) {
    throw StudyError(given ? explain(error, *given) : explained(error, StudyText::place_of(name), ""));
  }
}

std::vector<std::string> plugin_warnings(const OpenStudy& open) {
  std::set<std::pair<Role, std::string>> used;
  for (const StudyCase& study_case : open.study.cases) {
    for (const auto& [role, method] : methods_of(study_case)) used.emplace(role, method->name);
    for (const MethodChoice& reference : study_case.references) used.emplace(Role::reference, reference.name);
  }
  std::vector<std::string> warnings;
  for (const auto& [role, name] : used)
    for (const std::filesystem::path& file : open.catalogue.shadowed(role, name))
      warnings.push_back(std::string(role_name(role)) + " '" + name + "' of " + file.string() + " is shadowed by " +
                         open.catalogue.provider(role, name)->string());
  for (const std::filesystem::path& folder : open.catalogue.missing_folders())
    warnings.push_back("no such plugin folder: " + folder.string());
  return warnings;
}

namespace {

/// Whether a method of the study is of a library that is not the program's own: somebody is writing it.
bool runs_foreign_code(const OpenStudy& open) {
  for (const StudyCase& one : open.study.cases)
    for (const std::filesystem::path& file : libraries_of(one, open.registry))
      if (open.catalogue.foreign(file)) return true;
  return false;
}

}  // namespace

int command_run(const Arguments& arguments, std::ostream&) {
  const AllowedProcessors processors = allowed_processors();  // what is wrong with it is not the study's fault
  return with_study(arguments, [&](const OpenStudy& open) {
    for (const std::string& warning : plugin_warnings(open)) std::cerr << "ricochet: " << warning << "\n";
    RunOptions options;
    options.out = arguments.out.value_or("");
    options.jobs = arguments.jobs > 0 ? arguments.jobs : processors.count;
    options.fresh = arguments.fresh;
    options.table = arguments.table;
    options.part = arguments.part;
    if (arguments.hosts) {
      if (arguments.here) throw UsageError("--inline is for one process: the ranks of a job have workers");
      options.where = RunOptions::Where::workers;
      options.hosts = arguments.hosts(arguments.jobs);
    } else if (!arguments.here) {
      options.where =
          arguments.isolate || runs_foreign_code(open) ? RunOptions::Where::workers : RunOptions::Where::here_if_short;
    }
    options.plugins = arguments.plugins;
    if (arguments.here) ForeignCode::allow();  // for a debugger
    return run_study(open.study, open.catalogue, open.registry, options);
  });
}

namespace {

/// The folder that holds all of these: the longest common beginning of their paths.
std::filesystem::path common_folder(const std::vector<std::filesystem::path>& folders) {
  std::filesystem::path common = folders.front().parent_path();
  const auto holds = [&](const std::filesystem::path& folder) {
    return std::mismatch(common.begin(), common.end(), folder.begin(), folder.end()).first == common.end();
  };
  while (!std::all_of(folders.begin(), folders.end(), holds)) common = common.parent_path();
  return common;
}

/// A path as a relative link: what is no plain letter is %xx.
std::string as_link(const std::filesystem::path& path) {
  std::string out;
  for (const char c : path.generic_string())
    out += std::isalnum(static_cast<unsigned char>(c)) || std::string_view("-._~/").find(c) != std::string_view::npos
               ? std::string(1, c)
               : fmt::format("%{:02X}", static_cast<unsigned char>(c));
  return out;
}

/// A results folder, or a packed one in a folder of its own that goes with it.
struct OpenedResult {
  std::optional<TemporaryFolder> unpacked;
  fs::path folder;

  explicit OpenedResult(const fs::path& place) : folder(place) {
    if (!fs::exists(place)) throw UsageError(place.string() + ": there is no such folder or packed result");
    if (fs::is_regular_file(place)) {
      unpack_results(place, unpacked.emplace("compare").path());
      folder = unpacked->path() / packed::results;
    }
    if (!fs::exists(folder / "results.sqlite"))
      throw UsageError(place.string() + ": holds no results.sqlite; expected a folder of results");
  }
};

int report_pair(const Arguments& arguments, std::ostream& out) {
  if (arguments.operands.size() != 2)
    throw UsageError(fmt::format("--compare is for two results; {} given",
                                 arguments.operands.size() == 1 ? "one was" : "more were"));
  if (arguments.figures) throw UsageError("--figures is for one folder; --compare has two");
  const OpenedResult folder_a(arguments.operands[0]), folder_b(arguments.operands[1]);
  const fs::path path_a = fs::canonical(arguments.operands[0]), path_b = fs::canonical(arguments.operands[1]);
  if (path_a == path_b) throw UsageError(arguments.operands[1] + ": is the same result; expected another one");
  const AnalysedResults a = with_tables(read_store(folder_a.folder)), b = with_tables(read_store(folder_b.folder));
  if (a.kind != b.kind)
    throw UsageError(fmt::format("{} is of kind {} and {} of kind {}; expected two results of one kind",
                                 arguments.operands[0], a.kind, arguments.operands[1], b.kind));
  const PairedResults pairs = pair_results(a, b);
  fs::path page = arguments.out ? fs::absolute(*arguments.out) : common_folder({path_a, path_b}) / "comparison.html";
  write_file(page, paired_page(pairs, a, b));
  fs::path table = page;
  write_file(table.replace_extension(".csv"), table_csv(paired_table(pairs)));
  if (arguments.json)
    out << paired_json(pairs, a, b).dump(2, ' ', false, nlohmann::ordered_json::error_handler_t::replace) << "\n";
  else
    out << paired_text(pairs, a, b) << "page: " << page.string() << "\n";
  return exit_done;
}

/// Whether a report was written, whatever it says of its cases and asks.
bool has_report(int code) {
  return code == exit_done || code == exit_some_failed || code == exit_not_met;
}

}  // namespace

int command_report(const Arguments& arguments, std::ostream& out) {
  if (arguments.compare) return report_pair(arguments, out);
  if (arguments.operands.size() == 1) {
    if (arguments.out) throw UsageError("--out is for the page that lists several folders; only one was given");
    const int code = rebuild_report(arguments.operands.front(), arguments.json);
    if (!arguments.figures || !has_report(code)) return code;
    const std::size_t count =
        write_figures(std::filesystem::path(arguments.operands.front()) / "report.html", *arguments.figures);
    if (!arguments.json) out << "figures: " << count << " in " << arguments.figures->string() << "\n";
    return code;
  }
  if (arguments.figures) throw UsageError("--figures is for one folder; several were given");
  if (arguments.json) throw UsageError("--json is for one folder; several were given");
  std::vector<std::filesystem::path> folders;
  int ended = exit_done;
  for (const std::string& operand : arguments.operands) {
    const int code = rebuild_report(operand);
    if (!has_report(code)) return code;
    if (ended == exit_done || code == exit_some_failed) ended = code;
    folders.push_back(std::filesystem::canonical(operand));
  }
  const std::filesystem::path page = std::filesystem::weakly_canonical(
      arguments.out ? std::filesystem::absolute(*arguments.out) : common_folder(folders) / "index.html");
  std::vector<report::IndexEntry> studies;
  for (const std::filesystem::path& folder : folders)
    studies.push_back(
        {with_tables(read_store(folder)), as_link((folder / "report.html").lexically_relative(page.parent_path()))});
  write_file(page, page.extension() == ".md" ? report::index_markdown(studies) : report::index_page(studies));
  out << "index: " << page.string() << "\n";
  return ended;
}

int command_merge(const Arguments& arguments, std::ostream&) {
  if (!arguments.out) throw UsageError("merge expects --out DIR, the folder that is made");
  return merge_folders({arguments.operands.begin(), arguments.operands.end()}, *arguments.out, arguments.plugins);
}

int command_export(const Arguments& arguments, std::ostream&) {
  if (!arguments.to) throw UsageError("export expects --to CSVDIR, the folder that receives the tables");
  return export_tables(arguments.operands.front(), *arguments.to, arguments.curves);
}

int command_league(const Arguments& arguments, std::ostream& out) {
  std::vector<StudyResults> studies;
  for (const std::string& folder : arguments.operands) studies.push_back(with_tables(read_store(folder)));
  out << markdown(league_table(studies)) << "\n";
  const std::size_t beginning = common_beginning(studies).size();
  for (const StudyResults& study : studies)
    out << "[" << study.name.substr(beginning) << "]: " << study.name << ".json\n";
  return exit_done;
}

int command_compare(const Arguments& arguments, std::ostream& out) {
  const StudyResults a = with_tables(read_store(arguments.operands[0])),
                     b = with_tables(read_store(arguments.operands[1]));
  const StudyComparison found = compare_studies(a, b);
  out << (arguments.table ? table_csv(comparison_table(found)) : comparison_text(found, a, b));
  return exit_done;
}

namespace {

// "bifurcation or basins".
std::string kinds_with_points() {
  std::vector<std::string> names;
  for (const KindPointer& kind : kinds())
    if (kind->has_points()) names.push_back(kind->format.name);
  return fmt::format("{}", fmt::join(names, " or "));
}

}  // namespace

int command_point(const Arguments& arguments, std::ostream& out) {
  const StudyResults results = read_store(arguments.operands[0]);
  const Kind* kind = find_kind(results.kind);
  if (!kind || !kind->has_points())
    throw UsageError(fmt::format("{} holds a study of kind {}; a point is one of kind {}", arguments.operands[0],
                                 results.kind, kinds_with_points()));
  const PointRequest asked{arguments.operands[1], arguments.plugins,   arguments.parameter,   arguments.start,
                           arguments.cell,        arguments.periods,   arguments.samples,     arguments.branch,
                           arguments.arc,         arguments.snapshots, arguments.operands[0], arguments.out};
  return march_apart(arguments, out, [&](std::ostream& to) {
    try {
      return kind->point(results, asked, to);
    } catch (const PointRefused& refused) {
      throw UsageError(refused.what());
    }
  });
}

namespace {

// A run writes how far it is every few seconds, and what it has under way is kept as often.
constexpr double silence = 60;  // s

std::string status_text(const std::string& folder, const RunStatus& status) {
  int finished = 0;
  std::string kinds;
  for (const auto& [word, count] : status.rows) {
    finished += count;
    kinds += fmt::format("{}{} {}", kinds.empty() ? ": " : ", ", count, word);
  }
  const std::string part = status.part.whole() ? "" : ", " + status.part.text();
  std::string text = fmt::format("{} ({}, {}{}): {} of {} case{} finished{}\n", folder, status.name, status.kind, part,
                                 finished, status.expected, status.expected == 1 ? "" : "s", kinds);
  const std::string who = status.run ? status.run->text() : "a run";
  if (!status.progress.empty()) {
    text += fmt::format("  {}\n", who);
    text += fmt::format("  {}, {} ago\n", status.progress, duration_text(status.silent));
    // On the machine of the run its process is looked for.
    const bool gone = status.run && status.run->process > 0 && status.run->host == this_run().host &&
                      ::kill(status.run->process, 0) != 0 && errno == ESRCH;
    if (gone)
      text += "  that process is not there any more: the same command again goes on where it was\n";
    else if (status.silent > silence)
      text += fmt::format(
          "  it has not written for {}: it has ended, or cannot write; the same command again goes on where it was\n",
          duration_text(status.silent));
  } else if (finished < status.expected) {
    text += fmt::format("  not under way; last {}: the same command again goes on where it was\n", who);
  }
  constexpr std::size_t most = 8;
  std::vector<std::string> running;
  for (const RunStatus::UnderWay& one : status.under_way)
    if (one.stage == "run") running.push_back(fmt::format("{} (since {})", one.id, one.since));
  const std::size_t told = std::min(most, running.size());
  if (told > 0)
    text +=
        fmt::format("  under way: {}{}\n", fmt::join(running.begin(), running.begin() + static_cast<long>(told), ", "),
                    running.size() > told ? fmt::format(" and {} more", running.size() - told) : "");
  return text;
}

}  // namespace

int command_status(const Arguments& arguments, std::ostream& out) {
  for (const std::string& folder : arguments.operands) out << status_text(folder, read_status(folder));
  return exit_done;
}

}  // namespace ricochet
