#include "runners/workers/worker_environment.hpp"

#include <unistd.h>

#include <algorithm>
#include <array>
#include <string_view>

#include "runners/store/fingerprint.hpp"

namespace ricochet {

const std::string& worker_program() {
  static const std::string program = program_file().string();
  return program;
}

std::vector<std::string> worker_environment() {
  constexpr std::array<std::string_view, 5> of_launchers = {"OMPI_", "PMIX_", "PMI_", "MPI_LOCAL", "OPAL_"};
  std::vector<std::string> variables;
  for (char** one = environ; *one; ++one)
    if (const std::string_view text = *one; std::none_of(of_launchers.begin(), of_launchers.end(),
                                                         [&](std::string_view head) { return text.starts_with(head); }))
      variables.emplace_back(text);
  // A worker is one thread: those of a BLAS would wait beside it, as many as there are processors, in every worker.
  for (const std::string_view name : {"OPENBLAS_NUM_THREADS=", "OMP_NUM_THREADS="})
    if (std::none_of(variables.begin(), variables.end(), [&](const auto& one) { return one.starts_with(name); }))
      variables.push_back(std::string(name) + "1");
  return variables;
}

sigset_t coordinator_signals() {
  sigset_t set;
  sigemptyset(&set);
  for (const int one : signals_of_coordinator) sigaddset(&set, one);
  return set;
}

}  // namespace ricochet
