#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <iostream>

#include "runners/command/command.hpp"
#include "runners/command/study_file.hpp"
#include "runners/command/subcommand.hpp"
#include "runners/march/study_identity.hpp"
#include "runners/report/index_page.hpp"
#include "runners/run/derive.hpp"
#include "runners/run/league.hpp"
#include "runners/run/run_study.hpp"
#include "runners/store/atomic_file.hpp"
#include "runners/store/store.hpp"
#include "runners/workers/allowed_processors.hpp"

namespace ricochet {

namespace {

/// Whether a method of the study is of a library that is not the program's own: somebody is writing it.
bool runs_foreign_code(const OpenStudy& open) {
  for (const StudyCase& one : open.study.cases)
    for (const std::filesystem::path& file : libraries_of(one, open.registry))
      if (file.extension() == ".so" && open.catalogue.foreign(file)) return true;
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

}  // namespace

int command_report(const Arguments& arguments, std::ostream& out) {
  if (arguments.operands.size() == 1) {
    if (arguments.out) throw UsageError("--out is for the page that lists several folders; only one was given");
    return rebuild_report(arguments.operands.front());
  }
  std::vector<std::filesystem::path> folders;
  for (const std::string& operand : arguments.operands) {
    if (const int code = rebuild_report(operand); code != exit_done) return code;
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
  return exit_done;
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

}  // namespace ricochet
