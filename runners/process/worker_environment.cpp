#include "runners/process/worker_environment.hpp"

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
  return variables;
}

}  // namespace ricochet
