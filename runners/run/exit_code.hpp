#pragma once

namespace ricochet {

/// Exit codes of the command (runners/README.md).
enum ExitCode {
  exit_done = 0,
  exit_bug = 1,          ///< our fault: an error that nothing else explains
  exit_bad_input = 2,    ///< bad study or usage
  exit_some_failed = 3,  ///< or none ran
  exit_plugin = 4,       ///< plugin missing or incompatible
  exit_store = 5,        ///< the store, an output or the machine's memory
  exit_not_met = 6,      ///< an ask that must have a yes has none
  exit_interrupted = 130
};

}  // namespace ricochet
