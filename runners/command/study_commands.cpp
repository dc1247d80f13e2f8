#include <iostream>

#include "runners/command/command.hpp"
#include "runners/command/study_file.hpp"
#include "runners/command/subcommand.hpp"
#include "runners/run/run_study.hpp"

namespace ricochet {

int command_run(const Arguments& arguments, std::ostream&) {
  return with_study(arguments, [&](const OpenStudy& open) {
    for (const std::string& warning : plugin_warnings(open)) std::cerr << "ricochet: " << warning << "\n";
    RunOptions options;
    options.out = arguments.out.value_or("");
    options.jobs = arguments.jobs;
    options.fresh = arguments.fresh;
    return run_study(open.study, open.catalogue, open.registry, options);
  });
}

int command_report(const Arguments& arguments, std::ostream&) {
  return rebuild_report(arguments.operands.front());
}

int command_export(const Arguments& arguments, std::ostream&) {
  if (!arguments.to) throw UsageError("ricochet export: expected --to CSVDIR, the folder that receives the tables");
  return export_tables(arguments.operands.front(), *arguments.to);
}

}  // namespace ricochet
