#pragma once
#include <functional>
#include <iosfwd>
#include <memory>
#include <string>
#include <vector>

namespace ricochet {

class WorkerHost;

/// The machines that workers may be started on, this one first, each with so many workers; 0: as many as it has
/// processors.
using FindHosts = std::function<std::vector<std::shared_ptr<WorkerHost>>(int jobs)>;

/// Exit codes of the command (runners/README.md).
enum ExitCode {
  exit_done = 0,
  exit_bug = 1,        ///< our fault: an error that nothing else explains
  exit_bad_input = 2,  ///< bad study or usage
  exit_some_failed = 3,
  exit_plugin = 4,  ///< plugin missing or incompatible
  exit_store = 5,   ///< the store, an output or the machine's memory
  exit_not_met = 6,    ///< an ask that must have a yes has none
  exit_interrupted = 130
};

/// The `ricochet` command: `arguments` without the program's name. Errors go to `err`, each as one clear message; no
/// exception leaves. `hosts`: where a run has more machines than this one.
int run_command(const std::vector<std::string>& arguments, std::ostream& out, std::ostream& err,
                const FindHosts& hosts = {});

}  // namespace ricochet
