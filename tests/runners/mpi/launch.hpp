#pragma once
#include <sys/types.h>

#include <string>
#include <vector>

#include "tests/runners/scratch_folder.hpp"
#include "tests/runners/workers/quick_studies.hpp"

/// \file
/// Programs that are started as a person starts them, and runs of one study in every way that there is.
namespace launch {

struct Ended {
  int code = 0;  ///< minus the signal that ended it
  std::string out, messages;
  /// How often a word stands in its messages.
  int told(const std::string& word) const;
};

/// Whether this machine or this build goes without what these tests need: then says so, and ctest calls it skipped.
bool without_mpi();
bool without_slurm();

/// "run STUDY --jobs 2 --out OUT" of this study, written as OUT.json.
std::string run_words(const ScratchFolder& scratch, const quick_studies::Json& study, const std::string& out);
/// The program with these words.
std::string program(const std::string& words);
/// The file of the program that ranks are.
std::string ranks_program();
/// So many ranks of it on this machine; `launcher`: further words for mpirun.
std::string ranks(int count, const std::string& words, const std::string& launcher = "");
/// Words of mpirun, without a program.
std::string mpirun(const std::string& words);

/// A line of a shell, to its end.
Ended to_its_end(const ScratchFolder& scratch, const std::string& line);

/// A line of a shell, under way in a session of its own, which ends with this object.
class UnderWay {
 public:
  UnderWay(const ScratchFolder& scratch, const std::string& line);
  ~UnderWay();
  UnderWay(const UnderWay&) = delete;
  UnderWay& operator=(const UnderWay&) = delete;

  pid_t process() const { return process_; }
  bool ended() const;
  /// Sends a signal to the program, and waits; after fifteen minutes it is killed.
  Ended finish(int signal = 0);
  /// Processes below it with these words in their command line, "ricochet worker".
  std::vector<pid_t> below(const std::string& words) const;

 private:
  void give_up_a_launcher();

  const ScratchFolder& scratch_;
  pid_t process_ = -1;
  int status_ = 0;
  mutable bool seen_ = false;  // something of the program below it
};

/// The ranks below a process: a rank's number, or minus one for any but 0.
std::vector<pid_t> ranks_below(const UnderWay& run, int rank);

/// All processes with these words in their command line.
std::vector<pid_t> processes(const std::string& words);

/// 0 where it is gone.
pid_t parent_of(pid_t process);

}  // namespace launch
