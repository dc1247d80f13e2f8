#include "runners/mpi/ranks.hpp"

#include <fmt/format.h>

#include <ostream>

#include "runners/command/command.hpp"
#include "runners/workers/machines.hpp"
#include "runners/workers/worker_process.hpp"

namespace ricochet {
namespace {

constexpr const char* usage =
    "Usage: mpirun --bind-to none --map-by ppr:1:node ricochet-mpi run STUDY.json [options of `ricochet run`]\n"
    "       srun --mpi=pmix --kill-on-bad-exit=1 ricochet-mpi run STUDY.json …   (`ricochet slurm` prints a job "
    "script)\n\n"
    "Runs a study with workers on all machines of a job: one rank for each. --jobs N: workers of each machine.\n"
    "Everything else is done by `ricochet`, without MPI.\n";

}  // namespace

int run_rank(Transport& transport, const std::vector<std::string>& arguments, std::ostream& out, std::ostream& err,
             bool& lost) {
  const bool runs = !arguments.empty() && arguments.front() == "run";
  if (transport.rank() != 0) {
    if (!runs) return exit_done;
    const HostFacts facts = facts_of_this_machine(transport.rank());
    if (serve_as_agent(transport, facts, [] { return std::make_unique<WorkerProcess>(); })) return exit_done;
    err << fmt::format("ricochet: rank {} on {}: rank 0 does not answer any more\n", facts.rank, facts.name);
    lost = true;
    return exit_bug;
  }
  if (!runs) {
    const bool asked = !arguments.empty() && (arguments.front() == "--help" || arguments.front() == "help");
    (asked ? out : err) << (asked ? "" : "ricochet: ricochet-mpi expects the command run\n") << usage;
    return asked ? exit_done : exit_bad_input;
  }
  RemoteHosts remote(transport, [&err](const HostFacts& one, const std::string& why) {
    err << fmt::format("ricochet: rank {} on {} {}: its work is given to others\n", one.rank, one.name, why)
        << std::flush;
  });
  int code = exit_bug;
  try {
    std::vector<HostFacts> machines = {facts_of_this_machine(0)};
    for (HostFacts& one : remote.facts()) machines.push_back(std::move(one));
    const std::string why_not = objections(machines);
    if (!why_not.empty()) {
      err << "ricochet: these machines cannot march one study together:\n" << why_not;
      code = exit_bad_input;
    } else {
      const std::vector<int> workers = workers_of(machines);
      err << oddities(machines, workers);
      code = run_command(arguments, out, err, [&](int jobs) {
        const std::vector<int> asked = jobs > 0 ? std::vector<int>(machines.size(), jobs) : workers;
        err << "ricochet: " << words_of(machines, asked) << "\n" << std::flush;
        return hosts_of(remote, machines, jobs);
      });
    }
  } catch (const std::exception& error) {
    err << "ricochet: " << error.what() << "\n";
  }
  lost = !remote.dismiss();
  return code;
}

}  // namespace ricochet
