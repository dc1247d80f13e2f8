#include <fmt/format.h>

#include <filesystem>
#include <ostream>
#include <regex>

#include "runners/command/command.hpp"
#include "runners/command/manual.hpp"
#include "runners/command/subcommand.hpp"
#include "runners/store/fingerprint.hpp"
#include "runners/study/load_study.hpp"
#include "runners/table/text.hpp"

namespace ricochet {
namespace {

namespace fs = std::filesystem;

/// A word of a shell, whatever stands in it.
std::string shell_word(const std::string& text) {
  static const std::regex plain("[-A-Za-z0-9_./:=@%+,]+");
  return std::regex_match(text, plain) ? text : shell_quoted(text);
}

/// Seconds of a time as Slurm writes it: M, M:S, H:M:S, D-H, D-H:M, D-H:M:S. Throws UsageError.
long long slurm_seconds(const std::string& text) {
  static const std::regex form("(?:(\\d{1,4})-)?(\\d{1,6})(?::(\\d{1,2}))?(?::(\\d{1,2}))?");
  std::smatch part;
  if (!std::regex_match(text, part, form))
    throw UsageError("--time expects a time as Slurm writes it: minutes, H:M:S or D-H:M:S; \"" + text + "\" is none");
  const auto number = [&](std::size_t i) {
    return part[i].matched ? static_cast<long long>(number_in(part[i].str()).value_or(0)) : 0;
  };
  constexpr long long minute = 60, hour = 3600, day = 86400;
  long long seconds = 0;
  if (part[1].matched)
    seconds = number(1) * day + number(2) * hour + number(3) * minute + number(4);
  else if (part[4].matched)
    seconds = number(2) * hour + number(3) * minute + number(4);
  else
    seconds = number(2) * minute + number(3);
  if (seconds < minute) throw UsageError("--time " + text + " is less than a minute: nothing would come of it");
  return seconds;
}

/// The program of this installation that ranks are.
fs::path ranks_program() {
  std::error_code error;
  const fs::path file = fs::canonical(program_file(), error).parent_path() / "ricochet-mpi";
  if (!fs::exists(file, error))
    throw UsageError(file.string() +
                     " is not there: jobs on several machines need a build with -DRICOCHET_MPI=ON (and the MPI of the "
                     "cluster). Without it, `ricochet run --part K/N` in a job array runs parts of a study");
  return file;
}

/// The exit codes after which another try would mend nothing, as a pattern of `case`: all but a bug and an
/// interruption. A job that a signal ended has none of them.
std::string final_codes() {
  std::vector<int> codes;
  for (const ExitMeaning& meaning : exit_meanings())
    if (meaning.code != exit_bug && meaning.code != exit_interrupted) codes.push_back(meaning.code);
  return fmt::format("{}", fmt::join(codes, "|"));
}

}  // namespace

int command_slurm(const Arguments& arguments, std::ostream& out) {
  if (arguments.time.empty()) throw UsageError("slurm expects --time T, the time limit of one start of the job");
  const long long limit = slurm_seconds(arguments.time);
  const fs::path program = ranks_program();
  if (!StudyText::is_file(arguments.operands.front()))
    throw UsageError("slurm expects the file of a study: the job reads it later, and a pipe gives its text once");
  return with_study(arguments, [&](const OpenStudy& open) -> int {
    // Time enough to bring what is under way to the store.
    constexpr long long most_notice = 120, part_of_limit = 4;
    const long long notice = std::min(most_notice, limit / part_of_limit);
    const std::string study = fs::absolute(arguments.operands.front()).string();
    const std::string folder = fs::absolute(arguments.out.value_or(fs::path("results") / open.study.name)).string();
    std::string plugins;
    for (const fs::path& file : arguments.plugins) plugins += " --plugin " + shell_word(fs::absolute(file).string());
    const std::string cpus =
        arguments.cpus > 0 ? fmt::format("--cpus-per-task={}", arguments.cpus) : std::string("--exclusive");
    const std::string each = arguments.cpus > 0 ? "\"$SLURM_CPUS_PER_TASK\"" : "\"$SLURM_CPUS_ON_NODE\"";
    out << fmt::format(
        R"(#!/bin/sh
#SBATCH --job-name={name}
#SBATCH --nodes={nodes} --ntasks-per-node=1 {cpus} --time={time}
#SBATCH --signal=USR1@{notice} --requeue --open-mode=append
#
# One rank for each machine, which starts a worker for each processor there. {notice} s before its time limit the run
# keeps what is under way and ends (130); then, and when a machine is lost, the job goes back into the queue and goes on
# where it was. `ricochet status {folder}` says how far it is, from any machine.

mkdir -p {folder} && : >{folder}/.started
srun --mpi=pmix --kill-on-bad-exit=1 --cpus-per-task={each} \
  {program} run {study} --out {folder}{plugins}
code=$?
# srun says 0 as well where it could not start the ranks; a run that came to its end has written its report.
[ $code -ne 0 ] || [ {folder}/report.html -nt {folder}/.started ] || code=1
rm -f {folder}/.started
case $code in
  {final}) exit $code ;; # done, or nothing that another try would mend
esac
# A node that is stopped while it clears away what is left of the ranks would not start them again.
[ "${{SLURM_RESTART_COUNT:-0}}" -lt 10 ] && sleep 5 && scontrol requeue "$SLURM_JOB_ID"
exit $code
)",
        fmt::arg("name", shell_word(open.study.name)), fmt::arg("nodes", std::max(1, arguments.nodes)),
        fmt::arg("cpus", cpus), fmt::arg("time", arguments.time), fmt::arg("notice", notice), fmt::arg("each", each),
        fmt::arg("program", shell_word(program.string())), fmt::arg("study", shell_word(study)),
        fmt::arg("folder", shell_word(folder)), fmt::arg("plugins", plugins), fmt::arg("final", final_codes()));
    return exit_done;
  });
}

}  // namespace ricochet
