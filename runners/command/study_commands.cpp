#include <iostream>

#include "runners/command/command.hpp"
#include "runners/command/study_file.hpp"
#include "runners/command/subcommand.hpp"
#include "runners/run/derive.hpp"
#include "runners/run/league.hpp"
#include "runners/run/run_study.hpp"
#include "runners/store/store.hpp"

namespace ricochet {

int command_run(const Arguments& arguments, std::ostream&) {
  return with_study(arguments, [&](const OpenStudy& open) {
    for (const std::string& warning : plugin_warnings(open)) std::cerr << "ricochet: " << warning << "\n";
    RunOptions options;
    options.out = arguments.out.value_or("");
    options.jobs = arguments.jobs;
    options.fresh = arguments.fresh;
    options.table = arguments.table;
    return run_study(open.study, open.catalogue, open.registry, options);
  });
}

int command_report(const Arguments& arguments, std::ostream&) {
  return rebuild_report(arguments.operands.front());
}

int command_export(const Arguments& arguments, std::ostream&) {
  if (!arguments.to) throw UsageError("export expects --to CSVDIR, the folder that receives the tables");
  return export_tables(arguments.operands.front(), *arguments.to);
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
