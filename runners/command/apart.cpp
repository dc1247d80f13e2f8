#include <iostream>
#include <limits>
#include <ricochet/loader/child.hpp>
#include <sstream>

#include "runners/command/command.hpp"
#include "runners/command/subcommand.hpp"
#include "runners/plan_files/plan_file.hpp"
#include "runners/workers/worker_process.hpp"

namespace ricochet {
namespace {

bool finds_foreign_libraries(const std::vector<std::filesystem::path>& plugins) {
  const Catalogue catalogue = standard_catalogue(plugins);
  for (const Provided& method : catalogue.provided())
    if (catalogue.foreign(method.file)) return true;
  return false;
}

}  // namespace

int march_apart(const Arguments& arguments, std::ostream& out, const std::function<int(std::ostream&)>& work) {
  if (!finds_foreign_libraries(arguments.plugins)) return work(out);
  const ChildOutcome outcome = run_in_child({.work =
                                                 [&] {
                                                   std::ostringstream text;
                                                   const auto code =
                                                       exit_code_of([&] { return work(text); }, std::cerr);
                                                   return std::string(1, static_cast<char>(code)) + text.str();
                                                 },
                                             .seconds = std::numeric_limits<double>::infinity(),
                                             .memory = memory_for_each(free_memory(), 1)});
  if (outcome.ok() && !outcome.text.empty()) {
    out << outcome.text.substr(1);
    return static_cast<unsigned char>(outcome.text.front());
  }
  std::cerr << "ricochet: " << outcome.sentence() << "\n";
  return exit_some_failed;
}

}  // namespace ricochet
